//! Names of accounts: readable, printable, and each distinct to the eye.
//!
//! A text becomes a name in these steps:
//!
//! 1. It is converted to the Unicode form NFKC, so that wide or decomposed letters become the plain ones.
//! 2. Each character must be a letter of one of the [scripts](NameFault::Character) below, a digit from 0
//!    to 9, `-` or `_`. The first one must be a letter, and the last one must not be `-` or `_`.
//! 3. It must be 2 to 16 columns wide.
//! 4. Its letters must belong to one script, or to Latin together with Japanese, Korean or Chinese:
//!    "highly restrictive" in Unicode Technical Standard #39, section 5.2.
//! 5. It must not look like a [reserved](Name::is_reserved) name.
//!
//! The scripts are written from left to right, with letters of one or two cells: Latin, Greek, Cyrillic,
//! Armenian, Georgian, Han, Hiragana, Katakana, Hangul, Bopomofo. Rejected: letters that are written with
//! combining marks or from right to left. Terminals disagree about their width and order, and a name
//! appears in the middle of another player's picture.

use std::fmt;
use std::sync::LazyLock;

use serde::{Deserialize, Deserializer, Serialize};
use thiserror::Error;
use unicode_normalization::UnicodeNormalization;
use unicode_script::{Script, UnicodeScript};
use unicode_security::{
    GeneralSecurityProfile, RestrictionLevel, RestrictionLevelDetection, skeleton,
};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// A player's name.
///
/// ```
/// use cellcaster_server::accounts::{Name, NameFault};
///
/// let name = Name::new("Ada")?;
/// assert!(name.looks_like(&Name::new("ADA")?));
/// assert_eq!(Name::new("\u{1b}[2J").unwrap_err(), NameFault::Character('\u{1b}'));
/// assert_eq!(Name::new("server"), Err(NameFault::Reserved));
/// # Ok::<(), NameFault>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Name(String);

/// The reason why a text is not a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NameFault {
    /// It is too short.
    #[error("A name needs at least {} letters.", Name::MIN_COLUMNS)]
    Short,
    /// It is too long.
    #[error("A name can be at most {} columns wide.", Name::MAX_COLUMNS)]
    Long,
    /// It contains a character that is not allowed.
    #[error("A name can contain letters, digits, - and _, but not {}.", shown(*.0))]
    Character(char),
    /// It does not begin with a letter.
    #[error("A name must begin with a letter.")]
    Begin,
    /// It ends with `-` or `_`.
    #[error("A name must end with a letter or a digit.")]
    End,
    /// Its letters belong to different scripts.
    #[error("All letters of a name must belong to one script.")]
    Mixed,
    /// It is reserved, or looks like a reserved name.
    #[error("This name is reserved.")]
    Reserved,
}

/// The allowed scripts.
const SCRIPTS: [Script; 10] = [
    Script::Latin,
    Script::Greek,
    Script::Cyrillic,
    Script::Armenian,
    Script::Georgian,
    Script::Han,
    Script::Hiragana,
    Script::Katakana,
    Script::Hangul,
    Script::Bopomofo,
];
/// Names that nobody may use.
const RESERVED: &str = "admin administrator all anonymous anybody cellcaster console everybody everyone \
    game guard host lobby mod moderator nobody none operator owner player room root \
    server spectator staff support system you";
/// The beginning of guests' names.
const GUEST: &str = "guest";
/// Characters that some terminals show as nothing although they have a width, or that change their
/// neighbours: the soft hyphen, Hangul fillers, the blank of Braille, annotation marks, and the object
/// replacement.
const INVISIBLE: [char; 9] = [
    '\u{ad}', '\u{115f}', '\u{1160}', '\u{2800}', '\u{3164}', '\u{ffa0}', '\u{fff9}', '\u{fffb}',
    '\u{fffc}',
];
/// The longest text that is examined, in bytes.
const MAX_BYTES: usize = 256;

impl Name {
    /// The least width in columns.
    pub const MIN_COLUMNS: usize = 2;
    /// The largest width in columns.
    pub const MAX_COLUMNS: usize = 16;

    /// Parses a name.
    ///
    /// # Errors
    /// A [`NameFault`], which is one sentence for the player.
    pub fn new(text: &str) -> Result<Self, NameFault> {
        let name = Self::unreserved(text)?;
        if name.is_reserved() { Err(NameFault::Reserved) } else { Ok(name) }
    }

    /// The name of a guest, such as `guest-12`. No account can have it.
    pub fn of_guest(number: u32) -> Self {
        Self(format!("{GUEST}-{number}"))
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns true if the names look the same, or differ only in case.
    pub fn looks_like(&self, other: &Self) -> bool {
        let keys = self.keys();
        other.keys().iter().any(|key| keys.contains(key))
    }

    /// Returns true if only the host can have the name: it looks like `guest` or begins like that, or it
    /// is a word for the host or for nobody.
    fn is_reserved(&self) -> bool {
        // Computed once, because that takes about thirty times as long as the keys of one name.
        static GUESTS: LazyLock<Vec<String>> = LazyLock::new(|| keys_of(GUEST));
        static WORDS: LazyLock<Vec<String>> =
            LazyLock::new(|| RESERVED.split(' ').flat_map(keys_of).collect());
        let is_guest = |key: &String| GUESTS.iter().any(|guest| key.starts_with(guest.as_str()));
        self.keys().iter().any(|key| is_guest(key) || WORDS.contains(key))
    }

    /// The keys of the name. Two names that share a key count as the same.
    pub(crate) fn keys(&self) -> Vec<String> {
        keys_of(&self.0)
    }

    /// A name that the store has kept. A text that would not be a name today is accepted, as far as it is
    /// printable.
    pub(crate) fn kept(text: &str) -> Self {
        Self(printable(text, Self::MAX_COLUMNS))
    }

    fn unreserved(text: &str) -> Result<Self, NameFault> {
        if text.len() > MAX_BYTES {
            return Err(NameFault::Long);
        }
        let text: String = text.nfkc().collect();
        if let Some(character) = text.chars().find(|&character| !is_allowed(character)) {
            return Err(NameFault::Character(character));
        }
        match text.width() {
            ..Self::MIN_COLUMNS => return Err(NameFault::Short),
            Self::MIN_COLUMNS..=Self::MAX_COLUMNS => {}
            _ => return Err(NameFault::Long),
        }
        if !text.starts_with(is_letter) {
            return Err(NameFault::Begin);
        }
        if text.ends_with(['-', '_']) {
            return Err(NameFault::End);
        }
        if !text.check_restriction_level(RestrictionLevel::HighlyRestrictive) {
            return Err(NameFault::Mixed);
        }
        Ok(Self(text))
    }
}

/// Accepts the same texts as [`Name::kept`].
impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        String::deserialize(from).map(|text| Self::kept(&text))
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0)
    }
}

/// The printable characters of a text, up to `columns`, in one line.
///
/// Every character that is kept takes one or two columns. Blanks and breaks of all kinds become one blank,
/// and there is none at the ends. Control characters and the introducers of escape sequences are dropped.
/// So are combining marks, direction marks, invisible, private-use and unassigned characters, and
/// characters that terminals draw in different widths. Letters with accents are composed first, so they
/// stay.
///
/// ```
/// use cellcaster_server::accounts::printable;
///
/// assert_eq!(printable(" a\tb\r\n\u{1b}[31mc\u{202e} e\u{301}", 80), "a b [31mc é");
/// assert_eq!(printable("漢字漢字", 5), "漢字");
/// ```
pub fn printable(text: &str, columns: usize) -> String {
    let mut line = String::new();
    let (mut width, mut owes_blank) = (0, false);
    for character in text.nfc() {
        if character.is_whitespace() {
            owes_blank = !line.is_empty();
            continue;
        }
        let Some(own_width) = width_of(character) else { continue };
        let needed = own_width + usize::from(owes_blank);
        if width + needed > columns {
            break;
        }
        if owes_blank {
            line.push(' ');
        }
        line.push(character);
        (width, owes_blank) = (width + needed, false);
    }
    line
}

/// The keys of a name. Two names that share a key count as the same.
///
/// A key is a skeleton as in Unicode Technical Standard #39, section 4, in which letters that look alike
/// are one letter. Skeletons distinguish upper from lower case, because a letter has different look-alikes
/// in each: `I` looks like `l`, but `i` does not. So there are two keys: the skeleton of the name in lower
/// case, and the skeleton of the name as it is, which is then put in lower case. Names that differ only in
/// case share the first key, and names with the same skeleton share the second one.
fn keys_of(name: &str) -> Vec<String> {
    let of_lower_case: String = skeleton(&folded(name)).collect();
    let of_name: String = skeleton(name).collect();
    let mut keys = vec![of_lower_case, folded(&of_name)];
    keys.dedup();
    keys
}

/// The text in one case. It goes through upper case, where `ß` becomes `SS` and both forms of a small
/// sigma become one.
fn folded(text: &str) -> String {
    text.chars().flat_map(char::to_uppercase).flat_map(char::to_lowercase).collect()
}

fn is_allowed(character: char) -> bool {
    matches!(character, '0'..='9' | '-' | '_') || is_letter(character)
}

fn is_letter(character: char) -> bool {
    let has_width = matches!(character.width(), Some(1 | 2));
    let is_of_script = SCRIPTS.contains(&character.script());
    is_of_script && has_width && character.is_alphabetic() && character.identifier_allowed()
}

/// The character as a sentence can show it: itself, or its number.
fn shown(character: char) -> String {
    match printable(character.encode_utf8(&mut [0; 4]), 2) {
        text if character != ' ' && text.starts_with(character) => character.to_string(),
        _ => format!("U+{:04X}", u32::from(character)),
    }
}

/// The number of columns of a character; `None` if the character is dropped.
fn width_of(character: char) -> Option<usize> {
    let is_dropped = character.is_control()
        || INVISIBLE.contains(&character)
        || is_of_disputed_width(character)
        || [Script::Unknown, Script::Cuneiform].contains(&character.script());
    character.width().filter(|width| !is_dropped && (1..=2).contains(width))
}

/// Returns true if terminals draw `character` over its neighbours, or join it with them: dashes of two and
/// three ems, Arabic words that are one character, halves of flags, and skin tones. (They do the same with
/// Cuneiform signs.)
fn is_of_disputed_width(character: char) -> bool {
    matches!(
        character,
        '\u{2e3a}'..='\u{2e3b}'
            | '\u{fdf0}'..='\u{fdff}'
            | '\u{1f1e6}'..='\u{1f1ff}'
            | '\u{1f3fb}'..='\u{1f3ff}'
    )
}

#[cfg(test)]
mod tests;
