//! Times the 3-D caster for a pixel, in the gallery's scene.
//!
//! `cargo bench -p cellcaster-lab --bench space`. An element is a pixel.

use std::hint::black_box;

use cellcaster::map::{self, Level, NoFiles};
use cellcaster::render::{Frame, FrameSize, PixelAspect};
use cellcaster::space::Renderer;
use cellcaster::world::FieldOfView;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const MAP: &str = include_str!("../../../maps/gallery/spheres.toml");
const SIZES: [(u32, u32); 3] = [(80, 48), (320, 200), (1920, 1080)];

fn space(criterion: &mut Criterion) {
    let level = map::parse_level(MAP, "spheres", &NoFiles);
    let Ok(Level::Space(scene)) = level else { panic!("the gallery's map is one of bodies") };
    let camera = scene.start_camera(FieldOfView::default());
    let mut group = criterion.benchmark_group("space");
    for (width, height) in SIZES {
        let size = FrameSize::new(width, height).expect("no side of these is zero");
        let mut frame = Frame::new(size, PixelAspect::SQUARE);
        let mut renderer = Renderer::new();
        group.throughput(Throughput::Elements(u64::from(width) * u64::from(height)));
        group.bench_function(BenchmarkId::from_parameter(format!("{width}x{height}")), |bencher| {
            bencher.iter(|| renderer.render(black_box(&scene), &camera, &mut frame));
        });
    }
    group.finish();
}

criterion_group!(benches, space);
criterion_main!(benches);
