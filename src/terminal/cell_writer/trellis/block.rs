//! The blocks that a cell may be drawn as.

use super::super::ink::{Halves, Ink, Price};
use super::super::look::Glyph;
use super::super::palette::Telling;
use super::super::style::Shade;
use super::Store;
use super::candidates::{Candidates, Turn, key};
use super::{KEPT, StepKind, Ways};

/// A block to draw, after each of the ways to it.
pub(super) struct Block<'a> {
    wanted: Halves,
    /// How many bytes the only glyph takes that it may be drawn as; `None` for those of blocks.
    letter: Option<u8>,
    price: Price,
    ways: &'a Ways,
    /// What it costs to come here by each way.
    start: [f32; KEPT],
    /// The least of these.
    least: f32,
    /// What is drawn again for less.
    repeated: [Option<Glyph>; KEPT],
    /// Where the cursor is then.
    cursor: u16,
}

/// Where the inks of all ways lie, side by side.
struct Labs([[f32; KEPT]; 3]);

impl Labs {
    #[inline]
    fn of(inks: [Ink; KEPT]) -> Self {
        Self([0, 1, 2].map(|component| inks.map(|ink| ink.lab[component])))
    }

    /// How far they are from `ink`.
    #[inline]
    fn distances(&self, ink: Ink) -> [f32; KEPT] {
        let [ls, as_, bs] = &self.0;
        let [l, a, b] = ink.lab;
        std::array::from_fn(|way| {
            let (l, a, b) = (ls[way] - l, as_[way] - a, bs[way] - b);
            (l * l + a * a + b * b).sqrt()
        })
    }
}

/// The colours that a block's halves may be told in, and one that may stand for both.
#[derive(Clone, Copy)]
pub(super) struct Fresh([Telling; 3]);

/// Which colour the terminal is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Told {
    Upper,
    Lower,
    /// One that stands for both halves.
    Both,
    /// None: it stays.
    None,
}

/// The bytes of a sequence that sets one colour, without the colour, and of one that sets both.
const ONE_COLOR: f32 = 3.0;
const TWO_COLORS: f32 = 4.0;

impl Fresh {
    /// That one, unless it stays.
    #[inline]
    pub(super) fn ink(&self, told: Told) -> Option<&Ink> {
        self.0.get(told as usize).map(|telling| &telling.ink)
    }

    #[inline]
    pub(super) fn of(wanted: Halves) -> Self {
        let [upper, lower] = wanted.map(|ink| Telling { ink, bytes: 0.0, error: 0.0 });
        Self([upper, lower, upper])
    }
}

impl<'a> Block<'a> {
    #[inline]
    pub(super) fn new(
        wanted: Halves,
        letter: Option<u8>,
        price: Price,
        ways: &'a Ways,
        start: [f32; KEPT],
        repeated: [Option<Glyph>; KEPT],
        cursor: u16,
    ) -> Self {
        let least = start.into_iter().fold(f32::INFINITY, f32::min);
        Self { wanted, letter, price, ways, start, least, repeated, cursor }
    }

    /// What it costs that each way's text and ground stand for each half.
    #[inline]
    fn errors(&self) -> [[f32; KEPT]; 4] {
        let [upper, lower] = self.wanted;
        let [text, ground] = [0, 1].map(|which| Labs::of(self.ways.inks.map(|inks| inks[which])));
        let distances = [
            text.distances(upper),
            text.distances(lower),
            ground.distances(upper),
            ground.distances(lower),
        ];
        distances.map(|way| way.map(|distance| self.price.of_distance(distance)))
    }

    /// In the text's colour and the ground's that the terminal draws in already, and where `inks` are
    /// there to find others in, in one new colour or in two.
    #[inline]
    pub(super) fn draw(&self, candidates: &mut Candidates, store: Option<&mut Store>) -> Fresh {
        let mut fresh = Fresh::of(self.wanted);
        if !candidates.would_keep(self.least + REPETITION) {
            return fresh;
        }
        let errors = self.errors();
        self.draw_in_old_colors(&errors, candidates);
        // A colour that is told takes some bytes in any case.
        if !candidates.would_keep(self.least + ONE_COLOR + SHORTEST_GLYPH + SHORTEST_INK) {
            return fresh;
        }
        if let Some(store) = store {
            let [upper, lower] =
                self.wanted.map(|wanted| store.palette.telling(wanted, self.price));
            fresh.0[..2].copy_from_slice(&[upper, lower]);
            if self.letter.is_none() {
                self.draw_in_one_for_both(candidates, &mut fresh, store);
            }
            self.draw_in_one_color(&errors, candidates, [upper, lower]);
            self.draw_in_two_colors(candidates, [upper, lower]);
        }
        fresh
    }

    #[inline]
    fn draw_in_old_colors(&self, errors: &[[f32; KEPT]; 4], candidates: &mut Candidates) {
        let [text_above, text_below, ground_above, ground_below] = errors;
        if let Some(bytes) = self.letter {
            for way in 0..KEPT {
                let error = text_above[way] + ground_below[way];
                let cost = self.start[way] + f32::from(bytes) + error;
                if candidates.would_keep(cost) {
                    self.add(candidates, cost, way, Glyph::Upper, [Told::None; 2], [None; 2]);
                }
            }
            return;
        }
        for way in 0..KEPT {
            let blocks = [
                (Glyph::Space, ground_above[way] + ground_below[way]),
                (Glyph::Full, text_above[way] + text_below[way]),
                (Glyph::Upper, text_above[way] + ground_below[way]),
                (Glyph::Lower, ground_above[way] + text_below[way]),
            ];
            let repeated = self.repeated[way];
            let blocks = blocks.map(|(glyph, error)| {
                let bytes = if repeated == Some(glyph) { REPETITION } else { bytes(glyph) };
                (glyph, error + bytes)
            });
            let cheapest = |one: (Glyph, f32), other: (Glyph, f32)| {
                if other.1 < one.1 { other } else { one }
            };
            let (glyph, cost) =
                cheapest(cheapest(blocks[0], blocks[1]), cheapest(blocks[2], blocks[3]));
            let cost = self.start[way] + cost;
            if candidates.would_keep(cost) {
                self.add(candidates, cost, way, glyph, [Told::None; 2], [None; 2]);
            }
        }
    }

    #[inline]
    fn draw_in_one_color(
        &self,
        errors: &[[f32; KEPT]; 4],
        candidates: &mut Candidates,
        [upper, lower]: [Telling; 2],
    ) {
        let [text_above, text_below, ground_above, ground_below] = errors;
        let half = ONE_COLOR + self.bytes_of_half();
        let (above, below) = (half + upper.cost(), half + lower.cost());
        let mut offer = |glyph, cost: f32, errors: &[f32; KEPT], told, inks| {
            if candidates.would_keep(self.least + cost) {
                for (way, error) in errors.iter().enumerate() {
                    let cost = self.start[way] + cost + error;
                    if candidates.would_keep(cost) {
                        self.add(candidates, cost, way, glyph, told, inks);
                    }
                }
            }
        };
        let (upper, lower) = (Some(upper.ink), Some(lower.ink));
        offer(Glyph::Upper, above, ground_below, [Told::Upper, Told::None], [upper, None]);
        offer(Glyph::Upper, below, text_above, [Told::None, Told::Lower], [None, lower]);
        if self.letter.is_some() {
            return;
        }
        offer(Glyph::Lower, above, text_below, [Told::None, Told::Upper], [None, upper]);
        offer(Glyph::Lower, below, ground_above, [Told::Lower, Told::None], [lower, None]);
    }

    /// In one colour for both halves.
    #[inline]
    fn draw_in_one_for_both(
        &self,
        candidates: &mut Candidates,
        fresh: &mut Fresh,
        store: &mut Store,
    ) {
        let [upper, lower] = self.wanted;
        let apart = upper.distance(lower);
        let mut offer = |telling: Telling, told| {
            let ink = telling.ink;
            let error = self.price.of(ink, upper) + self.price.of(ink, lower);
            let cost = ONE_COLOR + bytes(Glyph::Space) + telling.bytes + error;
            if candidates.would_keep(self.least + cost) {
                for way in 0..KEPT {
                    let cost = self.start[way] + cost;
                    if candidates.would_keep(cost) {
                        let told = [Told::None, told];
                        self.add(candidates, cost, way, Glyph::Space, told, [None, Some(ink)]);
                    }
                }
            }
        };
        offer(fresh.0[0], Told::Upper);
        if upper.shade == lower.shade {
            return;
        }
        offer(fresh.0[1], Told::Lower);
        // Halfway, the errors add up to no less than the distance.
        if apart <= 2.0 * self.price.farthest {
            let both = store.inks.between(upper, lower);
            let both = store.palette.telling(both, self.price);
            fresh.0[Told::Both as usize] = both;
            offer(both, Told::Both);
        }
    }

    /// In two new colours, which lead to the same from everywhere.
    #[inline]
    fn draw_in_two_colors(&self, candidates: &mut Candidates, [upper, lower]: [Telling; 2]) {
        let cost = self.least + TWO_COLORS + upper.cost() + lower.cost() + self.bytes_of_half();
        let (upper, lower) = (upper.ink, lower.ink);
        if !candidates.would_keep(cost) {
            return;
        }
        let way = (0..KEPT).find(|&way| self.start[way] == self.least).unwrap_or(0);
        let (told, inks) = ([Told::Upper, Told::Lower], [Some(upper), Some(lower)]);
        self.add(candidates, cost, way, Glyph::Upper, told, inks);
        if self.letter.is_none() && candidates.would_keep(cost) {
            let (told, inks) = ([Told::Lower, Told::Upper], [Some(lower), Some(upper)]);
            self.add(candidates, cost, way, Glyph::Lower, told, inks);
        }
    }

    /// What a half block takes, or a letter.
    #[inline]
    fn bytes_of_half(&self) -> f32 {
        self.letter.map_or(bytes(Glyph::Upper), f32::from)
    }

    /// Adds a way that draws `glyph`.
    #[inline]
    fn add(
        &self,
        candidates: &mut Candidates,
        cost: f32,
        way: usize,
        glyph: Glyph,
        [text, ground]: [Told; 2],
        [text_ink, ground_ink]: [Option<Ink>; 2],
    ) {
        let text_shade = text_ink.map_or(self.ways.inks[way][0].shade, |ink| ink.shade);
        let ground_shade = ground_ink.map_or(self.ways.inks[way][1].shade, |ink| ink.shade);
        let key = key([text_shade, ground_shade].map(Shade::in_bits), self.cursor);
        let turn = Turn { kind: StepKind::Draw(glyph), before: way as u8, text, ground };
        candidates.add(cost, key, turn);
    }
}

#[inline]
fn bytes(glyph: Glyph) -> f32 {
    if glyph == Glyph::Space { SHORTEST_GLYPH } else { 3.0 }
}

const SHORTEST_GLYPH: f32 = 1.0;
/// About how many bytes it takes to draw once more what was drawn just before.
const REPETITION: f32 = 0.5;
/// A colour takes no fewer bytes.
const SHORTEST_INK: f32 = 7.0;
