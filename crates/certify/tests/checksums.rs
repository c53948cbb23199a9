//! Checksums of frames and of final states, which are the same on every machine.
//!
//! `.ci/checksums` runs this test on this processor and, by QEMU, on aarch64. `.ci/checksums keep` keeps new ones.

use std::path::Path;
use std::{env, fs};

use cellcaster::game::{Game, Script};
use cellcaster::map::builtin;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::rng::hash;
use cellcaster::world::FieldOfView;

/// The number of frames of each script, at equal intervals.
const FRAMES: usize = 14;

/// The checksums of the frames of the script `name` and of its last state, in a line.
fn line(name: &str, text: &str) -> String {
    let script = Script::parse(text, name).unwrap();
    let level = script.header().level.as_ref().unwrap().as_str();
    let level = builtin::LEVELS.iter().find(|it| it.name == level).unwrap();
    let mut game = Game::with_rules(level.world().unwrap(), script.header().rules());
    let every = script.steps() as usize / FRAMES;
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut sums = Vec::new();
    for (step, (_, intents)) in script.iter().enumerate() {
        game.step(intents);
        if step % every == 0 && step / every < FRAMES {
            let filters = [Filter::Nearest, Filter::Mip, Filter::Area];
            renderer.set_filter(filters[step / every % filters.len()]);
            renderer.render(game.world(), &game.camera(FieldOfView::default()), &mut frame);
            let pixels = frame.rows().flatten();
            let words =
                pixels.map(|it| it.channels().iter().fold(0, |sum, &it| sum << 8 | u64::from(it)));
            sums.push(format!("{:08x}", hash(0, words) >> 32));
        }
    }
    format!("{name} {:016x} {}\n", game.checksum(), sums.join(" "))
}

#[test]
fn frames_and_final_states_have_the_kept_checksums() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let kept = here.join("tests/checksums.txt");
    let scripts = fs::read_dir(here.join("../../maps/scripts")).unwrap();
    let mut scripts: Vec<_> = scripts.map(|entry| entry.unwrap().path()).collect();
    scripts.sort();
    let lines = scripts.iter().map(|path| {
        line(path.file_stem().unwrap().to_str().unwrap(), &fs::read_to_string(path).unwrap())
    });
    let lines: String = lines.collect();
    if env::var_os("CELLCASTER_KEEP_CHECKSUMS").is_some() {
        fs::write(&kept, &lines).unwrap();
    }
    assert!(lines.lines().flat_map(|line| line.split(' ').skip(2)).count() >= 500);
    let kept = fs::read_to_string(kept).unwrap();
    assert_eq!(lines.lines().count(), kept.lines().count());
    for (line, kept) in lines.lines().zip(kept.lines()) {
        assert_eq!(line, kept);
    }
}
