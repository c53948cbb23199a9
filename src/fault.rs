//! Faults in a text: what is wrong, where, and what to write instead.
//!
//! A reader collects every fault that it finds and continues, so that one run reports all of them;
//! [`Faults`] is its error. One cause makes one fault: consequences of an earlier fault are not
//! reported. Stopping at the first fault was refused: correcting a file would take one run for
//! each.

pub mod document;
mod excerpt;
mod printable;
mod words;

use crate::sort;
use std::fmt;
use std::ops::Range;

pub(crate) use printable::printable;
#[cfg(feature = "cli")]
pub(crate) use printable::printable_lines;
#[cfg(feature = "terminal")]
pub use printable::printable_path;
pub use words::{nearest, quoted};

/// All faults of a file; there is at least one.
///
/// It displays as a report: each fault with its file, line and column, the line underlined, and
/// what to write instead, in the order of their places. A report stops after 100 faults and says
/// how many more there are.
pub struct Faults {
    name: String,
    text: String,
    /// In the order of their places, those without a place first.
    list: Vec<Fault>,
}

impl Faults {
    /// The faults of the file `name` with the contents `text`. `faults` is not empty.
    pub fn new(name: &str, text: &str, mut faults: Vec<Fault>) -> Self {
        debug_assert!(!faults.is_empty(), "an error has a cause");
        sort::by_key(&mut faults, |fault| {
            fault.place.as_ref().map(|place| (place.start, place.end))
        });
        Self { name: printable(name), text: text.to_owned(), list: faults }
    }

    /// A fault of the whole file `name`, such as that it does not exist. `message` names the file.
    pub(crate) fn of_whole_file(name: &str, message: &str, help: &str) -> Self {
        let message = printable(message);
        let fault = Fault { place: None, message, label: String::new(), help: help.to_owned() };
        Self::new(name, "", vec![fault])
    }

    /// The text `bytes` of the file `name`, which is `what`, such as a map.
    ///
    /// # Errors
    /// A fault that names the first line that is not UTF-8.
    pub fn text_of(bytes: Vec<u8>, name: &str, what: &str) -> Result<String, Self> {
        String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let line = error.as_bytes()[..valid].split(|&byte| byte == b'\n').count();
            let message = format!(
                "{name} is not UTF-8 text: line {line} has a byte that is part of no character"
            );
            Self::of_whole_file(name, &message, &format!("save the {what} in the encoding UTF-8"))
        })
    }

    /// The number of faults, 1 or more.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.list.len()
    }
}

impl Faults {
    /// The first fault in one line, with its place, and the number of further faults.
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
    /// The report: the text of a whole map in a failed `unwrap` would not help.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Faults {}

/// A fault in a text.
pub struct Fault {
    /// Bytes of the text; `None` if the fault is that of the whole file.
    place: Option<Range<usize>>,
    /// A sentence.
    message: String,
    /// A few words under the underlined place; may be empty.
    label: String,
    /// What to write instead; may be empty.
    help: String,
}

impl Fault {
    /// A fault at `place`, a range of bytes of the text.
    pub fn new(place: Range<usize>, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { place: Some(place), message, label: String::new(), help: String::new() }
    }

    /// The fault with a label under the underlined place.
    pub(crate) fn label(self, label: impl Into<String>) -> Self {
        Self { label: label.into(), ..self }
    }

    /// The fault with what to write instead.
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: help.into(), ..self }
    }
    /// The first byte of the place.
    pub(crate) fn start(&self) -> usize {
        self.place.as_ref().map_or(0, |place| place.start)
    }
}
