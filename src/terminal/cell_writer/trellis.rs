//! What to send of a row that may be shown inexactly.
//!
//! Each cell is left as it is, or drawn by one of several glyphs, in the colours that the terminal draws in already
//! or in new ones. What is best for a cell depends on the colours that the cells before it have left behind, so a
//! row is searched as video encoders search theirs: through a trellis, cell by cell, with the few cheapest paths
//! kept (Viterbi's algorithm, IEEE Transactions on Information Theory 13, 1967, over a beam). The cost of a path is
//! its bytes, and what its errors are worth in bytes; no colour is farther off than the fidelity allows. A character
//! is searched as a half block that has but one glyph: its own.
//!
//! Each field of the paths is an array, so that all paths are computed at once. Costs are relative: what all
//! paths pay alike is not added. A cell that no cursor stands at is passed over where it costs less to leave than a
//! motion of the cursor: to search these cells, too, took a fifth more instructions for the same bytes and error.
//!
//! To take cells in turn, leave what is within a threshold, and draw the rest in the colours at hand
//! where these are within it, was refused: it took 1.7 times the bytes at the same mean error at
//! high fidelity, and 2.3 times at low.

mod branches;
mod lanes;
mod survivors;

use self::branches::Branches;
use self::lanes::{Labs, Lanes};
use self::survivors::{Survivors, Turn, colors_of, key};
use super::ink::{Ink, Inks, Price};
use super::packed_cell::BlockElement;
use super::palette::Palette;
use super::style::{Shade, Style};

/// A cell that is to be shown, or about: the colours of its halves, or of its character and the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) inks: [Ink; 2],
    /// How many bytes its only glyph takes; `None` where it is any of the blocks.
    pub(super) character: Option<u8>,
}

/// What to do about a cell that is not left as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Action {
    /// Draw it exactly.
    DrawExactly,
    /// Draw it so; a character by its own glyph.
    Draw(BlockElement, Style),
}

/// How many paths are kept at each cell. With twice as many, the same error takes a twentieth fewer
/// bytes, and twice the time.
const KEPT: usize = 4;

/// Where colours are looked up.
pub(super) struct Store<'a> {
    pub(super) inks: &'a mut Inks,
    pub(super) palette: &'a mut Palette,
}

/// What holds for a whole row.
#[derive(Clone, Copy)]
pub(super) struct Terms {
    pub(super) price: Price,
    /// What the terminal draws in before the row.
    pub(super) style: Option<Style>,
    /// Whether it repeats characters.
    pub(super) repeats: bool,
}

/// A search, and its memory.
#[derive(Debug, Default)]
pub(super) struct Trellis {
    /// The cells that not all paths leave alone.
    steps: Vec<Step>,
    actions: Vec<(u16, Action)>,
}

/// What the paths do about a cell.
#[derive(Clone, Copy, Debug)]
struct Step {
    column: u16,
    turns: [Turn; KEPT],
    /// Where they leave the terminal.
    keys: [u64; KEPT],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum StepKind {
    Keep,
    DrawExactly,
    Draw(BlockElement),
}

/// The cheapest paths past a cell, in no order; those that there are not cost infinitely much.
#[derive(Clone, Copy, Debug)]
struct Paths {
    /// In bytes, beside what all of them cost.
    cost: Lanes,
    /// What the terminal draws text in, and the ground, and where its cursor stands.
    keys: [u64; KEPT],
    /// L*, a* and b* of the colours of text and ground; far from everything where they are unknown.
    labs: [Labs; 2],
    /// Where the cursor stands; [`NOWHERE`] if nobody knows.
    cursor: Lanes,
    /// What was drawn last.
    last: [Option<BlockElement>; KEPT],
}

/// Where the cursor is taken to stand of which nobody knows it: far to the left.
const NOWHERE: f32 = -1e6;

/// A colour that nobody knows: no other is near.
const UNKNOWN: Ink = Ink { lab: [1e9; 3], shade: Shade::DEFAULT };

/// A cell that costs less to leave, in bytes, is drawn only where a cursor stands at it.
const NEGLIGIBLE: f32 = 4.0;

impl Trellis {
    /// What is best done about the cells of a row, where to leave them as they are costs `keep` each; those that
    /// are left are left out. `wanted` tells what a cell is to be, or that it may only be drawn exactly.
    pub(super) fn search(
        &mut self,
        keep: &[[f32; 2]],
        wanted: impl Fn(usize, &mut Inks) -> Option<Wanted>,
        terms: Terms,
        store: &mut Store,
    ) -> &[(u16, Action)] {
        self.steps.clear();
        let mut paths = Paths::from_start(terms.style, store.inks);
        let mut survivors = Survivors::of(&paths);
        // Whether a path has drawn the cell before, so that its cursor stands at this one.
        let mut is_drawn = false;
        for (x, [one, other]) in keep.iter().enumerate() {
            let keep = one + other;
            if keep < NEGLIGIBLE && !is_drawn {
                continue;
            }
            let column = x as u16;
            if let Some(wanted) = wanted(x, store.inks) {
                survivors.begin(&paths, keep);
                Branches::new(&wanted, terms, &paths, column).draw(&mut survivors, store);
                is_drawn = survivors.is_changed();
                if is_drawn {
                    paths.go_on(&survivors, column);
                    let Survivors { turns, keys, .. } = survivors;
                    self.steps.push(Step { column, turns, keys });
                }
            } else {
                is_drawn = keep > 0.0;
                if is_drawn {
                    self.steps.push(paths.past_fixed(column));
                }
            }
        }
        self.trace_back(paths.cheapest())
    }

    /// What that path has done.
    fn trace_back(&mut self, path: usize) -> &[(u16, Action)] {
        self.actions.clear();
        let mut at = path;
        for Step { column, turns, keys } in self.steps.iter().rev() {
            let Turn { kind, before, .. } = turns[at];
            match kind {
                StepKind::Keep => {}
                StepKind::DrawExactly => self.actions.push((*column, Action::DrawExactly)),
                StepKind::Draw(element) => {
                    let [text, ground] = colors_of(keys[at]);
                    self.actions.push((*column, Action::Draw(element, Style::plain(text, ground))));
                }
            }
            at = usize::from(before);
        }
        self.actions.reverse();
        &self.actions
    }
}

impl Paths {
    /// The one path to the start of a row.
    fn from_start(style: Option<Style>, inks: &mut Inks) -> Self {
        let told = style.and_then(Style::plain_colors).map(|colors| inks.of_both(colors));
        Self::one(0.0, told.unwrap_or([UNKNOWN; 2]), None)
    }

    fn one(cost: f32, inks: [Ink; 2], cursor: Option<u16>) -> Self {
        let mut costs = [f32::INFINITY; KEPT];
        costs[0] = cost;
        Self {
            cost: costs,
            keys: [key(inks.map(|ink| ink.shade), cursor.unwrap_or(u16::MAX)); KEPT],
            labs: inks.map(|ink| ink.lab.map(|component| [component; KEPT])),
            cursor: [cursor.map_or(NOWHERE, f32::from); KEPT],
            last: [None; KEPT],
        }
    }

    fn cheapest(&self) -> usize {
        (1..KEPT).fold(0, |best, path| if self.cost[path] < self.cost[best] { path } else { best })
    }

    /// Past a cell that is drawn in colours that matter to no other.
    fn past_fixed(&mut self, x: u16) -> Step {
        let before = self.cheapest();
        *self = Self::one(self.cost[before], [UNKNOWN; 2], Some(x + 1));
        let turn = Turn { kind: StepKind::DrawExactly, before: before as u8, sources: [0; 2] };
        Step { column: x, turns: [turn; KEPT], keys: self.keys }
    }

    /// Goes on by the survivors past the cell in column `x`.
    fn go_on(&mut self, survivors: &Survivors, x: u16) {
        let before = self.labs;
        self.cost = survivors.cost;
        self.keys = survivors.keys;
        let next = f32::from(x + 1);
        for (path, turn) in survivors.turns.iter().enumerate() {
            // Those that leave the cell stay in their places.
            let StepKind::Draw(element) = turn.kind else { continue };
            for (which, &source) in turn.sources.iter().enumerate() {
                let source = usize::from(source) % (2 * KEPT);
                let lab = match source.checked_sub(KEPT) {
                    None => before[which].map(|lanes| lanes[source]),
                    Some(fresh) => survivors.fresh[fresh],
                };
                for (lanes, component) in self.labs[which].iter_mut().zip(lab) {
                    lanes[path] = component;
                }
            }
            (self.cursor[path], self.last[path]) = (next, Some(element));
        }
    }
}

/// Room for the colours of a cell that the terminal does not draw in already: that of its upper half, of its lower half,
/// and one for both. As many as paths, so that the number of a path or of a colour needs no check.
const FRESH: usize = KEPT;
