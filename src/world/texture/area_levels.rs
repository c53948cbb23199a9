//! Area levels: the means of a texture over boxes of many widths and heights.
//!
//! A pixel covers a box of a wall's texture. The box is as wide as the ray's step and as high as
//! the row's step, and these two may differ much. Each level holds the means over boxes of one
//! width and one height, in linear light, centred at points a fraction of a box apart. A pixel that
//! reads one texel of a level therefore has the mean over nearly its own box, at the cost of any
//! other lookup. A level is made when it is first read.
//!
//! Rejected: a summed-area table (Crow, "Summed-Area Tables for Texture Mapping", 1984), which
//! contains the mean over any box. It takes four lookups in 64 bits, three divisions and three
//! roots for each pixel.

use std::f64::consts::SQRT_2;
use std::num::NonZeroU32;
use std::sync::OnceLock;

use super::MipLevel;
use crate::color::srgb::{from_linear_16, linear_16};

/// The extent of a pixel on a texture, along both axes, in steps of half an octave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct AreaLod {
    across: u8,
    down: u8,
}

/// The continuation of a texture beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Repeat {
    /// The texture again on the left and the right; above and below it a wall ends.
    Across,
    /// The texture again, on all sides.
    Both,
}

/// The area levels of a texture that have been made.
#[derive(Clone)]
pub(crate) struct AreaLevels {
    /// The number of steps along both axes.
    steps: [u8; 2],
    across: Vec<OnceLock<Box<MipLevel>>>,
    both: Vec<OnceLock<Box<MipLevel>>>,
}

/// The boxes of a level along one axis.
#[derive(Clone, Copy, Debug)]
struct Boxes {
    /// The extent of each box, in texels.
    extent: f64,
    /// The number of boxes.
    count: u32,
}

impl AreaLod {
    /// The texture itself.
    pub(crate) const TEXTURE: Self = Self { across: 0, down: 0 };

    /// The extent closest to one with these squares along both axes, in square texels.
    #[inline]
    pub(crate) fn of_squares(across: f64, down: f64) -> Self {
        Self { across: step_of(across), down: step_of(down) }
    }
}

impl AreaLevels {
    pub(crate) fn new(picture: &MipLevel) -> Self {
        let steps = [picture.width(), picture.height()].map(steps_for);
        let count = steps.map(usize::from).into_iter().product();
        let none = || (0..count).map(|_| OnceLock::new()).collect();
        Self { steps, across: none(), both: none() }
    }

    /// The level of `picture` with this extent.
    #[inline]
    pub(crate) fn level(&self, picture: &MipLevel, lod: AreaLod, repeat: Repeat) -> &MipLevel {
        let [across, down] = self.steps;
        let lod = AreaLod { across: lod.across.min(across - 1), down: lod.down.min(down - 1) };
        let levels = match repeat {
            Repeat::Across => &self.across,
            Repeat::Both => &self.both,
        };
        let index = usize::from(lod.across) * usize::from(down) + usize::from(lod.down);
        levels[index].get_or_init(|| Box::new(means(picture, lod, repeat)))
    }
}

impl Boxes {
    /// The boxes of a step along an axis with `texels` texels.
    fn new(step: u8, texels: u32) -> Self {
        let all = f64::from(texels);
        let Some(half_octaves) = step.checked_sub(1) else {
            let count = texels.next_power_of_two().min(MAX);
            return Self { extent: all / f64::from(count), count };
        };
        let octaves = f64::from(1_u32 << (half_octaves / 2).min(31));
        let half = if half_octaves % 2 == 0 { 1.0 } else { SQRT_2 };
        let extent = (MIN * octaves * half).min(all);
        if extent == all {
            return Self { extent, count: 1 };
        }
        let count = (BOXES_IN_AN_EXTENT * all / extent) as u32;
        Self { extent, count: count.next_power_of_two().min(MAX) }
    }
}

/// The extent of the first step, in texels. A pixel that covers less than this is drawn from the
/// texture.
const MIN: f64 = 0.25;
const MIN_HALF_OCTAVES: i64 = -4;
/// The number of boxes that begin within one of them.
const BOXES_IN_AN_EXTENT: f64 = 4.0;
/// The largest number of boxes along an axis.
const MAX: u32 = 256;
/// The largest number of boxes in a level for planes, as a power of two. It is even, as the loops
/// for planes require.
const MAX_BITS_OF_PLANES: u32 = 14;

/// The step for an extent with this square, in square texels.
#[inline]
fn step_of(square: f64) -> u8 {
    const BITS: u32 = f64::MANTISSA_DIGITS - 1;
    const BIAS: i64 = f64::MAX_EXP as i64 - 1;
    // The exponent of a square is the number of half octaves.
    let half_octaves = ((square * SQRT_2).to_bits() >> BITS) as i64 - BIAS;
    (half_octaves - MIN_HALF_OCTAVES + 1).clamp(0, i64::from(u8::MAX)) as u8
}

/// The number of steps for an axis of `texels` texels, up to the extent of the whole axis.
fn steps_for(texels: u32) -> u8 {
    let squares = f64::from(texels) * f64::from(texels);
    step_of(squares) + 2
}

/// The means of `picture` over the boxes of `lod`.
fn means(picture: &MipLevel, lod: AreaLod, repeat: Repeat) -> MipLevel {
    let mut across = Boxes::new(lod.across, picture.width());
    let mut down = Boxes::new(lod.down, picture.height());
    if repeat == Repeat::Both {
        suit_planes(&mut across.count, &mut down.count);
    }
    let height = picture.height() as usize;
    let light: Vec<[f64; 3]> =
        picture.texels().iter().map(|&texel| linear_16(texel).map(f64::from)).collect();
    let mut columns = vec![[0.0; 3]; across.count as usize * height];
    for y in 0..height {
        let row = light.iter().skip(y).step_by(height).copied();
        for (x, mean) in means_along(row, across, true).enumerate() {
            columns[x * height + y] = mean;
        }
    }
    let texels = columns.chunks(height).flat_map(|column| {
        means_along(column.iter().copied(), down, repeat == Repeat::Both)
            .map(|mean| from_linear_16(mean.map(|light| (light + 0.5) as u16)))
    });
    let texels = texels.collect();
    let side = |count: u32| NonZeroU32::new(count).unwrap_or(NonZeroU32::MIN);
    MipLevel::new(side(across.count), side(down.count), texels, Vec::new())
}

/// Changes two powers of two so that their product is a power of four within the limit.
fn suit_planes(across: &mut u32, down: &mut u32) {
    let bits = |across: u32, down: u32| across.trailing_zeros() + down.trailing_zeros();
    while bits(*across, *down) > MAX_BITS_OF_PLANES {
        *(if across > down { &mut *across } else { &mut *down }) /= 2;
    }
    if !bits(*across, *down).is_multiple_of(2) {
        *(if across < down { across } else { down }) *= 2;
    }
}

/// The means of `light` along one axis over `boxes`.
fn means_along(
    light: impl Iterator<Item = [f64; 3]>,
    boxes: Boxes,
    repeats: bool,
) -> impl Iterator<Item = [f64; 3]> {
    let mut sums = vec![[0.0; 3]];
    for light in light {
        let before = *sums.last().unwrap_or(&[0.0; 3]);
        sums.push(std::array::from_fn(|channel| before[channel] + light[channel]));
    }
    let all = (sums.len() - 1) as f64;
    // The sum from the first texel to `place`, which is not before it.
    let sum_to = move |place: f64| -> [f64; 3] {
        let repeats = (place / all).floor();
        let place = (place - repeats * all).max(0.0);
        let index = (place as usize).min(sums.len() - 2);
        let rest = place - index as f64;
        let [whole, next, total] = [sums[index], sums[index + 1], sums[sums.len() - 1]];
        std::array::from_fn(|channel| {
            let part = rest * (next[channel] - whole[channel]);
            repeats * total[channel] + whole[channel] + part
        })
    };
    let step = all / f64::from(boxes.count);
    (0..boxes.count).map(move |index| {
        let centre = (f64::from(index) + 0.5) * step;
        let (start, end) = (centre - boxes.extent / 2.0, centre + boxes.extent / 2.0);
        let (start, end) = if repeats { (start, end) } else { (start.max(0.0), end.min(all)) };
        let [before, after] = [sum_to(start), sum_to(end)];
        std::array::from_fn(|channel| (after[channel] - before[channel]) / (end - start))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::color::Rgb;

    fn picture(width: u32, height: u32) -> MipLevel {
        let side = |side: u32| NonZeroU32::new(side).unwrap();
        let texels = (0..width * height).map(|texel| {
            let [red, green, ..] = texel.wrapping_mul(2_654_435_761).to_be_bytes();
            Rgb::new(red, green, 255 * (texel % 2) as u8)
        });
        MipLevel::new(side(width), side(height), texels.collect(), Vec::new())
    }

    /// The mean light of many samples of a box, which repeats along the axes for which `repeats` is
    /// true.
    fn sampled(
        picture: &MipLevel,
        centre: [f64; 2],
        extent: [f64; 2],
        repeats: [bool; 2],
    ) -> [f64; 3] {
        const SAMPLES: u32 = 64;
        let sides = [picture.width(), picture.height()];
        let texels = |axis: usize| {
            let side = i64::from(sides[axis]);
            let places = (0..SAMPLES).map(move |sample| {
                let along = (f64::from(sample) + 0.5) / f64::from(SAMPLES) - 0.5;
                (centre[axis] + along * extent[axis]).floor() as i64
            });
            let on_texture = move |&place: &i64| repeats[axis] || (0..side).contains(&place);
            places.filter(on_texture).map(move |place| place.rem_euclid(side) as u32)
        };
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for x in texels(0) {
            for y in texels(1) {
                let light = linear_16(picture.texel(x, y).0);
                (0..3).for_each(|channel| sum[channel] += f64::from(light[channel]));
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    }

    #[test]
    fn steps_are_half_octaves() {
        let steps = [0.0, 0.04, 0.0625, 0.125, 1.0, 2.0, 4.0, 1e300, f64::INFINITY].map(step_of);
        assert_eq!(steps, [0, 0, 1, 2, 5, 6, 7, 255, 255]);
    }

    #[test]
    fn the_last_step_is_the_mean_of_all_texels() {
        let picture = picture(6, 4);
        let level = AreaLevels::new(&picture);
        let most = AreaLod { across: u8::MAX, down: u8::MAX };
        let level = level.level(&picture, most, Repeat::Both);
        assert_eq!((level.width(), level.height()), (1, 1));
        let all = sampled(&picture, [3.0, 2.0], [6.0, 4.0], [true; 2]);
        let mean = from_linear_16(all.map(|light| (light + 0.5) as u16));
        let off = mean.channels().into_iter().zip(level.texel(0, 0).0.channels());
        assert!(off.into_iter().all(|(one, other)| one.abs_diff(other) <= 6), "{mean}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn a_texel_is_the_mean_over_its_box(
            sides in (1_u32..20, 1_u32..20),
            (across, down) in (0_u8..14, 0_u8..14),
            repeats_down in any::<bool>(),
            place in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        ) {
            let picture = picture(sides.0, sides.1);
            let repeat = if repeats_down { Repeat::Both } else { Repeat::Across };
            let levels = AreaLevels::new(&picture);
            let [most_across, most_down] = levels.steps;
            let lod = AreaLod { across: across.min(most_across - 1), down: down.min(most_down - 1) };
            let level = levels.level(&picture, lod, repeat);
            let [x, y] = [
                place.0.index(level.width() as usize) as u32,
                place.1.index(level.height() as usize) as u32,
            ];
            let centre = |index: u32, count: u32, side: u32| {
                (f64::from(index) + 0.5) / f64::from(count) * f64::from(side)
            };
            let centre = [centre(x, level.width(), sides.0), centre(y, level.height(), sides.1)];
            let extent = [Boxes::new(lod.across, sides.0).extent, Boxes::new(lod.down, sides.1).extent];
            let expected = sampled(&picture, centre, extent, [true, repeats_down]);
            let shown = linear_16(level.texel(x, y).0);
            for channel in 0..3 {
                // A channel's values are up to a hundredth of full light apart.
                let off = (f64::from(shown[channel]) - expected[channel]).abs() / f64::from(u16::MAX);
                prop_assert!(off < 0.06, "{off}");
            }
        }
    }
}
