//! What grows with the map: a ray with the open distance, a frame and the loading with the area.
//!
//! `cargo bench --no-default-features --bench growth`. A hall is empty but for the walls around it; a
//! plain has, besides, a pillar in one cell of 4096. In a map of `n` × `n` cells each of the rays goes
//! nearly `n` cells across, half of them along the rows and half along the columns; on the plain, it
//! is a pillar's fault if one does not get that far. An element is a ray. All maps take their turns
//! one after the other, so compare within one run only.

use std::fmt::Write;
use std::hint::black_box;

use cellcaster::cast::{Caster, Exact, Ray, Walk};
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{FieldOfView, World};
use criterion::{
    BatchSize, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use glam::{DVec2, Vec2Swizzles};

/// The sides of the maps that rays are cast in.
const DISTANCES: [u32; 5] = [16, 64, 256, 1024, 4096];
/// The sides of the maps that are drawn and loaded.
const SIDES: [u32; 4] = [64, 256, 1024, 4096];
/// How many rays are cast in a map.
const RAYS: u32 = 256;

/// What stands in an open map.
#[derive(Clone, Copy)]
struct Ground {
    name: &'static str,
    /// Whether there are pillars.
    is_plain: bool,
}

const GROUNDS: [Ground; 2] =
    [Ground { name: "hall", is_plain: false }, Ground { name: "plain", is_plain: true }];

impl Ground {
    /// The map, as one writes it.
    fn map(self, side: u32) -> String {
        let last = side - 1;
        let mut text = String::from("grid = '''\n");
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let is_edge = row == 0 || column == 0 || row == last || column == last;
            text.push(if is_edge || (self.is_plain && is_pillar(column, row)) {
                '#'
            } else if (column, row) == (1, side / 2) {
                '@'
            } else {
                '.'
            });
            if column == last {
                text.push('\n');
            }
        }
        writeln!(text, "'''\n[tiles]\n'#'.wall = 'brick'\n[things]\n'@'.start = 0")
            .expect("a text takes what is written");
        text
    }

    fn world(self, side: u32) -> World {
        map::parse_str(&self.map(side)).unwrap_or_else(|faults| panic!("{faults}"))
    }
}

/// Whether a plain has a pillar there: in the middle of what is some 64 cells on a side, or a bit off.
fn is_pillar(column: u32, row: u32) -> bool {
    let (within, block) = (|place: u32| place % 64, |place: u32| place / 64);
    let moved = |by: u32| 16 + (block(column) * 37 + block(row) * 101 + by * 53) % 32;
    (within(column), within(row)) == (moved(0), moved(1))
}

/// Rays that cross a map of that side, along the rows and along the columns.
fn rays(side: u32) -> Vec<Ray> {
    let ray = |index: u32| {
        let share = f64::from(index) / f64::from(RAYS);
        let start = DVec2::new(1.5, f64::from(side) * (0.45 + 0.1 * share));
        let direction = DVec2::new(1.0, 0.8 * (share * 7.3).fract() - 0.4);
        if index.is_multiple_of(2) { (start, direction) } else { (start.yx(), direction.yx()) }
    };
    let cast = |index| {
        let (start, direction) = ray(index);
        Ray::new(start, direction).expect("both are finite, and it goes somewhere")
    };
    (0..RAYS).map(cast).collect()
}

fn cast(criterion: &mut Criterion) {
    for ground in GROUNDS {
        let mut group = criterion.benchmark_group(format!("rays in a {}", ground.name));
        group.throughput(Throughput::Elements(u64::from(RAYS)));
        for side in DISTANCES {
            let (world, rays) = (ground.world(side), rays(side));
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
    for ground in GROUNDS {
        let mut group = criterion.benchmark_group(format!("frame of a {}", ground.name));
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
        let text = GROUNDS[1].map(side);
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
