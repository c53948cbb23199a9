//! The guards: a model for each kind, and eight poses.

mod archer;
mod hound;
mod lantern;
mod listener;
mod warden;

use glam::DVec3;

use super::model::skeleton::Joints;
use super::model::{self, Model, Paint, Size};
use super::{Design, Facings, GuardFrame};
use crate::world::GuardKind;

/// The sprite of a kind of guard.
pub(crate) fn guard(kind: GuardKind) -> Design {
    let Figure { height, size, model } = figure(kind);
    let pictures = model::pictures(GuardFrame::ALL, model, size);
    let shines = if kind == GuardKind::Lantern { 0.7 } else { 0.0 };
    let standing = Design::standing(height, pictures);
    Design { facings: Facings::Eight, animated: Some(1), shines, ..standing }
}

/// How a kind of guard looks.
struct Figure {
    /// The height of its pictures, in cells. They have room for a raised weapon.
    height: f64,
    size: Size,
    model: fn(GuardFrame) -> Model,
}

fn figure(kind: GuardKind) -> Figure {
    let (height, [width, texels], model): (_, _, fn(GuardFrame) -> Model) = match kind {
        GuardKind::Warden => (1.0, [38, 34], warden::model),
        GuardKind::Listener => (0.9, [34, 32], listener::model),
        GuardKind::Lantern => (0.9, [36, 32], lantern::model),
        GuardKind::Hound => (0.48, [46, 25], hound::model),
        GuardKind::Archer => (0.82, [34, 30], archer::model),
    };
    Figure { height, size: Size { width, height: texels }, model }
}

/// Adds both legs and boots.
pub(crate) fn legs(
    model: &mut Model,
    joints: &Joints,
    radii: [f64; 2],
    trousers: Paint,
    boots: Paint,
) {
    let [thigh, shin] = radii;
    let middle = thigh.midpoint(shin);
    for [hip, knee, foot] in joints.legs {
        let ankle = foot + DVec3::new(0.0, 0.0, shin);
        model.limb([hip, knee], [thigh, middle], trousers);
        model.limb([knee, ankle], [middle, shin], trousers);
        let toes = joints.hips.transform_vector3(DVec3::new(shin * 1.3, 0.0, 0.0));
        model.limb([ankle, ankle + toes], [shin * 1.1, shin], boots);
    }
}

/// Adds both arms and hands.
pub(crate) fn arms(
    model: &mut Model,
    joints: &Joints,
    radii: [f64; 2],
    sleeves: Paint,
    hands: Paint,
) {
    let [upper, lower] = radii;
    let middle = upper.midpoint(lower);
    for [shoulder, elbow, hand] in joints.arms {
        model.limb([shoulder, elbow], [upper, middle], sleeves);
        let wrist = elbow + (hand - elbow) * 0.75;
        model.limb([elbow, wrist], [middle, lower], sleeves);
        model.ball(hand, lower * 1.05, hands);
    }
}

#[cfg(test)]
mod tests;
