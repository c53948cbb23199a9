//! A map with a grid: a game in it, and pictures of it.

use cellcaster::game::{Game, Intents, Rules, is_exit_out_of_reach};
use cellcaster::world::{Difficulty, FieldOfView, World};

use super::intents::{Stretch, stretch, usual};
use super::views::{self, Format, Old};
use crate::bytes::Bytes;
use crate::open::is_in_the_open;

/// The largest number of steps of a game.
const MAX_STEPS: u64 = 600;
/// The number of steps that a wait is compared with.
const STEPS_AT_REST: u64 = 40;
/// The largest number of pictures.
const MAX_PICTURES: usize = 4;

/// Plays in `world`, and draws it before, meanwhile and afterwards.
pub(crate) fn check(world: World, choices: &mut Bytes) {
    // This takes bounded work, whatever it finds.
    is_exit_out_of_reach(&world);
    let script = if choices.is_empty() { usual() } else { Vec::new() };
    let format = Format::new(choices);
    let mut old = Old::new(&format);
    old.check(&world, &world.start_camera(format.field_of_view), &format, choices);
    let difficulty = choices.pick(&[Difficulty::Normal, Difficulty::Easy, Difficulty::Hard]);
    let mut game = Game::with_rules(world, Rules { difficulty, seed: choices.byte().into() });
    check_place(&game);
    for stretch in script {
        play(&mut game, &stretch);
    }
    let mut pictures = 0;
    while !choices.is_empty() && game.steps() < MAX_STEPS && !game.is_finished() {
        let before = game.steps();
        play(&mut game, &stretch(choices));
        if game.steps() == before && game.health().is_gone() {
            break;
        }
        if pictures < MAX_PICTURES && choices.below(4) == 0 {
            pictures += 1;
            let format = Format::new(choices);
            let camera = views::camera(game.world(), &format, choices);
            old.check(game.world(), &camera, &format, choices);
        }
    }
    old.check(game.world(), &game.camera(format.field_of_view), &format, choices);
}

/// Plays a stretch, and checks each step of it.
fn play(game: &mut Game, Stretch { steps, intents }: &Stretch) {
    check_wait(game, *intents);
    for _ in 0..*steps {
        game.step(*intents);
        assert!(game.work() <= Game::MAX_WORK, "a step looks at {} things", game.work());
        check_place(game);
    }
}

/// Checks that the player is not inside anything.
fn check_place(game: &Game) {
    let camera = game.camera(FieldOfView::default());
    let (place, feet, eye) = (camera.position(), game.feet(), camera.eye());
    assert!(is_in_the_open(game.world(), place, feet), "inside of something: {place}, {feet}");
    assert!(feet < eye || feet.abs() > 1e8, "an eye at {eye}, feet at {feet}");
}

/// Checks that a wait equals as many steps of a game at rest.
fn check_wait(game: &Game, intents: Intents) {
    if !game.is_at_rest(intents) {
        return;
    }
    let (mut stepping, mut waiting) = (game.clone(), game.clone());
    for _ in 0..STEPS_AT_REST {
        stepping.step(intents);
    }
    waiting.wait(STEPS_AT_REST);
    assert!(stepping == waiting, "steps at rest are not one wait");
}
