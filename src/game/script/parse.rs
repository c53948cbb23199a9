//! Parses a script; reports all its faults in one run.

use std::ops::Range;

use super::{Header, STAND, Script, Section, Stretch};
use crate::fault::{Fault, Faults, nearest, quoted};
use crate::game::{Intent, Intents, STEPS_PER_SECOND, look};

pub(crate) fn parse(text: &str, name: &str) -> Result<Script, Faults> {
    let mut reader =
        Reader { text, header: Header::default(), sections: Vec::new(), faults: Vec::new() };
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let end = line.find('#').unwrap_or(line.len());
        reader.read_line(trimmed(text, start..start + end));
        start += line.len();
    }
    reader.end(name)
}

/// What has been read so far.
struct Reader<'t> {
    text: &'t str,
    header: Header,
    sections: Vec<Named>,
    faults: Vec<Fault>,
}

/// A section, and the place of its name.
struct Named {
    section: Section,
    place: Range<usize>,
}

impl Reader<'_> {
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
            Ok(stretch) => self.section().stretches.push(stretch),
            Err(fault) => {
                // One fault is enough: if this line were correct, the section would not be empty.
                self.faults.push(fault);
            }
        }
    }

    fn read_header(&mut self, line: Range<usize>) {
        let read = if self.sections.is_empty() {
            self.header.read_line(self.text, line)
        } else {
            Err(Fault::new(line, "what a script is about stands before everything else")
                .label("too late")
                .help("move this line to the top"))
        };
        self.faults.extend(read.err());
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
        self.sections.push(Named { section: Section { name, stretches: Vec::new() }, place });
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

    fn stretch(&self, line: Range<usize>) -> Result<Stretch, Fault> {
        let (steps, rest) = self.duration(line.clone())?;
        let words = words(self.text, rest);
        if words.is_empty() {
            return Err(Fault::new(line, "a line says what is wanted after how long it is")
                .label("and then?")
                .help(format!("write {STAND:?} where nothing is")));
        }
        Ok(Stretch { steps, intents: self.intents(&words)? })
    }

    /// The number of steps of a line, and the rest of the line.
    fn duration(&self, line: Range<usize>) -> Result<(u32, Range<usize>), Fault> {
        let text = &self.text[line.clone()];
        let length = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
        let number = line.start..line.start + length;
        let Ok(amount) = text[..length].parse::<f64>() else {
            let first = words(self.text, line).swap_remove(0);
            return Err(Fault::new(first, "a line begins with how long it lasts")
                .label("not a number")
                .help("write 2.5 s forward, or 12 steps forward turn-left"));
        };
        let rest = trimmed(self.text, number.end..line.end);
        let unit = words(self.text, rest.clone()).into_iter().next().unwrap_or(number.clone());
        let steps = match &self.text[unit.clone()] {
            "s" => (amount * f64::from(STEPS_PER_SECOND)).round(),
            "step" | "steps" if amount.fract() == 0.0 => amount,
            "step" | "steps" => {
                return Err(Fault::new(number, "there is no part of a step")
                    .label("not a whole number")
                    .help(format!("a second has {STEPS_PER_SECOND} steps")));
            }
            _ => {
                return Err(Fault::new(unit, "a time is in seconds or in steps")
                    .label("no unit of time")
                    .help("write 2.5 s, or 150 steps"));
            }
        };
        if !(1.0..=f64::from(Stretch::MOST_STEPS)).contains(&steps) {
            return Err(Fault::new(number, "a line lasts from one step to one hour")
                .label(if steps < 1.0 { "too short" } else { "too long" })
                .help(format!("a second has {STEPS_PER_SECOND} steps")));
        }
        Ok((steps as u32, unit.end..rest.end))
    }

    fn intents(&self, words: &[Range<usize>]) -> Result<Intents, Fault> {
        let mut intents = Intents::new();
        for place in words.iter().cloned() {
            match (&self.text[place.clone()], words.len()) {
                (STAND, 1) => {}
                (STAND, _) => {
                    return Err(Fault::new(place, "who stands wants nothing else")
                        .label("take this away, or all the rest"));
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

    fn end(mut self, name: &str) -> Result<Script, Faults> {
        if self.faults.is_empty() && self.sections.is_empty() {
            return Err(Faults::of_whole_file(
                name,
                &format!("{name} holds no stretch of time"),
                "write a line such as 2.5 s forward",
            ));
        }
        if self.faults.is_empty() {
            let empty = self.sections.iter().filter(|named| named.section.stretches.is_empty());
            self.faults.extend(empty.map(|named| {
                Fault::new(named.place.clone(), "a section holds at least one stretch of time")
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

/// The intents that words name, as a line of a script does after its duration.
pub(crate) fn intents(words_of_line: &str) -> Option<Intents> {
    let reader = Reader {
        text: words_of_line,
        header: Header::default(),
        sections: Vec::new(),
        faults: Vec::new(),
    };
    let words = words(words_of_line, 0..words_of_line.len());
    if words.is_empty() { None } else { reader.intents(&words).ok() }
}

/// `intents` with the turn or tilt of `word`, such as `turn:-1.5`.
fn looking(intents: Intents, word: &str, place: Range<usize>) -> Result<Intents, Fault> {
    let (name, degrees) = word.split_once(':').unwrap_or((word, ""));
    let mut look = intents.look();
    let amount = match name {
        look::TURN => &mut look.turn,
        look::TILT => &mut look.tilt,
        _ => return Err(unknown(word, place)),
    };
    if *amount != 0 {
        return Err(wanted_twice(name, place));
    }
    let Some(hundredths) = look::hundredths(degrees) else {
        let help = format!("write {name}:2.5, or {name}:-0.25; 327.67 is the most");
        return Err(Fault::new(
            place,
            "an angle is in degrees and not 0, with two digits at most after the point",
        )
        .label("no such angle")
        .help(help));
    };
    *amount = hundredths;
    Ok(intents.with_look(look))
}

fn wanted_twice(word: &str, place: Range<usize>) -> Fault {
    Fault::new(place, format!("{} is wanted twice", quoted(word))).label("once is enough")
}

fn unknown(word: &str, place: Range<usize>) -> Fault {
    let names: Vec<&str> = Intent::ALL.into_iter().map(Intent::name).chain([STAND]).collect();
    let help = match nearest(word, &names) {
        Some(meant) => format!("the nearest is {}", quoted(meant)),
        None => format!("there are {}", names.join(", ")),
    };
    Fault::new(place, format!("nobody can want {}", quoted(word))).label("unknown").help(help)
}

/// The words in a part of `text`.
pub(crate) fn words(text: &str, part: Range<usize>) -> Vec<Range<usize>> {
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
pub(crate) fn trimmed(text: &str, part: Range<usize>) -> Range<usize> {
    let whole = &text[part.clone()];
    let start = part.start + (whole.len() - whole.trim_start().len());
    start..(part.start + whole.trim_end().len()).max(start)
}
