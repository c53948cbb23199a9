//! The filtered checker: the mean of a checkerboard of cubes over the area of a pixel.
//!
//! A checkerboard of +1 and −1 is the product of one square wave for each axis, so that its mean
//! over a box is the product of three means. The integral of a square wave is a triangle wave. The
//! mean over the box is therefore exact for any size. The method is Íñigo Quílez's, "Filtering the
//! checkerboard" (<https://iquilezles.org/articles/checkerfiltering/>), with a third axis. The area
//! of a pixel on the surface follows from the movement of a ray's end from pixel to pixel (Igehy,
//! "Tracing Ray Differentials", 1999). Along each axis, the box has the variance of that area.
//!
//! Several rays for each pixel were refused: near the horizon a pixel covers hundreds of squares,
//! and any number of samples still shimmers there.

use glam::DVec3;

/// The area that a pixel covers on a surface, as the widths of a box along the axes, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Footprint(pub(super) DVec3);

impl Footprint {
    /// The footprint on a surface with this `normal`, which a ray with this `direction` meets at
    /// `t`. `steps` are the changes of the direction to the next column and to the next row.
    pub(super) fn new(direction: DVec3, t: f64, normal: DVec3, steps: [DVec3; 2]) -> Self {
        let across = normal.dot(direction);
        let [column, row] = steps.map(|step| (step - direction * (normal.dot(step) / across)) * t);
        let square = column * column + row * row;
        Self(DVec3::new(square.x.sqrt(), square.y.sqrt(), square.z.sqrt()))
    }
}

/// The mean of a checkerboard of +1 and −1 over a box with these `widths` around `point`. Both are
/// in cubes; the cube at the origin is +1.
pub(super) fn mean(point: DVec3, widths: DVec3) -> f64 {
    mean_along(point.x, widths.x) * mean_along(point.y, widths.y) * mean_along(point.z, widths.z)
}

/// The mean of a square wave, +1 from 0 to 1 and −1 from 1 to 2, over `width` around `place`.
fn mean_along(place: f64, width: f64) -> f64 {
    /// For larger widths, the mean is closer to 0 than the resolution of colours.
    const WIDEST: f64 = 65_536.0;
    // With a large place, the difference of two close ends would lose its digits.
    let place = within_two(place);
    let (low, high) = (place - width / 2.0, place + width / 2.0);
    if low.floor() == high.floor() {
        if within_two(low.floor()) == 0.0 { 1.0 } else { -1.0 }
    } else if width < WIDEST {
        ((integral(high) - integral(low)) / width).clamp(-1.0, 1.0)
    } else {
        0.0
    }
}

/// The integral of the square wave from 0 to `place`.
fn integral(place: f64) -> f64 {
    1.0 - (within_two(place) - 1.0).abs()
}

/// `place` modulo 2, from 0 to 2. This is exact, and faster than the remainder operator.
fn within_two(place: f64) -> f64 {
    place - 2.0 * (place / 2.0).floor()
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

    proptest! {
        #[test]
        fn the_mean_along_an_axis_is_that_of_many_samples(place in -9.0..9.0, width in 0.0..30.0) {
            prop_assert!((mean_along(place, width) - sampled(place, width)).abs() < 3e-3);
        }

        #[test]
        fn any_place_and_any_width_have_a_mean(
            place in any::<f64>(), width in any::<f64>().prop_map(f64::abs),
        ) {
            let mean = mean_along(place, width);
            prop_assert!(mean.is_nan() || (-1.0..=1.0).contains(&mean), "{mean}");
        }
    }

    #[test]
    fn within_a_cube_there_is_one_colour() {
        assert_eq!(mean(DVec3::new(0.5, 0.5, 0.5), DVec3::splat(0.9)), 1.0);
        assert_eq!(mean(DVec3::new(1e9 + 0.5, 1.5, -0.5), DVec3::splat(0.9)), 1.0);
        assert_eq!(mean(DVec3::new(1.5, 0.5, 0.5), DVec3::ZERO), -1.0);
        assert_eq!(mean(DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0)), 0.0);
    }

    #[test]
    fn the_footprint_on_a_perpendicular_surface_is_the_distance_between_rays() {
        let steps = [DVec3::Y * 0.01, DVec3::Z * 0.02];
        let Footprint(widths) = Footprint::new(DVec3::X, 10.0, -DVec3::X, steps);
        assert!((widths - DVec3::new(0.0, 0.1, 0.2)).length() < 1e-12, "{widths}");
        // A floor that is seen at a slope of one in ten is covered ten times as far along the ray.
        let direction = DVec3::new(1.0, 0.0, -0.1);
        let Footprint(widths) = Footprint::new(direction, 10.0, DVec3::Z, steps);
        assert!((widths - DVec3::new(2.0, 0.1, 0.0)).length() < 1e-12, "{widths}");
    }
}
