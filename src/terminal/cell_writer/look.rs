//! What a cell looks like, and the cheapest way to say so.
//!
//! A cell of two pixels can be written as an upper or a lower half block with the colours swapped, and
//! one whose pixels are alike as a space or a full block. All of them look the same; the one is taken
//! that takes the fewest bytes after what the terminal has been told so far. A space is drawn in no
//! foreground at all, so that of the cell before it stays.

use std::fmt;

use ratatui::buffer::{Cell, CellWidth};

use super::style::{Shade, Style};
use super::tolerance::Tolerance;

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
        let (symbol, style) = (cell.symbol(), Style::of(cell));
        if let Some((top, bottom)) = halves(symbol, style) {
            return Self::of_halves(top, bottom);
        }
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

    /// Whether it may be wider than a cell.
    pub(super) fn is_intricate(self) -> bool {
        self == Self::INTRICATE
    }

    /// Whether it stays what it is where it is moved.
    pub(super) fn can_move(self) -> bool {
        self != Self::INTRICATE
    }

    /// Whether a cell that looks like `wanted` need not be sent.
    pub(super) fn is(self, wanted: Self) -> bool {
        self == wanted && self != Self::INTRICATE
    }

    /// Whether a cell that looks like `wanted` need not be sent, where colours may be off by
    /// `tolerance`.
    #[inline]
    pub(super) fn is_near(self, wanted: Self, tolerance: Tolerance) -> bool {
        self.is(wanted) || !tolerance.is_exact() && self.is_about(wanted, tolerance)
    }

    fn is_about(self, wanted: Self, tolerance: Tolerance) -> bool {
        match (self.halves(), wanted.halves()) {
            (Some(shown), Some(wanted)) => {
                tolerance.covers(shown[0], wanted[0]) && tolerance.covers(shown[1], wanted[1])
            }
            _ => false,
        }
    }

    /// The colours of the upper and the lower half of a block.
    pub(super) fn halves(self) -> Option<[Shade; 2]> {
        (self.0 >> 112 == Self::BLOCK)
            .then(|| [Shade::from_bits((self.0 >> 32) as u32), Shade::from_bits(self.0 as u32)])
    }

    fn of_halves(top: Shade, bottom: Shade) -> Self {
        Self::of_fields(Self::BLOCK, 0, top.in_bits(), bottom.in_bits(), 0)
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

/// A block, how it is drawn, and what that looks like.
pub(super) struct Block {
    pub(super) symbol: &'static str,
    pub(super) style: Style,
    pub(super) look: Look,
}

/// The cheapest block that looks like these two halves, within `tolerance`, after `current`.
pub(super) fn cheapest(
    [top, bottom]: [Shade; 2],
    current: Option<Style>,
    tolerance: Tolerance,
) -> Block {
    let plain = |symbol, text, ground, halves: [Shade; 2]| Block {
        symbol,
        style: Style::plain(text, ground),
        look: Look::of_halves(halves[0], halves[1]),
    };
    let Some(current) = current else { return plain(UPPER, top, bottom, [top, bottom]) };
    let (text, ground) = (current.foreground, current.background);
    let is_told = current.has_no_modifiers();
    let passes = |shade| tolerance.covers(shade, top) && tolerance.covers(shade, bottom);
    // What takes no colour at all is cheapest, and what takes one comes next.
    if is_told && passes(ground) {
        return plain(SPACE, text, ground, [ground; 2]);
    }
    if is_told && passes(text) {
        return plain(FULL, text, ground, [text; 2]);
    }
    let merged = [top, bottom].into_iter().find(|&shade| passes(shade));
    if let Some(merged) = merged {
        return if merged.bytes() < text.bytes() && !is_told {
            plain(SPACE, merged, merged, [merged; 2])
        } else {
            plain(SPACE, text, merged, [merged; 2])
        };
    }
    let snapped = |wanted, told| if tolerance.covers(told, wanted) { told } else { wanted };
    let upright = [snapped(top, text), snapped(bottom, ground)];
    let turned = [snapped(top, ground), snapped(bottom, text)];
    let upright = plain(UPPER, upright[0], upright[1], upright);
    let turned = plain(LOWER, turned[1], turned[0], turned);
    let bytes = |block: &Block| block.style.bytes_after(current);
    if bytes(&turned) < bytes(&upright) { turned } else { upright }
}

/// The colours of the upper and the lower half of a cell; `None` where it is no block, or where
/// another block would not look the same: in the terminal's own colours, which are not the same two
/// as text and as ground, and with modifiers.
fn halves(symbol: &str, style: Style) -> Option<(Shade, Shade)> {
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
