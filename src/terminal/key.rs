//! Keys and key events.
//!
//! A key is a physical key, not the text that it types: letters are lower-case, and Shift is a
//! modifier.
//!
//! Bindings name Latin letters. For layouts without them, a key also has the key of a US keyboard at its place. The
//! kitty protocol reports it. Other terminals send the letter alone, and its place is derived from the most common
//! layout of its script. Latin letters are not mapped: users of an AZERTY or Dvorak keyboard choose keys by their
//! letters.
//!
//! Rejected: the types of a parser. Files with bindings contain these names, and must outlive any parser.

use std::fmt;
use std::str::FromStr;

/// An event of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KeyEvent {
    /// The key, by the character that the keyboard's layout assigns to it.
    pub key: Key,
    /// The key of a US keyboard at the same place, if the layout types non-Latin letters and the
    /// place is known.
    pub base: Option<Key>,
    /// The modifiers during the event.
    pub modifiers: Modifiers,
    /// The kind of event.
    pub phase: Phase,
}

impl KeyEvent {
    /// The character that the event types into a text; `None` for other keys, with Control or Alt,
    /// and for releases.
    pub fn typed(&self) -> Option<char> {
        let Key::Char(character) = self.key else { return None };
        let Modifiers { shift, control, alt } = self.modifiers;
        if control || alt || self.phase == Phase::Release {
            return None;
        }
        let mut upper = character.to_uppercase();
        match (upper.next(), upper.next()) {
            (Some(single), None) if shift => Some(single),
            _ => Some(character),
        }
    }
}

/// A key of the keyboard.
///
/// Its text, for [`Display`](fmt::Display) and [`FromStr`], is the character or a name: `space`,
/// `up`, `down`, `left`, `right`, `enter`, `escape`, `tab`, `backspace`, `insert`, `delete`,
/// `home`, `end`, `pageup`, `pagedown`, `shift`, `control`, `alt`, `f1` to `f35`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A key that types a character. A letter is lower-case, whether Shift is down or not.
    Char(char),
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Enter, also the keypad's.
    Enter,
    /// Escape.
    Escape,
    /// Tab; backwards with Shift.
    Tab,
    /// Backspace.
    Backspace,
    /// Insert.
    Insert,
    /// Delete.
    Delete,
    /// Home.
    Home,
    /// End.
    End,
    /// Page up.
    PageUp,
    /// Page down.
    PageDown,
    /// Either Shift by itself. Reported only if the terminal reports releases.
    Shift,
    /// Either Control by itself. Reported only if the terminal reports releases.
    Control,
    /// Either Alt by itself. Reported only if the terminal reports releases.
    Alt,
    /// A function key, from 1 to 35.
    Function(u8),
}

/// The held modifiers during an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Modifiers {
    /// Either Shift.
    pub shift: bool,
    /// Either Control.
    pub control: bool,
    /// Either Alt, or Option.
    pub alt: bool,
}

/// The kind of a key event.
///
/// A terminal without reports of releases sends presses only, and repeats them while the key is
/// held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// The key was pressed.
    Press,
    /// The key is held, and the keyboard repeats it.
    Repeat,
    /// The key was released.
    Release,
}

/// The error of [`Key::from_str`]: no key has this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownKey {
    name: String,
}

const LAST_FUNCTION_KEY: u8 = 35;

const NAMES: [(&str, Key); 18] = [
    ("space", Key::Char(' ')),
    ("up", Key::Up),
    ("down", Key::Down),
    ("left", Key::Left),
    ("right", Key::Right),
    ("enter", Key::Enter),
    ("escape", Key::Escape),
    ("tab", Key::Tab),
    ("backspace", Key::Backspace),
    ("insert", Key::Insert),
    ("delete", Key::Delete),
    ("home", Key::Home),
    ("end", Key::End),
    ("pageup", Key::PageUp),
    ("pagedown", Key::PageDown),
    ("shift", Key::Shift),
    ("control", Key::Control),
    ("alt", Key::Alt),
];

impl Key {
    /// The key that types `character`, in upper or lower case.
    pub(crate) fn typing(character: char) -> Self {
        let mut lower = character.to_lowercase();
        match (lower.next(), lower.next()) {
            (Some(single), None) => Self::Char(single),
            _ => Self::Char(character),
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (NAMES.iter().find(|(_, key)| key == self), self) {
            (Some((name, _)), _) => f.write_str(name),
            (None, Self::Char(character)) => write!(f, "{character}"),
            (None, Self::Function(number)) => write!(f, "f{number}"),
            (None, named) => unreachable!("{named:?} is in the list of names"),
        }
    }
}

impl FromStr for Key {
    type Err = UnknownKey;

    /// Parses a name or a single character, in upper or lower case.
    fn from_str(text: &str) -> Result<Self, UnknownKey> {
        let unknown = || UnknownKey { name: text.to_owned() };
        let mut characters = text.chars();
        if let (Some(only), None) = (characters.next(), characters.next()) {
            return if only.is_control() { Err(unknown()) } else { Ok(Self::typing(only)) };
        }
        let name = text.to_ascii_lowercase();
        if let Some((_, key)) = NAMES.iter().find(|(known, _)| *known == name) {
            return Ok(*key);
        }
        name.strip_prefix('f')
            .filter(|number| number.bytes().all(|digit| digit.is_ascii_digit()))
            .and_then(|number| number.parse().ok())
            .filter(|number| (1..=LAST_FUNCTION_KEY).contains(number))
            .map(Self::Function)
            .ok_or_else(unknown)
    }
}

impl fmt::Display for UnknownKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:?} is not a key: write one character, such as \"w\", or a name, such as \"up\", \
             \"space\" or \"f1\"",
            self.name
        )
    }
}

impl std::error::Error for UnknownKey {}

/// Letters, and the keys of a US keyboard at their places: of the Russian layout, with the
/// different letters of the Ukrainian and Belarusian ones, and of the Greek layout.
const PLACES: [(&str, &str); 7] = [
    ("йцукенгшщзхъ", "qwertyuiop[]"),
    ("фывапролджэ", "asdfghjkl;'"),
    ("ячсмитьбюё", "zxcvbnm,.`"),
    ("іїєґў", "s]'\\o"),
    ("ςερτυθιοπ", "wertyuiop"),
    ("ασδφγηξκλ", "asdfghjkl"),
    ("ζχψωβνμ", "zxcvbnm"),
];

/// The key of a US keyboard at the place of `key`, if `key` types a non-Latin letter: the key that
/// the terminal has reported (`told`), or else the one in the table.
pub(crate) fn base_key(key: Key, told: Option<char>) -> Option<Key> {
    let Key::Char(letter) = key else { return None };
    if !letter.is_alphabetic() || is_latin(letter) {
        return None;
    }
    let told = told.filter(char::is_ascii_graphic);
    told.or_else(|| known_base(letter)).map(Key::typing)
}

fn known_base(letter: char) -> Option<char> {
    let place = |(letters, keys): (&str, &str)| {
        letters.chars().zip(keys.chars()).find(|&(known, _)| known == letter)
    };
    PLACES.into_iter().find_map(place).map(|(_, key)| key)
}

/// Whether `letter` is in one of Unicode's Latin blocks.
fn is_latin(letter: char) -> bool {
    matches!(letter, '\0'..='\u{24f}' | '\u{1e00}'..='\u{1eff}' | '\u{ff00}'..='\u{ff5e}')
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn names_and_keys_agree() {
        for (name, key) in NAMES {
            assert_eq!(name.parse(), Ok(key));
            assert_eq!(key.to_string(), name);
        }
        for number in 1..=LAST_FUNCTION_KEY {
            let key = Key::Function(number);
            assert_eq!(key.to_string().parse(), Ok(key));
        }
    }

    #[test]
    fn either_case_names_the_same_key() {
        assert_eq!("W".parse(), Ok(Key::Char('w')));
        assert_eq!("Ä".parse(), Ok(Key::Char('ä')));
        assert_eq!("PageUp".parse(), Ok(Key::PageUp));
        assert_eq!("F11".parse(), Ok(Key::Function(11)));
    }

    #[test]
    fn an_invalid_name_is_refused_and_named() {
        for text in ["", "upp", "f0", "f36", "f+1", "f999", "ctrl-c", "\u{7}"] {
            let error = text.parse::<Key>().unwrap_err();
            assert!(error.to_string().starts_with(&format!("{text:?}")), "{error}");
        }
    }

    proptest! {
        #[test]
        fn every_character_key_survives_its_text(character: char) {
            prop_assume!(!character.is_control());
            let key = Key::typing(character);
            prop_assert_eq!(key.to_string().parse::<Key>(), Ok(key));
        }
    }

    #[test]
    fn every_letter_in_the_table_has_one_place() {
        let mut letters = Vec::new();
        for (row, keys) in PLACES {
            assert_eq!(row.chars().count(), keys.chars().count(), "{row}");
            letters.extend(row.chars());
        }
        for &letter in &letters {
            assert_eq!(letters.iter().filter(|&&other| other == letter).count(), 1, "{letter}");
            assert!(base_key(Key::Char(letter), None).is_some(), "{letter}");
        }
    }

    #[test]
    fn latin_letters_and_signs_are_not_mapped() {
        for character in ['z', 'é', 'ß', 'ő', 'ĳ', 'ạ', ';', ' ', '7', '—'] {
            assert_eq!(base_key(Key::Char(character), Some('w')), None, "{character}");
        }
        assert_eq!(base_key(Key::Up, Some('w')), None);
    }

    #[test]
    fn the_key_that_the_terminal_reports_comes_first() {
        // A phonetic layout has this letter at the place of S.
        assert_eq!(base_key(Key::Char('с'), Some('s')), Some(Key::Char('s')));
        assert_eq!(base_key(Key::Char('с'), None), Some(Key::Char('c')));
        assert_eq!(base_key(Key::Char('ש'), None), None);
    }
}
