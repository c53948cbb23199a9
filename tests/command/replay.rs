//! For any intents, repeated any number of times, the frames are equal and the player is never
//! inside a wall.

use crate::geometry::clearance;
use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map::builtin;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;
use glam::DVec2;
use proptest::prelude::*;

/// The player's radius.
const RADIUS: f64 = 0.25;

fn wants() -> impl Strategy<Value = Vec<(Intents, u8)>> {
    let intents = prop::collection::vec(prop::sample::select(&Intent::ALL[..]), 0..4);
    let held = intents.prop_map(|intents| intents.into_iter().collect::<Intents>());
    prop::collection::vec((held, 1_u8..40), 1..30)
}

/// The position of the player after a step, and the distance to the nearest wall.
type Place = (DVec2, f64);

/// Every position on the way, and a frame after each of `wants`.
fn play(level: usize, wants: &[(Intents, u8)]) -> (Vec<Place>, Vec<Frame>) {
    let mut game = Game::new(builtin::LEVELS[level].world().unwrap());
    let mut renderer = Renderer::new();
    let (mut places, mut frames) = (Vec::new(), Vec::new());
    for &(intents, steps) in wants {
        for _ in 0..steps {
            game.step(intents);
            let position = game.camera(FieldOfView::default()).position();
            places.push((position, clearance(game.world(), position)));
        }
        let mut frame = Frame::new(FrameSize::new(40, 24).unwrap(), PixelAspect::SQUARE);
        renderer.render(game.world(), &game.camera(FieldOfView::default()), &mut frame);
        frames.push(frame);
    }
    (places, frames)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_same_intents_give_the_same_frames(level in 0..builtin::LEVELS.len(), wants in wants()) {
        let (places, frames) = play(level, &wants);
        let (places_again, frames_again) = play(level, &wants);
        prop_assert_eq!(places, places_again);
        prop_assert!(frames == frames_again);
    }

    #[test]
    fn the_player_is_never_inside_a_wall(level in 0..builtin::LEVELS.len(), wants in wants()) {
        for (position, clearance) in play(level, &wants).0 {
            prop_assert!(clearance >= RADIUS, "{} from a wall, at {}", clearance, position);
        }
    }
}
