//! Rays that cross many cells before they hit.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Set, all, made};
use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;

pub(crate) fn sets(random: &mut SplitMix64) -> Vec<Set> {
    vec![corridor(), long_map(), plain(random)]
}

/// A corridor of 10⁵ cells, one cell wide.
fn corridor() -> Set {
    let length = 100_000;
    let last = length - 1;
    let grid = made(length, 3, |column, row| row != 1 || column == 0 || column == last);
    let origins = [(1.5, 1.5), (1.1, 1.0 + 1e-9)].map(DVec2::from);
    let directions = [(1.0, 0.0), (1.0, 1e-6), (1.0, 4.9e-6), (1.0, 5.1e-6), (1.0, -1e-300)];
    Set { name: "corridor", grid, rays: all(&origins, &directions.map(DVec2::from)) }
}

/// A map of 10⁶ cells with walls close to the ray where it crosses the line between two rows.
fn long_map() -> Set {
    let length = 1_000_000;
    let grid = made(length, 4, |column, row| row % 3 == 0 || column == length - 1);
    let slope = 1.0 / 3e5;
    let directions = [(1.0, slope), (0.7, 0.7 * slope), (1.0, 1e-6)].map(DVec2::from);
    Set { name: "long map", grid, rays: all(&[DVec2::new(0.5, 1.0)], &directions) }
}

/// An open plain of 4096 × 4096 cells, with a wall around it.
fn plain(random: &mut SplitMix64) -> Set {
    let size = 4096;
    let is_edge = |index: u32| index == 0 || index == size - 1;
    let grid = made(size, size, |column, row| is_edge(column) || is_edge(row));
    let mut rays = all(
        &[DVec2::new(1.5, 1.5), DVec2::new(1.0, 1.0), DVec2::new(2048.5, 2048.5)],
        &[(1.0, 1.0), (2.0, 1.0), (-1.0, -1.0), (1.0, 1.0 + f64::EPSILON)].map(DVec2::from),
    );
    for _ in 0..30 {
        let origin = DVec2::new(random.between(1.0, 4095.0), random.between(1.0, 4095.0));
        let (sine, cosine) = libm::sincos(random.between(0.0, TAU));
        rays.extend(Ray::new(origin, DVec2::new(cosine, sine)));
    }
    Set { name: "plain", grid, rays }
}
