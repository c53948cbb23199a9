//! A map of bodies: a flight through it, and pictures of it.

use cellcaster::game::Flight;
use cellcaster::render::Frame;
use cellcaster::space::{Camera, Renderer, Scene};

use super::intents::{stretch, usual};
use super::views::{Format, check_equal};
use crate::bytes::Bytes;

const MAX_STEPS: usize = 400;

/// The smallest distance from the player to a body, less a margin for rounding.
fn least_clearance(scale: f64) -> f64 {
    cellcaster::space::EYE_CLEARANCE - 1e-12 * scale.max(1.0)
}

/// Flies through `scene`, and draws it before and afterwards.
pub(crate) fn check(scene: Scene, choices: &mut Bytes) {
    let script = if choices.is_empty() { usual() } else { Vec::new() };
    let format = Format::new(choices);
    let mut flight = Flight::new(scene);
    let mut old = (Renderer::new(), format.frame());
    check_pictures(&mut old, &flight, &format);
    for stretch in &script {
        (0..stretch.steps).for_each(|_| fly(&mut flight, stretch.intents));
    }
    let mut steps = 0;
    while !choices.is_empty() && steps < MAX_STEPS {
        let stretch = stretch(choices);
        for _ in 0..stretch.steps {
            fly(&mut flight, stretch.intents);
            steps += 1;
        }
    }
    check_pictures(&mut old, &flight, &Format::new(choices));
}

/// Takes one step, and checks that the player is not in any body.
fn fly(flight: &mut Flight, intents: cellcaster::game::Intents) {
    let mut waiting = flight.clone();
    let rests = flight.is_at_rest(intents);
    flight.step(intents);
    if rests {
        waiting.wait(1);
        assert!(*flight == waiting, "a step at rest is not a wait");
    }
    let place = flight.camera(Default::default()).position();
    let least = least_clearance(place.abs().max_element());
    for body in &flight.scene().bodies {
        let (distance, _) = body.shape.signed_distance(place);
        assert!(distance >= least, "{distance} from {body:?} at {place}");
    }
}

/// Draws a picture in every way, and checks that all results are equal.
fn check_pictures(old: &mut (Renderer, Frame), flight: &Flight, format: &Format) {
    let camera: Camera = flight.camera(format.field_of_view);
    old.1.resize(format.size, format.pixel_aspect);
    old.0.render(flight.scene(), &camera, &mut old.1);
    let mut fresh = (Renderer::new(), format.frame());
    fresh.0.explain(flight.scene(), &camera, &mut fresh.1);
    check_equal(&old.1, &fresh.1, "after another picture");
}
