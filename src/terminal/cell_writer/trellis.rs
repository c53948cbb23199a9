//! The search for the cheapest way to show a row inexactly.
//!
//! Each cell is kept, or drawn with one of several glyphs in the terminal's current colours or in new colours. The
//! best choice for a cell depends on the colours that the cells before it have set. Therefore a row is searched as in
//! a video encoder: through a trellis, cell by cell, keeping the few cheapest paths (Viterbi's algorithm, IEEE
//! Transactions on Information Theory 13, 1967, over a beam). The cost of a path is its bytes plus the price of its
//! errors in bytes. No colour is farther off than the fidelity allows. A character is searched as a half block with
//! only one glyph, its own.
//!
//! Each field of the paths is an array, so that all paths are computed at once. Costs are relative: they omit costs
//! that all paths share. A cell at which no path has its cursor is skipped if keeping it costs less than a motion of
//! the cursor. Rejected: searching these cells, too. It took a fifth more instructions for the same bytes and error.
//!
//! The [greedy choice](super::greedy) takes 0.2 to 0.3 times the time, and two to three times the bytes at the same mean
//! error.

use super::block::{BlockElement, MosaicShape};
use super::ink::{ColorCode, Ink, Inks, Price};
use super::palette::TerminalPalette;
use super::style::{PackedColor, Style};

/// The target of a cell: the colours of its halves, or of its character and its background.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellTarget {
    pub(crate) inks: [Ink; 2],
    /// The shape of a block; [`MosaicShape::HALF`] for a character.
    pub(crate) shape: MosaicShape,
    /// The number of bytes of its only glyph. `None` if any block element will do.
    pub(crate) character: Option<u8>,
}

/// The action on a cell that is not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DrawAction {
    /// Draw it exactly.
    DrawExactly,
    /// Draw it as this block element or, if it is a character, as its own glyph, in this style.
    Draw(BlockElement, Style),
}

/// The number of paths kept at each cell. With twice as many, the same error takes a twentieth
/// fewer bytes, and twice the time.
const KEPT: usize = 4;

/// The tables in which colours are looked up.
pub(crate) struct ColorTables<'a> {
    pub(crate) inks: &'a mut Inks,
    pub(crate) palette: &'a mut TerminalPalette,
}

/// The parameters that apply to a whole row.
#[derive(Clone, Copy)]
pub(crate) struct RowParameters {
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
    steps: Vec<PathTurns>,
}

/// The turns of the paths at one cell.
#[derive(Clone, Copy, Debug)]
struct PathTurns {
    column: u16,
    turns: [PathAction; KEPT],
    /// The state of the terminal after each turn.
    keys: [u64; KEPT],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum StepKind {
    Keep,
    DrawExactly,
    Draw(BlockElement),
}

/// The cheapest paths past a cell, in no order. Absent paths have infinite cost.
#[derive(Clone, Copy, Debug)]
struct Paths {
    /// In bytes, without the costs that all paths share.
    cost: PathValues,
    /// The terminal's text and background colours and its cursor column.
    keys: [u64; KEPT],
    /// L*, a* and b* of the text and background colours; far from all others if they are unknown.
    labs: [Labs; 2],
    /// The column of the cursor; [`NOWHERE`] if it is unknown.
    cursor: PathValues,
    /// The block element drawn last.
    last: [Option<BlockElement>; KEPT],
    /// The shape of the cell that was drawn last by any path.
    last_shape: MosaicShape,
}

/// The assumed column of a cursor with unknown position, far to the left.
const NOWHERE: f32 = -1e6;

/// An unknown colour, which is far from all others.
const UNKNOWN: Ink = Ink { lab: [1e9; 3], shade: PackedColor::DEFAULT };

/// A cell that costs less than this to keep, in bytes, is drawn only if a path has its cursor there.
const NEGLIGIBLE: f32 = 4.0;

impl Trellis {
    /// Writes the best actions on the cells of a row to `actions`, without the cells to keep. `keep` is the
    /// cost of keeping each cell. `wanted` returns the target of a cell, or `None` if it may only
    /// be drawn exactly.
    pub(crate) fn search(
        &mut self,
        keep: &[[f32; 2]],
        wanted: impl Fn(usize, &mut Inks) -> Option<CellTarget>,
        terms: RowParameters,
        store: &mut ColorTables,
        actions: &mut Vec<(u16, DrawAction)>,
    ) {
        self.steps.clear();
        let mut paths = Paths::from_start(terms.style, store.inks);
        let mut survivors = SurvivorPaths::of(&paths);
        // True if a path has drawn the cell before, so that its cursor is at this cell.
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
                    let SurvivorPaths { turns, keys, .. } = survivors;
                    self.steps.push(PathTurns { column, turns, keys });
                }
            } else {
                is_drawn = keep > 0.0;
                if is_drawn {
                    self.steps.push(paths.past_fixed(column));
                }
            }
        }
        self.trace_back(paths.cheapest(), actions);
    }

    /// Writes the actions of `path` to `actions`.
    fn trace_back(&self, path: usize, actions: &mut Vec<(u16, DrawAction)>) {
        actions.clear();
        let mut at = path;
        for PathTurns { column, turns, keys } in self.steps.iter().rev() {
            let PathAction { kind, before, .. } = turns[at];
            match kind {
                StepKind::Keep => {}
                StepKind::DrawExactly => actions.push((*column, DrawAction::DrawExactly)),
                StepKind::Draw(element) => {
                    let [text, ground] = colors_of(keys[at]);
                    actions.push((*column, DrawAction::Draw(element, Style::plain(text, ground))));
                }
            }
            at = usize::from(before);
        }
        actions.reverse();
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
            last_shape: MosaicShape::HALF,
        }
    }

    fn cheapest(&self) -> usize {
        (1..KEPT).fold(0, |best, path| if self.cost[path] < self.cost[best] { path } else { best })
    }

    /// Continues past a cell that is drawn exactly, in colours that no other cell depends on.
    fn past_fixed(&mut self, x: u16) -> PathTurns {
        let before = self.cheapest();
        *self = Self::one(self.cost[before], [UNKNOWN; 2], Some(x + 1));
        let turn =
            PathAction { kind: StepKind::DrawExactly, before: before as u8, sources: [0; 2] };
        PathTurns { column: x, turns: [turn; KEPT], keys: self.keys }
    }

    /// Continues with the survivors past the cell in column `x`.
    fn go_on(&mut self, survivors: &SurvivorPaths, x: u16, shape: MosaicShape) {
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

/// The number of places for a cell's new colours: one for its upper half, one for its lower half, and one for both.
/// It equals the number of paths, so that the index of a path or a colour needs no bounds check.
const FRESH: usize = KEPT;

/// A cell to draw.
struct Branches<'a> {
    wanted: &'a CellTarget,
    price: Price,
    /// The prices of errors in the upper half and in the lower, or in the dots and the rest.
    prices: [Price; 2],
    /// The number of bytes of the glyph that shows both colours.
    bytes: f32,
    paths: &'a Paths,
    x: u16,
    repeats: bool,
    /// The cost of each path to this cell. The next field is the least of these costs.
    start: PathValues,
    least: f32,
}

/// The indices of the fresh colours.
const UPPER: u8 = 0;
const LOWER: u8 = 1;
const BOTH: u8 = 2;

/// The numbers of bytes of the sequences that set one colour and both, without the parameters.
const ONE_COLOR: f32 = 3.0;
const TWO_COLORS: f32 = 4.0;
/// The smallest number of bytes of a colour's parameters.
const MIN_COLOR_BYTES: f32 = 2.0;
/// The smallest number of bytes of a palette entry's parameters.
const MIN_ENTRY_BYTES: f32 = 7.0;
/// The approximate number of bytes of one repetition of the last block.
const REPETITION: f32 = 0.5;

impl<'a> Branches<'a> {
    #[inline]
    fn new(wanted: &'a CellTarget, terms: RowParameters, paths: &'a Paths, x: u16) -> Self {
        let RowParameters { price, repeats, .. } = terms;
        let mut start = [0.0; KEPT];
        add_motions(paths, x, &mut start);
        let least = least(&start);
        let (prices, bytes) = match wanted.character {
            Some(bytes) => ([price; 2], f32::from(bytes)),
            None if wanted.shape == MosaicShape::HALF => ([price; 2], HALF_BLOCK),
            None => (wanted.shape.parts().map(|parts| price.of_parts(parts)), wanted.shape.bytes()),
        };
        Self { wanted, price, prices, bytes, paths, x, repeats, start, least }
    }

    /// Draws in the terminal's current colours, in one new colour and in two. A cell that is already right is drawn
    /// again only if that is a shorter way to the next cell.
    #[inline]
    fn draw(&mut self, survivors: &mut SurvivorPaths, store: &mut ColorTables) {
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
        if !is_right && survivors.would_keep(self.least + ONE_COLOR + SPACE + MIN_COLOR_BYTES) {
            self.draw_in_new_colors(&errors, survivors, store);
        }
    }

    /// Draws the character in the old colours.
    #[inline]
    fn draw_character(&self, errors: &Errors, survivors: &mut SurvivorPaths) {
        let costs = sum(&sum(&self.start, &errors.text_above), &errors.ground_below);
        self.offer(survivors, &plus(&costs, self.bytes), BlockElement::Upper, ColorChange::NOTHING);
    }

    #[inline]
    fn draw_in_old_colors(&self, blocks: &mut Blocks, survivors: &mut SurvivorPaths) {
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
                self.add(survivors, costs[path], path, element, ColorChange::NOTHING);
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

    fn draw_in_new_colors(
        &self,
        errors: &Errors,
        survivors: &mut SurvivorPaths,
        store: &mut ColorTables,
    ) {
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
        survivors: &mut SurvivorPaths,
        [upper, lower]: &[ColorCode; 2],
    ) {
        let half = ONE_COLOR + self.bytes;
        let (above, below) = (half + upper.cost(), half + lower.cost());
        let (upper, lower) = (upper.ink.shade, lower.ink.shade);
        let Errors { text_above, text_below, ground_above, ground_below } = errors;
        let mut offer = |element, cost: f32, errors: &PathValues, told| {
            if survivors.would_keep(self.least + cost) {
                self.offer(survivors, &plus(&sum(&self.start, errors), cost), element, told);
            }
        };
        offer(BlockElement::Upper, above, ground_below, ColorChange::NOTHING.text(upper, UPPER));
        offer(BlockElement::Upper, below, text_above, ColorChange::NOTHING.ground(lower, LOWER));
        if self.wanted.character.is_none() {
            offer(
                BlockElement::Lower,
                above,
                text_below,
                ColorChange::NOTHING.ground(upper, UPPER),
            );
            offer(
                BlockElement::Lower,
                below,
                ground_above,
                ColorChange::NOTHING.text(lower, LOWER),
            );
        }
    }

    /// Draws both halves in one new colour.
    #[inline]
    fn draw_in_one_for_both(
        &self,
        survivors: &mut SurvivorPaths,
        [above, below]: &[ColorCode; 2],
        store: &mut ColorTables,
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
            + MIN_COLOR_BYTES
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
    fn offer_for_both(&self, survivors: &mut SurvivorPaths, telling: &ColorCode, source: u8) {
        let ColorCode { ink, bytes, .. } = *telling;
        let [upper, lower] = self.wanted.inks;
        let error = self.prices[0].of(ink, upper) + self.prices[1].of(ink, lower);
        let cost = ONE_COLOR + SPACE + bytes + error;
        if survivors.would_keep(self.least + cost) {
            let told = ColorChange::NOTHING.ground(ink.shade, source);
            self.offer(survivors, &plus(&self.start, cost), BlockElement::Space, told);
        }
    }

    /// Draws in two new colours. All paths then lead to the same state, so only the cheapest is added.
    #[inline]
    fn draw_in_two_colors(&self, survivors: &mut SurvivorPaths, [upper, lower]: &[ColorCode; 2]) {
        let cost = self.least + TWO_COLORS + upper.cost() + lower.cost() + self.bytes;
        if !survivors.would_keep(cost) {
            return;
        }
        let (upper, lower) = (upper.ink.shade, lower.ink.shade);
        let path = (0..KEPT).find(|&path| self.start[path] == self.least).unwrap_or(0);
        let told = ColorChange::NOTHING.text(upper, UPPER).ground(lower, LOWER);
        self.add(survivors, cost, path, BlockElement::Upper, told);
        if self.wanted.character.is_none() && survivors.would_keep(cost) {
            let told = ColorChange::NOTHING.text(lower, LOWER).ground(upper, UPPER);
            self.add(survivors, cost, path, BlockElement::Lower, told);
        }
    }

    /// Adds the paths that would survive if they draw `element` at these costs.
    #[inline]
    fn offer(
        &self,
        survivors: &mut SurvivorPaths,
        costs: &PathValues,
        element: BlockElement,
        told: ColorChange,
    ) {
        if survivors.would_keep(least(costs)) {
            self.add_all(survivors, costs, element, told);
        }
    }

    /// Adds the paths if at least one would survive. Not inlined, so that the check before the call can be.
    #[inline(never)]
    fn add_all(
        &self,
        survivors: &mut SurvivorPaths,
        costs: &PathValues,
        element: BlockElement,
        told: ColorChange,
    ) {
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
        survivors: &mut SurvivorPaths,
        cost: f32,
        path: usize,
        element: BlockElement,
        told: ColorChange,
    ) {
        let key = told.key(self.paths.keys[path], self.x + 1);
        let sources = told.sources(path);
        let turn = PathAction { kind: StepKind::Draw(element), before: path as u8, sources };
        survivors.add(cost, key, turn);
    }
}

/// The smallest number of parameter bytes of a colour that takes `bytes` itself, or of an entry in its place.
#[inline]
fn shortest(bytes: f32, palette: &TerminalPalette) -> f32 {
    if palette.is_on { min(bytes, MIN_ENTRY_BYTES) } else { bytes }
}

// The longer of the following functions are not inlined. On their own they compile to vector instructions, four paths
// at a time. When they were inlined, the compiler split the paths, and a cell took three times the instructions.

/// A number for each path.
type PathValues = [f32; KEPT];

/// L*, a* and b* of a colour for each path.
type Labs = [PathValues; 3];

/// The numbers of bytes of a glyph of one colour, and of two.
const SPACE: f32 = 1.0;
const HALF_BLOCK: f32 = 3.0;

/// The costs, path by path, of showing the text or the background colour in each half.
#[derive(Default)]
struct Errors {
    text_above: PathValues,
    text_below: PathValues,
    ground_above: PathValues,
    ground_below: PathValues,
}

/// The costs, path by path, of drawing each block in the old colours.
#[derive(Default)]
struct Blocks {
    space: PathValues,
    full: PathValues,
    upper: PathValues,
    lower: PathValues,
}

/// The costs of the paths, plus the approximate number of bytes that move their cursors to column `x`.
#[inline(never)]
fn add_motions(paths: &Paths, x: u16, start: &mut PathValues) {
    let x = f32::from(x);
    let is_above = |distance: f32, least: f32| if distance > least { 1.0 } else { 0.0 };
    for (path, start) in start.iter_mut().enumerate() {
        let distance = x - paths.cursor[path];
        let digits = is_above(distance, 1.0) + is_above(distance, 9.0) + is_above(distance, 99.0);
        *start = paths.cost[path] + 3.0 * is_above(distance, 0.0) + digits;
    }
}

/// Measures the errors of the paths' colours against the wanted colours, and the costs of the blocks in them. One
/// function does both, so that no number is stored and loaded again.
#[inline(never)]
fn measure(
    labs: &[Labs; 2],
    wanted: &[Ink; 2],
    prices: &[Price; 2],
    bytes: f32,
    errors: &mut Errors,
    blocks: &mut Blocks,
) {
    let [text, ground] = labs;
    let [upper, lower] = wanted;
    let &[above, below] = prices;
    for path in 0..KEPT {
        let of = |[ls, as_, bs]: &Labs, ink: &Ink, price: Price| {
            let [l, a, b] = [ls[path] - ink.lab[0], as_[path] - ink.lab[1], bs[path] - ink.lab[2]];
            price.of_distance((l * l + a * a + b * b).sqrt())
        };
        let (text_above, text_below) = (of(text, upper, above), of(text, lower, below));
        let (ground_above, ground_below) = (of(ground, upper, above), of(ground, lower, below));
        errors.text_above[path] = text_above;
        errors.text_below[path] = text_below;
        errors.ground_above[path] = ground_above;
        errors.ground_below[path] = ground_below;
        blocks.space[path] = ground_above + ground_below + SPACE;
        blocks.full[path] = text_above + text_below + HALF_BLOCK;
        blocks.upper[path] = text_above + ground_below + bytes;
        blocks.lower[path] = ground_above + text_below + bytes;
    }
}

/// The cost of the cheapest block.
#[inline(never)]
fn choose(blocks: &Blocks, start: &PathValues, costs: &mut PathValues) {
    let Blocks { space, full, upper, lower } = blocks;
    for path in 0..KEPT {
        let (flat, split) = (min(space[path], full[path]), min(upper[path], lower[path]));
        costs[path] = start[path] + min(flat, split);
    }
}

#[inline]
fn sum(one: &PathValues, other: &PathValues) -> PathValues {
    std::array::from_fn(|path| one[path] + other[path])
}

#[inline]
fn plus(one: &PathValues, other: f32) -> PathValues {
    one.map(|one| one + other)
}

/// The least of all costs.
#[inline]
fn least(costs: &PathValues) -> f32 {
    min(min(costs[0], costs[1]), min(costs[2], costs[3]))
}

/// The lesser of two numbers, in one instruction. `f32::min` also tests for NaN.
#[inline]
fn min(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}

/// The cheapest known paths past a cell. No two lead to the same colours and cursor column.
struct SurvivorPaths {
    cost: PathValues,
    turns: [PathAction; KEPT],
    /// The states to which the paths lead.
    keys: [u64; KEPT],
    /// L*, a* and b* of the new colours.
    fresh: [[f32; 3]; FRESH],
    /// The cost of keeping the cell.
    keep: f32,
    /// A path survives only if it costs less than this.
    highest: f32,
    /// The index of the most expensive survivor.
    worst: usize,
    is_changed: bool,
}

/// The action of a path on a cell.
#[derive(Clone, Copy, Debug)]
struct PathAction {
    kind: StepKind,
    before: u8,
    /// The sources of the text and background colours. Values below [`KEPT`] are the paths before, and higher values
    /// are the fresh colours.
    sources: [u8; 2],
}

/// The turns of paths that all keep the cell.
const KEEP: [PathAction; KEPT] = {
    let mut turns = [PathAction { kind: StepKind::Keep, before: 0, sources: [0; 2] }; KEPT];
    let mut path = 0;
    while path < KEPT {
        turns[path].before = path as u8;
        turns[path].sources = [path as u8; 2];
        path += 1;
    }
    turns
};

impl SurvivorPaths {
    /// The paths themselves, before any cell.
    fn of(paths: &Paths) -> Self {
        Self {
            cost: paths.cost,
            turns: KEEP,
            keys: paths.keys,
            fresh: [[0.0; 3]; FRESH],
            highest: 0.0,
            keep: 0.0,
            worst: 0,
            is_changed: false,
        }
    }

    /// Begins with all paths, which keep the cell at this cost in bytes.
    #[inline]
    fn begin(&mut self, paths: &Paths, keep: f32) {
        for (cost, before) in self.cost.iter_mut().zip(&paths.cost) {
            *cost = before + keep;
        }
        self.keep = keep;
        self.keys = paths.keys;
        self.turns = KEEP;
        self.is_changed = false;
        self.find_worst();
    }

    /// Returns true if the cell shows its target exactly.
    #[inline]
    fn is_right(&self) -> bool {
        self.keep == 0.0
    }

    /// Returns true if a path of this cost would survive.
    #[inline]
    fn would_keep(&self, cost: f32) -> bool {
        cost < self.highest
    }

    /// Returns true if any path was added.
    #[inline]
    fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Adds a path that is cheaper than the most expensive survivor. It replaces the path to the same state or, if
    /// there is none, that survivor.
    #[inline]
    fn add(&mut self, cost: f32, key: u64, turn: PathAction) {
        let mut place = self.worst;
        for path in 0..KEPT {
            place = if self.keys[path] == key { path } else { place };
        }
        if cost < self.cost[place] {
            self.is_changed = true;
            self.cost[place] = cost;
            self.keys[place] = key;
            self.turns[place] = turn;
            self.find_worst();
        }
    }

    #[inline]
    fn find_worst(&mut self) {
        let cost = &self.cost;
        let one = usize::from(cost[1] > cost[0]);
        let other = 2 + usize::from(cost[3] > cost[2]);
        self.worst = if cost[other] > cost[one] { other } else { one };
        self.highest = min(cost[self.worst], least(cost) + BEAM);
    }
}

/// A path does not survive if it costs this many bytes more than the cheapest.
const BEAM: f32 = 24.0;

/// The key of a state: the text and background colours, and the cursor column.
#[inline]
fn key([text, ground]: [PackedColor; 2], cursor: u16) -> u64 {
    u64::from(text.in_bits()) << TEXT
        | u64::from(ground.in_bits()) << GROUND
        | u64::from(cursor) & CURSOR
}

/// The text and background colours of a key.
#[inline]
fn colors_of(key: u64) -> [PackedColor; 2] {
    [TEXT, GROUND].map(|place| PackedColor::from_bits((key >> place) as u32))
}

/// The places of the colours in a key, and the bits of the cursor.
const TEXT: u32 = GROUND + PackedColor::BITS;
const GROUND: u32 = 12;
const CURSOR: u64 = (1 << GROUND) - 1;

/// The colours that a branch sets: the bits of a key that they change, and the indices of fresh
/// colours.
#[derive(Clone, Copy)]
struct ColorChange {
    kept: u64,
    set: u64,
    /// For the text and the background: the bits of a path's index to keep, and the bits to set.
    kept_sources: [u8; 2],
    set_sources: [u8; 2],
}

impl ColorChange {
    const NOTHING: Self =
        Self { kept: !CURSOR, set: 0, kept_sources: [u8::MAX; 2], set_sources: [0; 2] };

    /// Adds this text colour.
    #[inline]
    fn text(self, shade: PackedColor, source: u8) -> Self {
        self.with(shade, TEXT, 0, source)
    }

    /// Adds this background colour.
    #[inline]
    fn ground(self, shade: PackedColor, source: u8) -> Self {
        self.with(shade, GROUND, 1, source)
    }

    #[inline]
    fn with(self, shade: PackedColor, place: u32, which: usize, source: u8) -> Self {
        const SHADE: u64 = (1 << PackedColor::BITS) - 1;
        let Self { mut kept_sources, mut set_sources, .. } = self;
        (kept_sources[which], set_sources[which]) = (0, KEPT as u8 + source);
        let kept = self.kept & !(SHADE << place);
        let set = self.set | u64::from(shade.in_bits()) << place;
        Self { kept, set, kept_sources, set_sources }
    }

    /// The key after `key`, with the cursor in this column.
    #[inline]
    fn key(self, key: u64, cursor: u16) -> u64 {
        key & self.kept | self.set | u64::from(cursor) & CURSOR
    }

    /// The sources of the colours after `path`.
    #[inline]
    fn sources(self, path: usize) -> [u8; 2] {
        let [text, ground] = self.kept_sources.map(|kept| kept & path as u8);
        [text | self.set_sources[0], ground | self.set_sources[1]]
    }
}
