//! Runs: neighbouring pixels of a row that show the same texel.
//!
//! In a large picture, a texel of a near surface is dozens of pixels wide. The ends of the texels
//! are then computed instead of the texel of each pixel. They are computed in whole steps and a
//! remainder, as in an algorithm that draws a straight line on a grid, so all pixels are identical.
//!
//! Rejected: testing whether the first and the last of eight pixels show the same texel. If texels
//! are sixteen pixels wide, nearly half of the groups of eight contain an edge. The processor
//! cannot predict which groups do, and their pixels have to be drawn one by one.

use crate::color::Rgb;
use crate::visibility::TexelPlaces;
use crate::world::texture::MipLevelByShifts;

/// The runs of a span.
#[derive(Clone, Debug)]
pub(crate) struct TexelRuns {
    east: Edges,
    south: Edges,
}

/// The least mean length of runs, in pixels. Below it, drawing each pixel separately is faster.
const MIN: u64 = 6;
/// The least number of pixels. For fewer pixels, the divisions take longer than they save.
const MIN_PIXELS: usize = 32;
/// The number of pixels that are set at a time. Some may be beyond the end of a run; the next run
/// overwrites them.
const AT_ONCE: usize = 16;

impl TexelRuns {
    /// The runs of `pixels` pixels at `places` that show `level`; `None` if they are too short.
    #[inline]
    pub(crate) fn of(
        level: MipLevelByShifts<'_>,
        places: &TexelPlaces,
        pixels: usize,
    ) -> Option<Self> {
        if pixels < MIN_PIXELS {
            return None;
        }
        let (bits, steps) = (level.bits(), places.steps());
        let edges_a_pixel = edges_a_pixel(steps[0], bits[0]) + edges_a_pixel(steps[1], bits[1]);
        let is_worth_it = edges_a_pixel * MIN <= 1 << EDGE_BITS;
        is_worth_it.then(|| Self::new(level, places)).flatten()
    }

    fn new(level: MipLevelByShifts<'_>, places: &TexelPlaces) -> Option<Self> {
        let ([mask_x, mask_y], [step_x, step_y], [x, y]) =
            (level.masks(), places.steps(), places.first());
        Some(Self {
            east: Edges::new(x, step_x, level.index(x, 0), mask_x)?,
            south: Edges::new(y, step_y, level.index(0, y), mask_y)?,
        })
    }

    /// Draws `level` on `pixels`.
    pub(crate) fn draw(self, level: MipLevelByShifts<'_>, pixels: &mut [Rgb]) {
        let Self { mut east, mut south } = self;
        let count = pixels.len() as u64;
        let mut start = 0;
        while start < count {
            let end = east.next.min(south.next).min(count);
            let color = level.at_index(east.index | south.index);
            fill(&mut pixels[start as usize..], (end - start) as usize, color);
            east.pass(end);
            south.pass(end);
            start = end;
        }
    }
}

/// Sets the first `count` of `pixels`, and possibly some after them.
#[inline]
fn fill(pixels: &mut [Rgb], count: usize, color: Rgb) {
    let (blocks, rest) = pixels.as_chunks_mut::<AT_ONCE>();
    let full = count.div_ceil(AT_ONCE);
    if full <= blocks.len() {
        for block in &mut blocks[..full] {
            *block = [color; AT_ONCE];
        }
    } else {
        blocks.as_flattened_mut().fill(color);
        rest.fill(color);
    }
}

/// The mean number of edges between two neighbouring pixels, along one axis with two to the power of
/// `bits` texels, in units of 2 to the power of −[`EDGE_BITS`].
fn edges_a_pixel(step: u64, bits: u32) -> u64 {
    step.cast_signed().unsigned_abs() >> (u64::BITS - EDGE_BITS).saturating_sub(bits)
}

/// The number of fraction bits. With these, the edges of 2³¹ texels do not overflow.
const EDGE_BITS: u32 = 28;

/// The edges between texels, along one axis.
#[derive(Clone, Debug)]
struct Edges {
    /// The first pixel after the next edge.
    next: u64,
    /// The distance of that pixel's position from the edge: less than a step.
    behind: u64,
    /// The step from one pixel to the next.
    step: u64,
    /// The width of a texel, in whole steps and a remainder.
    steps: u64,
    rest: u64,
    /// The contribution of this axis to the index of the texel.
    index: u32,
    /// The step of `index` from one texel to the next, modulo the number of texels.
    index_step: u32,
    mask: u32,
}

impl Edges {
    /// The edges from `place` on, with this `step` from each pixel to the next. A position
    /// contributes the bits in `mask` to the index of a texel. At first, these bits are `index`.
    /// `None` if there is only one texel.
    fn new(place: u64, step: u64, index: u32, mask: u32) -> Option<Self> {
        let texel = 1_u64.checked_shl(u64::BITS - mask.count_ones())?;
        let to_next = mask & mask.wrapping_neg();
        // A negative step is mirrored to a positive one.
        let (place, step, index_step) = if step.cast_signed() < 0 {
            (!place, step.wrapping_neg(), to_next.wrapping_neg())
        } else {
            (place, step, to_next)
        };
        let last_of_texel = texel - 1 - (place & (texel - 1));
        let along =
            Self { next: u64::MAX, behind: 0, step, steps: 0, rest: 0, index, index_step, mask };
        Some(match last_of_texel.checked_div(step) {
            // The row is parallel to the edges and crosses none.
            None => along,
            Some(steps) => Self {
                next: steps + 1,
                behind: step - 1 - last_of_texel % step,
                steps: texel / step,
                rest: texel % step,
                ..along
            },
        })
    }

    /// Advances to the next edge if the current one is before the pixel `end`.
    #[inline]
    fn pass(&mut self, end: u64) {
        // A branch would be unpredictable, so both results are computed.
        let passes = u64::from(self.next == end).wrapping_neg();
        let is_one_more = u64::from(self.rest > self.behind);
        let moved = self.steps + is_one_more;
        let further = (is_one_more.wrapping_neg() & self.step).wrapping_sub(self.rest);
        self.next += moved & passes;
        self.behind = self.behind.wrapping_add(further & passes);
        self.index = self.index.wrapping_add(self.index_step & passes as u32) & self.mask;
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use crate::visibility::SpanMapping;
    use crate::world::Texture;

    fn half_step() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), Just(-0.0), Just(1.0 / 4096.0), -1e-3..1e-3, -1e-18..1e-18]
    }

    proptest! {
        #[test]
        fn runs_give_each_pixel_its_own_texel(
            sides in (0_u32..6, 0_u32..6),
            middle in (-50.0..50.0, -50.0..50.0),
            on_edges in any::<bool>(),
            half_step in (half_step(), half_step()),
            (width, first) in (1_u32..3000, 0_u32..200),
        ) {
            let side = |bits: u32| NonZeroU32::MIN.saturating_add((1 << bits) - 1);
            let texture = Texture::from_fn(side(sides.0), side(sides.1), |x, y| {
                Rgb::new(x as u8, y as u8, 0)
            });
            let level = texture.level(0);
            let by_shifts = level.by_shifts().unwrap();
            let middle = DVec2::from(middle);
            let middle = if on_edges { middle.floor() } else { middle };
            let half_step = DVec2::from(half_step);
            let mapping = SpanMapping { distance: 1.0, pixel_area: 1.0, middle, half_step, width };
            let places = mapping.places(first as usize, 1.0);
            let mut pixels = vec![Rgb::WHITE; width as usize];
            let Some(runs) = TexelRuns::of(by_shifts, &places, pixels.len()) else {
                // There are runs if a texel is at least 32 pixels wide, unless it is the only one.
                let is_near = half_step.abs().max_element() <= 0.5 / 64.0 / 32.0;
                let is_one = sides.0 == 0 || sides.1 == 0;
                prop_assert!(pixels.len() < MIN_PIXELS || !is_near || is_one);
                return Ok(());
            };
            runs.draw(by_shifts, &mut pixels);
            for (pixel, (x, y)) in pixels.into_iter().zip(places) {
                prop_assert_eq!(pixel, level.at_fraction(x, y));
            }
        }
    }
}
