//! Times a frame of every map of the gallery, and a frame of the flat one by the baseline renderer.
//!
//! `cargo bench -p cellcaster-lab --bench frame`. An element is a pixel. For ratios between maps,
//! use `--bench prices`, in which they take turns.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

#[path = "frame/baseline.rs"]
mod baseline;
#[path = "frame/gallery.rs"]
mod gallery;

use baseline::Baseline;
use gallery::{Drawing, flat, name_of, scenes, sizes};

fn frames(criterion: &mut Criterion) {
    let scenes = scenes();
    let (world, camera) = flat(&scenes[0]);
    for size in sizes() {
        let mut group = criterion.benchmark_group(name_of(size));
        group.throughput(Throughput::Elements(u64::from(size.width.get() * size.height.get())));
        group.warm_up_time(Duration::from_millis(300));
        group.measurement_time(Duration::from_secs(2));
        let mut baseline = Baseline::new(size);
        group.bench_function("flat, before", |bencher| {
            bencher.iter(|| {
                baseline.render(world, black_box(&camera));
                black_box(baseline.pixels());
            });
        });
        let mut drawing = Drawing::new(size);
        for scene in &scenes {
            group.bench_function(&scene.name, |bencher| {
                bencher.iter(|| _ = black_box(drawing.draw(black_box(scene))));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
