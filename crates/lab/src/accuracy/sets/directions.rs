//! Directions that are hard to cast.

use glam::DVec2;

use super::{Set, all, hall, places, turned};
use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;

pub(crate) fn sets(random: &mut SplitMix64) -> Vec<Set> {
    vec![
        set("axis-parallel", all(&places(), &turned(1.0, 0.0))),
        set("negative zero", all(&places(), &negative_zeros())),
        set("tiny beside one", all(&places(), &beside_one(&[1e-300, 1e-308, 1e-310, 5e-324]))),
        set("tiny", all(&places(), &tiny())),
        set("unlike components", all(&places(), &unlike())),
        set("nearly parallel", all(&places(), &beside_one(&powers_of_ten(3..=17)))),
        set("through corners", through_corners(random)),
        set("between diagonal walls", between_diagonal_walls()),
        set("along lines", along_lines()),
    ]
}

fn set(name: &'static str, rays: Vec<Ray>) -> Set {
    Set { name, grid: hall(), rays }
}

fn negative_zeros() -> Vec<DVec2> {
    turned(1.0, -0.0).into_iter().chain(turned(-1.0, -0.0)).collect()
}

fn beside_one(sizes: &[f64]) -> Vec<DVec2> {
    sizes.iter().flat_map(|&size| turned(1.0, size)).collect()
}

fn powers_of_ten(exponents: std::ops::RangeInclusive<i32>) -> Vec<f64> {
    exponents.map(|exponent| libm::exp10(f64::from(-exponent))).collect()
}

fn tiny() -> Vec<DVec2> {
    let sizes = [(1e-300, 2e-300), (1e-310, 3e-310), (5e-324, 5e-324), (5e-324, 1e-323)];
    sizes.into_iter().flat_map(|(x, y)| turned(x, y)).collect()
}

fn unlike() -> Vec<DVec2> {
    let sizes = [(1e300, 5e-324), (1e300, 1e-300), (f64::MAX, f64::MIN_POSITIVE), (1e300, 1.0)];
    sizes.into_iter().flat_map(|(x, y)| turned(x, y)).collect()
}

/// From random points to every corner of the grid, and an ulp beside it.
fn through_corners(random: &mut SplitMix64) -> Vec<Ray> {
    let anywhere = DVec2::new(random.between(1.0, 3.0), random.between(8.0, 10.0));
    let mut rays = Vec::new();
    for origin in places().into_iter().chain([anywhere]) {
        for corner in (0..=12).flat_map(|y| (0..=16).map(move |x| DVec2::new(x.into(), y.into()))) {
            let way = corner - origin;
            let directions =
                [way, way.with_x(way.x.next_up()), way.with_x(way.x.next_down()), way / 3.0];
            rays.extend(all(&[origin], &directions));
        }
    }
    rays
}

/// Through the corners at (4, 3), (5, 4) and (5, 5), where walls meet diagonally.
fn between_diagonal_walls() -> Vec<Ray> {
    let mut rays = Vec::new();
    for corner in [DVec2::new(4.0, 3.0), DVec2::new(5.0, 4.0), DVec2::new(5.0, 5.0)] {
        for way in turned(0.5, 0.5).into_iter().chain(turned(0.75, 0.25)) {
            let ways = [way, way.with_y(way.y.next_up()), way.with_y(way.y.next_down())];
            rays.extend(all(&[corner - way], &ways));
        }
    }
    rays
}

fn along_lines() -> Vec<Ray> {
    let origins: Vec<DVec2> = (1..12)
        .flat_map(|row| [DVec2::new(1.5, row.into()), DVec2::new(14.0, row.into())])
        .chain((1..16).map(|column| DVec2::new(column.into(), 9.5)))
        .collect();
    all(&origins, &turned(1.0, 0.0))
}
