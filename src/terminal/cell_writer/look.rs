//! What a cell looks like, and the cheapest way to say so.
//!
//! A cell of two pixels can be written as an upper or a lower half block with the colours swapped, and
//! one whose pixels are alike as a space or a full block. All of them look the same; the one is taken
//! that takes the fewest bytes after what the terminal has been told so far. A space is drawn in no
//! foreground at all, so that of the cell before it stays.

use std::fmt;

use ratatui::buffer::{Cell, CellWidth};
use ratatui::style::Color;

use super::alphabet::{Alphabet, Letter, Number};
use super::style::{Shade, Style};
use crate::world::Rgb;

/// A character that shows two colours at most, each in a whole half of its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Glyph {
    /// The upper half in the text's colour, the lower one in the ground's.
    Upper,
    /// The other way about.
    Lower,
    /// Both in the text's.
    Full,
    /// Both in the ground's.
    Space,
}

impl Glyph {
    /// Itself in UTF-8, and how many of the bytes that takes.
    #[inline]
    pub(super) const fn encoded(self) -> ([u8; 4], usize) {
        match self {
            Self::Upper => ([0xE2, 0x96, 0x80, 0], 3),
            Self::Lower => ([0xE2, 0x96, 0x84, 0], 3),
            Self::Full => ([0xE2, 0x96, 0x88, 0], 3),
            Self::Space => ([b' ', 0, 0, 0], 1),
        }
    }

    const fn character(self) -> char {
        match self {
            Self::Upper => '▀',
            Self::Lower => '▄',
            Self::Full => '█',
            Self::Space => ' ',
        }
    }

    /// By its bytes in UTF-8, as every changed cell is asked.
    #[inline]
    fn of(symbol: &str) -> Option<Self> {
        match *symbol.as_bytes() {
            [b' '] => Some(Self::Space),
            [0xE2, 0x96, 0x80] => Some(Self::Upper),
            [0xE2, 0x96, 0x84] => Some(Self::Lower),
            [0xE2, 0x96, 0x88] => Some(Self::Full),
            _ => None,
        }
    }

    /// The colours of the upper and the lower half.
    #[inline]
    pub(super) fn halves<T: Copy>(self, text: T, ground: T) -> [T; 2] {
        match self {
            Self::Upper => [text, ground],
            Self::Lower => [ground, text],
            Self::Full => [text; 2],
            Self::Space => [ground; 2],
        }
    }
}

/// What a cell is beside its two colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Two halves, of one colour each, by any of the glyphs.
    Block,
    /// A letter without modifiers, in one colour on another.
    Letter(Number),
}

/// What a cell looks like, in one word: equal ones look the same.
///
/// The uppermost twelve bits say what it is, and the rest are two colours: of the upper and the lower half,
/// or of the text and its ground.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Look(u64);

impl Look {
    /// Nobody knows; no cell that is to be shown looks like this.
    pub(super) const UNKNOWN: Self = Self(1 << Self::KIND);
    /// Of several characters, or wider than a cell, or of a character that has no number: sent whenever
    /// its row changes.
    const INTRICATE: Self = Self(2 << Self::KIND);
    /// A space in the terminal's own colours.
    pub(super) const BLANK: Self = Self::of_text(Number::SPACE, [Shade::DEFAULT; 2]);

    /// Where the kind is: none for blocks, and from here on letters by their numbers.
    const KIND: u32 = 2 * Shade::BITS;
    const FIRST_LETTER: u64 = 3;
    const _KINDS_FIT: () =
        assert!(Self::FIRST_LETTER + (Number::COUNT as u64) < 1 << (u64::BITS - Self::KIND));

    const LAST_LETTER: u64 = Self::FIRST_LETTER + Number::COUNT as u64 - 1;

    /// What `cell` looks like.
    #[inline]
    pub(super) fn of(cell: &Cell, alphabet: &mut Alphabet) -> Self {
        let (symbol, style) = (cell.symbol(), Style::of(cell));
        match Glyph::of(symbol) {
            Some(glyph) => Self::of_glyph(glyph, style, alphabet),
            None => Self::of_symbol(cell, style, alphabet),
        }
    }

    /// What two colours look like, the first above the second.
    #[inline]
    pub(super) fn of_colors(colors: [Color; 2]) -> Self {
        let shades = colors.map(Shade::of);
        match halves(Glyph::Upper, Style::plain(shades[0], shades[1])) {
            Some(halves) => Self::of_halves(halves),
            None => Self::of_text(Number::UPPER_HALF, shades),
        }
    }

    /// What two pixels look like, the first above the second.
    #[inline]
    pub(super) fn of_pixels(pixels: [Rgb; 2]) -> Self {
        Self::of_halves(pixels.map(Shade::of_pixel))
    }

    /// What a character that is one cell wide looks like, in the colours of its text and of its ground.
    pub(super) fn of_character(
        character: char,
        colors: [Color; 2],
        alphabet: &mut Alphabet,
    ) -> Self {
        let style = Style::in_colors(colors);
        match Glyph::of(character.encode_utf8(&mut [0; 4])) {
            Some(glyph) => Self::of_glyph(glyph, style, alphabet),
            None => Self::of_letter(character, style, alphabet),
        }
    }

    #[inline]
    fn of_glyph(glyph: Glyph, style: Style, alphabet: &mut Alphabet) -> Self {
        match halves(glyph, style) {
            Some(halves) => Self::of_halves(halves),
            None => Self::of_letter(glyph.character(), style, alphabet),
        }
    }

    fn of_symbol(cell: &Cell, style: Style, alphabet: &mut Alphabet) -> Self {
        let mut characters = cell.symbol().chars();
        match (characters.next(), characters.next()) {
            (Some(character), None) if character.is_ascii_graphic() || cell.cell_width() == 1 => {
                Self::of_letter(character, style, alphabet)
            }
            _ => Self::INTRICATE,
        }
    }

    /// What a character looks like that may be the letter of a number, and is never drawn as a block.
    #[inline(never)]
    pub(super) fn of_letter(character: char, style: Style, alphabet: &mut Alphabet) -> Self {
        let number = alphabet.number(Letter::new(character, style.modifier));
        let colors = [style.foreground, style.background];
        number.map_or(Self::INTRICATE, |number| Self::of_text(number, colors))
    }

    /// What a block looks like that is drawn so.
    pub(super) fn of_block(glyph: Glyph, style: Style) -> Self {
        Self::of_halves(glyph.halves(style.foreground, style.background))
    }

    #[inline]
    const fn of_halves([top, bottom]: [Shade; 2]) -> Self {
        Self((top.in_bits() as u64) << Shade::BITS | bottom.in_bits() as u64)
    }

    const fn of_text(number: Number, colors: [Shade; 2]) -> Self {
        let kind = Self::FIRST_LETTER + number.get() as u64;
        Self(kind << Self::KIND | Self::of_halves(colors).0)
    }

    /// The letter that it is, and how it is drawn; `None` for blocks and what is intricate.
    pub(super) fn text(self, alphabet: &Alphabet) -> Option<(char, Style)> {
        let number = (self.0 >> Self::KIND).checked_sub(Self::FIRST_LETTER)?;
        let letter = alphabet.letter(Number::new(number as u16));
        let [foreground, background] = self.colors();
        let style = Style { foreground, background, modifier: letter.modifier() };
        Some((letter.character(), style))
    }

    /// Whether it may be wider than a cell.
    pub(super) fn is_intricate(self) -> bool {
        self == Self::INTRICATE
    }

    /// Whether a cell that looks like `wanted` need not be sent.
    pub(super) fn is(self, wanted: Self) -> bool {
        self == wanted && self != Self::INTRICATE
    }

    /// A hash; its upper bits are the best. Of few bits, so that a compiler has several computed at once.
    #[inline]
    pub(super) fn hash(self) -> u32 {
        ((self.0 ^ self.0 >> 29) as u32).wrapping_mul(0x9E37_79B1)
    }

    /// Three numbers of sixteen bits that all looks alike have in common.
    pub(super) fn hashes(self) -> [u16; 3] {
        let hash = self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        [48, 32, 16].map(|from| (hash >> from) as u16)
    }

    /// What it is beside its colours, and these; `None` where it may only be shown as it is.
    #[inline]
    pub(super) fn recolorable(self, alphabet: &Alphabet) -> Option<(Form, [Shade; 2])> {
        let form = match self.0 >> Self::KIND {
            0 => Form::Block,
            number => {
                let number = Number::new(number.checked_sub(Self::FIRST_LETTER)? as u16);
                let letter = alphabet.letter(number);
                letter.modifier().is_empty().then_some(Form::Letter(number))?
            }
        };
        Some((form, self.colors()))
    }

    /// The same letter in other colours.
    pub(super) fn recolored(self, colors: [Shade; 2]) -> Self {
        Self(self.0 >> Self::KIND << Self::KIND | Self::of_halves(colors).0)
    }

    /// The colours of the upper and the lower half of a block.
    #[inline]
    pub(super) fn halves(self) -> Option<[Shade; 2]> {
        (self.0 >> Self::KIND == 0).then(|| self.colors())
    }

    /// Its two colours, whatever it is.
    #[inline]
    pub(super) fn colors(self) -> [Shade; 2] {
        [self.0 >> Shade::BITS, self.0].map(|bits| Shade::from_bits(bits as u32))
    }
}

const _: () = assert!(Look::LAST_LETTER <= u64::MAX >> Look::KIND);

impl fmt::Debug for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:x}", self.0)
    }
}

/// The cheapest block that looks like these two halves, and how it is drawn, after `current`.
pub(super) fn cheapest([top, bottom]: [Shade; 2], current: Option<Style>) -> (Glyph, Style) {
    let block = |glyph, text, ground| (glyph, Style::plain(text, ground));
    let Some(current) = current else { return block(Glyph::Upper, top, bottom) };
    let (text, ground) = (current.foreground, current.background);
    let is_told = current.has_no_modifiers();
    if top == bottom {
        return if is_told && text == top && ground != top {
            block(Glyph::Full, text, ground)
        } else if !is_told && top.bytes() < text.bytes() {
            block(Glyph::Space, top, top)
        } else {
            block(Glyph::Space, text, top)
        };
    }
    let told = |new_text, new_ground| u8::from(new_text == text) + u8::from(new_ground == ground);
    if told(bottom, top) > told(top, bottom) {
        block(Glyph::Lower, bottom, top)
    } else {
        block(Glyph::Upper, top, bottom)
    }
}

/// The colours of the upper and the lower half of a cell; `None` where another block would not look the
/// same: in the terminal's own colours, which are not the same two as text and as ground, and with
/// modifiers.
#[inline]
fn halves(glyph: Glyph, style: Style) -> Option<[Shade; 2]> {
    let halves = glyph.halves(style.foreground, style.background);
    let has_own = halves.contains(&Shade::DEFAULT);
    (style.has_no_modifiers() && !has_own).then_some(halves)
}
