//! Faults in a text, each with its place and a remedy.
//!
//! A reader collects every fault that it finds and continues, so one run reports all of them.
//! [`Faults`] is its error type. One cause produces one fault, because consequences of an earlier
//! fault are not reported. Rejected: stopping at the first fault. Correcting a file would then take
//! one run for each fault.
//!
//! Names of files and values of options may contain any character. All text on standard error goes
//! through [`printable`] or a similar function. These functions replace control characters by
//! visible escapes, because a terminal would obey them.

pub mod document;

use std::fmt;
use std::ops::Range;
#[cfg(feature = "terminal")]
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::sort;

/// The maximum number of faults in a report. Nobody corrects more than this at once.
const MAX_REPORTED: usize = 100;
/// The longest line that a report shows, in bytes: four times the widest row of a map, at four
/// bytes for each character.
const MAX_LINE: usize = 1 << 16;
/// The length limit for similar names and quotes, longer than any misspelt name.
const MAX_NAME: usize = 40;

/// All faults in a file. There is at least one.
///
/// The `Display` output is a report. Each fault has its file, line and column, the underlined line,
/// and a remedy. The faults are in the order of their places. A report stops after 100 faults and
/// says how many more there are.
pub struct Faults {
    name: String,
    text: String,
    /// The faults in the order of their places. Faults without a place come first.
    list: Vec<Fault>,
}

/// A fault in a text.
pub struct Fault {
    /// The range of bytes in the text; `None` if the whole file is at fault.
    place: Option<Range<usize>>,
    /// The place in words, in a file whose lines nobody reads.
    origin: Option<String>,
    /// A sentence that describes the fault.
    message: String,
    /// A few words under the underlined place; may be empty.
    label: String,
    /// The remedy; may be empty.
    help: String,
}

impl Faults {
    /// The faults in the file `name` with the content `text`. `faults` must not be empty.
    pub fn new(name: &str, text: &str, mut faults: Vec<Fault>) -> Self {
        debug_assert!(!faults.is_empty(), "an error has a cause");
        sort::by_key(&mut faults, |fault| {
            fault.place.as_ref().map(|place| (place.start, place.end))
        });
        Self { name: printable(name), text: text.to_owned(), list: faults }
    }

    /// A fault of the whole file `name`, for example because it does not exist. `message` should
    /// mention the file.
    pub(crate) fn of_whole_file(name: &str, message: &str, help: &str) -> Self {
        let message = printable(message);
        let (label, help) = (String::new(), help.to_owned());
        let fault = Fault { place: None, origin: None, message, label, help };
        Self::new(name, "", vec![fault])
    }

    /// Decodes `bytes`, the content of the file `name`. `what` says what the file is, for example a
    /// map.
    ///
    /// # Errors
    /// A fault that mentions the first line that is not UTF-8.
    pub fn text_of(bytes: Vec<u8>, name: &str, what: &str) -> Result<String, Self> {
        String::from_utf8(bytes).map_err(|error| {
            let line = 1 + line_breaks(&error.as_bytes()[..error.utf8_error().valid_up_to()]);
            let message = format!("{name} is not UTF-8 text: line {line} has an invalid byte");
            Self::of_whole_file(name, &message, &format!("save the {what} as UTF-8"))
        })
    }

    /// The same faults, in a file from which the text was made. For a byte of the text, `origin`
    /// returns the place in the file, and whether the author wrote what is there.
    #[cfg(feature = "cli")]
    pub(crate) fn traced(mut self, origin: impl Fn(usize) -> (String, bool)) -> Self {
        for fault in self.list.iter_mut().take(MAX_REPORTED) {
            let Some(place) = fault.place.take() else { continue };
            let (origin, is_written) = origin(place.start);
            fault.origin = Some(origin);
            if let Some(written) = self.text.get(place).filter(|_| is_written)
                && !fault.label.is_empty()
            {
                let written = written.chars().take(MAX_NAME).collect::<String>();
                fault.label = format!("{}: {}", printable(&written), fault.label);
            }
        }
        self
    }

    /// The number of faults, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The faults in the order of their places. Faults without a place come first.
    #[cfg(feature = "cli")]
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Fault> {
        self.list.iter()
    }

    /// The first fault in one line, with its place and the number of further faults.
    pub fn summary(&self) -> String {
        let Some(fault) = self.list.first() else { return String::new() };
        let more = match self.list.len() - 1 {
            0 => String::new(),
            1 => ", and 1 more fault".to_owned(),
            more => format!(", and {more} more faults"),
        };
        if let Some(origin) = &fault.origin {
            return format!("{}: {origin}: {}{more}", self.name, fault.message);
        }
        if fault.place.is_none() {
            return format!("{}{more}", fault.message);
        }
        let line = 1 + line_breaks(&self.text.as_bytes()[..fault.start().min(self.text.len())]);
        format!("{}:{line}: {}{more}", self.name, fault.message)
    }
}

impl fmt::Display for Faults {
    /// Shows only the first line of a place that spans several lines, because a map's grid may have
    /// thousands.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, text, list } = self;
        let (shown, left_out) = list.split_at(list.len().min(MAX_REPORTED));
        // Lines are counted in one pass over the text.
        let (mut line_start, mut number) = (0, 1);
        for (index, fault) in shown.iter().enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            let mut group = Group::with_title(Level::ERROR.primary_title(&fault.message));
            if let Some(place) = &fault.place {
                let start = text.floor_char_boundary(place.start);
                let passed = &text[line_start..start];
                number += line_breaks(passed.as_bytes());
                line_start += passed.rfind('\n').map_or(0, |at| at + 1);
                let line = text[line_start..].lines().next().unwrap_or_default();
                let start = (start - line_start).min(line.len());
                let end = text.floor_char_boundary(place.end).saturating_sub(line_start);
                group = if line.len() > MAX_LINE {
                    let column = line[..start].chars().count() + 1;
                    group.element(Origin::path(name).line(number).char_column(column))
                } else {
                    let label = Some(fault.label.as_str()).filter(|label| !label.is_empty());
                    let span = start..end.clamp(start, line.len());
                    let underline = AnnotationKind::Primary.span(span).label(label);
                    let source = Snippet::source(line).path(name).line_start(number);
                    group.element(source.annotation(underline))
                };
            }
            if let Some(origin) = &fault.origin {
                let place = format!("{name}: {}", printable(origin));
                group = group.element(Origin::path(place));
                if !fault.label.is_empty() {
                    group = group.element(Level::NOTE.message(&fault.label));
                }
            }
            if !fault.help.is_empty() {
                group = group.element(Level::HELP.message(&fault.help));
            }
            f.write_str(&Renderer::plain().render(&[group]))?;
        }
        if left_out.is_empty() {
            return Ok(());
        }
        write!(f, "\n\nerror: {} more faults in {name} are not shown", left_out.len())
    }
}

impl fmt::Debug for Faults {
    /// Writes the report. The text of a whole map would not help in a failed `unwrap`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Faults {}

impl Fault {
    /// A fault at `place`, a range of bytes in the text.
    pub fn new(place: Range<usize>, message: impl Into<String>) -> Self {
        let message = message.into();
        let (label, help) = (String::new(), String::new());
        Self { place: Some(place), origin: None, message, label, help }
    }

    /// A fault at the place that `origin` describes.
    #[cfg(feature = "cli")]
    pub(crate) fn at(origin: impl Into<String>, message: impl Into<String>) -> Self {
        Self { place: None, origin: Some(origin.into()), ..Self::new(0..0, message) }
    }

    /// Sets the label under the underlined place.
    pub(crate) fn label(self, label: impl Into<String>) -> Self {
        Self { label: label.into(), ..self }
    }

    /// Sets the remedy.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: help.into(), ..self }
    }

    /// The range of bytes in the text; `None` if the whole file is at fault.
    #[cfg(feature = "cli")]
    pub(crate) fn place(&self) -> Option<&Range<usize>> {
        self.place.as_ref()
    }

    /// The description and the remedy, on one line.
    #[cfg(feature = "cli")]
    pub(crate) fn line(&self) -> String {
        let described =
            [self.message.as_str(), &self.label].into_iter().filter(|it| !it.is_empty());
        let described = described.collect::<Vec<_>>().join(": ");
        let remedy = if self.help.is_empty() { String::new() } else { format!("; {}", self.help) };
        printable(&format!("{described}{remedy}"))
    }

    /// The first byte of the place.
    fn start(&self) -> usize {
        self.place.as_ref().map_or(0, |place| place.start)
    }
}

#[expect(clippy::naive_bytecount, reason = "a crate for it would be larger than the time it saves")]
fn line_breaks(text: &[u8]) -> usize {
    text.iter().filter(|&&byte| byte == b'\n').count()
}

/// `text` on one line, with escapes such as `\u{1b}` for non-printing characters.
pub(crate) fn printable(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut shown, c| {
        if does_print(c) {
            shown.push(c);
        } else {
            shown.extend(c.escape_debug());
        }
        shown
    })
}

/// A path for use in a sentence: on one line, with escapes as in [`printable`].
#[cfg(feature = "terminal")]
pub fn printable_path(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// As [`printable`], but keeps the line breaks of `text`.
#[cfg(feature = "cli")]
pub(crate) fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// Returns true if `c` is not a control character and does not change the direction of the
/// characters after it (Boucher and Anderson, "Trojan Source: Invisible Vulnerabilities", 2021).
fn does_print(c: char) -> bool {
    !c.is_control() && !matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The name in `known` that is most similar to `word`, with at most one edit for every three
/// letters; `None` if none is similar.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    if word.len() > MAX_NAME {
        return None;
    }
    let slips_allowed = (word.chars().count() / 3).max(1);
    let slips = |name: &&str| strsim::damerau_levenshtein(word, name);
    let name = known.iter().copied().min_by_key(slips)?;
    (slips(&name) <= slips_allowed && name.len() > slips_allowed).then_some(name)
}

/// A help text: `meant` and the name in `known` that is most similar to `word`; or, if none is
/// similar, `otherwise` and all of `known`.
pub(crate) fn nearest_or_all(word: &str, known: &[&str], meant: &str, otherwise: &str) -> String {
    match nearest(word, known) {
        Some(name) => format!("{meant} {}", quoted(name)),
        None => format!("{otherwise} {}", known.join(", ")),
    }
}

/// `word` in double quotes, with non-printing characters escaped. A long word is shortened.
pub fn quoted(word: &str) -> String {
    match word.char_indices().nth(MAX_NAME) {
        Some((end, _)) => format!("{:?}…", &word[..end]),
        None => format!("{word:?}"),
    }
}

#[cfg(test)]
mod tests;
