//! Keys by their places on the keyboard, for layouts without Latin letters.
//!
//! Bindings name Latin letters. The kitty protocol reports the key of a US keyboard at the place of
//! the pressed one; other terminals send the letter alone, and its place is derived from the most
//! common layout of its script. Latin letters are not mapped: users of an AZERTY or Dvorak keyboard
//! choose keys by their letters.

use super::Key;

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
    use super::*;

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
