//! Compares Cellcaster's encoder with ratatui's own for crossterm: the time from changed cells to
//! bytes.
//!
//! `cargo bench -p cellcaster-lab --bench encode`. One iteration is a walk through the citadel at
//! 120×40, and an element is a frame. The encoders take turns, so only figures of the same run are
//! comparable.

use std::convert::Infallible;
use std::fmt::Write as _;
use std::hint::black_box;
use std::num::NonZeroU32;

use cellcaster::app::{Levels, Replay, Settings};
use cellcaster::game::{Script, Stretch};
use cellcaster::map::builtin;
use cellcaster::terminal::{CellWriter, Fidelity};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;

const SIZE: Size = Size::new(120, 40);

/// Each stretch of the script is shortened to this fraction of its length.
const SHARE: u32 = 4;

/// The changed cells of a frame.
type Changes = Vec<(u16, u16, Cell)>;

fn encode(criterion: &mut Criterion) {
    let frames = frames();
    let mut group = criterion.benchmark_group("encode 120x40");
    group.sample_size(20);
    group.throughput(Throughput::Elements(frames.len() as u64));
    group.bench_function("stock", |bencher| {
        bencher.iter(|| {
            let mut bytes = Vec::new();
            for frame in &frames {
                bytes.clear();
                send(&mut CrosstermBackend::new(&mut bytes), frame);
                black_box(&bytes);
            }
        });
    });
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        group.bench_function(fidelity.to_string(), |bencher| {
            bencher.iter(|| {
                let mut writer = CellWriter::new(Vec::new(), SIZE);
                writer.set_fidelity(fidelity);
                for frame in &frames {
                    writer.output_mut().clear();
                    send(&mut writer, frame);
                    black_box(writer.output_mut());
                }
            });
        });
    }
}

/// Sends one frame as ratatui does without a cursor. Writing to memory cannot fail.
fn send<B: Backend>(backend: &mut B, changes: &Changes) {
    _ = backend.draw(changes.iter().map(|(x, y, cell)| (*x, *y, cell)));
    _ = backend.hide_cursor();
    _ = Backend::flush(backend);
}

fn frames() -> Vec<Changes> {
    let citadel = builtin::LEVELS.iter().find(|level| level.name == "citadel");
    let world = citadel.expect("it is built in").world().expect("built-in levels have no faults");
    let levels = Levels::new(world.into(), std::iter::empty());
    let frames_per_second = NonZeroU32::new(30).expect("30 is not zero");
    let mut before = Buffer::empty(SIZE.into());
    let mut frames = Vec::new();
    let mut replay = Replay::new(levels, Settings::default(), SIZE);
    let Ok(()) = replay.play(&script(), frames_per_second, |_, _, picture| {
        let changes = before.diff(picture);
        frames.push(changes.into_iter().map(|(x, y, cell)| (x, y, cell.clone())).collect());
        before.clone_from(picture);
        Ok::<(), Infallible>(())
    });
    frames
}

/// The committed script, with each stretch shortened.
fn script() -> Script {
    let whole = include_str!("../../../maps/showcase.script");
    let whole = Script::parse(whole, "showcase").expect("the committed script has no faults");
    let mut text = String::new();
    for section in whole.sections() {
        _ = writeln!(text, "[{}]", section.name);
        for stretch in &section.stretches {
            _ = writeln!(text, "{}", Stretch { steps: stretch.steps / SHARE, ..*stretch });
        }
    }
    Script::parse(&text, "short").expect("shorter stretches have no faults either")
}

criterion_group!(benches, encode);
criterion_main!(benches);
