//! The two colours of a cell and the dots that have the first of them.
//!
//! The best two colours for a set of points in a Euclidean space are the means of its two parts, and the best
//! parts lie on either side of a plane. So of all thresholds along a direction, the one
//! is taken that leaves the least squared error. The direction is the principal axis at first, and then the line
//! between the two means, until the parts no longer change. Cells of at most two colours need no search.
//!
//! The space is linear light, weighted by channel: dots that blend in the eye blend in light, and the means are
//! the mean light of their parts. Rejected: sRGB, whose pictures have 2 to 5 hundredths more error after a blur of
//! half a cell in each direction; the exact search over all masks, which takes 127 of them for octants and gains
//! nothing that can be seen (less than 0.001 of the error of random cells, 0.0001 of that of frames).

use std::array;

use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};

/// The dots of a cell in two colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Split {
    /// The dots with the first colour: the lowest bit is the first pixel. The last pixel is never among them.
    pub(crate) mask: u8,
    pub(crate) colors: [Rgb; 2],
}

/// The number of directions that are tried at most.
const DIRECTIONS: usize = 3;

impl Split {
    /// The split of the pixels of a cell, of which there are at least two and at most eight.
    #[inline]
    pub(crate) fn of<const N: usize>(pixels: &[Rgb; N]) -> Self {
        let last = pixels[N - 1];
        let others = mask_of(pixels, |pixel| pixel != last);
        if others == 0 {
            return Self { mask: 0, colors: [last; 2] };
        }
        let first = pixels[others.trailing_zeros() as usize];
        if mask_of(pixels, |pixel| pixel == first) == others {
            return Self { mask: others, colors: [first, last] };
        }
        Self::search(pixels)
    }

    /// The same for pixels of more than two colours.
    #[inline(never)]
    fn search<const N: usize>(pixels: &[Rgb; N]) -> Self {
        let light: [[u32; N]; 3] = {
            let light = pixels.map(linear_16);
            array::from_fn(|channel| light.map(|light| u32::from(light[channel])))
        };
        let points = Points::of(&light);
        let mut best = points.best_along(points.principal_axis());
        for _ in 1..DIRECTIONS {
            if points.is_settled(&best) {
                break;
            }
            let next = points.best_along(best.sum);
            if next.gain <= best.gain {
                break;
            }
            best = next;
        }
        let whole = u8::MAX >> (8 - N);
        let mask = if best.mask >> (N - 1) == 1 { best.mask ^ whole } else { best.mask };
        Self { mask, colors: means(&light, mask) }
    }
}

/// The pixels that fulfil a condition.
#[inline]
fn mask_of<const N: usize>(pixels: &[Rgb; N], is_in: impl Fn(Rgb) -> bool) -> u8 {
    (0..N).fold(0, |mask, place| mask | u8::from(is_in(pixels[place])) << place)
}

/// The mean light of the pixels in `mask`, and of the others.
#[inline]
fn means<const N: usize>(light: &[[u32; N]; 3], mask: u8) -> [Rgb; 2] {
    let is_in: [u32; N] = array::from_fn(|place| 0_u32.wrapping_sub(u32::from(mask >> place & 1)));
    let count = mask.count_ones().max(1);
    let others = (N as u32 - count).max(1);
    let mean = |sum: u32, count: u32| ((sum + count / 2) / count) as u16;
    let both = light.each_ref().map(|light| {
        let sum: u32 = light.iter().zip(&is_in).map(|(light, is_in)| light & is_in).sum();
        let rest = light.iter().sum::<u32>() - sum;
        [mean(sum, count), mean(rest, others)]
    });
    [0, 1].map(|part| from_linear_16(both.map(|means| means[part])))
}

/// The pixels of a cell as points around their mean, component by component.
struct Points<const N: usize>([[f32; N]; 3]);

/// The points on one side of a plane.
struct Half {
    mask: u8,
    /// The number of its points.
    count: f32,
    /// The sum of its points.
    sum: [f32; 3],
    /// The squared error that the split saves.
    gain: f32,
}

/// The share of red, green and blue light in what is seen.
const WEIGHTS: [f32; 3] = [0.55, 0.9, 0.35];

impl<const N: usize> Points<N> {
    #[inline]
    fn of(light: &[[u32; N]; 3]) -> Self {
        Self(array::from_fn(|channel| {
            let scale = WEIGHTS[channel] / f32::from(u16::MAX);
            let values = light[channel].map(|light| light.cast_signed() as f32 * scale);
            let mean = values.iter().sum::<f32>() / N as f32;
            values.map(|value| value - mean)
        }))
    }

    /// Approximately the direction in which the points are spread most, of any length: by power iteration from
    /// the component with the largest variance.
    #[inline]
    fn principal_axis(&self) -> [f32; 3] {
        let [x, y, z] = &self.0;
        let product = |one: &[f32; N], other: &[f32; N]| -> f32 {
            one.iter().zip(other).map(|(one, other)| one * other).sum()
        };
        let (xx, xy, xz) = (product(x, x), product(x, y), product(x, z));
        let (yy, yz, zz) = (product(y, y), product(y, z), product(z, z));
        let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let largest = if xx >= yy && xx >= zz {
            0
        } else if yy >= zz {
            1
        } else {
            2
        };
        (0..2).fold(columns[largest], |axis, _| {
            columns.map(|[x, y, z]| x * axis[0] + y * axis[1] + z * axis[2])
        })
    }

    /// The distance of each point along a direction, of any unit.
    #[inline]
    fn along(&self, [dx, dy, dz]: [f32; 3]) -> [f32; N] {
        let [x, y, z] = &self.0;
        array::from_fn(|place| x[place] * dx + y[place] * dy + z[place] * dz)
    }

    /// Whether each point is nearer to the mean of its own part than to that of the other. Then the line between
    /// the means has no better threshold nearby.
    #[inline]
    fn is_settled(&self, half: &Half) -> bool {
        // The means are the sum divided by the count, and its opposite divided by the rest.
        let [x, y, z] = half.sum;
        let middle =
            (x * x + y * y + z * z) * 0.5 * (1.0 / half.count - 1.0 / (N as f32 - half.count));
        let distances = self.along(half.sum);
        let near =
            (0..N).fold(0, |mask, place| mask | u8::from(distances[place] >= middle) << place);
        near == half.mask
    }

    /// The best of the parts on one side of a plane across `direction`. Rejected: the sums for all thresholds at
    /// once, without an order, which take twice the instructions.
    #[inline]
    fn best_along(&self, direction: [f32; 3]) -> Half {
        let [x, y, z] = &self.0;
        let distances = self.along(direction);
        let mut keys: [i32; N] = array::from_fn(|place| key(distances[place], place));
        sort(&mut keys);
        let mut best = Half { mask: 0, count: 1.0, sum: [0.0; 3], gain: -1.0 };
        let (mut mask, mut count, mut sum) = (0, 0.0, [0.0; 3]);
        for &key in &keys[..N - 1] {
            let place = (key & 7) as usize % N;
            mask |= 1 << place;
            count += 1.0;
            sum = [sum[0] + x[place], sum[1] + y[place], sum[2] + z[place]];
            let square = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
            let gain = square / (count * (N as f32 - count));
            if gain > best.gain {
                best = Half { mask, count, sum, gain };
            }
        }
        best
    }
}

/// A number that sorts as `value` does, almost, with a place in its lowest bits.
#[inline]
fn key(value: f32, place: usize) -> i32 {
    let bits = value.to_bits().cast_signed();
    let ordered = bits ^ (bits >> 31 & i32::MAX);
    ordered & !7 | place as i32
}

/// Puts each pair of keys in order, one after another.
macro_rules! exchange {
    ($keys:ident: $($one:literal $other:literal),*) => {{$(
        let (one, other) = ($keys[$one], $keys[$other]);
        ($keys[$one], $keys[$other]) = (one.min(other), one.max(other));
    )*}};
}

/// Sorts four, six or eight numbers without branches, by Batcher's networks (1968).
#[inline]
fn sort<const N: usize>(keys: &mut [i32; N]) {
    match N {
        4 => exchange!(keys: 0 1, 2 3, 0 2, 1 3, 1 2),
        6 => exchange!(keys: 0 5, 1 3, 2 4, 1 2, 3 4, 0 3, 2 5, 0 1, 2 3, 4 5, 1 2, 3 4),
        _ => {
            exchange!(keys: 0 2, 1 3, 4 6, 5 7, 0 4, 1 5, 2 6, 3 7, 0 1, 2 3, 4 5, 6 7, 2 4, 3 5);
            exchange!(keys: 1 4, 3 6, 1 2, 3 4, 5 6);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::builtin;
    use crate::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
    use crate::world::FieldOfView;

    /// The squared error of a split, in the space of the search.
    fn error<const N: usize>(pixels: &[Rgb; N], mask: u8) -> f64 {
        let light = pixels.map(linear_16);
        let light = array::from_fn(|channel| light.map(|light| u32::from(light[channel])));
        let points = Points::of(&light);
        let part = |is_in: bool| {
            let places = (0..N).filter(move |place| (mask >> place & 1 == 1) == is_in);
            let count = places.clone().count().max(1) as f64;
            let of_channel = points.0.each_ref().map(|values| {
                let values = || places.clone().map(|place| f64::from(values[place]));
                let mean = values().sum::<f64>() / count;
                values().map(|value| (value - mean) * (value - mean)).sum::<f64>()
            });
            of_channel.iter().sum::<f64>()
        };
        part(true) + part(false)
    }

    /// The excess of the error over the least of all masks, over that of all cells.
    fn excess<const N: usize>(cells: impl Iterator<Item = [Rgb; N]>) -> f64 {
        let (mut found, mut least) = (0.0, 0.0);
        for pixels in cells {
            found += error(&pixels, Split::of(&pixels).mask);
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
    fn splits_of_random_cells_are_almost_the_best() {
        let excess =
            [excess::<4>(noise(20_000)), excess::<6>(noise(20_000)), excess::<8>(noise(20_000))];
        assert!(excess.into_iter().all(|excess| excess < 0.002), "{excess:?}");
    }

    #[test]
    fn splits_of_frames_are_almost_the_best() {
        for name in ["cellar", "museum", "citadel", "treasury"] {
            let excess = excess(cells(name));
            assert!(excess < 0.0002, "{name} {excess}");
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
        assert_eq!(Split::of(&[a; 6]), Split { mask: 0, colors: [a; 2] });
        for mask in 1..128 {
            let pixels: [Rgb; 8] =
                array::from_fn(|place| if mask >> place & 1 == 1 { a } else { b });
            assert_eq!(Split::of(&pixels), Split { mask, colors: [a, b] });
        }
    }
}
