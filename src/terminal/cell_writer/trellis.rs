//! The search for the cheapest way to show a row inexactly.
//!
//! Each cell is kept, or drawn with one of several glyphs in the terminal's present colours or in
//! new ones. The best choice for a cell depends on the colours that the cells before it have set.
//! So a row is searched as video encoders do it: through a trellis, cell by cell, keeping the few
//! cheapest paths (Viterbi's algorithm, IEEE Transactions on Information Theory 13, 1967, over a
//! beam). The cost of a path is its bytes plus the price of its errors in bytes; no colour is
//! farther off than the fidelity allows. A character is searched as a half block with only one
//! glyph, its own.
//!
//! Each field of the paths is an array, so that all paths are computed at once. Costs are relative:
//! they omit costs that all paths share. A cell without a cursor is skipped if keeping it costs
//! less than a motion of the cursor; to search these cells, too, took a fifth more instructions for
//! the same bytes and error.
//!
//! A greedy pass was refused. It keeps each cell within a threshold and draws the others in the
//! present colours if these are within it; it took 1.7 times the bytes at the same mean error at
//! high fidelity, and 2.3 times at low.

mod branches;
mod lanes;
mod survivors;

use self::branches::Branches;
use self::lanes::{Labs, Lanes};
use self::survivors::{Survivors, Turn, colors_of, key};
use super::block_element::BlockElement;
use super::ink::{Ink, Inks, Price};
use super::palette::Palette;
use super::shape::Shape;
use super::style::{Shade, Style};

/// The target of a cell: the colours of its halves, or of its character and its background.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) inks: [Ink; 2],
    /// The shape of a block; that of the halves for a character.
    pub(crate) shape: Shape,
    /// The bytes of its only glyph; `None` if any block element will do.
    pub(crate) character: Option<u8>,
}

/// The action on a cell that is not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Action {
    /// Draw it exactly.
    DrawExactly,
    /// Draw it as this block element, or a character by its own glyph, in this style.
    Draw(BlockElement, Style),
}

/// The number of paths kept at each cell. With twice as many, the same error takes a twentieth
/// fewer bytes, and twice the time.
const KEPT: usize = 4;

/// The tables in which colours are looked up.
pub(crate) struct Store<'a> {
    pub(crate) inks: &'a mut Inks,
    pub(crate) palette: &'a mut Palette,
}

/// The parameters that apply to a whole row.
#[derive(Clone, Copy)]
pub(crate) struct Terms {
    pub(crate) price: Price,
    /// The terminal's style before the row.
    pub(crate) style: Option<Style>,
    /// Whether the terminal repeats characters.
    pub(crate) repeats: bool,
}

/// A search and its memory.
#[derive(Debug, Default)]
pub(crate) struct Trellis {
    /// The cells that at least one path draws.
    steps: Vec<Step>,
    actions: Vec<(u16, Action)>,
}

/// The turns of the paths at one cell.
#[derive(Clone, Copy, Debug)]
struct Step {
    column: u16,
    turns: [Turn; KEPT],
    /// The state of the terminal after each.
    keys: [u64; KEPT],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum StepKind {
    Keep,
    DrawExactly,
    Draw(BlockElement),
}

/// The cheapest paths past a cell, in no order; absent paths have infinite cost.
#[derive(Clone, Copy, Debug)]
struct Paths {
    /// In bytes, without the costs that all paths share.
    cost: Lanes,
    /// The terminal's text and background colours and its cursor column.
    keys: [u64; KEPT],
    /// L*, a* and b* of the text and background colours; far from all others if they are unknown.
    labs: [Labs; 2],
    /// The column of the cursor; [`NOWHERE`] if it is unknown.
    cursor: Lanes,
    /// The block element drawn last.
    last: [Option<BlockElement>; KEPT],
    /// The shape of the cell that was drawn last by any path.
    last_shape: Shape,
}

/// The assumed column of a cursor with unknown position, far to the left.
const NOWHERE: f32 = -1e6;

/// An unknown colour, which is far from all others.
const UNKNOWN: Ink = Ink { lab: [1e9; 3], shade: Shade::DEFAULT };

/// A cell that costs less than this to keep, in bytes, is drawn only if a cursor is at it.
const NEGLIGIBLE: f32 = 4.0;

impl Trellis {
    /// Returns the best actions on the cells of a row, without the cells to keep. `keep` is the
    /// cost of keeping each cell. `wanted` returns the target of a cell, or `None` if it may only
    /// be drawn exactly.
    pub(crate) fn search(
        &mut self,
        keep: &[[f32; 2]],
        wanted: impl Fn(usize, &mut Inks) -> Option<Wanted>,
        terms: Terms,
        store: &mut Store,
    ) -> &[(u16, Action)] {
        self.steps.clear();
        let mut paths = Paths::from_start(terms.style, store.inks);
        let mut survivors = Survivors::of(&paths);
        // Whether a path has drawn the cell before, so that its cursor is at this cell.
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
                    paths.go_on(&survivors, column, wanted.shape);
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

    /// Returns the actions of `path`.
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
    /// The only path at the start of a row.
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
            last_shape: Shape::HALF,
        }
    }

    fn cheapest(&self) -> usize {
        (1..KEPT).fold(0, |best, path| if self.cost[path] < self.cost[best] { path } else { best })
    }

    /// Continues past a cell that is drawn exactly, in colours that no other cell depends on.
    fn past_fixed(&mut self, x: u16) -> Step {
        let before = self.cheapest();
        *self = Self::one(self.cost[before], [UNKNOWN; 2], Some(x + 1));
        let turn = Turn { kind: StepKind::DrawExactly, before: before as u8, sources: [0; 2] };
        Step { column: x, turns: [turn; KEPT], keys: self.keys }
    }

    /// Continues with the survivors past the cell in column `x`.
    fn go_on(&mut self, survivors: &Survivors, x: u16, shape: Shape) {
        let before = self.labs;
        self.last_shape = shape;
        self.cost = survivors.cost;
        self.keys = survivors.keys;
        let next = f32::from(x + 1);
        for (path, turn) in survivors.turns.iter().enumerate() {
            // A path that keeps the cell stays in its place.
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

/// The number of places for new colours of a cell: of its upper half, of its lower half, and one
/// for both. It is the number of paths, so that the index of a path or a colour needs no check.
const FRESH: usize = KEPT;
