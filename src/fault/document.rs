//! TOML with the place of each key and value.
//!
//! Rejected: deserializing into structs with serde. It stops at the first fault, and only fields of
//! type `Spanned` have places.
//!
//! The parser stores each token several times, at up to 150 bytes, and a file of 64 MiB can have as
//! many tokens as bytes. The lexer alone needs no memory, so tokens are counted before the text is
//! parsed.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

use super::{Fault, nearest_or_all, quoted};
use crate::sort;

/// The maximum number of tokens in a document, white space and line breaks included: about twenty
/// for each of ten thousand definitions.
const MAX_TOKENS: usize = 1 << 18;
/// The number of tokens above which only the first TOML error is reported, because each token may
/// be one.
const MAX_TOKENS_RECOVERED: usize = 1 << 16;

/// The faults of a document, collected while it is read.
#[derive(Default)]
pub struct FaultList(RefCell<Vec<Fault>>);

impl FaultList {
    /// Adds a fault.
    pub fn push(&self, fault: Fault) {
        self.0.borrow_mut().push(fault);
    }

    /// Adds several faults.
    pub(crate) fn extend(&self, faults: impl IntoIterator<Item = Fault>) {
        faults.into_iter().for_each(|fault| self.push(fault));
    }

    /// The number of faults up to now.
    pub(crate) fn len(&self) -> usize {
        self.0.borrow().len()
    }

    /// Returns true if there are no faults yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Removes and returns the faults up to now.
    pub fn take(&self) -> Vec<Fault> {
        self.0.take()
    }

    /// Adds `not_toml`, the TOML errors in `text`, and removes other faults on the same lines,
    /// because the parser only guesses the meaning of such lines.
    pub(crate) fn extend_by_broken_lines(&self, not_toml: Vec<Fault>, text: &str) {
        let found = self.take();
        let starts: BTreeSet<usize> =
            sort::gathered(found.iter().chain(&not_toml).map(Fault::start));
        let lines = line_numbers(text, starts);
        let broken: BTreeSet<usize> =
            sort::gathered(not_toml.iter().map(|fault| lines[&fault.start()]));
        let sound = found.into_iter().filter(|fault| !broken.contains(&lines[&fault.start()]));
        self.extend(sound.chain(not_toml));
    }
}

/// The line numbers of `places` in `text`, found in one pass.
fn line_numbers(text: &str, places: BTreeSet<usize>) -> BTreeMap<usize, usize> {
    let (mut line, mut counted) = (0, 0);
    let numbered = places.into_iter().map(|place| {
        let passed = text.as_bytes().get(counted..place).unwrap_or_default();
        line += passed.split(|&byte| byte == b'\n').count() - 1;
        counted = place;
        (place, line)
    });
    sort::gathered(numbered)
}

/// Parses as much of `text` as possible as TOML, and adds faults to `faults`.
///
/// If a bracket is never closed, the document ends with the line of the bracket. The parser would
/// take the rest of the text as the content of the bracket, and find a fault in almost every line.
pub fn parse<'t>(text: &'t str, faults: &FaultList) -> DeTable<'t> {
    let mut tokens = Source::new(text).lex();
    let is_recovered = tokens.by_ref().nth(MAX_TOKENS_RECOVERED).is_none();
    if let Some(token) = tokens.nth(MAX_TOKENS - MAX_TOKENS_RECOVERED - 1) {
        faults.push(too_many_tokens(token.span().start()..token.span().end()));
        return DeTable::new();
    }
    let (table, errors) = if is_recovered {
        DeTable::parse_recoverable(&text[..end_of_unclosed_line(text).unwrap_or(text.len())])
    } else {
        match DeTable::parse(text) {
            Ok(table) => (table, Vec::new()),
            Err(error) => (Spanned::new(0..0, DeTable::new()), vec![error]),
        }
    };
    let mut seen = BTreeSet::new();
    for error in errors {
        let place = error.span().unwrap_or(0..0);
        // The parser may report several errors at the same place.
        if seen.insert(place.start) {
            faults.push(Fault::new(place, "this is not valid TOML").label(error.message()));
        }
    }
    table.into_inner()
}

/// The end of the line with the outermost unclosed bracket; `None` if every bracket in the values
/// of `text` is closed.
fn end_of_unclosed_line(text: &str) -> Option<usize> {
    let mut open = Vec::new();
    let mut is_value = false;
    for token in Source::new(text).lex() {
        match token.kind() {
            TokenKind::Equals => is_value = true,
            TokenKind::Newline if open.is_empty() => is_value = false,
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket if is_value => {
                open.push(token.span().start());
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => _ = open.pop(),
            _ => {}
        }
    }
    let start = *open.first()?;
    Some(start + text[start..].find('\n')?)
}

fn too_many_tokens(place: Range<usize>) -> Fault {
    Fault::new(place, format!("a file may have at most {MAX_TOKENS} TOML tokens"))
        .label("this is one too many")
        .help("leave some definitions out; a string is one token, however long")
}

/// A key and its value.
pub struct Entry<'a, 't> {
    /// The key, without quotes.
    pub key: &'a str,
    /// The bytes of the key in the text.
    pub key_place: Range<usize>,
    /// The value.
    pub value: &'a DeValue<'t>,
    /// The bytes of the value in the text.
    pub value_place: Range<usize>,
    /// The faults of the document that contains the entry.
    pub faults: &'a FaultList,
}

/// The entries of `table`, ordered by key. Their faults go to `faults`.
pub fn entries<'a, 't>(
    table: &'a DeTable<'t>,
    faults: &'a FaultList,
) -> impl Iterator<Item = Entry<'a, 't>> {
    table.iter().map(move |(key, value)| Entry {
        key: key.get_ref(),
        key_place: key.span(),
        value: value.get_ref(),
        value_place: value.span(),
        faults,
    })
}

impl<'a, 't> Entry<'a, 't> {
    /// The entries of another table in the same document, ordered by key.
    pub fn entries(&self, table: &'a DeTable<'t>) -> impl Iterator<Item = Self> + use<'a, 't> {
        entries(table, self.faults)
    }

    /// The value as a string; reports a fault if it is not one. `example` is a complete valid
    /// entry.
    pub fn string(&self, example: &str) -> Option<&'a str> {
        let DeValue::String(string) = self.value else {
            self.faults.push(self.wrong_type("a string", example));
            return None;
        };
        Some(string)
    }

    /// The value as a table; reports a fault as [`Entry::string`] does.
    pub fn table(&self, example: &str) -> Option<&'a DeTable<'t>> {
        let DeValue::Table(table) = self.value else {
            self.faults.push(self.wrong_type("a table", example));
            return None;
        };
        Some(table)
    }

    /// The value as a number; `None` if it is not one.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|integer| integer as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        }
    }

    /// The elements of a list, each as an entry with the same key; `None` if the value is not a
    /// list.
    pub fn list(&self) -> Option<Vec<Self>> {
        let DeValue::Array(list) = self.value else { return None };
        let entry = |value: &'a Spanned<DeValue<'t>>| Self {
            key: self.key,
            key_place: self.key_place.clone(),
            value: value.get_ref(),
            value_place: value.span(),
            faults: self.faults,
        };
        Some(list.iter().map(entry).collect())
    }

    /// The value as a list of two elements, each as in [`Entry::list`]; reports a fault if it is
    /// not one.
    pub(crate) fn pair(&self, example: &str) -> Option<[Self; 2]> {
        let Some(list) = self.list() else {
            self.faults.push(self.wrong_type("a list of two", example));
            return None;
        };
        let count = list.len();
        list.try_into().ok().or_else(|| {
            let message = format!("{} must be a list of two", quoted(self.key));
            self.reject(message, format!("this is a list of {count}"), format!("write {example}"))
        })
    }

    /// The entry `key` in `table`, the table that also contains this entry.
    pub(crate) fn beside(&self, table: &'a DeTable<'t>, key: &str) -> Option<Self> {
        self.entries(table).find(|entry| entry.key == key)
    }

    /// Reports a fault of the value, and returns `None`. The label and the help may be empty.
    pub fn reject<T>(
        &self,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.faults.push(Fault::new(self.value_place.clone(), message).label(label).help(help));
        None
    }

    /// The fault for a value of the wrong type. The message says that it must be `wanted`.
    /// `example` is a complete valid entry.
    pub fn wrong_type(&self, wanted: &str, example: &str) -> Fault {
        let found = match self.value {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "an integer",
            DeValue::Float(_) => "a float",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date or time",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        Fault::new(self.value_place.clone(), format!("{} must be {wanted}", quoted(self.key)))
            .label(format!("this is {found}"))
            .help(format!("write {example}"))
    }

    /// The fault for a key that is not in `known`, the keys of `owner`.
    pub fn unknown_key(&self, owner: &str, known: &[&str]) -> Fault {
        let message = format!("{owner} has no key {}", quoted(self.key));
        let help = nearest_or_all(self.key, known, "the nearest key is", "known keys:");
        Fault::new(self.key_place.clone(), message).label("unknown key").help(help)
    }
}

/// `text` as a TOML string on one line.
///
/// Rejected: `toml_writer`. It writes a text with line breaks on several lines.
pub fn toml_string(text: &str) -> String {
    let mut string = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => string.extend(['\\', character]),
            '\n' => string.push_str("\\n"),
            '\t' => string.push_str("\\t"),
            // Writing to a string never fails.
            it if it.is_control() => _ = write!(string, "\\u{:04X}", u32::from(it)),
            it => string.push(it),
        }
    }
    string.push('"');
    string
}
