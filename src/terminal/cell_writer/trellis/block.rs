//! The blocks that a cell may be drawn as.

use super::super::ink::{Halves, Ink, Price};
use super::super::look::Glyph;
use super::{Step, Way, Ways};

/// Ways past a cell that go on from one of those before it, and draw.
pub(super) struct Drawn<'a> {
    pub(super) past: &'a mut Ways,
    /// What it costs to come here.
    pub(super) start: f32,
    pub(super) before: u8,
    /// Where the cursor is then.
    pub(super) cursor: u16,
}

impl Drawn<'_> {
    /// Whether a way on that costs so much would be kept.
    #[inline]
    fn would_keep(&self, cost: f32) -> bool {
        self.past.would_keep(self.start + cost)
    }

    #[inline]
    fn add(&mut self, glyph: Glyph, inks: [Ink; 2], cost: f32) {
        let cost = self.start + glyph.encoded().1 as f32 + cost;
        if self.past.would_keep(cost) {
            self.past.add(Way {
                cost,
                inks: Some(inks),
                cursor: Some(self.cursor),
                step: Step::Draw(glyph),
                before: self.before,
            });
        }
    }
}

/// A block to draw.
pub(super) struct NewBlock {
    wanted: Halves,
    price: Price,
    /// Colours that may stand for both halves, and what that costs: their bytes, and the error.
    /// Worked out when it is asked for.
    merged: Option<[(Ink, f32); 3]>,
}

/// The bytes of a sequence that sets one colour, without the colour, and of one that sets both.
const ONE_COLOR: f32 = 3.0;
const TWO_COLORS: f32 = 4.0;
/// A colour takes no fewer bytes.
const SHORTEST_INK: f32 = 10.0;

impl NewBlock {
    pub(super) fn new(wanted: Halves, price: Price) -> Self {
        Self { wanted, price, merged: None }
    }

    /// In the text's colour and the ground's that the terminal draws in already, and where
    /// `may_tell`, in one of them and a new one.
    pub(super) fn draw_in_told_colors(
        &mut self,
        inks: [Ink; 2],
        may_tell: bool,
        drawn: &mut Drawn,
    ) {
        let [text, ground] = inks;
        let [upper, lower] = self.wanted;
        if !drawn.would_keep(0.0) {
            return;
        }
        let [text_above, text_below] = self.wanted.map(|wanted| self.price.of(text, wanted));
        let [ground_above, ground_below] = self.wanted.map(|wanted| self.price.of(ground, wanted));
        drawn.add(Glyph::Space, inks, ground_above + ground_below);
        drawn.add(Glyph::Full, inks, text_above + text_below);
        drawn.add(Glyph::Upper, inks, text_above + ground_below);
        drawn.add(Glyph::Lower, inks, ground_above + text_below);
        if !may_tell || !drawn.would_keep(ONE_COLOR + SHORTEST_INK) {
            return;
        }
        let told = |ink: Ink| ONE_COLOR + f32::from(ink.bytes);
        drawn.add(Glyph::Upper, [upper, ground], told(upper) + ground_below);
        drawn.add(Glyph::Upper, [text, lower], told(lower) + text_above);
        drawn.add(Glyph::Lower, [text, upper], told(upper) + text_below);
        drawn.add(Glyph::Lower, [lower, ground], told(lower) + ground_above);
        for (merged, cost) in self.merged() {
            drawn.add(Glyph::Space, [text, merged], cost);
        }
    }

    /// In two new colours.
    pub(super) fn draw_in_new_colors(&self, drawn: &mut Drawn) {
        let [upper, lower] = self.wanted;
        let cost = TWO_COLORS + f32::from(upper.bytes + lower.bytes);
        drawn.add(Glyph::Upper, [upper, lower], cost);
        drawn.add(Glyph::Lower, [lower, upper], cost);
    }

    fn merged(&mut self) -> [(Ink, f32); 3] {
        let (price, wanted) = (self.price, self.wanted);
        *self.merged.get_or_insert_with(|| {
            let [upper, lower] = wanted;
            [upper.between(lower), upper, lower].map(|ink| {
                let error = price.of_halves([ink; 2], wanted);
                (ink, ONE_COLOR + f32::from(ink.bytes) + error)
            })
        })
    }
}
