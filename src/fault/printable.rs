//! Printable text: what a terminal would obey is shown as an escape.
//!
//! Names of files and values of options may hold any character. All text on standard error goes
//! through these functions.

#[cfg(feature = "terminal")]
use std::path::Path;

/// `text` on one line, with escapes such as `\u{1b}` for characters that do not print.
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

/// A path in a sentence, on one line and with escapes as in [`printable`].
#[cfg(feature = "terminal")]
pub fn printable_path(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// As [`printable`], with the line breaks of `text` as they are.
#[cfg(feature = "cli")]
pub(crate) fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// Whether `c` is neither a control character nor one that changes the direction of the characters
/// after it ("Trojan Source: Invisible Vulnerabilities", Boucher and Anderson, 2021).
fn does_print(c: char) -> bool {
    !c.is_control() && !matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_shown_and_nothing_else_changes() {
        assert_eq!(printable("a\u{1b}[31m\r\n\u{9b}\u{7f}\0"), r"a\u{1b}[31m\r\n\u{9b}\u{7f}\0");
        assert_eq!(printable("\u{202e}live"), r"\u{202e}live");
        for text in ["", r#""it's" C:\maps"#, "Flur – 廊下", "e\u{301}"] {
            assert_eq!(printable(text), text);
        }
    }

    #[cfg(feature = "terminal")]
    #[test]
    fn a_path_is_shown_on_one_line() {
        assert_eq!(printable_path(Path::new("/maps\n/\u{1b}c.toml")), r"/maps\n/\u{1b}c.toml");
    }

    #[cfg(feature = "cli")]
    #[test]
    fn lines_stay_lines() {
        assert_eq!(printable_lines("one\ntwo\u{7}\n"), "one\ntwo\\u{7}\n");
    }
}
