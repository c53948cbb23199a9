//! The levels and the gallery: no pixel is wrong, and a wrong one is found.

use std::fs;
use std::path::{Path, PathBuf};

use cellcaster::game::{Game, Rules, Script};
use cellcaster::map::builtin;
use cellcaster::map::{self, Level};
use cellcaster::render::FrameSize;
use cellcaster::world::{Camera, Difficulty, FieldOfView, Heading, World};
use cellcaster_certify::{Counts, compare, draw};

fn maps() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../maps")
}

fn counts(world: &World, camera: &Camera) -> Counts {
    let frame = draw(world, camera, FrameSize::new(48, 30).unwrap());
    let (counts, wrong) = compare(world, camera, &frame);
    assert_eq!(wrong, None, "{:?} of {:?}", camera, world.title());
    counts
}

#[test]
fn no_pixel_of_the_gallery_is_wrong() {
    for entry in fs::read_dir(maps().join("gallery")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|it| it != "toml") {
            continue;
        }
        let Level::Grid(world) = map::load_level(&path).unwrap() else { continue };
        let game = Game::new(*world);
        let start = game.camera(FieldOfView::default());
        for degrees in [11.0, 101.0, 191.0, 281.0] {
            let heading = Heading::from_degrees(degrees).unwrap();
            let camera = Camera::new(start.position(), heading, FieldOfView::default()).unwrap();
            counts(game.world(), &camera.with_eye(start.eye()).unwrap());
        }
    }
}

#[test]
fn no_pixel_of_the_games_that_win_is_wrong() {
    const STEPS_BETWEEN: usize = 900;
    let mut sum = Counts::default();
    for level in builtin::LEVELS {
        let name = format!("{}.normal.script", level.name);
        let text = fs::read_to_string(maps().join("scripts").join(&name)).unwrap();
        let script = Script::parse(&text, &name).unwrap();
        let rules = Rules { difficulty: Difficulty::Normal, ..script.header().rules() };
        let mut game = Game::with_rules(level.world().unwrap(), rules);
        for (step, (_, intents)) in script.iter().enumerate() {
            game.step(intents);
            if step % STEPS_BETWEEN == 0 {
                sum += counts(game.world(), &game.camera(FieldOfView::default()));
            }
        }
    }
    assert!(sum.in_doubt * 200 < sum.pixels, "{sum}");
}

#[test]
fn a_wrong_pixel_is_found() {
    let world = builtin::LEVELS[1].world().unwrap();
    let camera = world.start_camera(FieldOfView::default());
    let moved = camera.with_eye(camera.eye() + 0.01).unwrap();
    let frame = draw(&world, &moved, FrameSize::new(48, 30).unwrap());
    let (counts, first) = compare(&world, &camera, &frame);
    assert!(counts.wrong > 20 && first.is_some(), "{counts}");
}
