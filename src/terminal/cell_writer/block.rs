//! Blocks: cells of two colours, and the characters that show them.
//!
//! A mosaic and its inverse with swapped colours look the same. A shape is the one of the two that lacks the last dot,
//! so that cells that look the same are equal. The first colour of a cell is the colour of the shape's dots, and the
//! second is the colour of the rest. A half block is the shape of the upper half.
//!
//! Two cells of different shapes are compared by the parts of a cell that their colours have in common. If an edge then
//! moves by a dot within one wall, the cells with near colours can be kept.

use super::style::{PackedColor, Style};
use crate::tui::canvas::Mosaic;

/// A mosaic without the last dot. Its number is below [`MosaicShape::COUNT`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MosaicShape(u8);

/// The number of octant shapes. The sextant shapes follow them.
const OCTANTS: u8 = 128;

/// The parts that the dots and the rest of a cell have in common with the dots and the rest of another cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overlap {
    /// The parts that are dots in both cells, and the parts that are rest in both.
    straight: [u8; 2],
    /// The parts that are dots in the first cell and rest in the other, and the reverse.
    crossed: [u8; 2],
}

impl Overlap {
    /// For each pair of colours: the index of the first cell's colour, the index of the other's, and the number of
    /// parts.
    #[inline]
    pub(crate) fn pairs(self) -> [([usize; 2], u8); 4] {
        let Self { straight, crossed } = self;
        [([0, 0], straight[0]), ([0, 1], crossed[0]), ([1, 0], crossed[1]), ([1, 1], straight[1])]
    }
}

impl MosaicShape {
    /// The upper half, in cells of two pixels.
    pub(crate) const HALF: Self = Self(0);
    /// No dot. No cell has this shape.
    pub(crate) const NONE: Self = Self(Self::HALF_MASK);
    pub(crate) const COUNT: u8 = OCTANTS + 32;
    /// The mask of the upper half, whose shape has the number 0.
    const HALF_MASK: u8 = 0x0F;

    /// The shape of a mosaic, and `true` if its colours must be swapped.
    #[inline]
    pub(crate) const fn of(mosaic: Mosaic) -> (Self, bool) {
        match mosaic.mask() {
            Ok(mask) => {
                let is_inverse = mask & 0x80 != 0;
                let mask = if is_inverse { !mask } else { mask };
                (Self(mask ^ Self::HALF_MASK), is_inverse)
            }
            Err(mask) => {
                let is_inverse = mask & 0x20 != 0;
                let mask = if is_inverse { mask ^ 0x3F } else { mask };
                (Self(OCTANTS + mask), is_inverse)
            }
        }
    }

    pub(crate) const fn mosaic(self) -> Mosaic {
        match self.0.checked_sub(OCTANTS) {
            None => Mosaic::octants(self.0 ^ Self::HALF_MASK),
            Some(mask) => Mosaic::sextants(mask),
        }
    }

    /// The number of the shape, less than [`MosaicShape::COUNT`].
    #[inline]
    pub(crate) const fn get(self) -> u8 {
        self.0
    }

    /// The shape with this number, which must come from [`MosaicShape::get`].
    #[inline]
    pub(crate) const fn new(number: u8) -> Self {
        Self(number)
    }

    /// The character that shows the shape in the way in which `element` shows a half block, in UTF-8, and the number of
    /// its bytes.
    #[inline]
    pub(crate) fn encoded(self, element: BlockElement) -> ([u8; 4], usize) {
        let inverse = match element {
            BlockElement::Upper => 0,
            BlockElement::Lower => 1,
            BlockElement::Full | BlockElement::Space => return element.encoded(),
        };
        let encoded = ENCODED[usize::from(self.0)][inverse];
        (encoded, if encoded[3] == 0 { 3 } else { 4 })
    }

    /// The number of bytes of its character.
    #[inline]
    pub(crate) fn bytes(self) -> f32 {
        if ENCODED[usize::from(self.0)][0][3] == 0 { 3.0 } else { 4.0 }
    }

    /// The numbers of parts of a cell, in twenty-fourths, that have the colour of the dots and the other colour.
    #[inline]
    pub(crate) fn parts(self) -> [u8; 2] {
        let dots = PARTS[usize::from(self.0)].count_ones() as u8;
        [dots, Self::PARTS - dots]
    }

    /// The number of parts of a cell.
    pub(crate) const PARTS: u8 = 24;

    /// The parts that this shape's dots and rest have in common with the dots and the rest of another shape.
    #[inline]
    pub(crate) fn overlap(self, other: Self) -> Overlap {
        let [one, other] = [self, other].map(|shape| PARTS[usize::from(shape.0)]);
        let count = |parts: u32| parts.count_ones() as u8;
        let both = count(one & other);
        let (only_one, only_other) = (count(one) - both, count(other) - both);
        Overlap {
            straight: [both, Self::PARTS - both - only_one - only_other],
            crossed: [only_one, only_other],
        }
    }
}

/// The characters of each shape and of its inverse in UTF-8. The last byte is zero if a character has three.
static ENCODED: [[[u8; 4]; 2]; MosaicShape::COUNT as usize] = {
    let mut table = [[[0; 4]; 2]; MosaicShape::COUNT as usize];
    let mut number = 0;
    while number < MosaicShape::COUNT {
        let mosaic = MosaicShape::new(number).mosaic();
        table[number as usize] = [encoded(mosaic), encoded(mosaic.inverse())];
        number += 1;
    }
    table
};

const fn encoded(mosaic: Mosaic) -> [u8; 4] {
    let mut bytes = [0; 4];
    mosaic.character().encode_utf8(&mut bytes);
    bytes
}

/// The twenty-fourths of a cell, two by twelve, in which each shape has dots.
static PARTS: [u32; MosaicShape::COUNT as usize] = {
    let mut table = [0; MosaicShape::COUNT as usize];
    let mut number = 0;
    while number < MosaicShape::COUNT {
        let mut part = 0;
        while part < MosaicShape::PARTS as u32 {
            let is_dot = MosaicShape::new(number).mosaic().has(part % 2, part / 2);
            table[number as usize] |= (is_dot as u32) << part;
            part += 1;
        }
        number += 1;
    }
    table
};

/// A character that shows one colour in each half of its cell.
///
/// A cell of two pixels can be written as an upper half block, or as a lower half block with swapped colours. A cell of
/// two equal pixels can be written as a space or a full block. The alternatives look the same, so the pen uses the one
/// with the fewest bytes after the terminal's current style. A space has no foreground, so it keeps the foreground of
/// the cell before it.
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

    /// Finds the element by its bytes in UTF-8, because this runs for every changed cell.
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

    /// Returns true if the element shows only one colour.
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

    /// The block element and style with the fewest bytes after `current` that show these two halves.
    pub(crate) fn cheapest(halves: [PackedColor; 2], current: Option<Style>) -> (Self, Style) {
        let [top, bottom] = halves;
        let plain =
            |element, [text, ground]: [PackedColor; 2]| (element, Style::plain(text, ground));
        let Some(current) = current else { return plain(Self::Upper, halves) };
        if top == bottom && !current.has_no_modifiers() {
            let text = current.foreground;
            let text = if top.bytes() < text.bytes() { top } else { text };
            return plain(Self::Space, [text, top]);
        }
        let (element, colors) = Self::cheapest_after(current.colors(), halves);
        plain(element, colors)
    }

    /// The block element and the colours with the fewest bytes after a text colour and a background that show these two
    /// halves. If the halves are equal, the current style must have no modifiers.
    #[inline]
    pub(crate) fn cheapest_after(
        [text, ground]: [PackedColor; 2],
        [top, bottom]: [PackedColor; 2],
    ) -> (Self, [PackedColor; 2]) {
        if top == bottom {
            return if text == top && ground != top {
                (Self::Full, [text, ground])
            } else {
                (Self::Space, [text, top])
            };
        }
        let told =
            |new_text, new_ground| u8::from(new_text == text) + u8::from(new_ground == ground);
        if told(bottom, top) > told(top, bottom) {
            (Self::Lower, [bottom, top])
        } else {
            (Self::Upper, [top, bottom])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mosaic_and_its_inverse_share_one_shape() {
        let all = (0..=u8::MAX).map(Mosaic::octants).chain((0..64).map(Mosaic::sextants));
        for mosaic in all {
            let ((shape, is_inverse), (other, is_other_inverse)) =
                (MosaicShape::of(mosaic), MosaicShape::of(mosaic.inverse()));
            assert_eq!((shape, is_inverse), (other, !is_other_inverse));
            assert!(shape.get() < MosaicShape::COUNT);
            if shape == MosaicShape::NONE {
                continue;
            }
            let element = if is_inverse { BlockElement::Lower } else { BlockElement::Upper };
            let (encoded, bytes) = shape.encoded(element);
            assert_eq!(encoded[..bytes], *mosaic.character().to_string().as_bytes());
        }
        assert_eq!(MosaicShape::of(Mosaic::UPPER_HALF), (MosaicShape::HALF, false));
    }

    #[test]
    fn overlaps_match_the_dots() {
        let shape = |mask| MosaicShape::of(Mosaic::octants(mask)).0;
        let (upper, left) = (shape(0x0F), shape(0x55));
        assert_eq!(upper.overlap(left), Overlap { straight: [6, 6], crossed: [6, 6] });
        assert_eq!(upper.overlap(upper), Overlap { straight: [12, 12], crossed: [0, 0] });
        let third = MosaicShape::of(Mosaic::sextants(0b11)).0;
        assert_eq!(third.overlap(upper), Overlap { straight: [8, 12], crossed: [0, 4] });
        assert_eq!(third.parts(), [8, 16]);
    }
}
