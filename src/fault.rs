//! Faults in a text that somebody wrote: what is wrong, where, and what to write instead.
//!
//! A reader of such a text collects every fault it finds and goes on reading, so that one run
//! names them all; [`Faults`] then is its error. One cause makes one fault: what follows from a
//! fault already found is left out. An error that is returned at the first fault was refused, as
//! mending a file then takes one run for each.

pub(crate) mod document;
mod excerpt;
mod words;

use std::fmt;
use std::ops::Range;

pub(crate) use words::{nearest, quoted};

/// Everything that is wrong with a file, at least one thing.
///
/// It displays as a report for people: each fault with file, line and column, its line underlined,
/// and what to write instead, in the order of their places. A report stops after 100 faults and
/// says how many more there are.
pub struct Faults {
    name: String,
    text: String,
    /// In the order of their places, those without one first.
    list: Vec<Fault>,
}

impl Faults {
    /// The faults of the file `name` that holds `text`; `faults` is not empty.
    pub(crate) fn new(name: &str, text: &str, mut faults: Vec<Fault>) -> Self {
        debug_assert!(!faults.is_empty(), "an error has a cause");
        faults.sort_by_key(|fault| fault.place.as_ref().map(|place| (place.start, place.end)));
        Self { name: name.to_owned(), text: text.to_owned(), list: faults }
    }

    /// What is wrong with the file `name` as a whole, such as that it does not exist. The `message`
    /// names the file.
    pub(crate) fn of_whole_file(name: &str, message: String, help: &str) -> Self {
        let fault = Fault { place: None, message, label: String::new(), help: help.to_owned() };
        Self::new(name, "", vec![fault])
    }

    /// How many there are, 1 or more.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.list.len()
    }
}

impl Faults {
    /// The first fault in a line, where it is and what it is; and how many more there are.
    pub fn summary(&self) -> String {
        let Some(fault) = self.list.first() else { return String::new() };
        let more = match self.list.len() - 1 {
            0 => String::new(),
            1 => ", and 1 more fault".to_owned(),
            more => format!(", and {more} more faults"),
        };
        if fault.place.is_none() {
            return format!("{}{more}", fault.message);
        }
        let before = &self.text.as_bytes()[..fault.start().min(self.text.len())];
        let line = before.split(|&byte| byte == b'\n').count();
        format!("{}:{line}: {}{more}", self.name, fault.message)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        excerpt::report(f, &self.name, &self.text, &self.list)
    }
}

impl fmt::Debug for Faults {
    /// As it displays: the text of a whole map in a failed `unwrap` helps nobody.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Faults {}

/// One thing that is wrong with a text.
pub(crate) struct Fault {
    /// Bytes of the text; `None` where the fault is the whole file's.
    place: Option<Range<usize>>,
    /// A whole sentence.
    message: String,
    /// A few words under the underlined place; may be empty.
    label: String,
    /// What to write instead; may be empty.
    help: String,
}

impl Fault {
    /// A fault at `place`, bytes of the text.
    pub(crate) fn new(place: Range<usize>, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { place: Some(place), message, label: String::new(), help: String::new() }
    }

    /// The same, with a few words under the underlined place.
    pub(crate) fn label(self, label: impl Into<String>) -> Self {
        Self { label: label.into(), ..self }
    }

    /// The same, with what to write instead.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: help.into(), ..self }
    }
    /// Where the place starts, in bytes of the text.
    pub(crate) fn start(&self) -> usize {
        self.place.as_ref().map_or(0, |place| place.start)
    }
}
