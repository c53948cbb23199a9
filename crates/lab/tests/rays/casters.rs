//! The contract of all casters, exact or not: they end, and a hit is a wall of the map, at a
//! distance and at a position on its face.

use cellcaster::cast::{Caster, Hit, Ray};
use cellcaster::rng::SplitMix64;
use cellcaster::world::Grid;
use cellcaster_lab::accuracy::{self, Set};
use cellcaster_lab::casters::{Method, Visitor};
use proptest::prelude::*;

use crate::adversarial::adversarial_ray;

/// The hits of all rays by one caster.
struct Cast<'a>(&'a Grid, &'a [Ray]);

impl Visitor for Cast<'_> {
    type Output = Vec<Option<Hit>>;

    fn visit<C: Caster>(self, caster: &C) -> Self::Output {
        self.1.iter().map(|ray| caster.cast(self.0, ray)).collect()
    }
}

/// Every method, with the default value and with both ends of its parameter's range.
fn methods() -> impl Iterator<Item = Method> {
    let ends = ["fixed:4", "fixed:26", "table:8", "table:65536", "march:1"];
    Method::all().into_iter().chain(ends.map(|name| name.parse().unwrap()))
}

fn is_sane(grid: &Grid, hit: &Hit) -> bool {
    grid.is_solid(hit.cell.column.into(), hit.cell.row.into())
        && hit.t >= 0.0
        && (0.0..=1.0).contains(&hit.u)
}

#[test]
fn every_method_returns_sane_hits_for_every_stiff_set() {
    for Set { name, grid, rays } in accuracy::sets(1) {
        for method in methods() {
            // A million cells at a hundred steps each take too long for a test.
            let is_long = grid.width() > 5000;
            let method = match method {
                Method::March(_) if is_long => "march:0.5".parse().unwrap(),
                method => method,
            };
            for (ray, hit) in rays.iter().zip(method.accept(Cast(&grid, &rays))) {
                if let Some(hit) = hit {
                    assert!(is_sane(&grid, &hit), "{name}, {method}: {ray:?} hits {hit:?}");
                }
            }
        }
    }
}

/// In ordinary scenes and with fine parameters, all methods agree with the exact caster on most
/// rays.
#[test]
fn every_method_is_mostly_right_on_ordinary_scenes() {
    for Set { name, grid, rays } in accuracy::ordinary(1, 2000) {
        let exact = Method::Exact.accept(Cast(&grid, &rays));
        for (method, most) in [
            ("dda", 1.0),
            ("dda32", 0.999),
            ("accumulate", 1.0),
            ("fixed:26", 0.999),
            ("fixed", 0.97),
            ("table:65536", 0.99),
            ("table", 0.95),
            ("march:0.001", 0.99),
        ] {
            let method: Method = method.parse().unwrap();
            let hits = method.accept(Cast(&grid, &rays));
            let agrees = |exact: &Option<Hit>, hit: &Option<Hit>| match (exact, hit) {
                (Some(exact), Some(hit)) => {
                    (exact.cell, exact.side) == (hit.cell, hit.side)
                        && (exact.t - hit.t).abs() < 0.02 * (1.0 + exact.t)
                }
                (exact, hit) => exact.is_none() && hit.is_none(),
            };
            let right = exact.iter().zip(&hits).filter(|(exact, hit)| agrees(exact, hit)).count();
            let share = right as f64 / rays.len() as f64;
            assert!(share >= most, "{name}, {method}: {share} right");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn every_method_returns_sane_hits_for_adversarial_rays(seed in any::<u64>()) {
        let grid = Grid::sketch(&["#.....", "..#..#", ".#....", "......"]).unwrap();
        let mut random = SplitMix64::new(seed);
        let rays: Vec<Ray> = (0..10).map(|_| adversarial_ray(&grid, &mut random)).collect();
        for method in methods().filter(|method| method.to_string() != "table:65536") {
            for (ray, hit) in rays.iter().zip(method.accept(Cast(&grid, &rays))) {
                if let Some(hit) = hit {
                    prop_assert!(is_sane(&grid, &hit), "{}: {:?} hits {:?}", method, ray, hit);
                }
            }
        }
    }
}
