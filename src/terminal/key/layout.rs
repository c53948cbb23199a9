//! Keys by their place on the keyboard, for layouts that type no Latin letters.
//!
//! Bindings name Latin letters. The kitty protocol tells which key of a US keyboard is at the place
//! of the one pressed; other terminals send the letter alone, and its place follows from the layout
//! that is most common for its script. Latin letters stay what they are: who types on an AZERTY or
//! Dvorak keyboard chooses keys by what they type.

use super::Key;

/// Letters and the keys of a US keyboard at their places: of the Russian layout, with the letters in
/// which the Ukrainian and the Belarusian ones differ, and of the Greek one.
const PLACES: [(&str, &str); 7] = [
    ("йцукенгшщзхъ", "qwertyuiop[]"),
    ("фывапролджэ", "asdfghjkl;'"),
    ("ячсмитьбюё", "zxcvbnm,.`"),
    ("іїєґў", "s]'\\o"),
    ("ςερτυθιοπ", "wertyuiop"),
    ("ασδφγηξκλ", "asdfghjkl"),
    ("ζχψωβνμ", "zxcvbnm"),
];

/// The key of a US keyboard at the place of `key`, where that types a letter that is not a Latin one:
/// the one that the terminal has `told`, or else the one that is known of the letter.
pub(in super::super) fn base_key(key: Key, told: Option<char>) -> Option<Key> {
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

/// Whether `letter` is of the Latin script, by Unicode's blocks of it.
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
    fn latin_letters_and_signs_stay_what_they_are() {
        for character in ['z', 'é', 'ß', 'ő', 'ĳ', 'ạ', ';', ' ', '7', '—'] {
            assert_eq!(base_key(Key::Char(character), Some('w')), None, "{character}");
        }
        assert_eq!(base_key(Key::Up, Some('w')), None);
    }

    #[test]
    fn what_the_terminal_tells_goes_first() {
        // A phonetic layout has this letter at the place of S.
        assert_eq!(base_key(Key::Char('с'), Some('s')), Some(Key::Char('s')));
        assert_eq!(base_key(Key::Char('с'), None), Some(Key::Char('c')));
        assert_eq!(base_key(Key::Char('ש'), None), None);
    }
}
