//! Lines that players type: names and chat.
//!
//! Nothing that a player typed reaches the terminal of another one but through a [`Line`]. So an
//! escape sequence, a direction mark or a pile of accents ends here, whoever forgets to check.

use std::fmt;

use unicode_width::UnicodeWidthChar;

/// Printable characters that fit in a number of columns. It is not empty, and no blank is at its ends.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Line(String);

impl Line {
    /// The printable characters of `text`, as many as fit in `columns`. `None` if there are none.
    pub(crate) fn of(text: &str, columns: usize) -> Option<Self> {
        let mut left = columns;
        let fits = |character: &char| {
            let width = character.width().unwrap_or(0);
            let fits = width <= left;
            left -= width.min(left);
            fits
        };
        let line: String = text.trim().chars().filter(is_printable).take_while(fits).collect();
        let line = line.trim();
        (!line.is_empty()).then(|| Self(line.to_owned()))
    }

    /// The text.
    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }
}

/// Whether a character occupies cells of its own. Marks that combine with the one before are left
/// out: some terminals draw a hundred of them across other lines.
fn is_printable(character: &char) -> bool {
    let is_private = matches!(u32::from(*character), 0xe000..=0xf8ff | 0xf_0000..);
    !is_private && !character.is_control() && character.width().is_some_and(|width| width > 0)
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use unicode_width::UnicodeWidthStr;

    use super::*;

    proptest! {
        #[test]
        fn a_line_is_printable_and_fits(text in any::<String>(), columns in 0_usize..80) {
            if let Some(line) = Line::of(&text, columns) {
                prop_assert!(line.as_str().width() <= columns);
                prop_assert!(!line.as_str().chars().any(char::is_control));
                prop_assert_eq!(Line::of(line.as_str(), columns), Some(line.clone()));
            }
        }
    }

    #[test]
    fn nothing_is_left_of_what_a_terminal_would_obey() {
        let line = |text| Line::of(text, 40).map(|line| line.to_string());
        assert_eq!(line("\x1b[31mred\x07\n"), Some("[31mred".to_owned()));
        assert_eq!(line("a\u{202e}b\u{200d}c\u{9b}d"), Some("abcd".to_owned()));
        assert_eq!(line("z\u{301}\u{302}\u{303}"), Some("z".to_owned()));
        assert_eq!(line(" \t\u{7f}"), None);
        assert_eq!(Line::of("日本語", 5).unwrap().as_str(), "日本");
    }
}
