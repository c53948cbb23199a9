//! Computations for all paths at once.
//!
//! The longer functions are not inlined: on their own they compile to vector instructions, four
//! paths at a time. When they were inlined, the compiler split the paths, and a cell took three
//! times the instructions.

use super::super::ink::{Ink, Price};
use super::{KEPT, Paths};

/// A number for each path.
pub(super) type Lanes = [f32; KEPT];

/// L*, a* and b* of a colour for each path.
pub(super) type Labs = [Lanes; 3];

/// The bytes of a glyph of one colour, and of two.
pub(super) const SPACE: f32 = 1.0;
pub(super) const HALF_BLOCK: f32 = 3.0;

/// The costs, path by path, of showing the text or the background colour in each half.
#[derive(Default)]
pub(super) struct Errors {
    pub(super) text_above: Lanes,
    pub(super) text_below: Lanes,
    pub(super) ground_above: Lanes,
    pub(super) ground_below: Lanes,
}

/// The costs, path by path, of drawing each block in the old colours.
#[derive(Default)]
pub(super) struct Blocks {
    pub(super) space: Lanes,
    pub(super) full: Lanes,
    pub(super) upper: Lanes,
    pub(super) lower: Lanes,
}

/// The costs of the paths, plus the approximate bytes to move their cursors to column `x`.
#[inline(never)]
pub(super) fn add_motions(paths: &Paths, x: u16, start: &mut Lanes) {
    let x = f32::from(x);
    let is_above = |distance: f32, least: f32| if distance > least { 1.0 } else { 0.0 };
    for (path, start) in start.iter_mut().enumerate() {
        let distance = x - paths.cursor[path];
        let digits = is_above(distance, 1.0) + is_above(distance, 9.0) + is_above(distance, 99.0);
        *start = paths.cost[path] + 3.0 * is_above(distance, 0.0) + digits;
    }
}

/// Measures the errors of the paths' colours against the wanted ones, and the costs of the blocks
/// in them. One function does both, so that no number is stored and loaded again.
#[inline(never)]
pub(super) fn measure(
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
pub(super) fn choose(blocks: &Blocks, start: &Lanes, costs: &mut Lanes) {
    let Blocks { space, full, upper, lower } = blocks;
    for path in 0..KEPT {
        let (flat, split) = (min(space[path], full[path]), min(upper[path], lower[path]));
        costs[path] = start[path] + min(flat, split);
    }
}

#[inline]
pub(super) fn sum(one: &Lanes, other: &Lanes) -> Lanes {
    std::array::from_fn(|path| one[path] + other[path])
}

#[inline]
pub(super) fn plus(one: &Lanes, other: f32) -> Lanes {
    one.map(|one| one + other)
}

/// The least of all costs.
#[inline]
pub(super) fn least(costs: &Lanes) -> f32 {
    min(min(costs[0], costs[1]), min(costs[2], costs[3]))
}

/// The lesser of two numbers, in one instruction; `f32::min` also tests for NaN.
#[inline]
pub(super) fn min(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}
