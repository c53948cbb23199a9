//! What to send of a row that may be shown inexactly.
//!
//! Each cell can be left as it is, or drawn by any of several blocks, in the colours that the terminal
//! draws in already or in others. What is best for a cell depends on the colours that the cells before
//! it have left behind, so rows are searched as video encoders search theirs: through a trellis, cell
//! by cell, with the few cheapest ways to get there kept (Viterbi's algorithm, over a beam). The cost of
//! a way is its bytes, and what its errors are worth in bytes; no colour is farther off than the fidelity
//! allows.
//!
//! What the ways have in common is computed for all of them at once, so each of their fields is an array.
//! Nothing is drawn where to leave a cell costs less than a byte, and no cursor is there: to search these
//! cells, too, took half as long again for the same bytes and error.
//!
//! To take cells in turn, leave what is within a threshold, and draw the rest in the colours at hand
//! where these are within it, was refused: it took 1.7 times the bytes at the same mean error at
//! high fidelity, and 2.3 times at low.

mod block;
mod candidates;

use self::block::{Block, Fresh};
use self::candidates::{Candidates, Turn};
use super::ink::{Halves, Ink, Inks, Price};
use super::look::Glyph;
use super::motion::digits;
use super::palette::Palette;
use super::style::{Shade, Style};

/// A cell of a row that is to be shown.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// These two halves, or about; to leave the cell as it is costs so many bytes.
    Halves { wanted: Halves, keep: f32 },
    /// A letter in about these colours of its text and its ground; it takes so many bytes itself.
    Letter { wanted: [Ink; 2], keep: f32, bytes: u8 },
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
    /// Draw it so; a letter, whatever the glyph.
    Draw(Glyph, Style),
}

/// So many ways are kept at each cell. With twice as many, the same error takes a twentieth fewer
/// bytes, and twice the time.
const KEPT: usize = 4;

/// Where colours are looked up.
pub(super) struct Store<'a> {
    pub(super) inks: &'a mut Inks,
    pub(super) palette: &'a mut Palette,
}

/// A search, and its memory.
#[derive(Debug, Default)]
pub(super) struct Trellis {
    /// The last step of each way past each cell.
    steps: Vec<[Step; KEPT]>,
    actions: Vec<Action>,
}

/// What a way does about a cell.
#[derive(Clone, Copy, Debug)]
struct Step {
    kind: StepKind,
    /// Which of the ways past the cell before it goes on from.
    before: u8,
    /// What the terminal draws text in, and the ground.
    shades: [Shade; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum StepKind {
    Keep,
    DrawExactly,
    Draw(Glyph),
}

/// The cheapest ways past a cell, in no order; those that there are not cost infinitely much.
#[derive(Clone, Copy, Debug)]
struct Ways {
    /// In bytes.
    cost: [f32; KEPT],
    /// What the terminal draws text in, and the ground; far from everything where that is unknown.
    inks: [[Ink; 2]; KEPT],
    /// Where its cursor stands.
    cursor: [u16; KEPT],
    /// What it has drawn last.
    last: [Option<Glyph>; KEPT],
}

/// The cursor of which nobody knows where it stands.
const NOWHERE: u16 = u16::MAX;

/// A colour that nobody knows: no other is near.
const UNKNOWN: Ink = Ink { lab: [1e9; 3], shade: Shade::DEFAULT };

/// What is left as it is for less than this need not be drawn, in bytes.
const NEGLIGIBLE: f32 = 1.0;

impl Trellis {
    /// What is best done about each cell of a row, where the terminal draws in `style` so far, and
    /// repeats characters if it `repeats`.
    pub(super) fn search(
        &mut self,
        row: &[Wanted],
        style: Option<Style>,
        price: Price,
        repeats: bool,
        store: &mut Store,
    ) -> &[Action] {
        self.steps.clear();
        let mut ways = Ways::from_start(style, store.inks);
        for (x, cell) in (0..).zip(row) {
            let steps = match *cell {
                Wanted::Halves { keep, .. } | Wanted::Letter { keep, .. }
                    if keep < NEGLIGIBLE && !ways.cursor.contains(&x) =>
                {
                    ways.keep(keep)
                }
                Wanted::Halves { wanted, keep } => {
                    ways.past_halves(x, wanted, keep, None, price, repeats, store)
                }
                Wanted::Letter { wanted, keep, bytes } => {
                    ways.past_halves(x, wanted, keep, Some(bytes), price, repeats, store)
                }
                Wanted::Fixed { is_shown: true } => ways.keep(0.0),
                Wanted::Fixed { is_shown: false } => ways.past_text(x),
            };
            self.steps.push(steps);
        }
        self.trace_back(ways.cheapest())
    }

    /// What that way has done.
    fn trace_back(&mut self, way: usize) -> &[Action] {
        self.actions.clear();
        let mut at = way;
        for steps in self.steps.iter().rev() {
            let step = &steps[at];
            self.actions.push(match step.kind {
                StepKind::Keep => Action::Keep,
                StepKind::DrawExactly => Action::DrawExactly,
                StepKind::Draw(glyph) => {
                    Action::Draw(glyph, Style::plain(step.shades[0], step.shades[1]))
                }
            });
            at = usize::from(step.before);
        }
        self.actions.reverse();
        &self.actions
    }
}

/// About how many bytes it takes to get from one column of a row to another.
#[inline]
fn motion(cursor: u16, x: u16) -> f32 {
    let bytes = match x.wrapping_sub(cursor) {
        0 => 0,
        // Most come from the row above.
        _ if cursor == NOWHERE && x == 0 => 2,
        _ if cursor == NOWHERE => 5 + digits(x),
        1 => 3,
        distance => 3 + digits(distance),
    };
    bytes as f32
}

impl Ways {
    /// The one way to the start of a row.
    fn from_start(style: Option<Style>, inks: &mut Inks) -> Self {
        let told = style.and_then(Style::plain_colors).map(|colors| inks.of_both(colors));
        Self::one(0.0, told.unwrap_or([UNKNOWN; 2]), NOWHERE)
    }

    fn one(cost: f32, inks: [Ink; 2], cursor: u16) -> Self {
        let mut costs = [f32::INFINITY; KEPT];
        costs[0] = cost;
        Self { cost: costs, inks: [inks; KEPT], cursor: [cursor; KEPT], last: [None; KEPT] }
    }

    fn cheapest(&self) -> usize {
        (1..KEPT).fold(0, |best, way| if self.cost[way] < self.cost[best] { way } else { best })
    }

    /// Past a cell that is left alone, for so many bytes.
    #[inline]
    fn keep(&mut self, error: f32) -> [Step; KEPT] {
        self.cost = self.cost.map(|cost| cost + error);
        std::array::from_fn(|way| Step {
            kind: StepKind::Keep,
            before: way as u8,
            shades: [Shade::DEFAULT; 2],
        })
    }

    /// Past a cell that is drawn in colours that matter to no other.
    fn past_text(&mut self, x: u16) -> [Step; KEPT] {
        let before = self.cheapest();
        *self = Self::one(self.cost[before], [UNKNOWN; 2], x + 1);
        let shades = [Shade::DEFAULT; 2];
        [Step { kind: StepKind::DrawExactly, before: before as u8, shades }; KEPT]
    }

    fn past_halves(
        &mut self,
        x: u16,
        wanted: Halves,
        keep: f32,
        letter: Option<u8>,
        price: Price,
        repeats: bool,
        store: &mut Store,
    ) -> [Step; KEPT] {
        let mut candidates = Candidates::keeping(self, keep);
        let is_right = keep == 0.0;
        // What is right is drawn again only where that is a shorter way to the next cell.
        let start: [f32; KEPT] = std::array::from_fn(|way| {
            let cursor = self.cursor[way];
            if is_right && cursor != x { f32::INFINITY } else { self.cost[way] + motion(cursor, x) }
        });
        let repeated = if repeats { self.repeated(x) } else { [None; KEPT] };
        let block = Block::new(wanted, letter, price, self, start, repeated, x + 1);
        let fresh = block.draw(&mut candidates, (!is_right).then_some(store));
        self.go_on(&candidates, &fresh, letter.is_some(), x + 1)
    }

    /// What each way has drawn just before column `x`.
    fn repeated(&self, x: u16) -> [Option<Glyph>; KEPT] {
        std::array::from_fn(|way| if self.cursor[way] == x { self.last[way] } else { None })
    }

    /// Goes on by the cheapest.
    #[inline]
    fn go_on(
        &mut self,
        candidates: &Candidates,
        fresh: &Fresh,
        is_letter: bool,
        cursor: u16,
    ) -> [Step; KEPT] {
        let (before, cursors) = (self.inks, self.cursor);
        self.cost = candidates.cost;
        std::array::from_fn(|way| {
            let Turn { kind, before: from, text, ground } = candidates.turns[way];
            let from_way = usize::from(from);
            let [old_text, old_ground] = &before[from_way];
            let inks =
                [fresh.ink(text).unwrap_or(old_text), fresh.ink(ground).unwrap_or(old_ground)];
            self.inks[way] = inks.map(|ink| *ink);
            (self.cursor[way], self.last[way]) = match kind {
                StepKind::Draw(glyph) => (cursor, if is_letter { None } else { Some(glyph) }),
                _ => (cursors[from_way], None),
            };
            Step { kind, before: from, shades: inks.map(|ink| ink.shade) }
        })
    }
}
