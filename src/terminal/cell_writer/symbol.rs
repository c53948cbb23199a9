//! The text of a cell, as far as a terminal may receive it.

use ratatui::buffer::{Cell, CellWidth};

/// The text of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    /// Nothing to show: the text is empty, has no width, or contains a control character. A terminal
    /// would obey a control character, and would add a character without a width to the cell before.
    Blank,
    /// A character one cell wide.
    Character(char),
    /// Several characters, or one that is wider than a cell; none of them is a control character.
    Intricate,
}

impl Symbol {
    /// The text of `cell`.
    #[inline]
    pub(crate) fn of(cell: &Cell) -> Self {
        Self::classify(cell.symbol(), |_| cell.cell_width())
    }

    /// A text without a cell.
    pub(crate) fn of_text(text: &str) -> Self {
        Self::classify(text, CellWidth::cell_width)
    }

    /// Measures `text` only if it has no control character, since ratatui cannot measure these.
    #[inline]
    fn classify(text: &str, width: impl FnOnce(&str) -> u16) -> Self {
        let mut characters = text.chars();
        let (first, second) = (characters.next(), characters.next());
        match (first, second) {
            (Some(character), None) if character.is_ascii_graphic() => Self::Character(character),
            _ if text.chars().any(char::is_control) => Self::Blank,
            _ => match (width(text), first, second) {
                (0, ..) => Self::Blank,
                (1, Some(character), None) => Self::Character(character),
                _ => Self::Intricate,
            },
        }
    }
}
