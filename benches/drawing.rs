//! Our drawing beside the classic loop and a fill, at five sizes.
//!
//! `cargo bench --no-default-features --features speed --bench drawing`. An element is a pixel. They
//! take turns within a size, so compare within one run only.

use std::hint::black_box;

use cellcaster::render::{Frame, FrameSize, Renderer};
use cellcaster::speed::{self, Classic, ClassicFloor};
use cellcaster::world::World;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const SIZES: [(u32, u32); 5] = [(160, 90), (320, 200), (640, 480), (1920, 1080), (3840, 2160)];

/// Cameras along the walk, one a picture.
const CAMERAS: usize = 64;

fn drawing(criterion: &mut Criterion) {
    let scenes = [
        (
            "planes",
            speed::textured_scene(),
            &[ClassicFloor::ByColumn, ClassicFloor::ByScanline][..],
        ),
        ("walls", speed::plain_scene(), &[ClassicFloor::None]),
    ];
    for (width, height) in SIZES {
        for (scene, world, floors) in &scenes {
            compare(criterion, (width, height), scene, world, floors);
        }
    }
}

fn compare(
    criterion: &mut Criterion,
    (width, height): (u32, u32),
    scene: &str,
    world: &World,
    floors: &[ClassicFloor],
) {
    let mut group = criterion.benchmark_group(format!("{scene} {width}x{height}"));
    group.sample_size(10);
    group.throughput(Throughput::Elements(u64::from(width) * u64::from(height)));
    let size = FrameSize::new(width, height).expect("no side is zero");
    let cameras = speed::walk(world, CAMERAS);
    let mut frame = Frame::new(size, speed::pixel_aspect(size));
    let mut pixels = vec![0; (width * height) as usize];
    let mut renderer = Renderer::new();
    let mut turn = 0;
    let mut next = || {
        turn = (turn + 1) % cameras.len();
        &cameras[turn]
    };
    group.bench_function("ours", |bencher| {
        bencher.iter(|| renderer.render(world, next(), black_box(&mut frame)));
    });
    let classic = Classic::new(world);
    for &floor in floors {
        group.bench_function(format!("classic {floor:?}"), |bencher| {
            bencher.iter(|| {
                let size = (width as usize, height as usize);
                classic.draw(next(), floor, size, black_box(&mut pixels));
            });
        });
    }
    group.bench_function("fill", |bencher| {
        let mut color = 0_u32;
        bencher.iter(|| {
            color = color.wrapping_add(1);
            speed::fill(black_box(&mut pixels), color);
        });
    });
    group.finish();
}

criterion_group!(benches, drawing);
criterion_main!(benches);
