//! A frame of every map of the gallery, and of the flat one as it was drawn before all the others.
//!
//! `cargo bench --no-default-features --bench frame`. An element is a pixel. For ratios between maps
//! there is `--bench prices`, where they take turns.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

#[path = "frame/before.rs"]
mod before;
#[path = "frame/gallery.rs"]
mod gallery;

use before::Before;
use gallery::{Easel, name_of, scenes, sizes};

fn frames(criterion: &mut Criterion) {
    let scenes = scenes();
    let flat = &scenes[0];
    for size in sizes() {
        let mut group = criterion.benchmark_group(name_of(size));
        group.throughput(Throughput::Elements(u64::from(size.width.get() * size.height.get())));
        group.warm_up_time(Duration::from_millis(300));
        group.measurement_time(Duration::from_secs(2));
        let mut before = Before::new(size);
        group.bench_function("flat, before", |bencher| {
            bencher.iter(|| {
                before.render(&flat.world, black_box(&flat.camera));
                black_box(before.pixels());
            });
        });
        let mut easel = Easel::new(size);
        for scene in &scenes {
            group.bench_function(&scene.name, |bencher| {
                bencher.iter(|| _ = black_box(easel.draw(black_box(scene))));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
