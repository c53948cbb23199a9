//! The canvas: cells on which pictures and widgets are drawn.
//!
//! Ratatui's [`Buffer`] is a canvas, so this crate's pictures are ordinary widgets. The other canvas is the encoder's
//! own screen. It draws cells directly and never builds ratatui's cells, which take forty bytes and a string each.
//! Clearing, filling, comparing and decoding them took half the time of a frame.
//!
//! Rejected: an intermediate type of cell, from which both canvases are filled. It would add one more copy of each
//! picture.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::{Clear, Widget};

use crate::color::Rgb;

/// Cells to draw on. Positions outside of the bounds are ignored.
pub trait Canvas {
    /// The area of the canvas, in cells.
    fn bounds(&self) -> Rect;

    /// Draws two colours in each cell from `(x, y)` to the right, the first above the second.
    #[inline]
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        self.draw_mosaics(x, y, row.map(|halves| (Mosaic::UPPER_HALF, halves)));
    }

    /// Does the same as [`Canvas::draw_halves`] in true colour, which most cells of most pictures
    /// use.
    #[inline]
    fn draw_pixels(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Rgb; 2]>) {
        self.draw_halves(x, y, row.map(|halves| halves.map(true_color)));
    }

    /// Draws a mosaic in each cell from `(x, y)` to the right, in the colours of its dots and of the rest.
    fn draw_mosaics(&mut self, x: u16, y: u16, row: impl Iterator<Item = (Mosaic, [Color; 2])>);

    /// Draws a character that is one cell wide, in a foreground and a background colour.
    fn draw_character(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]);

    /// Clears `area` and draws a widget there.
    fn draw_widget(&mut self, widget: impl Widget, area: Rect);
}

impl Canvas for Buffer {
    fn bounds(&self) -> Rect {
        self.area
    }

    /// A mosaic and its inverse show the same two colours. Chooses whichever shares more colours with the cell to the
    /// left, because most encoders need not send shared colours again. A cell of one colour is a space.
    fn draw_mosaics(&mut self, x: u16, y: u16, row: impl Iterator<Item = (Mosaic, [Color; 2])>) {
        let mut before = [Color::Reset; 2];
        for (x, (mosaic, [dots, rest])) in (x..self.area.right()).zip(row) {
            let (mosaic, colors) = if dots == rest {
                (Mosaic::NONE, [dots; 2])
            } else if shared([rest, dots], before) > shared([dots, rest], before) {
                (mosaic.inverse(), [rest, dots])
            } else {
                (mosaic, [dots, rest])
            };
            self.draw_character(x, y, mosaic.character(), colors);
            before = colors;
        }
    }

    fn draw_character(
        &mut self,
        x: u16,
        y: u16,
        character: char,
        [foreground, background]: [Color; 2],
    ) {
        if let Some(cell) = self.cell_mut((x, y)) {
            cell.reset();
            cell.set_char(character).set_fg(foreground).set_bg(background);
        }
    }

    fn draw_widget(&mut self, widget: impl Widget, area: Rect) {
        let area = area.intersection(self.area);
        Clear.render(area, self);
        widget.render(area, self);
    }
}

/// Draws a character in each cell of `area`. `cell(x, y)` returns the character and its colours. `x` and `y` count
/// from the top left corner.
pub(crate) fn draw_characters(
    area: Rect,
    canvas: &mut impl Canvas,
    cell: impl Fn(u32, u32) -> (char, [Color; 2]),
) {
    for (row, y) in (0..).zip(area.top()..area.bottom()) {
        for (column, x) in (0..).zip(area.left()..area.right()) {
            let (character, colors) = cell(column, row);
            canvas.draw_character(x, y, character, colors);
        }
    }
}

/// The characters that show one, two and three quarters of the text colour.
pub(crate) const SHADES: [char; 3] = ['░', '▒', '▓'];

/// `color` as a ratatui colour.
#[inline]
pub(crate) fn true_color(color: Rgb) -> Color {
    Color::Rgb(color.red(), color.green(), color.blue())
}

/// The number of colours that two cells share.
fn shared(one: [Color; 2], other: [Color; 2]) -> u8 {
    u8::from(one[0] == other[0]) + u8::from(one[1] == other[1])
}

/// A block mosaic: a character that divides a cell into dots, each in the text or the background colour.
///
/// A cell has two columns and two, three or four rows of dots: quadrants, sextants and octants. Quadrants, halves and
/// the whole cell consist of pairs of octants, and so do four of the sextants. A mosaic is identified by its dots and
/// not by its character, so that mosaics that look the same are equal.
///
/// Unicode has sextants since version 13 and octants since version 16. Both blocks omit patterns that already had a
/// character.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mosaic(u16);

/// The number of octant patterns. The sextant patterns follow them.
const OCTANTS: u16 = 256;

impl Mosaic {
    /// No dot.
    pub const NONE: Self = Self(0);
    /// Every dot.
    pub const ALL: Self = Self(0xFF);
    /// The upper half.
    pub const UPPER_HALF: Self = Self(0x0F);

    /// A mosaic of two halves. The lowest bit of `mask` is the upper half.
    pub const fn halves(mask: u8) -> Self {
        const MOSAICS: [u16; 4] = [0, 0x0F, 0xF0, 0xFF];
        Self(MOSAICS[(mask & 3) as usize])
    }

    /// A mosaic of two by two dots. The lowest bit of `mask` is the upper left dot, the next bit is the dot to the
    /// right of it, and so on by rows. Bits without a dot are ignored.
    pub const fn quadrants(mask: u8) -> Self {
        const ROWS: [u16; 4] = [0, 0x05, 0x0A, 0x0F];
        Self(ROWS[(mask & 3) as usize] | ROWS[(mask >> 2 & 3) as usize] << 4)
    }

    /// A mosaic of two by three dots, in the order of [`Mosaic::quadrants`].
    pub const fn sextants(mask: u8) -> Self {
        match mask & 0x3F {
            0 => Self::NONE,
            LEFT_SEXTANTS => Self(0x55),
            RIGHT_SEXTANTS => Self(0xAA),
            0x3F => Self::ALL,
            mask => Self(OCTANTS | mask as u16),
        }
    }

    /// A mosaic of two by four dots, in the order of [`Mosaic::quadrants`].
    pub const fn octants(mask: u8) -> Self {
        Self(mask as u16)
    }

    /// A mosaic of this number of dots: octants, sextants, quadrants or halves.
    #[inline]
    pub(crate) const fn of_dots(dots: usize, mask: u8) -> Self {
        match dots {
            8 => Self::octants(mask),
            6 => Self::sextants(mask),
            4 => Self::quadrants(mask),
            _ => Self::halves(mask),
        }
    }

    /// The mosaic in which exactly the other dots have the text colour.
    #[must_use]
    pub const fn inverse(self) -> Self {
        if self.0 < OCTANTS { Self(self.0 ^ 0xFF) } else { Self(self.0 ^ 0x3F) }
    }

    /// `Ok` with the mask of octants, or `Err` with the mask of sextants.
    pub(crate) const fn mask(self) -> Result<u8, u8> {
        if self.0 < OCTANTS { Ok(self.0 as u8) } else { Err((self.0 - OCTANTS) as u8) }
    }

    /// The character.
    pub const fn character(self) -> char {
        let code = match self.mask() {
            Ok(mask) => OCTANT_CODES[mask as usize],
            Err(mask) => FIRST_SEXTANT + sextants_before(mask),
        };
        match char::from_u32(code) {
            Some(character) => character,
            None => unreachable!(),
        }
    }

    /// The mosaic with this character.
    pub fn of_character(character: char) -> Option<Self> {
        let code = u32::from(character);
        match code {
            FIRST_SEXTANT..=LAST_SEXTANT => {
                let place = code - FIRST_SEXTANT + 1;
                let skipped = u32::from(place >= u32::from(LEFT_SEXTANTS))
                    + u32::from(place + 1 >= u32::from(RIGHT_SEXTANTS));
                Some(Self::sextants((place + skipped) as u8))
            }
            FIRST_OCTANT..=LAST_OCTANT => {
                Some(Self::octants(NEW_OCTANTS[(code - FIRST_OCTANT) as usize]))
            }
            _ => {
                let (mask, _) = OLDER.iter().find(|(_, older)| *older == character)?;
                Some(Self::octants(*mask))
            }
        }
    }

    /// Returns true if the dot at the column `x` and the row `y` of a cell of 2×12 parts has the text colour. Sextants
    /// and octants are several rows of such parts.
    pub const fn has(self, x: u32, y: u32) -> bool {
        match self.mask() {
            Ok(mask) => mask >> (y / 3 * 2 + x) & 1 == 1,
            Err(mask) => mask >> (y / 4 * 2 + x) & 1 == 1,
        }
    }
}

const FIRST_SEXTANT: u32 = 0x1FB00;
const LAST_SEXTANT: u32 = 0x1FB3B;
const LEFT_SEXTANTS: u8 = 0b01_01_01;
const RIGHT_SEXTANTS: u8 = 0b10_10_10;
const FIRST_OCTANT: u32 = 0x1CD00;
const LAST_OCTANT: u32 = FIRST_OCTANT + NEW_OCTANTS.len() as u32 - 1;

/// The place of a sextant among the 60 sextants that have a character of their own.
const fn sextants_before(mask: u8) -> u32 {
    mask as u32 - 1 - (mask > LEFT_SEXTANTS) as u32 - (mask > RIGHT_SEXTANTS) as u32
}

/// The octant patterns that had a character before Unicode 16, in order.
const OLDER: [(u8, char); 26] = [
    (0x00, ' '),
    (0x01, '\u{1CEA8}'),
    (0x02, '\u{1CEAB}'),
    (0x03, '\u{1FB82}'),
    (0x05, '▘'),
    (0x0A, '▝'),
    (0x0F, '▀'),
    (0x14, '\u{1FBE6}'),
    (0x28, '\u{1FBE7}'),
    (0x3F, '\u{1FB85}'),
    (0x40, '\u{1CEA3}'),
    (0x50, '▖'),
    (0x55, '▌'),
    (0x5A, '▞'),
    (0x5F, '▛'),
    (0x80, '\u{1CEA0}'),
    (0xA0, '▗'),
    (0xA5, '▚'),
    (0xAA, '▐'),
    (0xAF, '▜'),
    (0xC0, '▂'),
    (0xF0, '▄'),
    (0xF5, '▙'),
    (0xFA, '▟'),
    (0xFC, '▆'),
    (0xFF, '█'),
];

/// The character of each octant pattern. The patterns that had none before follow each other in Unicode.
const OCTANT_CODES: [u32; OCTANTS as usize] = {
    let mut codes = [0; OCTANTS as usize];
    let (mut mask, mut older, mut next) = (0, 0, FIRST_OCTANT);
    while mask < codes.len() {
        if older < OLDER.len() && OLDER[older].0 as usize == mask {
            codes[mask] = OLDER[older].1 as u32;
            older += 1;
        } else {
            codes[mask] = next;
            next += 1;
        }
        mask += 1;
    }
    codes
};

/// The patterns of the octants from [`FIRST_OCTANT`] on.
const NEW_OCTANTS: [u8; OCTANTS as usize - OLDER.len()] = {
    let mut masks = [0; OCTANTS as usize - OLDER.len()];
    let mut mask = 0;
    while mask < OCTANT_CODES.len() {
        let place = OCTANT_CODES[mask].wrapping_sub(FIRST_OCTANT) as usize;
        if place < masks.len() {
            masks[place] = mask as u8;
        }
        mask += 1;
    }
    masks
};

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use ratatui::buffer::Cell;

    use super::*;

    #[test]
    fn a_glyph_sharing_its_neighbours_colours_is_chosen() {
        let [a, b, c] = [1, 2, 3].map(|red| Color::Rgb(red, 0, 0));
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 1));
        buffer.draw_halves(0, 0, [[a, b], [b, a], [c, b], [c, c], [a, a]].into_iter());
        let symbols: String = buffer.content().iter().map(Cell::symbol).collect();
        assert_eq!(symbols, "▀▄▀ ");
        let second = &buffer.content()[1];
        assert_eq!((second.fg, second.bg), (a, b));
    }

    fn all() -> impl Iterator<Item = Mosaic> {
        (0..=u8::MAX).map(Mosaic::octants).chain((0..64).map(Mosaic::sextants))
    }

    /// The dots that Unicode counts in the name of a character, such as BLOCK OCTANT-1235.
    fn dots(digits: &str) -> u8 {
        digits.bytes().map(|digit| 1 << (digit - b'1')).sum()
    }

    /// From the names in UnicodeData.txt, version 16.
    #[test]
    fn characters_have_the_dots_in_their_names() {
        for (code, digits) in [
            (0x1CD00, "3"),
            (0x1CD01, "23"),
            (0x1CD02, "123"),
            (0x1CD03, "4"),
            (0x1CD04, "14"),
            (0x1CD09, "5"),
            (0x1CD18, "6"),
            (0x1CD42, "1347"),
            (0x1CD7C, "348"),
            (0x1CDA9, "134568"),
            (0x1CDE5, "2345678"),
        ] {
            let character = char::from_u32(code).unwrap();
            assert_eq!(Mosaic::octants(dots(digits)).character(), character, "{code:x}");
        }
        for (code, digits) in [
            (0x1FB00, "1"),
            (0x1FB13, "35"),
            (0x1FB14, "235"),
            (0x1FB27, "146"),
            (0x1FB28, "1246"),
            (0x1FB3B, "23456"),
        ] {
            let character = char::from_u32(code).unwrap();
            assert_eq!(Mosaic::sextants(dots(digits)).character(), character, "{code:x}");
        }
        let quadrants: String = (0..16).map(|mask| Mosaic::quadrants(mask).character()).collect();
        assert_eq!(quadrants, " ▘▝▀▖▌▞▛▗▚▐▜▄▙▟█");
        assert_eq!(Mosaic::sextants(dots("135")).character(), '▌');
    }

    #[test]
    fn every_mosaic_has_its_own_character() {
        let characters: HashSet<char> = all().map(Mosaic::character).collect();
        assert_eq!(characters.len(), 256 + 60);
        for mosaic in all() {
            assert_eq!(Mosaic::of_character(mosaic.character()), Some(mosaic));
            assert_eq!(mosaic.inverse().inverse(), mosaic);
            #[cfg(feature = "terminal")]
            for (x, y) in (0..24).map(|part| (part % 2, part / 2)) {
                assert_ne!(mosaic.has(x, y), mosaic.inverse().has(x, y));
            }
        }
        for other in ['a', '▁', '░', '\u{1CE90}', '\u{1FB3C}'] {
            assert_eq!(Mosaic::of_character(other), None);
        }
    }
}
