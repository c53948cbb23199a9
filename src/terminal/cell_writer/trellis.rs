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

mod block;

use self::block::{Drawn, NewBlock};
use super::ink::{Halves, Ink, Price};
use super::look::Glyph;
use super::style::Style;

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
    /// What costs no less than this is not kept.
    highest: f32,
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

impl Ways {
    fn none() -> Self {
        let way = Way { cost: 0.0, inks: None, cursor: None, step: Step::Keep, before: 0 };
        Self { kept: [way; KEPT], count: 0, highest: f32::INFINITY }
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
        let mut past = Self::none();
        if error < f32::INFINITY {
            for (before, way) in self.iter() {
                past.add(Way { cost: way.cost + error, step: Step::Keep, before, ..*way });
            }
        }
        let is_right = error == 0.0;
        let mut block = NewBlock::new(wanted, price);
        for (before, way) in self.iter() {
            // What is right is drawn again only where that is a shorter way to the next cell.
            if is_right && way.cursor != Some(place.x) {
                continue;
            }
            let start = way.cost + place.motion_from(way.cursor);
            let mut drawn = Drawn { past: &mut past, start, before, cursor: place.x + 1 };
            if let Some(inks) = way.inks {
                block.draw_in_told_colors(inks, !is_right, &mut drawn);
            }
            if !is_right {
                block.draw_in_new_colors(&mut drawn);
            }
        }
        past
    }

    /// Whether a way of that cost would be kept.
    #[inline]
    fn would_keep(&self, cost: f32) -> bool {
        cost < self.highest
    }

    /// Adds a way, unless there are cheaper ones in its place.
    fn add(&mut self, way: Way) {
        if !self.would_keep(way.cost) {
            return;
        }
        let kept = &mut self.kept[..self.count];
        let same = kept.iter_mut().find(|kept| kept.cursor == way.cursor && kept.inks == way.inks);
        if let Some(same) = same {
            if way.cost >= same.cost {
                return;
            }
            *same = way;
        } else if self.count < KEPT {
            self.kept[self.count] = way;
            self.count += 1;
        } else if let Some(worst) = kept.iter_mut().find(|kept| kept.cost == self.highest) {
            *worst = way;
        }
        if self.count == KEPT {
            self.highest = self.kept.iter().fold(0.0, |highest, way| way.cost.max(highest));
        }
    }
}
