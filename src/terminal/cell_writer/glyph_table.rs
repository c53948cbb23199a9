//! The table of a screen's glyphs. Each has an id of few bits, so that a packed cell fits in one
//! word.
//!
//! A character and its modifiers take 26 bits, and two colours 52. Most screens show some dozens of
//! characters. If the table is full, further characters are still shown, but not compared.

use std::collections::BTreeMap;

use ratatui::style::Modifier;

/// A character one cell wide, and its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Glyph {
    character: char,
    /// The modifiers as bits, which have an order.
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
    /// The glyphs that were looked up last, with their ids, each in its place: nearly all that a frame has.
    recent: [(Glyph, GlyphId); RECENT],
}

/// The number of places for recent glyphs.
const RECENT: usize = 128;

impl Glyph {
    pub(crate) const fn new(character: char, modifier: Modifier) -> Self {
        Self { character, modifiers: modifier.bits() }
    }

    /// Its place among the recent ones. ASCII characters with the same modifiers have different places.
    #[inline]
    fn place(self) -> usize {
        (self.character as usize ^ usize::from(self.modifiers)) % RECENT
    }

    pub(crate) fn character(self) -> char {
        self.character
    }

    pub(crate) fn modifier(self) -> Modifier {
        Modifier::from_bits_truncate(self.modifiers)
    }
}

impl GlyphId {
    /// The id of a space without modifiers, in every table.
    pub(crate) const SPACE: Self = Self(0);
    /// The id of an upper half block without modifiers, in every table.
    pub(crate) const UPPER_HALF: Self = Self(1);
    /// The maximum number of glyphs in a table.
    pub(crate) const COUNT: u16 = 3900;

    /// The id as a number, which is less than [`GlyphId::COUNT`].
    pub(crate) const fn get(self) -> u16 {
        self.0
    }

    /// The id with this number, which must be from [`GlyphId::get`].
    pub(crate) fn new(id: u16) -> Self {
        Self(id)
    }
}

impl GlyphTable {
    /// The id of `glyph`, a new one if necessary; `None` if the table is full.
    #[inline]
    pub(crate) fn id(&mut self, glyph: Glyph) -> Option<GlyphId> {
        self.recent_id(glyph).or_else(|| self.find(glyph))
    }

    /// The id of `glyph` if it was looked up recently.
    #[inline]
    pub(crate) fn recent_id(&self, glyph: Glyph) -> Option<GlyphId> {
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

#[cfg(test)]
mod tests {
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
}
