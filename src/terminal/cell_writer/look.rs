//! What a cell looks like, and the cheapest way to say so.
//!
//! A cell of two pixels can be written as an upper or a lower half block with the colours swapped, and
//! one whose pixels are alike as a space or a full block. All of them look the same; the one is taken
//! that takes the fewest bytes after what the terminal has been told so far. A space is drawn in no
//! foreground at all, so that of the cell before it stays.

use std::fmt;

use ratatui::buffer::{Cell, CellWidth};

use super::style::{Shade, Style};

const UPPER: &str = "▀";
const LOWER: &str = "▄";
const FULL: &str = "█";
const SPACE: &str = " ";

/// What a cell looks like, in one number: equal ones look the same.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Look(u128);

impl Look {
    /// Nobody knows; no cell that is to be shown looks like this.
    pub(super) const UNKNOWN: Self = Self(0);
    /// Of several characters, or wider than a cell: sent whenever its row changes.
    const INTRICATE: Self = Self(1);
    const BLOCK: u128 = 2;
    const CHARACTER: u128 = 3;

    /// What `cell` looks like.
    pub(super) fn of(cell: &Cell) -> Self {
        let glyph = (cell.symbol(), Style::of(cell));
        if let Some((top, bottom)) = halves(&glyph) {
            return Self::of_fields(Self::BLOCK, 0, top.in_bits(), bottom.in_bits(), 0);
        }
        let (symbol, style) = glyph;
        let mut characters = symbol.chars();
        match (characters.next(), characters.next()) {
            (Some(character), None) if cell.cell_width() == 1 => Self::of_fields(
                Self::CHARACTER,
                u32::from(character),
                style.foreground.in_bits(),
                style.background.in_bits(),
                style.modifier_bits(),
            ),
            _ => Self::INTRICATE,
        }
    }

    /// Whether it stays what it is where it is moved.
    pub(super) fn can_move(self) -> bool {
        self != Self::INTRICATE
    }

    /// Whether a cell that looks like `wanted` need not be sent.
    pub(super) fn is(self, wanted: Self) -> bool {
        self == wanted && self != Self::INTRICATE
    }

    fn of_fields(kind: u128, character: u32, one: u32, other: u32, modifier: u16) -> Self {
        let colors = u128::from(one) << 32 | u128::from(other);
        Self(kind << 112 | u128::from(modifier) << 96 | u128::from(character) << 64 | colors)
    }

    #[cfg(test)]
    pub(super) fn of_character(character: char) -> Self {
        Self::of(Cell::default().set_char(character))
    }
}

impl fmt::Debug for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:x}", self.0)
    }
}

/// A character, and how it is drawn.
pub(super) type Glyph<'a> = (&'a str, Style);

/// The cheapest glyph that looks like `cell`, after `current`.
pub(super) fn cheapest(cell: &Cell, current: Option<Style>) -> Glyph<'_> {
    let plain = (cell.symbol(), Style::of(cell));
    let (Some(current), Some((top, bottom))) = (current, halves(&plain)) else { return plain };
    let candidates = if top == bottom {
        [
            (SPACE, Style::plain(current.foreground, top)),
            (FULL, Style::plain(top, current.background)),
        ]
    } else {
        [(UPPER, Style::plain(top, bottom)), (LOWER, Style::plain(bottom, top))]
    };
    let bytes = |&(symbol, style): &Glyph| symbol.len() + style.bytes_after(current);
    candidates.into_iter().min_by_key(bytes).unwrap_or(plain)
}

/// The colours of the upper and the lower half of a glyph; `None` where it is no block, or where
/// another block would not look the same: in the terminal's own colours, which are not the same two
/// as text and as ground, and with modifiers.
fn halves(&(symbol, style): &Glyph) -> Option<(Shade, Shade)> {
    let (text, ground) = (style.foreground, style.background);
    let (top, bottom) = match symbol {
        UPPER => (text, ground),
        LOWER => (ground, text),
        FULL => (text, text),
        SPACE => (ground, ground),
        _ => return None,
    };
    let is_own = |shade| shade == Shade::Default;
    (style.has_no_modifiers() && !is_own(top) && !is_own(bottom)).then_some((top, bottom))
}
