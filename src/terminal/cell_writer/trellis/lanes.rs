//! Computations for all paths at once.
//!
//! The longer functions are not inlined: on their own they compile to vector instructions, four
//! paths at a time. When they were inlined, the compiler split the paths, and a cell took three
//! times the instructions.

use super::super::ink::{Ink, Price};
use super::{KEPT, Paths};

/// A number for each path.
pub(crate) type Lanes = [f32; KEPT];

/// L*, a* and b* of a colour for each path.
pub(crate) type Labs = [Lanes; 3];

/// The bytes of a glyph of one colour, and of two.
pub(crate) const SPACE: f32 = 1.0;
pub(crate) const HALF_BLOCK: f32 = 3.0;

/// The costs, path by path, of showing the text or the background colour in each half.
#[derive(Default)]
pub(crate) struct Errors {
    pub(crate) text_above: Lanes,
    pub(crate) text_below: Lanes,
    pub(crate) ground_above: Lanes,
    pub(crate) ground_below: Lanes,
}

/// The costs, path by path, of drawing each block in the old colours.
#[derive(Default)]
pub(crate) struct Blocks {
    pub(crate) space: Lanes,
    pub(crate) full: Lanes,
    pub(crate) upper: Lanes,
    pub(crate) lower: Lanes,
}

/// The costs of the paths, plus the approximate bytes to move their cursors to column `x`.
#[inline(never)]
pub(crate) fn add_motions(paths: &Paths, x: u16, start: &mut Lanes) {
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
pub(crate) fn measure(
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
pub(crate) fn choose(blocks: &Blocks, start: &Lanes, costs: &mut Lanes) {
    let Blocks { space, full, upper, lower } = blocks;
    for path in 0..KEPT {
        let (flat, split) = (min(space[path], full[path]), min(upper[path], lower[path]));
        costs[path] = start[path] + min(flat, split);
    }
}

#[inline]
pub(crate) fn sum(one: &Lanes, other: &Lanes) -> Lanes {
    std::array::from_fn(|path| one[path] + other[path])
}

#[inline]
pub(crate) fn plus(one: &Lanes, other: f32) -> Lanes {
    one.map(|one| one + other)
}

/// The least of all costs.
#[inline]
pub(crate) fn least(costs: &Lanes) -> f32 {
    min(min(costs[0], costs[1]), min(costs[2], costs[3]))
}

/// The lesser of two numbers, in one instruction; `f32::min` also tests for NaN.
#[inline]
pub(crate) fn min(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}
