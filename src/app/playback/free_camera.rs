//! A camera that flies through a world with the keys of the game.
//!
//! Forward is where the camera looks, up and down included. Walls do not stop it: closed doors would
//! shut it in. It stays above the map and within a few cells of the ground.

use glam::DVec2;

use crate::game::{Intent, Intents, STEP};
use crate::world::{Camera, Pitch, World};

/// The speed in cells per second, and while running.
const SPEED: f64 = 4.0;
const FAST: f64 = 10.0;
/// The turning speed, in radians per second.
const TURN: f64 = 2.0;
/// The angle of a single exact turn, in radians.
const FINE: f64 = std::f64::consts::PI / 36.0;
/// The change of the slope of the view per second.
const TILT: f64 = 0.6;
/// The range of the eye's height, in cells.
const HEIGHTS: (f64, f64) = (0.1, 12.0);

/// `camera` after a step in which the watcher wants `intents`.
pub(crate) fn flown(camera: Camera, world: &World, intents: Intents) -> Camera {
    let look = intents.look();
    let heading = camera
        .heading
        .turned(TURN * STEP * intents.balance(Intent::TurnRight, Intent::TurnLeft))
        .turned(FINE * intents.balance(Intent::FineRight, Intent::FineLeft))
        .turned(look.turn_radians());
    let tilt = TILT * STEP * intents.balance(Intent::LookUp, Intent::LookDown);
    let pitch = if intents.contains(Intent::LookAhead) {
        Pitch::LEVEL
    } else {
        camera.pitch.tilted(tilt + look.tilt_radians())
    };
    let speed = if intents.contains(Intent::Run) { FAST } else { SPEED };
    let ahead = speed * STEP * intents.balance(Intent::Forward, Intent::Back);
    let aside = speed * STEP * intents.balance(Intent::StrafeRight, Intent::StrafeLeft);
    let way = ahead * heading.direction() + aside * heading.direction().perp();
    // The map ends where there is nothing more to see.
    let least = DVec2::splat(0.05);
    let most = (world.grid().extent() - least).max(least);
    let position = (camera.position() + way).clamp(least, most);
    let eye = (camera.eye() + ahead * pitch.slope()).clamp(HEIGHTS.0, HEIGHTS.1);
    let flown = Camera::new(position, heading, camera.field_of_view);
    flown.and_then(|flown| flown.with_eye(eye)).map_or(camera, |flown| flown.with_pitch(pitch))
}
