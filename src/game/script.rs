//! Scripts: a player's intents and their durations, as text.
//!
//! ```text
//! # Out of the gate, and once around.
//! level      cellar
//! difficulty hard
//!
//! [walking]
//! 2.5 s     forward
//! 1 s       forward run
//! 3 steps   stand
//!
//! [turning]
//! 4 s       turn-left
//! ```
//!
//! A line has a duration, in seconds or steps, and all intents during that time, or `stand` for
//! none. `turn:1.5` and `tilt:-0.25` are the angles, in degrees, by which the player turns
//! clockwise and tilts up in each step. A name in brackets begins a section, for reports on parts
//! of a script. A `#` begins a comment. Lines at the top set the `level`, the `difficulty` and the
//! `seed` of the game. The program that plays the script chooses the settings that they leave out.
//! The same script in the same map produces the same states, bit for bit.
//!
//! A player may take time back. `10 s taken-back` removes the ten seconds before it: such a line is
//! appended while the game is played. The script that is read contains what remains, and counts
//! these lines. A line `taken-back 2` at the top says how often the script was shortened before it
//! was written. Rejected: a step that replays would have to undo. Each reader of a script would need
//! earlier states of the game.
//!
//! Rejected: lists of presses and releases with times. Authors would have to add up times, and a
//! missing line would hold a key forever.

use std::io::Write;
use std::ops::Range;
use std::{fmt, io};

use super::{Intent, Intents, Rules, STEPS_PER_SECOND, intent};
use crate::fault::{Fault, Faults, nearest_or_all, quoted};
use crate::world::Difficulty;

/// A script.
///
/// ```
/// use cellcaster::game::{Game, Script};
/// use cellcaster::map::builtin;
///
/// let script = Script::parse("1 s forward\n30 steps turn-left run\n", "walk.script")?;
/// let mut game = Game::new(builtin::LEVELS[0].world()?);
/// for (_section, intents) in script.iter() {
///     game.step(intents);
/// }
/// assert_eq!((script.steps(), game.elapsed()), (90, 1.5));
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Script {
    header: Header,
    sections: Vec<Section>,
}

/// A section of a script, with at least one stretch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// The name. Empty for the stretches before the first named section.
    pub name: String,
    /// The stretches of the section.
    pub stretches: Vec<Stretch>,
}

/// A period during which the intents do not change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// The duration in steps of [`STEP`](super::STEP) seconds, from 1 to [`Stretch::MAX_STEPS`].
    pub steps: u32,
    /// The intents in each of these steps.
    pub intents: Intents,
}

impl Script {
    /// Reads a script. Faults refer to it as `name`.
    ///
    /// # Errors
    /// All faults of the text.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let mut reader = ScriptReader {
            text,
            header: Header::default(),
            sections: Vec::new(),
            faults: Vec::new(),
        };
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let end = line.find('#').unwrap_or(line.len());
            reader.read_line(trimmed(text, start..start + end));
            start += line.len();
        }
        reader.end(name)
    }

    /// Like [`parse`](Self::parse), but reads the content of a file.
    ///
    /// # Errors
    /// All faults of the text, or the fault that it is not UTF-8.
    pub fn from_bytes(content: Vec<u8>, name: &str) -> Result<Self, Faults> {
        Self::parse(&Faults::text_of(content, name, "script")?, name)
    }

    /// The settings of the game that the script belongs to.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The sections in order. There is at least one, and none is empty.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The duration of the script, in steps.
    pub fn steps(&self) -> u64 {
        self.sections.iter().map(Section::steps).sum()
    }

    /// The intents of each step, with the index of its section.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Intents)> {
        let stretches = self.sections.iter().enumerate().flat_map(|(index, section)| {
            section.stretches.iter().map(move |&stretch| (index, stretch))
        });
        stretches.flat_map(|(index, Stretch { steps, intents })| {
            (0..steps).map(move |_| (index, intents))
        })
    }
}

impl Section {
    /// The duration in steps.
    pub fn steps(&self) -> u64 {
        self.stretches.iter().map(|stretch| u64::from(stretch.steps)).sum()
    }
}

impl Stretch {
    /// One hour.
    pub const MAX_STEPS: u32 = 60 * 60 * STEPS_PER_SECOND;
}

/// Multiples of this many steps are exact in seconds with one decimal digit.
const STEPS_PER_TENTH: u32 = STEPS_PER_SECOND / 10;
/// The word for no intents.
const STAND: &str = "stand";

impl fmt::Display for Script {
    /// Writes text that parses to an equal script.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.header.fmt(f)?;
        if !self.header.is_empty() && self.sections.first().is_some_and(|it| it.name.is_empty()) {
            writeln!(f)?;
        }
        for (index, section) in self.sections.iter().enumerate() {
            if !section.name.is_empty() {
                let is_first = index == 0 && self.header.is_empty();
                let blank = if is_first { "" } else { "\n" };
                writeln!(f, "{blank}[{}]", section.name)?;
            }
            section.stretches.iter().try_for_each(|stretch| writeln!(f, "{stretch}"))?;
        }
        Ok(())
    }
}

impl fmt::Display for Stretch {
    /// Writes the line without a line break.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<9} {}", duration(self.steps), self.intents.words())
    }
}

/// The first words of a line that lasts `steps` steps.
fn duration(steps: u32) -> String {
    match steps {
        1 => "1 step".to_owned(),
        steps if steps.is_multiple_of(STEPS_PER_TENTH) => {
            format!("{} s", f64::from(steps) / f64::from(STEPS_PER_SECOND))
        }
        steps => format!("{steps} steps"),
    }
}

impl Intents {
    /// The words for the set in a script.
    pub fn words(self) -> String {
        let names = self.iter().map(|intent| intent.name().to_owned());
        let wanted: Vec<String> = names.chain(self.look().words()).collect();
        if wanted.is_empty() { STAND.to_owned() } else { wanted.join(" ") }
    }

    /// The set that the words of a script name; `None` if they do not name a set.
    pub fn from_words(text: &str) -> Option<Self> {
        let words = words(text, 0..text.len());
        if words.is_empty() { None } else { read_intents(text, &words).ok() }
    }
}

/// The settings of a game in a script's header. Each is optional.
///
/// ```
/// use cellcaster::game::Script;
///
/// let script = Script::parse("level cellar\nseed 7\n2 s forward\n", "walk.script")?;
/// assert_eq!(script.header().level.as_ref().unwrap().as_str(), "cellar");
/// assert_eq!((script.header().difficulty, script.header().seed), (None, Some(7)));
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Header {
    /// The level.
    pub level: Option<LevelName>,
    /// The difficulty.
    pub difficulty: Option<Difficulty>,
    /// The seed of the game's random numbers, and of the descent if the level is a floor. Levels
    /// from maps are played with the seed 0, so that they are the same for everyone and a route can
    /// be learnt.
    pub seed: Option<u64>,
    /// The number of times that the player has taken time back. The script lacks that time.
    pub taken_back: u32,
}

/// The name of a level in a header: the name of a built-in level, `floor` and a number for a
/// [descent](crate::generate::descent) from that floor on, or the path of a map file. It is one
/// line without `#`, and has no blanks at its ends.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LevelName(String);

/// The first words of the lines of a header.
const WORDS: [&str; 4] = [LEVEL, DIFFICULTY, SEED, TAKEN_BACK];
const LEVEL: &str = "level";
const DIFFICULTY: &str = "difficulty";
const SEED: &str = "seed";
/// Also the word after the duration that a line takes back.
const TAKEN_BACK: &str = "taken-back";
/// The word before the number of a floor.
const FLOOR: &str = "floor ";

impl LevelName {
    /// The level name `name`; `None` if it is not valid in a header.
    pub fn new(name: &str) -> Option<Self> {
        let is_line = !name.is_empty() && name.trim() == name;
        let is_plain = !name.contains(|c: char| c == '#' || c.is_control());
        (is_line && is_plain).then(|| Self(name.to_owned()))
    }

    /// The name of a floor of the descent, counted from 1.
    pub fn of_floor(number: u32) -> Self {
        Self(format!("{FLOOR}{number}"))
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The number of the floor; `None` if the level is not a floor.
    pub fn floor(&self) -> Option<u32> {
        let number = self.0.strip_prefix(FLOOR)?.trim_start().parse().ok();
        number.filter(|&number| number > 0)
    }
}

impl fmt::Display for Header {
    /// Writes the header's lines.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(level) = &self.level {
            writeln!(f, "{LEVEL:<10} {}", level.as_str())?;
        }
        if let Some(difficulty) = self.difficulty {
            writeln!(f, "{DIFFICULTY:<10} {}", difficulty.name())?;
        }
        if let Some(seed) = self.seed {
            writeln!(f, "{SEED:<10} {seed}")?;
        }
        if self.taken_back > 0 {
            writeln!(f, "{TAKEN_BACK:<10} {}", self.taken_back)?;
        }
        Ok(())
    }
}

impl Header {
    /// The header of a game in `level` with these rules.
    pub fn of(level: Option<LevelName>, rules: Rules) -> Self {
        Self { level, difficulty: Some(rules.difficulty), seed: Some(rules.seed), taken_back: 0 }
    }

    /// The rules, with defaults for missing values.
    pub fn rules(&self) -> Rules {
        let Rules { difficulty, seed } = Rules::default();
        Rules { difficulty: self.difficulty.unwrap_or(difficulty), seed: self.seed.unwrap_or(seed) }
    }

    /// Whether the header has no values.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether a line that begins with `word` belongs to a header.
    pub(crate) fn has(word: &str) -> bool {
        WORDS.contains(&word)
    }

    /// Reads a line that begins with one of the header's words.
    pub(crate) fn read_line(&mut self, text: &str, line: Range<usize>) -> Result<(), Fault> {
        let Some(first) = words(text, line.clone()).into_iter().next() else { return Ok(()) };
        let word = &text[first.clone()];
        let value_place = trimmed(text, first.end..line.end);
        let value = &text[value_place.clone()];
        let is_said = match word {
            LEVEL => self.level.is_some(),
            DIFFICULTY => self.difficulty.is_some(),
            TAKEN_BACK => self.taken_back > 0,
            _ => self.seed.is_some(),
        };
        if is_said {
            return Err(
                Fault::new(line, format!("{} is set twice", quoted(word))).label("once is enough")
            );
        }
        if value.is_empty() {
            return Err(Fault::new(first, format!("{} has no value", quoted(word)))
                .label("a value is missing")
                .help(example(word)));
        }
        let is_read = match word {
            LEVEL => {
                self.level = LevelName::new(value);
                self.level.is_some()
            }
            DIFFICULTY => {
                self.difficulty = Difficulty::named(value);
                self.difficulty.is_some()
            }
            TAKEN_BACK => {
                self.taken_back = value.parse().unwrap_or(0);
                self.taken_back > 0
            }
            _ => {
                self.seed = value.parse().ok();
                self.seed.is_some()
            }
        };
        if is_read { Ok(()) } else { Err(no_value(word, value, value_place)) }
    }
}

fn no_value(word: &str, value: &str, place: Range<usize>) -> Fault {
    let message = match word {
        LEVEL => "a level's name must not contain control characters".to_owned(),
        DIFFICULTY => format!("there is no difficulty {}", quoted(value)),
        TAKEN_BACK => "a script with taken-back needs a count of at least 1".to_owned(),
        _ => "a seed is a whole number from 0 to 18446744073709551615".to_owned(),
    };
    let names = Difficulty::ALL.map(Difficulty::name);
    let help = match word {
        DIFFICULTY => nearest_or_all(value, &names, "the nearest is", "write one of"),
        _ => example(word),
    };
    Fault::new(place, message).label("not valid").help(help)
}

fn example(word: &str) -> String {
    match word {
        LEVEL => "write level cellar, level floor 3 or level my.toml".to_owned(),
        DIFFICULTY => "write difficulty easy, difficulty normal or difficulty hard".to_owned(),
        TAKEN_BACK => "write taken-back 2".to_owned(),
        _ => "write seed 7".to_owned(),
    }
}

/// Writes a script while the game is played.
///
/// The recorder writes a stretch in one piece when the stretch ends, so the output is a valid
/// script at any time. It writes the last stretch when it is [finished](ScriptWriter::finish) or
/// dropped.
#[derive(Debug)]
pub struct ScriptWriter<W: Write> {
    output: W,
    /// Written before the first stretch, so that a game that did not start leaves no output.
    header: Option<Header>,
    current: Option<Stretch>,
}

impl<W: Write> ScriptWriter<W> {
    /// A recorder that writes to `output`.
    pub fn new(output: W) -> Self {
        Self { output, header: None, current: None }
    }

    /// A recorder that writes `header` before the script.
    pub fn with_header(output: W, header: Header) -> Self {
        let header = Some(header).filter(|header| !header.is_empty());
        Self { output, header, current: None }
    }

    /// Records `steps` more steps with `intents`.
    ///
    /// # Errors
    /// If `output` fails.
    pub fn record(&mut self, intents: Intents, mut steps: u64) -> io::Result<()> {
        while steps > 0 {
            let before = match self.current {
                Some(stretch) if stretch.intents == intents => stretch.steps,
                _ => {
                    self.write_current()?;
                    0
                }
            };
            let taken = steps.min(u64::from(Stretch::MAX_STEPS - before)) as u32;
            steps -= u64::from(taken);
            self.current = Some(Stretch { steps: before + taken, intents });
            if steps > 0 {
                self.write_current()?;
            }
        }
        Ok(())
    }

    /// Sets the number of times that time was taken back before the script begins. Has no effect
    /// once a stretch has been written.
    pub fn set_taken_back(&mut self, count: u32) {
        self.header.iter_mut().for_each(|header| header.taken_back = count);
    }

    /// Records that the player takes back the last `steps` steps, at most an hour.
    ///
    /// # Errors
    /// If `output` fails.
    pub fn take_back(&mut self, steps: u32) -> io::Result<()> {
        self.write_current()?;
        self.output.write_all(format!("{:<9} {TAKEN_BACK}\n", duration(steps)).as_bytes())
    }

    /// Writes the last stretch.
    ///
    /// # Errors
    /// If `output` fails.
    pub fn finish(&mut self) -> io::Result<()> {
        self.write_current()?;
        self.output.flush()
    }

    fn write_current(&mut self) -> io::Result<()> {
        let Some(stretch) = self.current.take() else { return Ok(()) };
        if let Some(header) = self.header.take() {
            self.output.write_all(format!("{header}\n").as_bytes())?;
        }
        self.output.write_all(format!("{stretch}\n").as_bytes())
    }
}

impl<W: Write> Drop for ScriptWriter<W> {
    fn drop(&mut self) {
        // Callers that need the error have called `finish`.
        _ = self.finish();
    }
}

/// The parts of a script that have been read.
struct ScriptReader<'t> {
    text: &'t str,
    header: Header,
    sections: Vec<PlacedSection>,
    faults: Vec<Fault>,
}

/// A line that begins with a duration.
enum ScriptLine {
    Stretch(Stretch),
    /// The number of steps before the line that are removed.
    TakenBack(u32),
}

/// Removes the last `steps` steps of `stretches`. Returns the number of steps that were missing.
pub(crate) fn taken_back(stretches: &mut Vec<Stretch>, mut steps: u32) -> u32 {
    while steps > 0
        && let Some(last) = stretches.last_mut()
    {
        let removed = steps.min(last.steps);
        last.steps -= removed;
        steps -= removed;
        if last.steps == 0 {
            stretches.pop();
        }
    }
    steps
}

/// A section, and the place of its name.
struct PlacedSection {
    section: Section,
    place: Range<usize>,
}

impl ScriptReader<'_> {
    fn read_line(&mut self, line: Range<usize>) {
        if line.is_empty() {
            return;
        }
        if self.text[line.clone()].starts_with('[') {
            return self.read_name(line);
        }
        if words(self.text, line.clone())
            .first()
            .is_some_and(|it| Header::has(&self.text[it.clone()]))
        {
            return self.read_header(line);
        }
        match self.stretch(line) {
            Ok(ScriptLine::Stretch(stretch)) => self.section().stretches.push(stretch),
            Ok(ScriptLine::TakenBack(steps)) => self.take_back(steps),
            Err(fault) => {
                // One fault is enough. If this line were correct, the section would not be empty.
                self.faults.push(fault);
            }
        }
    }

    fn read_header(&mut self, line: Range<usize>) {
        let read = if self.sections.is_empty() {
            self.header.read_line(self.text, line)
        } else {
            Err(Fault::new(line, "level, difficulty and seed come before everything else")
                .label("too late")
                .help("move this line to the top"))
        };
        self.faults.extend(read.err());
    }

    /// Removes the last `steps` steps, and the sections that then have none.
    fn take_back(&mut self, mut steps: u32) {
        self.header.taken_back = self.header.taken_back.saturating_add(1);
        while let Some(PlacedSection { section, .. }) = self.sections.last_mut() {
            steps = taken_back(&mut section.stretches, steps);
            if !section.stretches.is_empty() {
                break;
            }
            self.sections.pop();
        }
    }

    /// The current section.
    fn section(&mut self) -> &mut Section {
        if self.sections.is_empty() {
            self.begin_section(String::new(), 0..0);
        }
        let last = self.sections.len() - 1;
        &mut self.sections[last].section
    }

    fn begin_section(&mut self, name: String, place: Range<usize>) {
        self.sections
            .push(PlacedSection { section: Section { name, stretches: Vec::new() }, place });
    }

    fn read_name(&mut self, line: Range<usize>) {
        let text = &self.text[line.clone()];
        let name = text.strip_prefix('[').and_then(|text| text.strip_suffix(']'));
        let name =
            name.map(str::trim).filter(|name| !name.is_empty() && !name.contains(['[', ']']));
        match name {
            Some(name) => self.begin_section(name.to_owned(), line),
            None => self.faults.push(
                Fault::new(
                    line,
                    "a section begins with its name in brackets, on a line of its own",
                )
                .help("write [walking]"),
            ),
        }
    }

    fn stretch(&self, line: Range<usize>) -> Result<ScriptLine, Fault> {
        let (steps, rest) = self.duration(line.clone())?;
        let words = words(self.text, rest.clone());
        if &self.text[trimmed(self.text, rest)] == TAKEN_BACK {
            return Ok(ScriptLine::TakenBack(steps));
        }
        if words.is_empty() {
            return Err(Fault::new(line, "a line needs an intent after its duration")
                .label("an intent is missing")
                .help(format!("write {STAND:?} to do nothing")));
        }
        Ok(ScriptLine::Stretch(Stretch { steps, intents: read_intents(self.text, &words)? }))
    }

    /// The number of steps of a line, and the rest of the line.
    fn duration(&self, line: Range<usize>) -> Result<(u32, Range<usize>), Fault> {
        let text = &self.text[line.clone()];
        let length = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
        let number = line.start..line.start + length;
        let Ok(amount) = text[..length].parse::<f64>() else {
            let first = words(self.text, line).swap_remove(0);
            return Err(Fault::new(first, "a line begins with its duration")
                .label("not a number")
                .help("write 2.5 s forward, or 12 steps forward turn-left"));
        };
        let rest = trimmed(self.text, number.end..line.end);
        let unit = words(self.text, rest.clone()).into_iter().next().unwrap_or(number.clone());
        let steps = match &self.text[unit.clone()] {
            "s" => (amount * f64::from(STEPS_PER_SECOND)).round(),
            "step" | "steps" if amount.fract() == 0.0 => amount,
            "step" | "steps" => {
                return Err(Fault::new(number, "a step cannot be divided")
                    .label("not a whole number")
                    .help(format!("a second has {STEPS_PER_SECOND} steps")));
            }
            _ => {
                return Err(Fault::new(unit, "a duration is in seconds or in steps")
                    .label("not a unit of time")
                    .help("write 2.5 s, or 150 steps"));
            }
        };
        if !(1.0..=f64::from(Stretch::MAX_STEPS)).contains(&steps) {
            return Err(Fault::new(number, "a line lasts from one step to one hour")
                .label(if steps < 1.0 { "too short" } else { "too long" })
                .help(format!("a second has {STEPS_PER_SECOND} steps")));
        }
        Ok((steps as u32, unit.end..rest.end))
    }

    fn end(mut self, name: &str) -> Result<Script, Faults> {
        if self.faults.is_empty() && self.sections.is_empty() {
            return Err(Faults::of_whole_file(
                name,
                &format!("{name} has no line with a duration"),
                "write a line such as 2.5 s forward",
            ));
        }
        if self.faults.is_empty() {
            let empty = self.sections.iter().filter(|named| named.section.stretches.is_empty());
            self.faults.extend(empty.map(|named| {
                Fault::new(named.place.clone(), "a section needs at least one line with a duration")
                    .label("this one is empty")
            }));
        }
        if self.faults.is_empty() {
            let sections = self.sections.into_iter().map(|named| named.section).collect();
            Ok(Script { header: self.header, sections })
        } else {
            Err(Faults::new(name, self.text, self.faults))
        }
    }
}

/// Adds the turn or tilt of `word`, such as `turn:-1.5`, to `intents`.
fn looking(intents: Intents, word: &str, place: Range<usize>) -> Result<Intents, Fault> {
    let (name, degrees) = word.split_once(':').unwrap_or((word, ""));
    let mut look = intents.look();
    let amount = match name {
        intent::TURN => &mut look.turn,
        intent::TILT => &mut look.tilt,
        _ => return Err(unknown(word, place)),
    };
    if *amount != 0 {
        return Err(wanted_twice(name, place));
    }
    let Some(hundredths) = intent::hundredths(degrees) else {
        let help = format!("write {name}:2.5, or {name}:-0.25; 327.67 is the maximum");
        return Err(Fault::new(
            place,
            "an angle is in degrees, not 0, and has at most two decimals",
        )
        .label("not valid")
        .help(help));
    };
    *amount = hundredths;
    Ok(intents.with_look(look))
}

fn read_intents(text: &str, words: &[Range<usize>]) -> Result<Intents, Fault> {
    let mut intents = Intents::new();
    for place in words.iter().cloned() {
        match (&text[place.clone()], words.len()) {
            (STAND, 1) => {}
            (STAND, _) => {
                return Err(Fault::new(place, "\"stand\" cannot be combined with other intents")
                    .label("remove this, or all the others"));
            }
            (word, _) if word.contains(':') => intents = looking(intents, word, place)?,
            (word, _) => match Intent::named(word) {
                None => return Err(unknown(word, place)),
                Some(intent) if intents.contains(intent) => {
                    return Err(wanted_twice(word, place));
                }
                Some(intent) => intents.insert(intent),
            },
        }
    }
    Ok(intents)
}

fn wanted_twice(word: &str, place: Range<usize>) -> Fault {
    Fault::new(place, format!("{} is repeated", quoted(word))).label("once is enough")
}

fn unknown(word: &str, place: Range<usize>) -> Fault {
    let names: Vec<&str> = Intent::ALL.into_iter().map(Intent::name).chain([STAND]).collect();
    let help = nearest_or_all(word, &names, "the nearest is", "known intents:");
    Fault::new(place, format!("unknown intent {}", quoted(word))).label("unknown").help(help)
}

/// The words in a part of `text`.
fn words(text: &str, part: Range<usize>) -> Vec<Range<usize>> {
    let mut words = Vec::new();
    let mut start = part.start;
    for piece in text[part].split_inclusive(char::is_whitespace) {
        let word = trimmed(text, start..start + piece.len());
        if !word.is_empty() {
            words.push(word);
        }
        start += piece.len();
    }
    words
}

/// A part of `text` without surrounding blanks.
fn trimmed(text: &str, part: Range<usize>) -> Range<usize> {
    let whole = &text[part.clone()];
    let start = part.start + (whole.len() - whole.trim_start().len());
    start..(part.start + whole.trim_end().len()).max(start)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::game::{Intent, Look};
    use crate::world::Difficulty;

    pub(crate) fn stretches() -> impl Strategy<Value = Vec<Stretch>> {
        let intents = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=Intent::ALL.len());
        let stretch = (1..=Stretch::MAX_STEPS, intents)
            .prop_map(|(steps, intents)| Stretch { steps, intents: intents.into_iter().collect() });
        let amount = || prop_oneof![Just(0), -i16::MAX..=i16::MAX];
        let look = (amount(), amount()).prop_map(|(turn, tilt)| Look { turn, tilt });
        let stretch = (stretch, look).prop_map(|(stretch, look)| Stretch {
            intents: stretch.intents.with_look(look),
            ..stretch
        });
        prop::collection::vec(stretch, 1..10)
    }

    fn header() -> impl Strategy<Value = Header> {
        let level = prop_oneof![
            ".{1,12}".prop_filter_map("one line", |name| LevelName::new(&name)),
            (1..9_u32).prop_map(LevelName::of_floor),
        ];
        let difficulty = prop::sample::select(&Difficulty::ALL);
        let settings =
            (prop::option::of(level), prop::option::of(difficulty), any::<Option<u64>>());
        (settings, 0..9_u32).prop_map(|((level, difficulty, seed), taken_back)| Header {
            level,
            difficulty,
            seed,
            taken_back,
        })
    }

    fn script() -> impl Strategy<Value = Script> {
        let named = ("[a-zä]([a-z ]{0,8}[a-z])?", stretches());
        (header(), prop::option::of(stretches()), prop::collection::vec(named, 1..4)).prop_map(
            |(header, first, named)| {
                let first = first.into_iter().map(|stretches| (String::new(), stretches));
                let section = |(name, stretches)| Section { name, stretches };
                Script { header, sections: first.chain(named).map(section).collect() }
            },
        )
    }

    proptest! {
        #[test]
        fn a_written_script_reads_back_unchanged(script in script()) {
            let text = script.to_string();
            prop_assert_eq!(Script::parse(&text, "it").map_err(|faults| faults.to_string()), Ok(script));
        }
    }

    #[test]
    fn a_header_names_the_game() {
        let text = "# all\nseed 7 # of chance\nlevel  my maps/a.toml\n[b]\n1 s stand\n";
        let script = Script::parse(text, "it").unwrap();
        assert_eq!(
            script.to_string(),
            "level      my maps/a.toml\nseed       7\n\n[b]\n1 s       stand\n"
        );
        let floor = |name| LevelName::new(name).and_then(|name| name.floor());
        assert_eq!(
            ["floor 3", "floor 0", "floor", "floor3"].map(floor),
            [Some(3), None, None, None]
        );
        assert_eq!(LevelName::of_floor(12).floor(), Some(12));
    }

    #[test]
    fn a_script_expands_to_its_steps() {
        let text = "1 step forward\n[b] # two\n0.05s stand\n2 steps run  open\n";
        let script = Script::parse(text, "it").unwrap();
        let wanted: Vec<(usize, Vec<Intent>)> =
            script.iter().map(|(section, intents)| (section, intents.iter().collect())).collect();
        let running = (1, vec![Intent::Run, Intent::Open]);
        let expected = [
            (0, vec![Intent::Forward]),
            (1, vec![]),
            (1, vec![]),
            (1, vec![]),
            running.clone(),
            running,
        ];
        assert_eq!(wanted, expected);
        assert_eq!(script.steps(), 6);
        assert_eq!(
            script.to_string(),
            "1 step    forward\n\n[b]\n3 steps   stand\n2 steps   run open\n"
        );
    }

    proptest! {
        #[test]
        fn a_recording_reads_back_as_the_steps_played(
            happened in prop::collection::vec((0..3_usize, 0..400_u64), 1..20)
        ) {
            let wants = [Intents::new(), [Intent::Run].into_iter().collect(), Intent::ALL.into_iter().collect()];
            prop_assume!(happened.iter().any(|&(_, steps)| steps > 0));
            let mut text = Vec::new();
            let mut recorder = ScriptWriter::new(&mut text);
            for &(want, steps) in &happened {
                recorder.record(wants[want], steps)?;
            }
            drop(recorder);
            let script = Script::parse(&String::from_utf8(text)?, "it").unwrap();
            let each = |&(want, steps): &(usize, u64)| (0..steps).map(move |_| wants[want]);
            prop_assert!(script.iter().map(|(_, intents)| intents).eq(happened.iter().flat_map(each)));
        }
    }

    proptest! {
        #[test]
        fn a_recording_reads_back_without_the_time_taken_back(
            happened in prop::collection::vec((0..3_usize, 1..400_u32, any::<bool>()), 1..20)
        ) {
            let wants = [Intents::new(), [Intent::Run].into_iter().collect(), Intent::ALL.into_iter().collect()];
            let (mut text, mut remaining, mut count) = (Vec::new(), Vec::new(), 0);
            let mut recorder = ScriptWriter::new(&mut text);
            for &(want, steps, is_taken_back) in &happened {
                if is_taken_back && !remaining.is_empty() {
                    recorder.take_back(steps)?;
                    remaining.truncate(remaining.len().saturating_sub(steps as usize));
                    count += 1;
                } else {
                    recorder.record(wants[want], steps.into())?;
                    remaining.extend(std::iter::repeat_n(wants[want], steps as usize));
                }
            }
            drop(recorder);
            prop_assume!(!remaining.is_empty());
            let script = Script::parse(&String::from_utf8(text)?, "it").unwrap();
            prop_assert!(script.iter().map(|(_, intents)| intents).eq(remaining));
            prop_assert_eq!(script.header().taken_back, count);
        }
    }

    #[test]
    fn time_is_taken_back_across_sections() {
        let text = "taken-back 2\n2 s run\n[b]\n1 s jump\n1.5 s taken-back\n1 s duck\n";
        let script = Script::parse(text, "it").unwrap();
        assert_eq!(script.to_string(), "taken-back 3\n\n1.5 s     run\n1 s       duck\n");
    }

    #[test]
    fn the_header_is_written_with_the_first_stretch() {
        let header = Header { seed: Some(7), ..Header::default() };
        let mut text = Vec::new();
        drop(ScriptWriter::with_header(&mut text, header.clone()));
        assert!(text.is_empty());
        ScriptWriter::with_header(&mut text, header).record(Intents::new(), 60).unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), "seed       7\n\n1 s       stand\n");
    }

    #[test]
    fn an_overlong_stretch_takes_several_lines() {
        let mut text = Vec::new();
        ScriptWriter::new(&mut text)
            .record(Intents::new(), 2 * u64::from(Stretch::MAX_STEPS) + 1)
            .unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "3600 s    stand\n3600 s    stand\n1 step    stand\n"
        );
    }
}
