//! Rays whose instructions `.ci/accuracy count` counts.
//!
//! Each method casts the rays of each ordinary scene once, inside [`counted`], and only the
//! instructions of that function are counted. For each call, the program prints a line with the
//! scene, the method and the number of rays.

use std::hint::black_box;

use cellcaster::cast::{Caster, Ray};
use cellcaster_lab::accuracy::{RAYS, SEED, ordinary, plain};
use cellcaster_lab::casters::{Method, Visitor};
use cellcaster::world::Grid;

struct Rays<'a> {
    grid: &'a Grid,
    rays: &'a [Ray],
}

impl Visitor for Rays<'_> {
    type Output = ();

    fn visit<C: Caster>(self, caster: &C) {
        counted(caster, self.grid, self.rays);
    }
}

fn main() {
    let sets = ordinary(SEED, RAYS).into_iter().chain([plain(SEED, RAYS)]);
    for set in sets {
        for method in Method::all() {
            method.accept(Rays { grid: &set.grid, rays: &set.rays });
            println!("{} {method} {}", set.name, set.rays.len());
        }
    }
}

/// Casts the rays that are counted.
#[inline(never)]
fn counted<C: Caster>(caster: &C, grid: &Grid, rays: &[Ray]) {
    for ray in rays {
        black_box(caster.cast(grid, black_box(ray)));
    }
}
