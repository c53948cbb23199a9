//! Compares all methods on the same rays, in three ordinary scenes.
//!
//! `cargo bench -p cellcaster-lab --bench casters`. An element is a ray. The methods take turns
//! within a scene, so only figures of the same run are comparable.

use std::hint::black_box;

use cellcaster::cast::{Caster, Ray};
use cellcaster::world::Grid;
use cellcaster_lab::accuracy::{self, Set};
use cellcaster_lab::casters::{Method, Visitor};
use criterion::{Bencher, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const RAYS: usize = 4096;

/// Measures the time of a caster for all rays.
struct Measure<'a, 'b> {
    grid: &'a Grid,
    rays: &'a [Ray],
    bencher: &'a mut Bencher<'b>,
}

impl Visitor for Measure<'_, '_> {
    type Output = ();

    fn visit<C: Caster>(self, caster: &C) {
        let Self { grid, rays, bencher } = self;
        bencher.iter(|| {
            for ray in rays {
                black_box(caster.cast(grid, black_box(ray)));
            }
        });
    }
}

fn casters(criterion: &mut Criterion) {
    for Set { name, grid, rays } in accuracy::ordinary(1, RAYS) {
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(rays.len() as u64));
        for method in Method::all() {
            let id = BenchmarkId::from_parameter(&method);
            group.bench_function(id, |bencher| {
                method.accept(Measure { grid: &grid, rays: &rays, bencher });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, casters);
criterion_main!(benches);
