//! Reproducible randomness: hashes of a position, smooth noise made from them, and irregular patches (a
//! Voronoi diagram that wraps around), in which every texel belongs to the nearest point.

use super::{SIDE, wrapped};

/// A random-looking number that depends only on `x`, `y` and `seed`.
pub(crate) fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let mut bits = (x as u32)
        .wrapping_mul(0x9e37_79b1)
        .wrapping_add((y as u32).wrapping_mul(0x85eb_ca77))
        .wrapping_add(seed.wrapping_mul(0xc2b2_ae3d));
    for _ in 0..2 {
        bits ^= bits >> 15;
        bits = bits.wrapping_mul(0x2c1b_3c6d);
        bits ^= bits >> 13;
    }
    bits
}

/// Smooth noise: random numbers at the points of a lattice, interpolated between them.
///
/// The lattice wraps around at the texture's edges, and the noise with it.
#[derive(Clone, Copy)]
pub(crate) struct Noise {
    seed: u32,
    across: Spacing,
    down: Spacing,
}

/// The distance from one lattice point to the next: a power of two, as a division takes longer than
/// all other operations of the noise.
#[derive(Clone, Copy)]
struct Spacing {
    bits: u32,
}

impl Noise {
    /// Noise with lattice points `across` texels apart in a row and `down` texels in a column. Both
    /// divide the texture's side, which is a power of two.
    pub(crate) const fn new(seed: u32, across: i32, down: i32) -> Self {
        Self { seed, across: Spacing::new(across), down: Spacing::new(down) }
    }

    /// The noise at a texel: from `-swing` to `swing`.
    pub(crate) fn at(self, x: i32, y: i32, swing: i32) -> i32 {
        let (left, from_left) = self.across.split(x);
        let (top, from_top) = self.down.split(y);
        let upper = blend(self.point(left, top), self.point(left + 1, top), from_left);
        let lower = blend(self.point(left, top + 1), self.point(left + 1, top + 1), from_left);
        blend(upper, lower, from_top) * swing / POINT_RANGE
    }

    /// The random number at a lattice point: from `-POINT_RANGE` to `POINT_RANGE`.
    fn point(self, column: i32, row: i32) -> i32 {
        let (column, row) = (self.across.wrapped(column), self.down.wrapped(row));
        (hash(column, row, self.seed) % (2 * POINT_RANGE as u32 + 1)) as i32 - POINT_RANGE
    }
}

impl Spacing {
    const fn new(texels: i32) -> Self {
        assert!(texels > 0 && SIDE % texels == 0, "this noise would not wrap");
        Self { bits: texels.trailing_zeros() }
    }

    /// The lattice point at a texel or before it, and the position of the texel between it and the
    /// next one.
    fn split(self, texel: i32) -> (i32, i32) {
        let from_point = texel & ((1 << self.bits) - 1);
        (texel >> self.bits, ease((from_point * WHOLE) >> self.bits))
    }

    /// The equivalent lattice point within the texture.
    fn wrapped(self, point: i32) -> i32 {
        point & ((SIDE >> self.bits) - 1)
    }
}

const POINT_RANGE: i32 = 1024;

/// The weight of the second of two values that excludes the first.
const WHOLE: i32 = 256;

fn blend(from: i32, to: i32, weight: i32) -> i32 {
    from + (to - from) * weight / WHOLE
}

/// A smooth step from 0 to [`WHOLE`], with slope 0 at both ends.
fn ease(t: i32) -> i32 {
    t * t * (3 * WHOLE - 2 * t) / (WHOLE * WHOLE)
}

/// The position of a texel in a patch.
#[derive(Clone, Copy)]
pub(crate) struct Patch {
    /// Texels right of the patch's point.
    pub(crate) x: i32,
    /// Texels below the patch's point.
    pub(crate) y: i32,
    /// Sixteenths of a texel to the border of the next patch.
    pub(crate) rim: i32,
    /// The index of the patch's point.
    pub(crate) id: i32,
}

impl Patch {
    /// The patch around one of `points` that contains `(x, y)`.
    pub(crate) fn around(points: impl Iterator<Item = (i32, i32)>, x: i32, y: i32) -> Self {
        let mut nearest = FAR;
        let mut next = FAR;
        for (id, (point_x, point_y)) in (0..).zip(points) {
            let site = Site { x: wrapped(x - point_x), y: wrapped(y - point_y), id };
            if site.square() < nearest.square() {
                (nearest, next) = (site, nearest);
            } else if site.square() < next.square() {
                next = site;
            }
        }
        Self { x: nearest.x, y: nearest.y, rim: to_border(nearest, next), id: nearest.id }
    }
}

/// The vector from a texel to a point.
#[derive(Clone, Copy)]
struct Site {
    x: i32,
    y: i32,
    id: i32,
}

/// Farther than any point of the texture.
const FAR: Site = Site { x: SIDE, y: SIDE, id: 0 };

impl Site {
    fn square(self) -> i32 {
        self.x * self.x + self.y * self.y
    }
}

/// Sixteenths of a texel to the line that is equally near to both points.
fn to_border(nearest: Site, next: Site) -> i32 {
    let (x, y) = (next.x - nearest.x, next.y - nearest.y);
    (next.square() - nearest.square()) * 8 / (x * x + y * y).isqrt().max(1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn noise_wraps_and_stays_within_its_swing(
            seed: u32, x in 0..SIDE, y in 0..SIDE, swing in 0..256,
            across in prop::sample::select(vec![2, 4, 8, 16, 32, 64]),
            down in prop::sample::select(vec![2, 4, 8, 16, 32, 64]),
        ) {
            let noise = Noise::new(seed, across, down);
            let value = noise.at(x, y, swing);
            prop_assert!(value.abs() <= swing);
            prop_assert_eq!(noise.at(x + SIDE, y, swing), value);
            prop_assert_eq!(noise.at(x, y - SIDE, swing), value);
        }
    }
}
