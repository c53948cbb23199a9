//! What a cell looks like, and the cheapest way to say so.
//!
//! A cell of two pixels can be written as an upper or a lower half block with the colours swapped, and
//! one whose pixels are alike as a space or a full block. All of them look the same; the one is taken
//! that takes the fewest bytes after what the terminal has been told so far. A space is drawn in no
//! foreground at all, so that of the cell before it stays.

use ratatui::buffer::Cell;

use super::style::{Shade, Style};

const UPPER: &str = "▀";
const LOWER: &str = "▄";
const FULL: &str = "█";
const SPACE: &str = " ";

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
