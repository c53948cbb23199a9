//! Lines that players type: names and chat.
//!
//! Nothing that a player typed reaches the terminal of another one but through a [`Line`]. So an
//! escape sequence, a direction mark or a pile of accents ends here, whoever forgets to check.

use std::fmt;

use crate::accounts::printable;

/// Printable characters that fit in a number of columns, as [`printable`] leaves them. It is not empty.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Line(String);

impl Line {
    /// The printable characters of `text`, as many as fit in `columns`. `None` if there are none.
    pub(crate) fn of(text: &str, columns: usize) -> Option<Self> {
        let line = printable(text, columns);
        (!line.is_empty()).then_some(Self(line))
    }

    /// The text.
    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_of_what_a_terminal_would_obey() {
        let line = |text| Line::of(text, 40).map(|line| line.to_string());
        assert_eq!(line("\x1b[31mred\x07\n"), Some("[31mred".to_owned()));
        assert_eq!(line(" \t\u{7f}\u{202e}\u{301}"), None);
        assert_eq!(Line::of("日本語", 5).unwrap().as_str(), "日本");
    }
}
