//! Names of accounts: readable, printable, and each distinct to the eye.
//!
//! A text becomes a name in these steps:
//!
//! 1. It is brought to the Unicode form NFKC, so that wide or decomposed letters are the plain ones.
//! 2. Each character is a letter of one of the [scripts](NameFault::Character) below, a digit from 0 to 9,
//!    `-` or `_`. The first one is a letter, and the last one is no `-` or `_`.
//! 3. It is 2 to 16 columns wide.
//! 4. Its letters are of one script, or of Latin with those of Japanese, Korean or Chinese: "highly
//!    restrictive" of Unicode Technical Standard #39, section 5.2.
//! 5. It does not look like a [reserved](Name::is_reserved) name.
//!
//! The scripts are those whose letters stand one in a cell or two, from left to right: Latin, Greek,
//! Cyrillic, Armenian, Georgian, Han, Hiragana, Katakana, Hangul, Bopomofo. Letters that are written with
//! combining marks or from right to left were refused: terminals disagree about their width and order,
//! and a name stands in the middle of another player's picture.

use std::fmt;
use std::sync::LazyLock;

use thiserror::Error;
use unicode_normalization::UnicodeNormalization;
use unicode_script::{Script, UnicodeScript};
use unicode_security::{
    GeneralSecurityProfile, RestrictionLevel, RestrictionLevelDetection, skeleton,
};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// A name.
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
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Name(String);

/// Why a text is no name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NameFault {
    /// It is too short.
    #[error("A name has at least {} letters.", Name::LEAST_COLUMNS)]
    Short,
    /// It is too long.
    #[error("A name is at most {} columns wide.", Name::MOST_COLUMNS)]
    Long,
    /// It has a character that no name has.
    #[error("A name has letters, digits, - and _, not {}.", shown(*.0))]
    Character(char),
    /// It does not begin with a letter.
    #[error("A name begins with a letter.")]
    Begin,
    /// It ends with `-` or `_`.
    #[error("A name ends with a letter or a digit.")]
    End,
    /// Its letters are of different scripts.
    #[error("The letters of a name are of one script.")]
    Mixed,
    /// It is reserved, or looks like a reserved name.
    #[error("This name is reserved.")]
    Reserved,
}

/// The scripts of letters.
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
/// Names that nobody may have.
const RESERVED: &str = "admin administrator all anonymous anybody cellcaster console everybody everyone \
    game guard host lobby mod moderator nobody none operator owner player room root \
    server spectator staff support system you";
/// The beginning of the names of guests.
const GUEST: &str = "guest";
/// Characters with a width that some terminals show as nothing, or that change what is beside them: the
/// soft hyphen, Hangul fillers, the blank of Braille, marks of annotation, and the object replacement.
const INVISIBLE: [char; 9] = [
    '\u{ad}', '\u{115f}', '\u{1160}', '\u{2800}', '\u{3164}', '\u{ffa0}', '\u{fff9}', '\u{fffb}',
    '\u{fffc}',
];
/// In bytes. A longer text is not looked at.
const MOST_BYTES: usize = 256;

impl Name {
    /// The least width in columns.
    pub const LEAST_COLUMNS: usize = 2;
    /// The largest width in columns.
    pub const MOST_COLUMNS: usize = 16;

    /// The name that a text is.
    ///
    /// # Errors
    /// A [`NameFault`], which is one sentence for the player.
    pub fn new(text: &str) -> Result<Self, NameFault> {
        let name = Self::unreserved(text)?;
        if name.is_reserved() { Err(NameFault::Reserved) } else { Ok(name) }
    }

    /// The name of a guest, such as `guest-12`. No account has it.
    pub fn of_guest(number: u32) -> Self {
        Self(format!("{GUEST}-{number}"))
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether it is the same as `other` in upper or lower case, or looks the same.
    pub fn looks_like(&self, other: &Self) -> bool {
        let keys = self.keys();
        other.keys().iter().any(|key| keys.contains(key))
    }

    /// Whether only the host can have it: it looks like `guest`, begins like that, or is a word for the
    /// host or for nobody.
    fn is_reserved(&self) -> bool {
        // Made once: that takes some thirty times as long as the keys of one name.
        static GUESTS: LazyLock<Vec<String>> = LazyLock::new(|| keys_of(GUEST));
        static WORDS: LazyLock<Vec<String>> =
            LazyLock::new(|| RESERVED.split(' ').flat_map(keys_of).collect());
        let is_guest = |key: &String| GUESTS.iter().any(|guest| key.starts_with(guest.as_str()));
        self.keys().iter().any(|key| is_guest(key) || WORDS.contains(key))
    }

    /// The keys of the name: two names that share one are not told from each other.
    pub(crate) fn keys(&self) -> Vec<String> {
        keys_of(&self.0)
    }

    /// The name that the store has kept. What would be no name now is taken as it is, as far as it can be
    /// printed.
    pub(crate) fn kept(text: &str) -> Self {
        Self(printable(text, Self::MOST_COLUMNS))
    }

    fn unreserved(text: &str) -> Result<Self, NameFault> {
        if text.len() > MOST_BYTES {
            return Err(NameFault::Long);
        }
        let text: String = text.nfkc().collect();
        if let Some(character) = text.chars().find(|&character| !is_allowed(character)) {
            return Err(NameFault::Character(character));
        }
        match text.width() {
            ..Self::LEAST_COLUMNS => return Err(NameFault::Short),
            Self::LEAST_COLUMNS..=Self::MOST_COLUMNS => {}
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

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0)
    }
}

/// The printable characters of a text, up to that many columns, in one line.
///
/// Every character that is kept takes one or two columns. Kinds of blanks and breaks become one blank,
/// and there is none at the ends. Control characters, escape sequences' introducers, marks that combine,
/// marks of direction, invisible, private and unassigned characters are dropped, and characters that
/// terminals draw in different widths. Letters with accents are composed before, so that these stay.
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

/// The keys of a name. Two names that share a key are not told from each other.
///
/// A key is a skeleton of Unicode Technical Standard #39, section 4, in which letters that look alike are
/// one. Skeletons know upper from lower case, and these look alike in another way each: `I` is like `l`,
/// and `i` is not. So there are two keys, the skeleton of the name in lower case, and the skeleton of the
/// name as it is, put in lower case then. Names that differ in case alone share the first one, and names
/// with the same skeleton share the second one.
fn keys_of(name: &str) -> Vec<String> {
    let of_lower_case: String = skeleton(&folded(name)).collect();
    let of_name: String = skeleton(name).collect();
    let mut keys = vec![of_lower_case, folded(&of_name)];
    keys.dedup();
    keys
}

/// The text with one case. It goes by way of upper case, in which `ß` is `SS` and both forms of a small
/// sigma are one.
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

/// The character in a sentence, or its number if a sentence cannot show it.
fn shown(character: char) -> String {
    match printable(character.encode_utf8(&mut [0; 4]), 2) {
        text if character != ' ' && text.starts_with(character) => character.to_string(),
        _ => format!("U+{:04X}", u32::from(character)),
    }
}

/// The columns of a character that is kept.
fn width_of(character: char) -> Option<usize> {
    let is_dropped = character.is_control()
        || INVISIBLE.contains(&character)
        || is_of_disputed_width(character)
        || [Script::Unknown, Script::Cuneiform].contains(&character.script());
    character.width().filter(|width| !is_dropped && (1..=2).contains(width))
}

/// Whether terminals draw `character` over its neighbours, or join it with them: dashes of two and three
/// ems, Arabic words that are one character, halves of flags, and skin tones. (Cuneiform signs, too.)
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
