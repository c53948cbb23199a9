//! What of a text may reach another player's terminal.

use unicode_normalization::UnicodeNormalization;
use unicode_script::{Script, UnicodeScript};
use unicode_width::UnicodeWidthChar;

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

/// Characters with a width that some terminals show as nothing, or that change what is beside them: the
/// soft hyphen, Hangul fillers, the blank of Braille, marks of annotation, and the object replacement.
const INVISIBLE: [char; 9] = [
    '\u{ad}', '\u{115f}', '\u{1160}', '\u{2800}', '\u{3164}', '\u{ffa0}', '\u{fff9}', '\u{fffb}',
    '\u{fffc}',
];
