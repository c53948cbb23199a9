//! Costs that grow with the map: the cost of a ray with the open distance, and the costs of a frame
//! and of loading with the area.
//!
//! `cargo bench -p cellcaster-lab --bench growth`, on the maps of `cellcaster-lab bench`. A hall is
//! empty except for the walls around it; a plain also has a pillar in one cell of 4096. In a map of
//! `n` × `n` cells, each ray crosses nearly `n` cells. An element is a ray. All maps take turns, so
//! only figures of the same run are comparable.

use std::hint::black_box;

use cellcaster::cast::{Caster, Exact, Walk};
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;
use cellcaster_lab::speed::{Ground, SIDES, crossing_rays};
use criterion::{
    BatchSize, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};

fn cast(criterion: &mut Criterion) {
    for ground in Ground::ALL {
        let mut group = criterion.benchmark_group(format!("rays in a {}", ground.name()));
        for side in SIDES {
            let (world, rays) = (ground.world(side), crossing_rays(side));
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.bench_function(BenchmarkId::new("walk", side), |bencher| {
                bencher.iter(|| {
                    for ray in &rays {
                        black_box(Walk::new(world.grid(), black_box(ray)).first_solid());
                    }
                });
            });
            group.bench_function(BenchmarkId::new("exact", side), |bencher| {
                bencher.iter(|| {
                    for ray in &rays {
                        black_box(Exact.cast(world.grid(), black_box(ray)));
                    }
                });
            });
        }
        group.finish();
    }
}

fn draw(criterion: &mut Criterion) {
    let size = FrameSize::new(160, 90).expect("neither is zero");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    for ground in Ground::ALL {
        let mut group = criterion.benchmark_group(format!("frame of a {}", ground.name()));
        for side in SIDES {
            let world = ground.world(side);
            let camera = world.start_camera(FieldOfView::default());
            let mut renderer = Renderer::new();
            group.bench_function(BenchmarkId::from_parameter(side), |bencher| {
                bencher.iter(|| renderer.render(&world, black_box(&camera), &mut frame));
            });
        }
        group.finish();
    }
}

fn load(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("loading a plain");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for side in SIDES {
        let text = Ground::Plain.map(side);
        group.throughput(Throughput::Elements(u64::from(side) * u64::from(side)));
        group.bench_function(BenchmarkId::from_parameter(side), |bencher| {
            let parse =
                || map::parse_str(black_box(&text)).unwrap_or_else(|faults| panic!("{faults}"));
            bencher.iter_batched(|| (), |()| parse(), BatchSize::PerIteration);
        });
    }
    group.finish();
}

criterion_group!(benches, cast, draw, load);
criterion_main!(benches);
