//! Cells in one word, and the table of a screen's glyphs.
//!
//! A character and its modifiers take 26 bits, and two colours take 52. Therefore each glyph has an id of few bits, so
//! that a packed cell fits in one word. Most screens show some dozens of characters. If the table is full, further
//! characters are still shown, but not compared.

use std::collections::BTreeMap;
use std::fmt;

use ratatui::buffer::{Cell, CellWidth};
use ratatui::style::{Color, Modifier};

use super::block::{BlockElement, MosaicShape};
use super::style::{PackedColor, Style};
use crate::color::Rgb;
use crate::tui::canvas::Mosaic;

/// The form of a cell, without its two colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// Two colours with any block element, or with a mosaic or its inverse.
    Block(MosaicShape),
    /// A glyph without modifiers, in a text and a background colour.
    Glyph(GlyphId),
}

/// A cell in one word. Cells with equal words look the same.
///
/// The upper twelve bits are the form. The other bits are two colours: of the upper and the lower half, of a shape's
/// dots and the rest, or of the text and the background. A block of one colour has the shape of halves.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct PackedCell(u64);

impl PackedCell {
    /// An unknown cell. No target is equal to it.
    pub(crate) const UNKNOWN: Self = Self(Self::SHAPES << Self::KIND);
    /// A cell with several characters, with a character wider than a cell, or with a glyph without an id. It is sent
    /// whenever its row changes.
    const INTRICATE: Self = Self((Self::SHAPES + 1) << Self::KIND);
    /// A space in the terminal's default colours.
    pub(crate) const BLANK: Self = Self::of_text(GlyphId::SPACE, [PackedColor::DEFAULT; 2]);

    /// The position of the form. Its values are the shapes of blocks (zero for halves), two special values, and then
    /// the ids of glyphs.
    const KIND: u32 = 2 * PackedColor::BITS;
    const SHAPES: u64 = MosaicShape::COUNT as u64;
    const FIRST_GLYPH: u64 = Self::SHAPES + 2;

    /// Packs `cell`.
    #[inline]
    pub(crate) fn of(cell: &Cell, glyph_table: &mut GlyphTable) -> Self {
        let (symbol, style) = (cell.symbol(), Style::of(cell));
        match BlockElement::of(symbol) {
            Some(element) => Self::of_element(element, style, glyph_table),
            None => {
                Self::of_symbol(CellText::of(symbol, |_| cell.cell_width()), style, glyph_table)
            }
        }
    }

    /// A space in the style of `cell`.
    pub(crate) fn blank(cell: &Cell, glyph_table: &mut GlyphTable) -> Self {
        Self::of_element(BlockElement::Space, Style::of(cell), glyph_table)
    }

    /// A cell of two colours, the first above the second.
    #[inline]
    pub(crate) fn of_colors(colors: [Color; 2]) -> Self {
        let shades = colors.map(PackedColor::of);
        match halves(BlockElement::Upper, Style::plain(shades[0], shades[1])) {
            Some(halves) => Self::of_halves(halves),
            None => Self::of_text(GlyphId::UPPER_HALF, shades),
        }
    }

    /// A cell of two pixels, the first above the second.
    #[inline]
    pub(crate) fn of_pixels(pixels: [Rgb; 2]) -> Self {
        Self::of_halves(pixels.map(PackedColor::of_pixel))
    }

    /// A mosaic in the colours of its dots and of the rest.
    #[inline]
    pub(crate) fn of_mosaic(
        mosaic: Mosaic,
        colors: [Color; 2],
        glyph_table: &mut GlyphTable,
    ) -> Self {
        let shades = colors.map(PackedColor::of);
        if shades.contains(&PackedColor::DEFAULT) {
            let [foreground, background] = shades;
            let style = Style::plain(foreground, background);
            return Self::of_glyph(mosaic.character(), style, glyph_table);
        }
        let (shape, is_inverse) = MosaicShape::of(mosaic);
        let [dots, rest] = shades;
        Self::of_shape(shape, if is_inverse { [rest, dots] } else { [dots, rest] })
    }

    /// A cell of this shape, in the colours of its dots and of the rest.
    #[inline]
    fn of_shape(shape: MosaicShape, colors: [PackedColor; 2]) -> Self {
        let [dots, rest] = colors;
        if dots == rest || shape == MosaicShape::NONE {
            return Self::of_halves([rest; 2]);
        }
        Self(u64::from(shape.get()) << Self::KIND | Self::of_halves(colors).0)
    }

    /// The mosaic with this character. `None` if another character for it would look different in this style.
    fn mosaic(character: char, style: Style) -> Option<Mosaic> {
        let has_own = style.colors().contains(&PackedColor::DEFAULT);
        let is_plain = character >= FIRST_MOSAIC && style.has_no_modifiers() && !has_own;
        Mosaic::of_character(character).filter(|_| is_plain)
    }

    /// A character in a text and a background colour.
    pub(crate) fn of_character(
        character: char,
        colors: [Color; 2],
        glyph_table: &mut GlyphTable,
    ) -> Self {
        let style = Style::in_colors(colors);
        let mut encoded = [0; 4];
        let symbol = &*character.encode_utf8(&mut encoded);
        if let Some(element) = BlockElement::of(symbol) {
            return Self::of_element(element, style, glyph_table);
        }
        if character >= FIRST_MOSAIC
            && let Some(mosaic) = Self::mosaic(character, style)
        {
            return Self::of_mosaic(mosaic, colors, glyph_table);
        }
        // This check is first, because finding the width of a character takes ten times as long.
        if let Some(id) = glyph_table.recent_id(Glyph::new(character, style.modifier)) {
            return Self::of_text(id, colors.map(PackedColor::of));
        }
        Self::of_symbol(CellText::of(symbol, CellWidth::cell_width), style, glyph_table)
    }

    #[inline]
    fn of_element(element: BlockElement, style: Style, glyph_table: &mut GlyphTable) -> Self {
        match halves(element, style) {
            Some(halves) => Self::of_halves(halves),
            None => Self::of_glyph(element.character(), style, glyph_table),
        }
    }

    fn of_symbol(symbol: CellText, style: Style, glyph_table: &mut GlyphTable) -> Self {
        match symbol {
            CellText::Blank => Self::of_element(BlockElement::Space, style, glyph_table),
            CellText::Character(character @ FIRST_MOSAIC..) => match Self::mosaic(character, style)
            {
                Some(mosaic) => {
                    let colors = style.colors().map(PackedColor::color);
                    Self::of_mosaic(mosaic, colors, glyph_table)
                }
                None => Self::of_glyph(character, style, glyph_table),
            },
            CellText::Character(character) => Self::of_glyph(character, style, glyph_table),
            CellText::Intricate => Self::INTRICATE,
        }
    }

    /// A cell with a character that cannot be drawn as a block.
    #[inline(never)]
    pub(crate) fn of_glyph(character: char, style: Style, glyph_table: &mut GlyphTable) -> Self {
        let id = glyph_table.id(Glyph::new(character, style.modifier));
        let colors = [style.foreground, style.background];
        id.map_or(Self::INTRICATE, |id| Self::of_text(id, colors))
    }

    /// A cell of this shape as `element` draws it in this style.
    #[inline]
    pub(crate) fn of_block(shape: MosaicShape, element: BlockElement, style: Style) -> Self {
        Self::of_shape(shape, element.halves(style.foreground, style.background))
    }

    #[inline]
    const fn of_halves([top, bottom]: [PackedColor; 2]) -> Self {
        Self((top.in_bits() as u64) << PackedColor::BITS | bottom.in_bits() as u64)
    }

    const fn of_text(id: GlyphId, colors: [PackedColor; 2]) -> Self {
        let kind = Self::FIRST_GLYPH + id.get() as u64;
        Self(kind << Self::KIND | Self::of_halves(colors).0)
    }

    /// The character and its style. `None` for blocks and intricate cells.
    pub(crate) fn text(self, glyph_table: &GlyphTable) -> Option<(char, Style)> {
        let id = (self.0 >> Self::KIND).checked_sub(Self::FIRST_GLYPH)?;
        let glyph = glyph_table.glyph(GlyphId::new(id as u16));
        let [foreground, background] = self.colors();
        let style = Style { foreground, background, modifier: glyph.modifier() };
        Some((glyph.character, style))
    }

    /// Returns true if the cell may be wider than one column.
    pub(crate) fn is_intricate(self) -> bool {
        self == Self::INTRICATE
    }

    /// Returns true if this shown cell need not be sent for the target `wanted`.
    pub(crate) fn is(self, wanted: Self) -> bool {
        self == wanted && self != Self::INTRICATE
    }

    /// A hash whose upper bits are the best. It is short, so that the compiler computes several at once.
    #[inline]
    pub(crate) fn hash(self) -> u32 {
        ((self.0 ^ self.0 >> 29) as u32).wrapping_mul(0x9E37_79B1)
    }

    /// Three hashes of sixteen bits.
    pub(crate) fn hashes(self) -> [u16; 3] {
        let hash = self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        [48, 32, 16].map(|from| (hash >> from) as u16)
    }

    /// The form and the colours. `None` if the cell may only be shown exactly.
    #[inline]
    pub(crate) fn recolorable(self, glyph_table: &GlyphTable) -> Option<(Form, [PackedColor; 2])> {
        let form = match self.0 >> Self::KIND {
            shape @ ..Self::SHAPES => Form::Block(MosaicShape::new(shape as u8)),
            id => {
                let id = GlyphId::new(id.checked_sub(Self::FIRST_GLYPH)? as u16);
                let glyph = glyph_table.glyph(id);
                glyph.modifier().is_empty().then_some(Form::Glyph(id))?
            }
        };
        Some((form, self.colors()))
    }

    /// The same form in other colours.
    pub(crate) fn recolored(self, colors: [PackedColor; 2]) -> Self {
        Self(self.0 >> Self::KIND << Self::KIND | Self::of_halves(colors).0)
    }

    /// The colours of the upper and the lower half of a block.
    #[inline]
    pub(crate) fn halves(self) -> Option<[PackedColor; 2]> {
        (self.0 >> Self::KIND == 0).then(|| self.colors())
    }

    /// The shape of a block, and the colours of its dots and of the rest.
    #[inline]
    pub(crate) fn block(self) -> Option<(MosaicShape, [PackedColor; 2])> {
        let kind = self.0 >> Self::KIND;
        (kind < Self::SHAPES).then(|| (MosaicShape::new(kind as u8), self.colors()))
    }

    /// The same as [`PackedCell::block`], but only if both colours are pixels.
    #[inline]
    pub(crate) fn pixels(self) -> Option<(MosaicShape, [PackedColor; 2])> {
        const PIXEL: u64 = PackedColor::rgb([0; 3]).in_bits() as u64;
        const PIXELS: u64 = PIXEL << PackedColor::BITS | PIXEL;
        const BOTH_KINDS: u64 = 3 * (PIXELS / 2);
        const BLOCKS: u64 = PackedCell::SHAPES << PackedCell::KIND;
        let is_of_pixels = self.0 & BOTH_KINDS == PIXELS && self.0 < BLOCKS;
        is_of_pixels.then(|| (MosaicShape::new((self.0 >> Self::KIND) as u8), self.colors()))
    }

    /// The two colours of any cell.
    #[inline]
    pub(crate) fn colors(self) -> [PackedColor; 2] {
        [self.0 >> PackedColor::BITS, self.0].map(|bits| PackedColor::from_bits(bits as u32))
    }
}

/// All forms fit in the upper bits.
const _: () =
    assert!(PackedCell::FIRST_GLYPH + GlyphId::COUNT as u64 <= 1 << (u64::BITS - PackedCell::KIND));

impl fmt::Debug for PackedCell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:x}", self.0)
    }
}

/// The first character other than a space that may be a mosaic.
const FIRST_MOSAIC: char = '\u{2580}';

/// The colours of the upper and the lower half. `None` if another block element would look different. This is so with
/// modifiers, and with the terminal's default colours, which differ as text and as background.
#[inline]
fn halves(element: BlockElement, style: Style) -> Option<[PackedColor; 2]> {
    let halves = element.halves(style.foreground, style.background);
    let has_own = halves.contains(&PackedColor::DEFAULT);
    (style.has_no_modifiers() && !has_own).then_some(halves)
}

/// A character that is one cell wide, and its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Glyph {
    pub(crate) character: char,
    /// The modifiers as bits, because bits have an order.
    modifiers: u16,
}

/// The id of a glyph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GlyphId(u16);

/// The glyphs that have an id.
#[derive(Debug)]
pub(crate) struct GlyphTable {
    glyphs: Vec<Glyph>,
    ids: BTreeMap<Glyph, GlyphId>,
    /// The glyphs that were looked up last, with their ids, each in its place. They are nearly all glyphs of a frame.
    recent: [(Glyph, GlyphId); RECENT],
}

/// The number of places for recent glyphs.
const RECENT: usize = 128;

impl Glyph {
    pub(crate) const fn new(character: char, modifier: Modifier) -> Self {
        Self { character, modifiers: modifier.bits() }
    }

    /// The glyph's place among the recent glyphs. ASCII characters with the same modifiers have different places.
    #[inline]
    fn place(self) -> usize {
        (self.character as usize ^ usize::from(self.modifiers)) % RECENT
    }

    pub(crate) fn modifier(self) -> Modifier {
        Modifier::from_bits_truncate(self.modifiers)
    }
}

impl GlyphId {
    /// The id of a space without modifiers, in every table.
    const SPACE: Self = Self(0);
    /// The id of an upper half block without modifiers, in every table.
    pub(crate) const UPPER_HALF: Self = Self(1);
    /// The maximum number of glyphs in a table.
    pub(crate) const COUNT: u16 = 3900;

    /// The id as a number, which is less than [`GlyphId::COUNT`].
    pub(crate) const fn get(self) -> u16 {
        self.0
    }

    /// The id with this number, which must come from [`GlyphId::get`].
    pub(crate) fn new(id: u16) -> Self {
        Self(id)
    }
}

impl GlyphTable {
    /// The id of `glyph`, which is a new id if necessary. `None` if the table is full.
    #[inline]
    pub(crate) fn id(&mut self, glyph: Glyph) -> Option<GlyphId> {
        self.recent_id(glyph).or_else(|| self.find(glyph))
    }

    /// The id of `glyph` if it was looked up recently.
    #[inline]
    fn recent_id(&self, glyph: Glyph) -> Option<GlyphId> {
        let (recent, id) = self.recent[glyph.place()];
        (recent == glyph).then_some(id)
    }

    fn find(&mut self, glyph: Glyph) -> Option<GlyphId> {
        let id = self.ids.get(&glyph).copied().or_else(|| self.add(glyph))?;
        self.recent[glyph.place()] = (glyph, id);
        Some(id)
    }

    fn add(&mut self, glyph: Glyph) -> Option<GlyphId> {
        let next = u16::try_from(self.glyphs.len()).ok()?;
        let id = (next < GlyphId::COUNT).then_some(GlyphId(next))?;
        self.glyphs.push(glyph);
        self.ids.insert(glyph, id);
        Some(id)
    }

    /// The glyph with this id.
    pub(crate) fn glyph(&self, id: GlyphId) -> Glyph {
        self.glyphs[usize::from(id.0)]
    }
}

impl Default for GlyphTable {
    fn default() -> Self {
        let [space, half] = [' ', '▀'].map(|glyph| Glyph::new(glyph, Modifier::empty()));
        let recent = [(space, GlyphId::SPACE); RECENT];
        let mut glyph_table = Self { glyphs: Vec::new(), ids: BTreeMap::new(), recent };
        let ids = [space, half].map(|glyph| glyph_table.find(glyph));
        debug_assert_eq!(ids, [Some(GlyphId::SPACE), Some(GlyphId::UPPER_HALF)]);
        glyph_table
    }
}

/// The text of a cell, as far as a terminal may receive it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellText {
    /// Nothing to show: the text is empty, has no width, or contains a control character. A terminal
    /// would obey a control character, and would add a character without a width to the cell before.
    Blank,
    /// A character one cell wide.
    Character(char),
    /// Several characters, or a character that is wider than a cell. None of them is a control character.
    Intricate,
}

impl CellText {
    /// Classifies `text`. Measures its `width` only if it contains no control character, because ratatui cannot
    /// measure these.
    #[inline]
    fn of(text: &str, width: impl FnOnce(&str) -> u16) -> Self {
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

/// The ASCII substitute for `symbol`, the text of a cell. It is the symbol if that is a single ASCII character,
/// otherwise a similar character or a question mark. The empty second cell of a wide character becomes a space.
pub(crate) fn ascii_substitute(symbol: &str) -> char {
    let Some(character) = symbol.chars().next() else { return ' ' };
    match character {
        ' '..='~' => character,
        '─' | '━' | '═' | '╌' | '┄' | '–' | '—' | '−' => '-',
        '│' | '┃' | '║' | '╎' | '┆' => '|',
        '\u{2500}'..='\u{257f}' => '+',
        '←' | '◀' | '◂' | '‹' => '<',
        '→' | '▶' | '▸' | '›' => '>',
        '↑' | '▲' | '▴' => '^',
        '↓' | '▼' | '▾' => 'v',
        '↗' | '↙' => '/',
        '↖' | '↘' => '\\',
        '░' | '·' | '…' => '.',
        '▒' => ':',
        '\u{2580}'..='\u{259f}' => '#',
        '×' => 'x',
        '•' | '●' | '◆' | '■' => '*',
        '‘' | '’' | '′' => '\'',
        '“' | '”' | '„' | '«' | '»' | '″' => '"',
        '\u{a0}' => ' ',
        _ => '?',
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn glyphs_have_ids_until_the_table_is_full() {
        let mut glyph_table = GlyphTable::default();
        // A half block has an id from the start.
        let glyphs =
            || std::iter::once('▀').chain(' '..).map(|glyph| Glyph::new(glyph, Modifier::empty()));
        let ids: Vec<_> =
            glyphs().take(GlyphId::COUNT.into()).map(|glyph| glyph_table.id(glyph)).collect();
        for (glyph, id) in glyphs().zip(&ids) {
            assert_eq!(glyph_table.glyph(id.unwrap()), glyph);
            assert_eq!(glyph_table.id(glyph), *id);
        }
        assert_eq!(glyph_table.id(Glyph::new('a', Modifier::BOLD)), None);
    }

    proptest! {
        #[test]
        fn any_cell_becomes_one_ascii_character(symbol in ".{0,3}") {
            let substitute = ascii_substitute(&symbol);
            prop_assert!(matches!(substitute, ' '..='~'));
            if let &[byte @ b' '..=b'~'] = symbol.as_bytes() {
                prop_assert_eq!(substitute, char::from(byte));
            }
        }
    }

    #[test]
    fn a_panel_stays_recognizable_in_ascii() {
        let panel = ["┌──┐", "│→↗│", "└──┘"];
        let shown = panel.map(|row| {
            row.chars()
                .map(|symbol| ascii_substitute(symbol.encode_utf8(&mut [0; 4])))
                .collect::<String>()
        });
        assert_eq!(shown, ["+--+", "|>/|", "+--+"]);
    }
}
