//! The exact caster compared with rational arithmetic: cell and side are equal, the distance is
//! within two units in its last place, and the texture coordinate is within 10⁻¹².

use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::rng::SplitMix64;
use cellcaster::world::Grid;
use cellcaster_lab::accuracy::{self, random_ray};
use proptest::prelude::*;

use crate::adversarial::adversarial_ray;

/// The difference between the exact caster and rational arithmetic for `ray`, if there is one.
fn fault(grid: &Grid, ray: &Ray) -> Option<String> {
    let (truth, hit) = (accuracy::cast(grid, ray), Exact.cast(grid, ray));
    let is_right = match (&truth, &hit) {
        (Some(truth), Some(hit)) => {
            truth.is_met_by(hit)
                && truth.t.error_in_ulps(hit.t) <= 2.0
                && truth.u.error(hit.u) <= 1e-12
        }
        (truth, hit) => truth.is_none() && hit.is_none(),
    };
    let explain = || {
        let truth = truth.map(|truth| (truth.cell, truth.side, truth.t.to_f64(), truth.u.to_f64()));
        format!("{ray:?} hits {truth:?}, but the exact caster says {hit:?}")
    };
    (!is_right).then(explain)
}

/// Random mazes of at most 17 × 13 cells, with walls in about every third cell.
fn maze(random: &mut SplitMix64) -> Grid {
    let (width, height) = (random.whole(1, 17) as usize, random.whole(1, 13) as usize);
    let rows: Vec<String> = (0..height)
        .map(|_| (0..width).map(|_| if random.whole(0, 2) == 0.0 { '#' } else { '.' }).collect())
        .collect();
    let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
    Grid::sketch(&rows).expect("a maze is a rectangle")
}

#[test]
fn every_stiff_set_matches_exact_arithmetic() {
    for set in accuracy::sets(1).into_iter().chain(accuracy::ordinary(1, 500)) {
        let faults: Vec<String> = set.rays.iter().filter_map(|ray| fault(&set.grid, ray)).collect();
        assert!(faults.is_empty(), "{}: {}\n{}", set.name, faults.len(), faults[0]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_and_adversarial_rays_match_exact_arithmetic(seed in any::<u64>()) {
        let mut random = SplitMix64::new(seed);
        let grid = maze(&mut random);
        for _ in 0..5 {
            prop_assert_eq!(fault(&grid, &random_ray(&grid, &mut random)), None);
            prop_assert_eq!(fault(&grid, &adversarial_ray(&grid, &mut random)), None);
        }
    }

    #[test]
    fn rays_of_any_doubles_match_exact_arithmetic(
        origin in (any::<f64>(), any::<f64>()),
        direction in (any::<f64>(), any::<f64>()),
        seed in any::<u64>(),
    ) {
        let ray = Ray::new(origin.into(), direction.into());
        prop_assume!(ray.is_ok());
        prop_assert_eq!(fault(&maze(&mut SplitMix64::new(seed)), &ray.unwrap()), None);
    }
}

#[test]
fn a_million_rays_match_exact_arithmetic() {
    let mut random = SplitMix64::new(2026);
    for _ in 0..10_000 {
        let grid = maze(&mut random);
        for _ in 0..50 {
            assert_eq!(fault(&grid, &random_ray(&grid, &mut random)), None);
            assert_eq!(fault(&grid, &adversarial_ray(&grid, &mut random)), None);
        }
    }
}
