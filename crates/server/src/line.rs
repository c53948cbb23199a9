//! Lines that players type: names and chat.
//!
//! Text that a player typed reaches another player's terminal only through a [`Line`]. It drops escape
//! sequences, direction marks and piles of accents, even if the caller forgets to check for them.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::accounts::printable;

/// Printable text that fits in a number of columns, as [`printable`] returns it. It is not empty.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub(crate) struct Line(Arc<str>);

impl Line {
    /// The printable characters of `text` that fit in `columns`. `None` if there are none.
    pub(crate) fn of(text: &str, columns: usize) -> Option<Self> {
        let line = printable(text, columns);
        (!line.is_empty()).then(|| Self(line.into()))
    }

    /// Returns true if the line fits in `columns`.
    pub(crate) fn fits(&self, columns: usize) -> bool {
        printable(&self.0, columns) == *self.0
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }
}

/// Accepts only text that [`printable`] leaves unchanged.
impl TryFrom<String> for Line {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, &'static str> {
        Self::of(&text, usize::MAX).filter(|line| *line.0 == *text).ok_or("a line")
    }
}

impl From<Line> for String {
    fn from(line: Line) -> Self {
        (*line.0).into()
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
    fn control_characters_are_removed() {
        let line = |text| Line::of(text, 40).map(|line| line.to_string());
        assert_eq!(line("\x1b[31mred\x07\n"), Some("[31mred".to_owned()));
        assert_eq!(line(" \t\u{7f}\u{202e}\u{301}"), None);
        assert_eq!(Line::of("日本語", 5).unwrap().as_str(), "日本");
    }
}
