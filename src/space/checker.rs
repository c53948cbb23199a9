//! The filtered checker: the mean of a checkerboard of cubes over the area of a pixel.
//!
//! A checkerboard of +1 and −1 is the product of one square wave for each axis. Its mean over a box
//! is therefore the product of three means. The integral of a square wave is a triangle wave, so
//! the mean over the box is exact for any size. The method is from Íñigo Quílez, "Filtering the
//! checkerboard" (<https://iquilezles.org/articles/checkerfiltering/>), with a third axis. The area
//! of a pixel on the surface follows from the movement of a ray's end from pixel to pixel (Igehy,
//! "Tracing Ray Differentials", 1999). Along each axis, the box has the variance of that area.
//!
//! Rejected: several rays for each pixel. Near the horizon a pixel covers hundreds of squares, and any
//! number of samples still shimmers there.

use glam::DVec3;

use super::lanes::{LANES, Lanes, Vectors, are_finite, greatest, least};
use crate::color::Rgb;
use crate::numeric::rounding::{floor_double, floor_of_small};
use crate::world::scene::SolidTexture;

/// The least width at which the mean counts as 0. The mean is then closer to 0 than the resolution
/// of colours.
const MAX_WIDTH: f64 = 65_536.0;
/// The largest place, positive or negative, that [`floor_of_small`] can round to an integer.
const MAX: f64 = (1_u64 << 50) as f64;

/// Sets each lane of `widths` to the area that its pixel covers on a surface, as the widths of a box along
/// the axes, in cells.
///
/// In each lane, the ray meets the surface at `t`, where the surface has the normal of this lane.
/// `steps` are the changes of a direction to the next column and to the next row. `are_alike` is
/// true if all normals are equal, and all of their dot products with the directions are equal, too.
#[inline(always)]
pub(crate) fn find_footprints(
    directions: &Vectors,
    t: &Lanes,
    normals: &Vectors,
    steps: [DVec3; 2],
    are_alike: bool,
    widths: &mut Vectors,
) {
    // The relative change of `t` to the next column and to the next row.
    let changes = |lane| {
        let normal: DVec3 = normals.get(lane);
        let across = normal.dot(directions.get(lane));
        steps.map(|step| normal.dot(step) / across)
    };
    let footprint = |lane, [column, row]: [f64; 2]| {
        let end = |step, change| (step - directions.get(lane) * change) * t[lane];
        let (column, row) = (end(steps[0], column), end(steps[1], row));
        let square = column * column + row * row;
        DVec3::new(square.x.sqrt(), square.y.sqrt(), square.z.sqrt())
    };
    if are_alike {
        let changes = changes(0);
        widths.fill(|lane| footprint(lane, changes));
    } else {
        widths.fill(|lane| footprint(lane, changes(lane)));
    }
}

/// Sets `means` to the mean of a checkerboard of +1 and −1 over a box with these `widths` around each of
/// `points`. Both are in cubes; the cube at the origin is +1.
#[inline(always)]
pub(crate) fn find_means(points: &Vectors, widths: &Vectors, means: &mut Lanes) {
    means.fill(1.0);
    for (places, widths) in points.axes().into_iter().zip(widths.axes()) {
        multiply_by_means_along(places, widths, means);
    }
}

impl SolidTexture {
    /// The colour at `point`.
    pub fn color_at(&self, point: DVec3) -> Rgb {
        match *self {
            Self::Plain(color) => color,
            Self::Checker([first, second], scale) => {
                if is_first(point / scale.cells()) {
                    first
                } else {
                    second
                }
            }
        }
    }
}

/// Whether the cube at `point` has the value +1. The coordinates are in cubes.
fn is_first(point: DVec3) -> bool {
    point.to_array().into_iter().map(|place| mean_along(place, 0.0)).product::<f64>() > 0.0
}

/// Multiplies `products` by the means along one axis.
#[inline(always)]
fn multiply_by_means_along(places: &Lanes, widths: &Lanes, products: &mut Lanes) {
    let ends = [least(places), greatest(places)];
    let width = greatest(widths);
    if !are_finite(places, widths) || ends.iter().any(|end| end.abs() > MAX) || width >= MAX_WIDTH {
        for lane in 0..LANES {
            products[lane] *= mean_along(places[lane], widths[lane]);
        }
    } else if let Some(mean) = mean_of_all(ends, width) {
        for product in products {
            *product *= mean;
        }
    } else {
        for lane in 0..LANES {
            products[lane] *= mean_of_small(places[lane], widths[lane]);
        }
    }
}

/// The mean along one axis that all areas share, if they are in one cube. The areas are around
/// places between the two ends, and up to `width` wide.
///
/// The areas of a level surface are usually in one cube along the axis of its normal. Sums of
/// doubles and their floors are monotonic. All areas are therefore between the two ends that are
/// computed here, despite rounding.
fn mean_of_all([least, greatest]: [f64; 2], width: f64) -> Option<f64> {
    let period = floor_of_small(least / 2.0);
    if period != floor_of_small(greatest / 2.0) {
        return None;
    }
    let low = WavePosition::new(least - 2.0 * period - width / 2.0);
    let high = WavePosition::new(greatest - 2.0 * period + width / 2.0);
    low.is_in_cube_of(&high).then(|| low.sign())
}

/// The mean of a square wave, +1 from 0 to 1 and −1 from 1 to 2, over `width` around `place`.
fn mean_along(place: f64, width: f64) -> f64 {
    // For a large place, the difference of two close ends would lose its digits.
    let place = place - 2.0 * floor_double(place / 2.0);
    let mean = mean_within(place, width);
    if width < MAX_WIDTH || mean.abs() == 1.0 { mean } else { 0.0 }
}

/// [`mean_along`] for a place of at most [`MAX`] and a width below [`MAX_WIDTH`].
#[inline(always)]
fn mean_of_small(place: f64, width: f64) -> f64 {
    mean_within(place - 2.0 * floor_of_small(place / 2.0), width)
}

/// [`mean_along`] for a place in the first period.
#[inline(always)]
fn mean_within(place: f64, width: f64) -> f64 {
    let (low, high) =
        (WavePosition::new(place - width / 2.0), WavePosition::new(place + width / 2.0));
    let mean = ((high.integral() - low.integral()) / width).clamp(-1.0, 1.0);
    if low.is_in_cube_of(&high) { low.sign() } else { mean }
}

/// A place of at most [`MAX`] on the axis of the square wave.
struct WavePosition {
    /// The index of its period.
    period: f64,
    /// The place in the period, from 0 to 2.
    within: f64,
}

impl WavePosition {
    #[inline(always)]
    fn new(place: f64) -> Self {
        let period = floor_of_small(place / 2.0);
        Self { period, within: place - 2.0 * period }
    }

    /// The value of the square wave.
    #[inline(always)]
    fn sign(&self) -> f64 {
        if self.within >= 1.0 { -1.0 } else { 1.0 }
    }

    #[inline(always)]
    fn is_in_cube_of(&self, other: &Self) -> bool {
        (self.period == other.period) & ((self.within >= 1.0) == (other.within >= 1.0))
    }

    /// The integral of the square wave from the start of the period.
    #[inline(always)]
    fn integral(&self) -> f64 {
        1.0 - (self.within - 1.0).abs()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The mean of many samples.
    fn sampled(place: f64, width: f64) -> f64 {
        const SAMPLES: u32 = 20_000;
        let sample = |index: u32| {
            let share = (f64::from(index) + 0.5) / f64::from(SAMPLES) - 0.5;
            if (place + share * width).floor().rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 }
        };
        (0..SAMPLES).map(sample).sum::<f64>() / f64::from(SAMPLES)
    }

    /// The mean by the functions of the standard library, branch by branch.
    fn mean_by_branches(place: f64, width: f64) -> f64 {
        let within_two = |place: f64| place - 2.0 * (place / 2.0).floor();
        let integral = |place: f64| 1.0 - (within_two(place) - 1.0).abs();
        let place = within_two(place);
        let (low, high) = (place - width / 2.0, place + width / 2.0);
        if low.floor() == high.floor() {
            if within_two(low.floor()) == 0.0 { 1.0 } else { -1.0 }
        } else if width < MAX_WIDTH {
            ((integral(high) - integral(low)) / width).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    fn place() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => -9.0..9.0,
            1 => (-20..20_i32).prop_map(|halves| f64::from(halves) / 2.0),
            1 => any::<f64>(),
        ]
    }

    fn width() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => 0.0..30.0,
            1 => 60_000.0..70_000.0,
            1 => any::<f64>().prop_map(f64::abs),
        ]
    }

    proptest! {
        #[test]
        fn the_mean_along_an_axis_matches_many_samples(place in -9.0..9.0, width in 0.0..30.0) {
            prop_assert!((mean_along(place, width) - sampled(place, width)).abs() < 3e-3);
        }

        #[test]
        fn every_place_and_width_has_a_mean(place in place(), width in width()) {
            let mean = mean_along(place, width);
            prop_assert!(mean.is_nan() || (-1.0..=1.0).contains(&mean), "{mean}");
            let expected = mean_by_branches(place, width);
            prop_assert_eq!(mean.is_nan(), expected.is_nan());
            prop_assert!(mean == expected || mean.is_nan(), "{mean} for {expected}");
        }

        #[test]
        fn lanes_match_the_means_of_single_places(
            place in place(), spread in prop_oneof![Just(0.0), -1e-9..1e-9, -2.0..2.0],
            width in width(), wider in 0.0..0.1, odd in 0..LANES, odd_place in place(),
        ) {
            let mut places: Lanes = std::array::from_fn(|lane| place + spread * lane as f64);
            let widths: Lanes = std::array::from_fn(|lane| width + wider * lane as f64);
            for _ in 0..2 {
                let expected = std::array::from_fn(|lane| mean_along(places[lane], widths[lane]));
                let mut means = [1.0; LANES];
                multiply_by_means_along(&places, &widths, &mut means);
                let bits = |means: Lanes| means.map(|it| if it.is_nan() { 0 } else { it.to_bits() });
                prop_assert_eq!(bits(means), bits(expected));
                places[odd] = odd_place;
            }
        }
    }

    /// The same vector in all lanes.
    fn vectors(vector: DVec3) -> Vectors {
        let mut vectors = Vectors::default();
        vectors.fill(|_| vector);
        vectors
    }

    /// The mean at one point.
    fn mean(point: DVec3, widths: DVec3) -> f64 {
        let mut means = [0.0; LANES];
        find_means(&vectors(point), &vectors(widths), &mut means);
        means[LANES - 1]
    }

    #[test]
    fn a_cube_has_one_colour() {
        assert_eq!(mean(DVec3::new(0.5, 0.5, 0.5), DVec3::splat(0.9)), 1.0);
        assert_eq!(mean(DVec3::new(1e9 + 0.5, 1.5, -0.5), DVec3::splat(0.9)), 1.0);
        assert_eq!(mean(DVec3::new(1.5, 0.5, 0.5), DVec3::ZERO), -1.0);
        assert_eq!(mean(DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0)), 0.0);
        assert!(is_first(DVec3::new(0.5, 0.5, 2.5)) && !is_first(DVec3::new(0.5, -0.5, 0.5)));
    }

    #[test]
    fn the_footprint_on_a_perpendicular_surface_is_the_distance_between_rays() {
        let steps = [DVec3::Y * 0.01, DVec3::Z * 0.02];
        let footprint = |direction, normal| {
            let mut widths = Vectors::default();
            let (directions, normals) = (vectors(direction), vectors(normal));
            find_footprints(&directions, &[10.0; LANES], &normals, steps, false, &mut widths);
            widths.get(LANES - 1)
        };
        let widths = footprint(DVec3::X, -DVec3::X);
        assert!((widths - DVec3::new(0.0, 0.1, 0.2)).length() < 1e-12, "{widths}");
        // On a floor that is seen at a slope of one in ten, the footprint is ten times as long
        // along the ray.
        let widths = footprint(DVec3::new(1.0, 0.0, -0.1), DVec3::Z);
        assert!((widths - DVec3::new(2.0, 0.1, 0.0)).length() < 1e-12, "{widths}");
    }
}
