//! The built-in levels: each can be finished, the player cannot get stuck, and the solution is the
//! intended one.

use std::collections::BTreeSet;

use crate::reach::{Gait, Keys, Place, Reach};
use cellcaster::map::{self, builtin};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Heading, Pitch, World};
use glam::DVec2;

/// The levels that need jumps, mirrors and heights.
const LEVELS: [&str; 2] = ["cistern", "observatory"];

fn text(name: &str) -> &'static str {
    builtin::LEVELS.iter().find(|level| level.name == name).unwrap().text
}

fn world(name: &str) -> World {
    map::parse_str(text(name)).unwrap()
}

fn reach(world: &World, gait: Gait) -> Reach<'_> {
    Reach { world, gait, keys: Keys::new(), takes_keys: true }
}

#[test]
fn the_exit_needs_a_jump() {
    for name in LEVELS {
        let world = world(name);
        let mut reach = reach(&world, Gait::Walks);
        let places = reach.from(reach.start());
        assert!(!reach.has_exit(&places), "{name}");
    }
}

/// This holds for any skill in jumping.
#[test]
fn the_exit_needs_the_key() {
    for name in ["citadel", "cistern", "observatory"] {
        let world = world(name);
        let mut reach = Reach { takes_keys: false, ..reach(&world, Gait::Jumps) };
        let places = reach.from(reach.start());
        assert!(!reach.has_exit(&places), "{name}");
    }
}

/// From every position that the best jumper reaches, an average player can reach the exit.
#[test]
fn the_player_cannot_get_stuck() {
    for name in LEVELS {
        let world = world(name);
        let mut safe = BTreeSet::<Place>::new();
        let mut keys = Keys::new();
        loop {
            let lucky = Reach { keys: keys.clone(), ..reach(&world, Gait::Jumps) };
            let places = Reach { takes_keys: false, ..lucky.clone() }.from(lucky.start());
            for place in places {
                let mut sure = Reach { keys: keys.clone(), ..reach(&world, Gait::IsSure) };
                assert!(sure.gets_out(place, &safe), "{name}: {place:?} with the keys {keys:?}");
                safe.insert(place);
            }
            // The search uses all keys that are in reach already.
            let mut lucky = lucky;
            lucky.from(lucky.start());
            if lucky.keys == keys {
                break;
            }
            keys = lucky.keys;
        }
    }
}

/// The view from the edge of the balcony above one of the shafts.
fn picture(world: &World, row: f64, degrees: f64) -> Frame {
    let heading = Heading::from_degrees(degrees).unwrap();
    let camera = Camera::new(DVec2::new(36.7, row), heading, FieldOfView::default()).unwrap();
    let camera = camera.with_pitch(Pitch::from_degrees(-15.0).unwrap());
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(world, &camera, &mut frame);
    frame
}

/// The mirror opposite shows which of the shafts in the cistern is lit. Nothing else shows it.
#[test]
fn a_mirror_shows_which_shaft_to_take() {
    const MIRROR: &str = "\"M\" = { mirror = \"#a8c0c0\", opacity = 0.1, height = 2 }";
    const TORCH: &str = "\"i\" = { sprite = \"torch\", on = \"T\", reach = 5, light = 0.9 }";
    let text = text("cistern");
    assert!(text.contains(MIRROR) && text.contains(TORCH));
    // A torch that lights nothing replaces the torch with a little light.
    let unlit = |text: &str| text.replace(TORCH, &TORCH.replace("0.9", "0"));
    let without = |text: &str| unlit(text).replace("Ti", "TT");
    let shows_torch = |text: &str, row: f64, degrees: f64| {
        let [with, without] =
            [unlit(text), without(text)].map(|text| map::parse_str(&text).unwrap());
        picture(&with, row, degrees) != picture(&without, row, degrees)
    };
    assert!(shows_torch(text, 12.0, 0.0), "it is above the lit one");
    for row in [15.0, 18.0, 21.0] {
        assert!(!shows_torch(text, row, 0.0), "it is above another, in row {row}");
    }
    let walled = text.replace(MIRROR, "\"M\" = { wall = \"moss\", height = 2 }");
    for degrees in [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0] {
        assert!(!shows_torch(&walled, 12.0, degrees), "without a mirror, at {degrees} degrees");
    }
}
