//! Scripts: what a player wants, and for how long, as text.
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
//! A line has a duration, in seconds or steps, and everything that is wanted meanwhile, or `stand`
//! for nothing. `turn:1.5` and `tilt:-0.25` are the degrees by which the player turns clockwise and
//! tilts up in each step. A name in brackets begins a section, for reports on parts of a script. A
//! `#` begins a comment. Lines at the top name the `level`, the `difficulty` and the `seed` of the game.
//! The program that plays the script chooses what they do not name. The same script in the same map
//! gives the same states, bit for bit.
//!
//! Lists of presses and releases with times were refused: their authors would have to add up times,
//! and a missing line would hold a key for ever.

mod header;
mod parse;
mod recorder;

use std::fmt;

use super::{Intents, STEPS_PER_SECOND};
use crate::fault::Faults;

pub use header::{Header, LevelName};
pub use recorder::Recorder;

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
    /// Empty for what comes before the first name.
    pub name: String,
    /// The stretches of the section.
    pub stretches: Vec<Stretch>,
}

/// A time during which the wanted intents do not change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// The duration in steps of [`STEP`](super::STEP) seconds, from 1 to [`Stretch::MOST_STEPS`].
    pub steps: u32,
    /// The wanted intents.
    pub intents: Intents,
}

impl Script {
    /// Reads a script, which faults call `name`.
    ///
    /// # Errors
    /// All faults of the text.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        parse::parse(text, name)
    }

    /// As [`parse`](Self::parse), from the content of a file.
    ///
    /// # Errors
    /// All faults of the text; or that it is not UTF-8.
    pub fn from_bytes(content: Vec<u8>, name: &str) -> Result<Self, Faults> {
        Self::parse(&Faults::text_of(content, name, "script")?, name)
    }

    /// The game that the script belongs to.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The sections in their order; there is at least one, and none is empty.
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
    pub const MOST_STEPS: u32 = 60 * 60 * STEPS_PER_SECOND;
}

/// Multiples of this many steps are written in seconds with one digit, without loss.
const STEPS_PER_TENTH: u32 = STEPS_PER_SECOND / 10;
/// The word for wanting nothing.
const STAND: &str = "stand";

impl fmt::Display for Script {
    /// A text that reads as the same script.
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
    /// A line without its end.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let duration = match self.steps {
            1 => "1 step".to_owned(),
            steps if steps.is_multiple_of(STEPS_PER_TENTH) => {
                format!("{} s", f64::from(steps) / f64::from(STEPS_PER_SECOND))
            }
            steps => format!("{steps} steps"),
        };
        write!(f, "{duration:<9} {}", self.intents.words())
    }
}

impl Intents {
    /// The words of a script for the set.
    pub fn words(self) -> String {
        let names = self.iter().map(|intent| intent.name().to_owned());
        let wanted: Vec<String> = names.chain(self.look().words()).collect();
        if wanted.is_empty() { STAND.to_owned() } else { wanted.join(" ") }
    }

    /// The set that words of a script name; `None` if they name none.
    pub fn from_words(words: &str) -> Option<Self> {
        parse::intents(words)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::game::{Intent, Look};
    use crate::world::Difficulty;

    pub(crate) fn stretches() -> impl Strategy<Value = Vec<Stretch>> {
        let intents = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=Intent::ALL.len());
        let stretch = (1..=Stretch::MOST_STEPS, intents)
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
        (prop::option::of(level), prop::option::of(difficulty), any::<Option<u64>>())
            .prop_map(|(level, difficulty, seed)| Header { level, difficulty, seed })
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
        fn what_is_written_reads_as_the_same(script in script()) {
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
    fn a_script_is_its_steps() {
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
}
