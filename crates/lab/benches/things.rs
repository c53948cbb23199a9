//! Compares frames of the same things in view, with few and with many things elsewhere.
//!
//! `cargo bench -p cellcaster-lab --bench things`, on the maps of `cellcaster-lab bench`. All
//! numbers of things take turns within a hall, so only figures of the same run are comparable.

use std::hint::black_box;

use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;
use cellcaster_lab::speed::{CROWDS, Vista};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn things(criterion: &mut Criterion) {
    let size = FrameSize::new(160, 90).expect("neither is zero");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    for vista in Vista::ALL {
        let mut group = criterion.benchmark_group(vista.name());
        for count in CROWDS {
            let world = vista.world(count);
            let camera = world.start_camera(FieldOfView::default());
            let mut renderer = Renderer::new();
            group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
                bencher.iter(|| renderer.render(&world, black_box(&camera), &mut frame));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, things);
criterion_main!(benches);
