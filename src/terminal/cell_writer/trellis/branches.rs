//! Branches: the glyphs and colours in which a cell may be drawn after each path.

use super::super::block_element::BlockElement;
use super::super::ink::Price;
use super::super::palette::{Palette, Telling};
use super::super::shape::Shape;
use super::lanes::{
    Blocks, Errors, HALF_BLOCK, Lanes, SPACE, add_motions, choose, least, measure, min, plus, sum,
};
use super::survivors::{Survivors, Told, Turn};
use super::{KEPT, Paths, StepKind, Store, Terms, Wanted};

/// A cell to draw.
pub(crate) struct Branches<'a> {
    wanted: &'a Wanted,
    price: Price,
    /// The prices of errors in the upper half and in the lower, or in the dots and the rest.
    prices: [Price; 2],
    /// The bytes of the glyph that shows both colours.
    bytes: f32,
    paths: &'a Paths,
    x: u16,
    repeats: bool,
    /// The cost of each path to this cell, and the least of these.
    start: Lanes,
    least: f32,
}

/// The indices of the fresh colours.
const UPPER: u8 = 0;
const LOWER: u8 = 1;
const BOTH: u8 = 2;

/// The bytes of a sequence that sets one colour, without the parameters, and of one that sets both.
const ONE_COLOR: f32 = 3.0;
const TWO_COLORS: f32 = 4.0;
/// The fewest bytes of a colour's parameters.
const SHORTEST_COLOR: f32 = 2.0;
/// The fewest bytes of a palette entry's parameters.
const SHORTEST_ENTRY: f32 = 7.0;
/// The approximate bytes of one repetition of the last block.
const REPETITION: f32 = 0.5;

impl<'a> Branches<'a> {
    #[inline]
    pub(crate) fn new(wanted: &'a Wanted, terms: Terms, paths: &'a Paths, x: u16) -> Self {
        let Terms { price, repeats, .. } = terms;
        let mut start = [0.0; KEPT];
        add_motions(paths, x, &mut start);
        let least = least(&start);
        let (prices, bytes) = match wanted.character {
            Some(bytes) => ([price; 2], f32::from(bytes)),
            None if wanted.shape == Shape::HALF => ([price; 2], HALF_BLOCK),
            None => (wanted.shape.parts().map(|parts| price.of_parts(parts)), wanted.shape.bytes()),
        };
        Self { wanted, price, prices, bytes, paths, x, repeats, start, least }
    }

    /// Draws in the terminal's present colours, in one new colour and in two. A cell that is
    /// already right is drawn again only if that is a shorter way to the next cell.
    #[inline]
    pub(crate) fn draw(&mut self, survivors: &mut Survivors, store: &mut Store) {
        let is_right = survivors.is_right();
        if is_right {
            for (start, &cursor) in self.start.iter_mut().zip(&self.paths.cursor) {
                *start = if cursor == f32::from(self.x) { *start } else { f32::INFINITY };
            }
            self.least = least(&self.start);
        }
        let shortest = if self.repeats { REPETITION } else { SPACE };
        if !survivors.would_keep(self.least + shortest) {
            return;
        }
        let (mut errors, mut blocks) = (Errors::default(), Blocks::default());
        let Self { wanted, prices, bytes, .. } = self;
        measure(&self.paths.labs, &wanted.inks, prices, *bytes, &mut errors, &mut blocks);
        match self.wanted.character {
            Some(_) => self.draw_character(&errors, survivors),
            None => self.draw_in_old_colors(&mut blocks, survivors),
        }
        if !is_right && survivors.would_keep(self.least + ONE_COLOR + SPACE + SHORTEST_COLOR) {
            self.draw_in_new_colors(&errors, survivors, store);
        }
    }

    /// Draws the character in the old colours.
    #[inline]
    fn draw_character(&self, errors: &Errors, survivors: &mut Survivors) {
        let costs = sum(&sum(&self.start, &errors.text_above), &errors.ground_below);
        self.offer(survivors, &plus(&costs, self.bytes), BlockElement::Upper, Told::NOTHING);
    }

    #[inline]
    fn draw_in_old_colors(&self, blocks: &mut Blocks, survivors: &mut Survivors) {
        if self.repeats {
            self.repeat(blocks);
        }
        let mut costs = [0.0; KEPT];
        choose(blocks, &self.start, &mut costs);
        if !survivors.would_keep(least(&costs)) {
            return;
        }
        for path in 0..KEPT {
            if survivors.would_keep(costs[path]) {
                let Blocks { space, full, upper, lower } = &*blocks;
                let (flat, flat_glyph) = if full[path] < space[path] {
                    (full[path], BlockElement::Full)
                } else {
                    (space[path], BlockElement::Space)
                };
                let (split, split_glyph) = if lower[path] < upper[path] {
                    (lower[path], BlockElement::Lower)
                } else {
                    (upper[path], BlockElement::Upper)
                };
                let element = if split < flat { split_glyph } else { flat_glyph };
                self.add(survivors, costs[path], path, element, Told::NOTHING);
            }
        }
    }

    /// Reduces the cost of repeating the last block.
    #[inline]
    fn repeat(&self, Blocks { space, full, upper, lower }: &mut Blocks) {
        let is_same = self.paths.last_shape == self.wanted.shape;
        for path in 0..KEPT {
            if self.paths.cursor[path] != f32::from(self.x) {
                continue;
            }
            match self.paths.last[path] {
                Some(BlockElement::Space) => space[path] += REPETITION - SPACE,
                Some(BlockElement::Full) => full[path] += REPETITION - HALF_BLOCK,
                Some(BlockElement::Upper) if is_same => upper[path] += REPETITION - self.bytes,
                Some(BlockElement::Lower) if is_same => lower[path] += REPETITION - self.bytes,
                _ => {}
            }
        }
    }

    fn draw_in_new_colors(&self, errors: &Errors, survivors: &mut Survivors, store: &mut Store) {
        let [upper, lower] = self.wanted.inks;
        let (bytes_above, bytes_below) = (upper.bytes(), lower.bytes());
        let shortest = shortest(min(bytes_above, bytes_below), store.palette);
        if !survivors.would_keep(self.least + ONE_COLOR + SPACE + shortest) {
            return;
        }
        let tellings = [
            store.palette.telling(upper, bytes_above, self.prices[0]),
            store.palette.telling(lower, bytes_below, self.prices[1]),
        ];
        survivors.fresh[usize::from(UPPER)] = tellings[0].ink.lab;
        survivors.fresh[usize::from(LOWER)] = tellings[1].ink.lab;
        if self.wanted.character.is_none() {
            self.draw_in_one_for_both(survivors, &tellings, store);
        }
        self.draw_in_one_color(errors, survivors, &tellings);
        self.draw_in_two_colors(survivors, &tellings);
    }

    #[inline]
    fn draw_in_one_color(
        &self,
        errors: &Errors,
        survivors: &mut Survivors,
        [upper, lower]: &[Telling; 2],
    ) {
        let half = ONE_COLOR + self.bytes;
        let (above, below) = (half + upper.cost(), half + lower.cost());
        let (upper, lower) = (upper.ink.shade, lower.ink.shade);
        let Errors { text_above, text_below, ground_above, ground_below } = errors;
        let mut offer = |element, cost: f32, errors: &Lanes, told| {
            if survivors.would_keep(self.least + cost) {
                self.offer(survivors, &plus(&sum(&self.start, errors), cost), element, told);
            }
        };
        offer(BlockElement::Upper, above, ground_below, Told::NOTHING.text(upper, UPPER));
        offer(BlockElement::Upper, below, text_above, Told::NOTHING.ground(lower, LOWER));
        if self.wanted.character.is_none() {
            offer(BlockElement::Lower, above, text_below, Told::NOTHING.ground(upper, UPPER));
            offer(BlockElement::Lower, below, ground_above, Told::NOTHING.text(lower, LOWER));
        }
    }

    /// Draws both halves in one new colour.
    #[inline]
    fn draw_in_one_for_both(
        &self,
        survivors: &mut Survivors,
        [above, below]: &[Telling; 2],
        store: &mut Store,
    ) {
        let [upper, lower] = self.wanted.inks;
        self.offer_for_both(survivors, above, UPPER);
        if upper.shade == lower.shade {
            return;
        }
        self.offer_for_both(survivors, below, LOWER);
        // Halfway between two colours, the errors add up to at least their distance.
        let apart = upper.distance(lower);
        let least = ONE_COLOR
            + SPACE
            + SHORTEST_COLOR
            + apart * min(self.prices[0].bytes, self.prices[1].bytes);
        let is_needed = apart > self.price.farthest && apart <= 2.0 * self.price.farthest;
        if is_needed && survivors.would_keep(self.least + least) {
            let both = store.inks.between(upper, lower);
            let both = store.palette.telling(both, both.bytes(), self.price);
            survivors.fresh[usize::from(BOTH)] = both.ink.lab;
            self.offer_for_both(survivors, &both, BOTH);
        }
    }

    #[inline]
    fn offer_for_both(&self, survivors: &mut Survivors, telling: &Telling, source: u8) {
        let Telling { ink, bytes, .. } = *telling;
        let [upper, lower] = self.wanted.inks;
        let error = self.prices[0].of(ink, upper) + self.prices[1].of(ink, lower);
        let cost = ONE_COLOR + SPACE + bytes + error;
        if survivors.would_keep(self.least + cost) {
            let told = Told::NOTHING.ground(ink.shade, source);
            self.offer(survivors, &plus(&self.start, cost), BlockElement::Space, told);
        }
    }

    /// Draws in two new colours. All paths then lead to the same state, so that only the cheapest
    /// is added.
    #[inline]
    fn draw_in_two_colors(&self, survivors: &mut Survivors, [upper, lower]: &[Telling; 2]) {
        let cost = self.least + TWO_COLORS + upper.cost() + lower.cost() + self.bytes;
        if !survivors.would_keep(cost) {
            return;
        }
        let (upper, lower) = (upper.ink.shade, lower.ink.shade);
        let path = (0..KEPT).find(|&path| self.start[path] == self.least).unwrap_or(0);
        let told = Told::NOTHING.text(upper, UPPER).ground(lower, LOWER);
        self.add(survivors, cost, path, BlockElement::Upper, told);
        if self.wanted.character.is_none() && survivors.would_keep(cost) {
            let told = Told::NOTHING.text(lower, LOWER).ground(upper, UPPER);
            self.add(survivors, cost, path, BlockElement::Lower, told);
        }
    }

    /// Adds the paths that would survive if they draw `element` at these costs.
    #[inline]
    fn offer(&self, survivors: &mut Survivors, costs: &Lanes, element: BlockElement, told: Told) {
        if survivors.would_keep(least(costs)) {
            self.add_all(survivors, costs, element, told);
        }
    }

    /// Adds them if at least one would survive. Not inlined, so that the check before it is.
    #[inline(never)]
    fn add_all(&self, survivors: &mut Survivors, costs: &Lanes, element: BlockElement, told: Told) {
        for (path, &cost) in costs.iter().enumerate() {
            if survivors.would_keep(cost) {
                self.add(survivors, cost, path, element, told);
            }
        }
    }

    /// Adds a path that draws `element`.
    #[expect(clippy::inline_always, reason = "a call would take a quarter of its time")]
    #[inline(always)]
    fn add(
        &self,
        survivors: &mut Survivors,
        cost: f32,
        path: usize,
        element: BlockElement,
        told: Told,
    ) {
        let key = told.key(self.paths.keys[path], self.x + 1);
        let sources = told.sources(path);
        let turn = Turn { kind: StepKind::Draw(element), before: path as u8, sources };
        survivors.add(cost, key, turn);
    }
}

/// The fewest parameter bytes of a colour that takes `bytes` itself, or of an entry in place of it.
#[inline]
fn shortest(bytes: f32, palette: &Palette) -> f32 {
    if palette.is_on() { min(bytes, SHORTEST_ENTRY) } else { bytes }
}
