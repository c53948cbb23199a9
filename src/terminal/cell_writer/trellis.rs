//! What to send of a row that may be shown inexactly.
//!
//! Each cell can be left as it is, or drawn by any of several blocks, in the colours that the terminal
//! draws in already or in others. What is best for a cell depends on the colours that the cells before
//! it have left behind, so rows are searched as video encoders search theirs: through a trellis, cell
//! by cell, with the few cheapest ways to get there kept. The cost of a way is its bytes, and what its
//! errors are worth in bytes; no colour is farther off than the fidelity allows.
//!
//! To take cells in turn, leave what is within a threshold, and draw the rest in the colours at hand
//! where these are within it, was refused: it took 1.7 times the bytes at the same mean error at
//! high fidelity, and 2.3 times at low.

use super::lab::Lab;
use super::look::Glyph;
use super::style::{Shade, Style};
use crate::terminal::Fidelity;

/// A colour, and what it costs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ink {
    channels: [u8; 3],
    lab: Lab,
    bytes: u8,
}

impl Ink {
    /// The colour of those channels.
    pub(super) fn new(channels: [u8; 3]) -> Self {
        let [red, green, blue] = channels;
        let bytes = Shade::Rgb(red, green, blue).bytes() as u8;
        Self { channels, lab: Lab::of(channels), bytes }
    }

    /// That colour, if it is one of red, green and blue.
    pub(super) fn of(shade: Shade) -> Option<Self> {
        match shade {
            Shade::Rgb(red, green, blue) => Some(Self::new([red, green, blue])),
            _ => None,
        }
    }

    fn shade(self) -> Shade {
        let [red, green, blue] = self.channels;
        Shade::Rgb(red, green, blue)
    }

    /// CIE76's ΔE.
    pub(super) fn distance(self, other: Self) -> f32 {
        self.lab.distance(other.lab)
    }

    fn between(self, other: Self) -> Self {
        let channel =
            |index: usize| self.channels[index].midpoint(other.channels[index]);
        Self::new([channel(0), channel(1), channel(2)])
    }
}

impl PartialEq for Ink {
    fn eq(&self, other: &Self) -> bool {
        self.channels == other.channels
    }
}

/// The colours of a block's halves, the upper one first.
pub(super) type Halves = [Ink; 2];

/// What an error is worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Price {
    /// No colour is farther off, in ΔE.
    farthest: f32,
    /// So many bytes are worth a ΔE of one of half a cell.
    bytes: f32,
}

impl Price {
    /// At that fidelity; `None` if it is exact. The less is allowed, the more an error is worth.
    pub(super) fn at(fidelity: Fidelity) -> Option<Self> {
        let farthest = f32::from(fidelity.tolerance());
        (fidelity > Fidelity::EXACT).then(|| Self { farthest, bytes: WORTH / farthest })
    }

    /// What it is worth, in bytes, that one colour is shown for the other; infinite if too much.
    #[inline]
    fn of(self, shown: Ink, wanted: Ink) -> f32 {
        let distance = shown.lab.distance(wanted.lab);
        if distance > self.farthest { f32::INFINITY } else { distance * self.bytes }
    }

    /// The same of both halves.
    #[inline]
    pub(super) fn of_halves(self, shown: Halves, wanted: Halves) -> f32 {
        self.of(shown[0], wanted[0]) + self.of(shown[1], wanted[1])
    }
}

/// So many bytes are worth an error as large as any that is allowed, of half a cell.
const WORTH: f32 = 10.5;

/// A cell of a row that is to be shown.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// These two halves, or about; the terminal shows the others, if it is known what it shows.
    Halves { wanted: Halves, shown: Option<Halves> },
    /// What can't be shown but exactly.
    Fixed { is_shown: bool },
}

/// What to do about a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Action {
    /// Leave it.
    Keep,
    /// Draw it exactly.
    DrawExactly,
    /// Draw it so.
    Draw(Glyph, Style),
}

/// A way to get past a cell.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// In bytes.
    cost: f32,
    /// What the terminal draws text in, and the ground, where that is known.
    inks: Option<[Ink; 2]>,
    /// Where its cursor stands.
    cursor: Option<u16>,
    step: Step,
    /// Which of the ways past the cell before it goes on from.
    before: u8,
}

/// What a way does about its cell.
#[derive(Clone, Copy, Debug)]
enum Step {
    Keep,
    DrawExactly,
    Draw(Glyph),
}

/// The cheapest ways past a cell, in no order.
#[derive(Clone, Copy, Debug)]
struct Ways {
    kept: [Way; KEPT],
    count: usize,
}

/// So many ways are kept at each cell. With twice as many, the same error takes a twentieth fewer
/// bytes, and twice the time.
const KEPT: usize = 4;

/// A search, and its memory.
#[derive(Debug, Default)]
pub(super) struct Trellis {
    /// The ways past each cell.
    cells: Vec<Ways>,
    actions: Vec<Action>,
}

impl Trellis {
    /// What is best done about each cell of row `y`, where the terminal draws in `style` so far.
    pub(super) fn search(
        &mut self,
        row: &[Wanted],
        y: u16,
        style: Option<Style>,
        price: Price,
    ) -> &[Action] {
        self.cells.clear();
        let mut ways = Ways::from_start(style);
        for (x, cell) in (0..).zip(row) {
            ways = match *cell {
                Wanted::Halves { wanted, shown } => {
                    ways.past_halves(Place { x, y }, wanted, shown, price)
                }
                Wanted::Fixed { is_shown: true } => ways.past_shown(),
                Wanted::Fixed { is_shown: false } => ways.past_text(Place { x, y }),
            };
            self.cells.push(ways);
        }
        self.trace_back()
    }

    /// What the cheapest way has done.
    fn trace_back(&mut self) -> &[Action] {
        self.actions.clear();
        let mut at = self.cells.last().map_or(0, Ways::cheapest);
        for ways in self.cells.iter().rev() {
            let way = &ways.kept[at];
            self.actions.push(way.action());
            at = usize::from(way.before);
        }
        self.actions.reverse();
        &self.actions
    }
}

impl Way {
    fn action(&self) -> Action {
        match (self.step, self.inks) {
            (Step::Draw(glyph), Some([text, ground])) => {
                Action::Draw(glyph, Style::plain(text.shade(), ground.shade()))
            }
            (Step::Keep, _) => Action::Keep,
            _ => Action::DrawExactly,
        }
    }
}

/// A cell's column and row.
#[derive(Clone, Copy)]
struct Place {
    x: u16,
    y: u16,
}

impl Place {
    /// How many bytes it takes to get the cursor here.
    fn motion_from(self, cursor: Option<u16>) -> f32 {
        let bytes = match cursor {
            Some(cursor) if cursor == self.x => 0,
            Some(cursor) => 3 + digits(self.x - cursor),
            None => 4 + digits(self.x + 1) + digits(self.y + 1),
        };
        bytes as f32
    }
}

fn digits(number: u16) -> u32 {
    number.checked_ilog10().unwrap_or(0) + 1
}

/// The bytes of a sequence that sets one colour, without the colour, and of one that sets both.
const ONE_COLOR: f32 = 3.0;
const TWO_COLORS: f32 = 4.0;

impl Ways {
    fn none() -> Self {
        let way = Way { cost: 0.0, inks: None, cursor: None, step: Step::Keep, before: 0 };
        Self { kept: [way; KEPT], count: 0 }
    }

    /// The one way to the start of a row.
    fn from_start(style: Option<Style>) -> Self {
        let mut start = Self::none();
        start.count = 1;
        start.kept[0].inks = style.and_then(|style| {
            let [text, ground] = style.plain_colors()?;
            Some([Ink::of(text)?, Ink::of(ground)?])
        });
        start
    }

    fn iter(&self) -> impl Iterator<Item = (u8, &Way)> {
        (0..).zip(&self.kept[..self.count])
    }

    fn cheapest(&self) -> usize {
        let costs = self.iter().map(|(index, way)| (usize::from(index), way.cost));
        costs.min_by(|one, other| one.1.total_cmp(&other.1)).map_or(0, |(index, _)| index)
    }

    /// Past a cell that is left alone.
    fn past_shown(mut self) -> Self {
        for (index, way) in (0..).zip(&mut self.kept[..self.count]) {
            *way = Way { step: Step::Keep, before: index, ..*way };
        }
        self
    }

    /// Past a cell that is drawn in colours that matter to no other.
    fn past_text(&self, place: Place) -> Self {
        let before = self.cheapest();
        let mut past = Self::none();
        past.count = 1;
        past.kept[0] = Way {
            cost: self.kept[before].cost,
            inks: None,
            cursor: Some(place.x + 1),
            step: Step::DrawExactly,
            before: before as u8,
        };
        past
    }

    fn past_halves(
        &self,
        place: Place,
        wanted: Halves,
        shown: Option<Halves>,
        price: Price,
    ) -> Self {
        let error = shown.map_or(f32::INFINITY, |shown| price.of_halves(shown, wanted));
        let block = NewBlock::new(wanted, price);
        let mut past = Self::none();
        for (before, way) in self.iter() {
            past.add(Way { cost: way.cost + error, step: Step::Keep, before, ..*way });
            // What is right already is drawn again only where that is a shorter way to the next cell.
            if error == 0.0 && way.cursor != Some(place.x) {
                continue;
            }
            let start = way.cost + place.motion_from(way.cursor);
            let mut draw = |glyph: Glyph, inks, cost: f32| {
                past.add(Way {
                    cost: start + glyph.symbol().len() as f32 + cost,
                    inks: Some(inks),
                    cursor: Some(place.x + 1),
                    step: Step::Draw(glyph),
                    before,
                });
            };
            if let Some(inks) = way.inks {
                block.in_told_colors(inks, price, &mut draw);
                if error > 0.0 {
                    block.in_one_new_color(inks, price, &mut draw);
                }
            }
            if error > 0.0 {
                block.in_new_colors(&mut draw);
            }
        }
        past
    }

    /// Adds a way, unless there are cheaper ones in its place.
    #[inline]
    fn add(&mut self, way: Way) {
        if way.cost == f32::INFINITY {
            return;
        }
        let kept = &mut self.kept[..self.count];
        if let Some(same) =
            kept.iter_mut().find(|kept| kept.cursor == way.cursor && kept.inks == way.inks)
        {
            if way.cost < same.cost {
                *same = way;
            }
        } else if self.count < KEPT {
            self.kept[self.count] = way;
            self.count += 1;
        } else if let Some(worst) =
            kept.iter_mut().max_by(|one, other| one.cost.total_cmp(&other.cost))
            && way.cost < worst.cost
        {
            *worst = way;
        }
    }
}

/// A block to draw, and what does not depend on the way there.
struct NewBlock {
    wanted: Halves,
    /// Colours that may stand for both halves, and what that costs: their bytes, and the error.
    merged: [(Ink, f32); 3],
}

impl NewBlock {
    fn new(wanted: Halves, price: Price) -> Self {
        let [upper, lower] = wanted;
        let merged = [upper.between(lower), upper, lower].map(|ink| {
            let error = price.of_halves([ink; 2], wanted);
            (ink, ONE_COLOR + f32::from(ink.bytes) + error)
        });
        Self { wanted, merged }
    }

    /// In what the terminal draws in already.
    #[inline]
    fn in_told_colors(
        &self,
        inks: [Ink; 2],
        price: Price,
        draw: &mut impl FnMut(Glyph, [Ink; 2], f32),
    ) {
        let [text, ground] = inks;
        for (glyph, halves) in [
            (Glyph::Space, [ground, ground]),
            (Glyph::Full, [text, text]),
            (Glyph::Upper, [text, ground]),
            (Glyph::Lower, [ground, text]),
        ] {
            draw(glyph, inks, price.of_halves(halves, self.wanted));
        }
    }

    /// In one of these colours and one that is told for it.
    #[inline]
    fn in_one_new_color(
        &self,
        inks: [Ink; 2],
        price: Price,
        draw: &mut impl FnMut(Glyph, [Ink; 2], f32),
    ) {
        let [text, ground] = inks;
        let [upper, lower] = self.wanted;
        for (glyph, inks, new, told, replaced) in [
            (Glyph::Upper, [upper, ground], upper, ground, lower),
            (Glyph::Upper, [text, lower], lower, text, upper),
            (Glyph::Lower, [text, upper], upper, text, lower),
            (Glyph::Lower, [lower, ground], lower, ground, upper),
        ] {
            let error = price.of(told, replaced);
            draw(glyph, inks, ONE_COLOR + f32::from(new.bytes) + error);
        }
        for (merged, cost) in self.merged {
            draw(Glyph::Space, [text, merged], cost);
        }
    }

    /// In two colours that are told for it.
    #[inline]
    fn in_new_colors(&self, draw: &mut impl FnMut(Glyph, [Ink; 2], f32)) {
        let [upper, lower] = self.wanted;
        let cost = TWO_COLORS + f32::from(upper.bytes + lower.bytes);
        draw(Glyph::Upper, [upper, lower], cost);
        draw(Glyph::Lower, [lower, upper], cost);
    }
}
