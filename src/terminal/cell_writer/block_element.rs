//! The cheapest block element that shows a cell.
//!
//! A cell of two pixels can be written as an upper or a lower half block with the colours swapped;
//! one of two equal pixels as a space or a full block. All of them look the same, so the pen uses
//! the one with the fewest bytes after the terminal's present style. A space has no foreground, so
//! that it keeps the one of the cell before it.

use super::style::{Shade, Style};

/// A character that shows at most two colours, each in a whole half of its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BlockElement {
    /// The upper half in the text colour, the lower half in the background colour.
    Upper,
    /// The upper half in the background colour, the lower half in the text colour.
    Lower,
    /// Both halves in the text colour.
    Full,
    /// Both halves in the background colour.
    Space,
}

impl BlockElement {
    /// The character in UTF-8, and the number of its bytes.
    #[inline]
    pub(crate) const fn encoded(self) -> ([u8; 4], usize) {
        match self {
            Self::Upper => ([0xE2, 0x96, 0x80, 0], 3),
            Self::Lower => ([0xE2, 0x96, 0x84, 0], 3),
            Self::Full => ([0xE2, 0x96, 0x88, 0], 3),
            Self::Space => ([b' ', 0, 0, 0], 1),
        }
    }

    pub(crate) const fn character(self) -> char {
        match self {
            Self::Upper => '▀',
            Self::Lower => '▄',
            Self::Full => '█',
            Self::Space => ' ',
        }
    }

    /// Finds the element by its bytes in UTF-8, since this runs for every changed cell.
    #[inline]
    pub(crate) fn of(symbol: &str) -> Option<Self> {
        match *symbol.as_bytes() {
            [b' '] => Some(Self::Space),
            [0xE2, 0x96, 0x80] => Some(Self::Upper),
            [0xE2, 0x96, 0x84] => Some(Self::Lower),
            [0xE2, 0x96, 0x88] => Some(Self::Full),
            _ => None,
        }
    }

    /// Whether it shows one colour.
    #[inline]
    pub(crate) fn is_flat(self) -> bool {
        matches!(self, Self::Full | Self::Space)
    }

    /// The colours of the upper and the lower half.
    #[inline]
    pub(crate) fn halves<T: Copy>(self, text: T, ground: T) -> [T; 2] {
        match self {
            Self::Upper => [text, ground],
            Self::Lower => [ground, text],
            Self::Full => [text; 2],
            Self::Space => [ground; 2],
        }
    }
}

/// The block element and style with the fewest bytes after `current` that show these two halves.
pub(crate) fn cheapest(halves: [Shade; 2], current: Option<Style>) -> (BlockElement, Style) {
    let [top, bottom] = halves;
    let plain = |element, [text, ground]: [Shade; 2]| (element, Style::plain(text, ground));
    let Some(current) = current else { return plain(BlockElement::Upper, halves) };
    if top == bottom && !current.has_no_modifiers() {
        let text = current.foreground;
        let text = if top.bytes() < text.bytes() { top } else { text };
        return plain(BlockElement::Space, [text, top]);
    }
    let (element, colors) = cheapest_after(current.colors(), halves);
    plain(element, colors)
}

/// The block element and the colours with the fewest bytes after a text colour and a background that show
/// these two halves; there must be no modifiers if they are equal.
#[inline]
pub(crate) fn cheapest_after(
    [text, ground]: [Shade; 2],
    [top, bottom]: [Shade; 2],
) -> (BlockElement, [Shade; 2]) {
    if top == bottom {
        return if text == top && ground != top {
            (BlockElement::Full, [text, ground])
        } else {
            (BlockElement::Space, [text, top])
        };
    }
    let told = |new_text, new_ground| u8::from(new_text == text) + u8::from(new_ground == ground);
    if told(bottom, top) > told(top, bottom) {
        (BlockElement::Lower, [bottom, top])
    } else {
        (BlockElement::Upper, [top, bottom])
    }
}
