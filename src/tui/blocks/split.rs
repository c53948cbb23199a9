//! Chooses the two colours of a cell, and the dots that have the first of them.
//!
//! The best two colours for a set of points in a Euclidean space are the means of its two parts, and the best
//! parts lie on either side of a plane. Therefore the pixels are compared along one direction, from the mean of
//! the darker pixels to the mean of the lighter pixels, and divided at the threshold with the least squared
//! error.
//!
//! The coordinates are the weighted squares of the channels. They approximate linear light, because dots that
//! blend in the eye blend in light. [`CELLS`] cells are split at once, without branches, as vectors of 16 bits.
//!
//! Rejected: splitting one cell at a time, with up to three directions and tables of linear light. From intents
//! to bytes, frames then took 153 million instructions, and now take 105 million. Its squared error was at most
//! 0.8 % less in pictures and 2 to 4 % less in random cells. Rejected: one colour for cells of nearly one colour.
//! Within 4 levels per channel, these are only 2 cells in 100. Rejected: the exact search over all masks. Octants
//! have 127 of them.
//! Octants have 127 of them.

#![expect(
    clippy::needless_range_loop,
    clippy::inline_always,
    reason = "loops by index, in one function, are what the compiler turns into vectors"
)]

use std::array;

use crate::color::Rgb;

/// The number of cells that are split at once. They are few enough for the first-level cache, and too many for
/// the compiler to unroll its loops instead of using vectors. Windows are often a multiple of it wide.
const CELLS: usize = 40;

/// A value for each of several cells.
type CellValues<T> = [T; CELLS];

/// The splits of several cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Splits {
    /// The dots with the first colour: the lowest bit is the first pixel. The last pixel is never among them.
    masks: CellValues<u8>,
    colors: [CellValues<Rgb>; 2],
}

/// The split of one cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Split {
    pub(crate) mask: u8,
    pub(crate) colors: [Rgb; 2],
}

impl Splits {
    /// The splits of the `width` cells of a row. `pixel(x, place)` returns the pixel at a place of cell `x`.
    pub(crate) fn of_row<const N: usize>(
        width: u16,
        pixel: impl Fn(u32, usize) -> Rgb,
    ) -> impl Iterator<Item = Split> {
        let last = u32::from(width).saturating_sub(1);
        let splits = (0..u32::from(width)).step_by(CELLS).flat_map(move |first| {
            let mut pixels = [[Rgb::BLACK; CELLS]; N];
            for cell in 0..CELLS {
                // The last cell is repeated if there are no more cells.
                let x = (first + cell as u32).min(last);
                for (place, pixels) in pixels.iter_mut().enumerate() {
                    pixels[cell] = pixel(x, place);
                }
            }
            let Self { masks, colors: [dots, rest] } = Self::of(&pixels);
            (0..CELLS)
                .map(move |cell| Split { mask: masks[cell], colors: [dots[cell], rest[cell]] })
        });
        splits.take(width.into())
    }
}

/// The weights of red, green and blue, as two powers of two each: 0.56, 1 and 0.38 of the squares, which are
/// almost light. The largest weighted square has 13 bits.
const SHIFTS: [[u32; 2]; 3] = [[4, 7], [4, 4], [5, 6]];

impl Splits {
    /// The splits of cells, given their pixels: two to eight in each cell.
    #[inline(never)]
    fn of<const N: usize>(pixels: &[CellValues<Rgb>; N]) -> Self {
        if let [first, last] = pixels.as_slice() {
            let masks = array::from_fn(|cell| u8::from(first[cell] != last[cell]));
            return Self { masks, colors: [*first, *last] };
        }
        let channels = [16, 8, 0].map(|shift| {
            let mut values = [[0; CELLS]; N];
            for_each(&mut values, |value, place, cell| {
                *value = (pixels[place][cell].to_bits() >> shift & 0xff) as u16;
            });
            values
        });
        let distances = distances(&points(&channels));
        let threshold = threshold(distances);
        let mut is_in = [[0; CELLS]; N];
        for_each(&mut is_in, |is_in, place, cell| {
            *is_in = to_mask(distances[place][cell] <= threshold[cell]);
        });
        let last = is_in[N - 1];
        for_each(&mut is_in, |is_in, _, cell| *is_in ^= last[cell]);
        let mut masks = [0; CELLS];
        for place in 0..N {
            let bit = 1_i16 << place;
            for cell in 0..CELLS {
                masks[cell] |= (is_in[place][cell] & bit) as u8;
            }
        }
        Self { masks, colors: means(&channels, &is_in) }
    }
}

/// Calls `act` with each value, its place and its cell.
#[inline(always)]
fn for_each<T, const N: usize>(
    values: &mut [CellValues<T>; N],
    mut act: impl FnMut(&mut T, usize, usize),
) {
    for place in 0..N {
        for cell in 0..CELLS {
            act(&mut values[place][cell], place, cell);
        }
    }
}

/// All bits if `is_set`, or none.
#[inline(always)]
fn to_mask(is_set: bool) -> i16 {
    -i16::from(is_set)
}

/// The light of the pixels as points around the mean of their cell, channel by channel.
#[inline(always)]
fn points<const N: usize>(channels: &[[CellValues<u16>; N]; 3]) -> [[CellValues<i16>; N]; 3] {
    let mut points = [[[0; CELLS]; N]; 3];
    for channel in 0..3 {
        let mut sums = [0_u16; CELLS];
        for_each(&mut points[channel], |point, place, cell| {
            let value = channels[channel][place][cell];
            let square = value.wrapping_mul(value);
            let [one, other] = SHIFTS[channel];
            let light = (square >> one) + (square >> other);
            sums[cell] = sums[cell].wrapping_add(light);
            *point = light as i16;
        });
        for_each(&mut points[channel], |point, _, cell| {
            *point = point.wrapping_sub((sums[cell] / N as u16) as i16);
        });
    }
    points
}

/// The distance of each point along the line of the largest spread, approximately. The first approximation is the
/// channel that varies most. The second is the line between the means of that channel's lower half and upper
/// half.
#[inline(always)]
fn distances<const N: usize>(points: &[[CellValues<i16>; N]; 3]) -> [CellValues<i16>; N] {
    let mut spread = [[0_i16; CELLS]; 3];
    for channel in 0..3 {
        for place in 0..N {
            for cell in 0..CELLS {
                let point = points[channel][place][cell];
                spread[channel][cell] += point.max(-point) >> 1;
            }
        }
    }
    let mut chosen = [[0_i16; CELLS]; 3];
    for cell in 0..CELLS {
        let [x, y, z] = [spread[0][cell], spread[1][cell], spread[2][cell]];
        chosen[0][cell] = to_mask(x > y) & to_mask(x > z);
        chosen[2][cell] = to_mask(z > y) & !chosen[0][cell];
        chosen[1][cell] = !chosen[0][cell] & !chosen[2][cell];
    }
    let mut distances = [[0; CELLS]; N];
    for_each(&mut distances, |distance, place, cell| {
        *distance = points[0][place][cell] & chosen[0][cell]
            | points[1][place][cell] & chosen[1][cell]
            | points[2][place][cell] & chosen[2][cell];
    });
    along(points, &axis(points, &distances))
}

/// The sum of the points whose distance is positive. It is scaled so that the largest component is about 32,000.
#[inline(always)]
fn axis<const N: usize>(
    points: &[[CellValues<i16>; N]; 3],
    distances: &[CellValues<i16>; N],
) -> [CellValues<i16>; 3] {
    let mut axis = [[0_i16; CELLS]; 3];
    for channel in 0..3 {
        for place in 0..N {
            for cell in 0..CELLS {
                let is_upper = to_mask(distances[place][cell] > 0);
                axis[channel][cell] =
                    axis[channel][cell].wrapping_add(points[channel][place][cell] & is_upper);
            }
        }
    }
    let mut scaled = [[0; CELLS]; 3];
    for cell in 0..CELLS {
        let [x, y, z] = [axis[0][cell], axis[1][cell], axis[2][cell]];
        let most =
            x.max(x.wrapping_neg()).max(y.max(y.wrapping_neg())).max(z.max(z.wrapping_neg()));
        let scale = 32_000.0 / f32::from(most.max(1));
        for channel in 0..3 {
            scaled[channel][cell] = rounded(f32::from(axis[channel][cell]) * scale) as i16;
        }
    }
    scaled
}

/// The nearest integer in the low 16 bits, for numbers of at most 22 bits.
#[inline(always)]
fn rounded(value: f32) -> u32 {
    const ONES: f32 = 12_582_912.0;
    (value + ONES).to_bits()
}

/// The distance of each point along an axis.
#[inline(always)]
fn along<const N: usize>(
    points: &[[CellValues<i16>; N]; 3],
    axis: &[CellValues<i16>; 3],
) -> [CellValues<i16>; N] {
    let mut distances = [[0_i16; CELLS]; N];
    for channel in 0..3 {
        for_each(&mut distances, |distance, place, cell| {
            let point = points[channel][place][cell].wrapping_mul(4);
            let product = (i32::from(point) * i32::from(axis[channel][cell])) >> 16;
            *distance = distance.wrapping_add(product as i16);
        });
    }
    distances
}

/// The largest distance in the lower part of the split with the least squared error.
#[inline(always)]
fn threshold<const N: usize>(mut distances: [CellValues<i16>; N]) -> CellValues<i16> {
    sort(&mut distances);
    let mut best = [0_i16; CELLS];
    let mut most = [-1.0_f32; CELLS];
    let mut sums = [0_i32; CELLS];
    for count in 1..N {
        let distances = &distances[count - 1];
        let share = 1.0 / (count * (N - count)) as f32;
        for cell in 0..CELLS {
            sums[cell] += i32::from(distances[cell]);
            let sum = sums[cell] as f32;
            let gain = sum * sum * share;
            let is_better = gain > most[cell];
            most[cell] = if is_better { gain } else { most[cell] };
            best[cell] = if is_better { distances[cell] } else { best[cell] };
        }
    }
    best
}

/// The mean light of the pixels that are in a part, and of the other pixels.
#[inline(always)]
fn means<const N: usize>(
    channels: &[[CellValues<u16>; N]; 3],
    is_in: &[CellValues<i16>; N],
) -> [CellValues<Rgb>; 2] {
    let mut counts = [0_i16; CELLS];
    for place in 0..N {
        for cell in 0..CELLS {
            counts[cell] -= is_in[place][cell];
        }
    }
    let mut shares = [[0.0_f32; CELLS]; 2];
    for cell in 0..CELLS {
        shares[0][cell] = 1.0 / f32::from(counts[cell].max(1));
        shares[1][cell] = 1.0 / f32::from(N as i16 - counts[cell]);
    }
    let mut colors = [[0_u32; CELLS]; 2];
    for channel in 0..3 {
        let (mut all, mut sums) = ([0_u32; CELLS], [0_u32; CELLS]);
        for place in 0..N {
            for cell in 0..CELLS {
                let value = channels[channel][place][cell];
                let square = value.wrapping_mul(value);
                all[cell] += u32::from(square);
                sums[cell] += u32::from(square & is_in[place][cell] as u16);
            }
        }
        for cell in 0..CELLS {
            for (part, sum) in [sums[cell], all[cell] - sums[cell]].into_iter().enumerate() {
                let value = (sum.cast_signed() as f32 * shares[part][cell]).sqrt();
                colors[part][cell] = colors[part][cell] << 8 | rounded(value) & 0xff;
            }
        }
    }
    for cell in 0..CELLS {
        colors[0][cell] = if counts[cell] == 0 { colors[1][cell] } else { colors[0][cell] };
    }
    colors.map(|colors| {
        colors.map(|bits| Rgb::new((bits >> 16) as u8, (bits >> 8) as u8, bits as u8))
    })
}

/// Sorts the values at pairs of places, one pair after another.
macro_rules! exchange {
    ($values:ident: $($one:literal $other:literal),*) => {{$(
        for cell in 0..CELLS {
            let (one, other) = ($values[$one][cell], $values[$other][cell]);
            $values[$one][cell] = one.min(other);
            $values[$other][cell] = one.max(other);
        }
    )*}};
}

/// Sorts four, six or eight numbers of each cell, with Batcher's networks (1968).
#[inline(always)]
fn sort<const N: usize>(values: &mut [CellValues<i16>; N]) {
    match N {
        4 => exchange!(values: 0 1, 2 3, 0 2, 1 3, 1 2),
        6 => exchange!(values: 0 5, 1 3, 2 4, 1 2, 3 4, 0 3, 2 5, 0 1, 2 3, 4 5, 1 2, 3 4),
        _ => {
            exchange!(values: 0 2, 1 3, 4 6, 5 7, 0 4, 1 5, 2 6, 3 7, 0 1, 2 3, 4 5, 6 7, 2 4, 3 5);
            exchange!(values: 1 4, 3 6, 1 2, 3 4, 5 6);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::srgb::linear;
    use crate::map::builtin;
    use crate::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
    use crate::world::FieldOfView;

    fn split<const N: usize>(pixels: &[Rgb; N]) -> Split {
        Splits::of_row::<N>(1, |_, place| pixels[place]).next().unwrap()
    }

    /// The squared error of a split in linear light, with the channels weighted.
    fn error<const N: usize>(pixels: &[Rgb; N], mask: u8) -> f64 {
        const WEIGHTS: [f64; 3] = [0.55, 0.9, 0.35];
        let light = pixels.map(linear);
        let part = |is_in: bool| {
            let places = (0..N).filter(move |place| (mask >> place & 1 == 1) == is_in);
            let count = places.clone().count().max(1) as f64;
            let of_channel = [0, 1, 2].map(|channel| {
                let values =
                    || places.clone().map(|place| WEIGHTS[channel] * light[place][channel]);
                let mean = values().sum::<f64>() / count;
                values().map(|value| (value - mean) * (value - mean)).sum::<f64>()
            });
            of_channel.iter().sum::<f64>()
        };
        part(true) + part(false)
    }

    /// The excess of the summed error of all cells over the sum of the least errors of any mask.
    fn excess<const N: usize>(cells: impl Iterator<Item = [Rgb; N]>) -> f64 {
        let (mut found, mut least) = (0.0, 0.0);
        for pixels in cells {
            found += error(&pixels, split(&pixels).mask);
            let masks = 0..1_u16 << (N - 1);
            least += masks.map(|mask| error(&pixels, mask as u8)).fold(f64::INFINITY, f64::min);
        }
        found / least - 1.0
    }

    fn noise<const N: usize>(count: usize) -> impl Iterator<Item = [Rgb; N]> {
        let mut state = 1_u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        };
        (0..count).map(move |_| array::from_fn(|_| Rgb::new(next(), next(), next())))
    }

    #[test]
    fn splits_of_random_cells_are_nearly_optimal() {
        let excess =
            [excess::<4>(noise(20_000)), excess::<6>(noise(20_000)), excess::<8>(noise(20_000))];
        assert!(excess.into_iter().all(|excess| excess < 0.045), "{excess:?}");
    }

    #[test]
    fn splits_of_frames_are_nearly_optimal() {
        for name in ["cellar", "museum", "citadel", "treasury"] {
            let excess = excess(cells(name));
            assert!(excess < 0.009, "{name} {excess}");
        }
    }

    /// The cells of a level's first picture, in octants.
    fn cells(name: &str) -> impl Iterator<Item = [Rgb; 8]> {
        let level = builtin::LEVELS.iter().find(|level| level.name == name).unwrap();
        let world = level.world().unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let mut renderer = Renderer::new();
        renderer.set_filter(Filter::Area);
        let mut frame = Frame::new(FrameSize::new(160, 96).unwrap(), PixelAspect::SQUARE);
        renderer.render(&world, &camera, &mut frame);
        (0..24 * 80).map(move |cell| {
            let (x, y) = (2 * (cell % 80), 4 * (cell / 80));
            array::from_fn(|pixel| frame.pixel(x + pixel as u32 % 2, y + pixel as u32 / 2))
        })
    }

    #[test]
    fn cells_of_two_colours_are_exact() {
        let [a, b] = [Rgb::new(1, 2, 3), Rgb::new(200, 2, 3)];
        assert_eq!(split(&[a; 6]), Split { mask: 0, colors: [a; 2] });
        for mask in 1..128 {
            let pixels: [Rgb; 8] =
                array::from_fn(|place| if mask >> place & 1 == 1 { a } else { b });
            assert_eq!(split(&pixels), Split { mask, colors: [a, b] });
        }
    }
}
