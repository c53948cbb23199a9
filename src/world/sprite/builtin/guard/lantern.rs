//! The lantern bearer: a yellow coat, a high hat, and a lamp on a pole.

use glam::{DAffine3, DVec3};

use super::super::GuardFrame;
use super::super::model::skeleton::{Build, Joints, Pose};
use super::super::model::{Model, Paint, glowing, matt};
use super::{arms, legs};

const COAT: Paint = matt(0xf0, 0xb4, 0x28);
const DARK_COAT: Paint = matt(0x94, 0x54, 0x14);
const SHIRT: Paint = matt(0xf4, 0xec, 0xd8);
const BELT: Paint = matt(0x50, 0x34, 0x18);
const HAT: Paint = matt(0x3c, 0x2c, 0x34);
const RIBBON: Paint = matt(0xd0, 0x40, 0x28);
const SKIN: Paint = matt(0xec, 0xb8, 0x90);
const BEARD: Paint = matt(0x8c, 0x50, 0x28);
const EYES: Paint = glowing(0x20, 0x18, 0x18);
const BOOTS: Paint = matt(0x4c, 0x34, 0x24);
const POLE: Paint = matt(0x6c, 0x48, 0x28);
const CAP: Paint = matt(0x54, 0x4c, 0x48);
const GLASS: Paint = glowing(0xff, 0xec, 0x90);
const FLAME: Paint = glowing(0xff, 0xff, 0xff);
const DARK_GLASS: Paint = matt(0x70, 0x74, 0x6c);
const BELL: Paint = matt(0xe4, 0xf0, 0xf4);

const BUILD: Build = Build { legs: 7.0, trunk: 8.0, neck: 3.6, shoulder: 4.0, hip: 2.0, arms: 9.5 };

/// The model of a frame.
pub(crate) fn model(frame: GuardFrame) -> Model {
    let joints = Joints::new(&BUILD, &pose(frame));
    let mut model = Model::default();
    legs(&mut model, &joints, [2.0, 1.6], BELT, BOOTS);
    coat(&mut model, &joints);
    arms(&mut model, &joints, [1.9, 1.7], COAT, SKIN);
    head(&mut model, &joints);
    pole(&mut model, &joints, frame);
    bell(&mut model, &joints, frame);
    model
}

fn pose(frame: GuardFrame) -> Pose {
    // The pole is in the right hand, the bell in the left one.
    let stand = Pose {
        hands: [[1.0, -5.2, -7.5], [4.5, 5.4, -4.0]],
        holds: [0.12, 0.12, 1.0],
        ..Pose::UPRIGHT
    };
    match frame {
        GuardFrame::Stand => stand,
        GuardFrame::WalkLeft => {
            Pose { hands: [[-2.5, -5.2, -7.5], stand.hands[1]], ..stand.in_stride(3.4) }
        }
        GuardFrame::WalkRight => {
            Pose { hands: [[3.5, -5.2, -7.0], stand.hands[1]], ..stand.in_stride(-3.4) }
        }
        // The bell rings above the head.
        GuardFrame::Alert => Pose {
            nod: -8.0,
            hands: [[2.0, -6.0, 7.0], [4.5, 6.0, -3.0]],
            feet: [[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]],
            ..stand
        },
        GuardFrame::WindUp => Pose {
            hips: [0.0, 0.0, -2.6],
            lean: -6.0,
            hands: [[1.5, -2.5, 5.0], [0.5, 3.0, 6.0]],
            feet: [[3.5, -2.4, 0.0], [-3.0, 2.4, 0.0]],
            holds: [-0.1, -0.1, 1.0],
            ..stand
        },
        GuardFrame::Strike => Pose {
            hips: [2.0, 0.0, -1.2],
            lean: 26.0,
            nod: -16.0,
            hands: [[5.5, -1.5, -3.5], [5.6, 2.5, -1.5]],
            feet: [[5.0, -1.0, 0.0], [-4.0, 1.0, 0.0]],
            holds: [1.0, -0.35, -0.05],
            ..stand
        },
        GuardFrame::Fallen => Pose {
            hips: [3.0, 0.0, -4.6],
            tilt: 90.0,
            hands: [[0.5, -8.5, -1.5], [0.5, 8.5, 1.5]],
            feet: [[0.0, -1.5, 0.0], [0.0, 2.0, 0.5]],
            holds: [-0.05, -0.1, -1.0],
            ..stand
        },
        GuardFrame::Asleep => Pose {
            hips: [-2.0, 0.0, -4.4],
            lean: 10.0,
            nod: 34.0,
            hands: [[4.0, -4.0, -6.5], [4.5, 5.0, -3.0]],
            feet: [[6.0, -0.8, 0.0], [6.0, 0.8, 0.0]],
            ..stand
        },
    }
}

fn coat(model: &mut Model, joints: &Joints) {
    let Joints { hips, chest, legs, .. } = *joints;
    for [hip, knee, _] in legs {
        // The skirts of the coat.
        model.limb([hip, hip + (knee - hip) * 1.25], [2.7, 3.0], COAT);
    }
    model.limb([hips.translation, chest.translation], [3.3, 3.0], COAT);
    model.ellipsoid(chest, [0.0, 0.0, -1.6], [3.0, 4.4, 2.8], COAT);
    model.ellipsoid(chest, [1.7, 0.0, -2.8], [2.1, 2.2, 3.6], SHIRT);
    model.ellipsoid(hips, [0.0, 0.0, 1.2], [3.5, 3.6, 0.9], BELT);
    // The back is a dark cape.
    model.ellipsoid(chest, [-1.8, 0.0, -3.4], [2.2, 4.3, 5.4], DARK_COAT);
    model.ellipsoid(hips, [-2.0, 0.0, -1.0], [2.2, 3.8, 3.6], DARK_COAT);
}

fn head(model: &mut Model, joints: &Joints) {
    let head = joints.head;
    model.ellipsoid(head, [0.0, 0.0, 0.0], [2.6, 2.5, 2.7], SKIN);
    model.ellipsoid(head, [-0.7, 0.0, 0.2], [2.4, 2.6, 2.8], BEARD);
    model.ellipsoid(head, [1.0, 0.0, -1.8], [2.0, 2.1, 1.5], BEARD);
    for side in [-1.1, 1.1] {
        model.ellipsoid(head, [2.5, side, 0.3], [0.5, 0.5, 0.6], EYES);
    }
    model.ellipsoid(head, [0.0, 0.0, 1.8], [3.9, 3.7, 0.7], HAT);
    let crown = [1.8, 6.0].map(|z| head.transform_point3(DVec3::new(-0.2, 0.0, z)));
    model.limb(crown, [2.0, 2.0], HAT);
    model.ellipsoid(head, [-0.1, 0.0, 2.7], [2.4, 2.4, 0.8], RIBBON);
}

/// The pole with the lamp: it hangs from the end, and points where the pole does in a fight. It is
/// dark beside a bearer who has fallen.
fn pole(model: &mut Model, joints: &Joints, frame: GuardFrame) {
    let hand = joints.arms[1][2];
    let (above, below) = match frame {
        GuardFrame::Fallen => (9.0, 8.0),
        GuardFrame::WindUp => (7.4, 7.0),
        GuardFrame::Strike => (4.5, 8.0),
        _ => (15.0, 13.0),
    };
    let above_floor = |point: DVec3| point.with_z(point.z.clamp(1.0, 29.0));
    let top = above_floor(hand + joints.holds * above);
    model.limb([above_floor(hand - joints.holds * below), top], [0.7, 0.7], POLE);
    let forwards = joints.hips.transform_vector3(DVec3::X);
    let paints = if frame == GuardFrame::Fallen { [DARK_GLASS; 2] } else { [GLASS, FLAME] };
    let lamp = if matches!(frame, GuardFrame::WindUp | GuardFrame::Strike) {
        top
    } else {
        let hook = top + forwards * 2.8;
        model.limb([top, hook], [0.7, 0.7], POLE);
        hook - DVec3::new(0.0, 0.0, 4.4)
    };
    lantern(model, lamp.with_z(lamp.z.max(3.6)), forwards, paints);
}

fn lantern(model: &mut Model, middle: DVec3, forwards: DVec3, [glass, flame]: [Paint; 2]) {
    let upright = DAffine3::from_translation(middle);
    model.ellipsoid(upright, [0.0, 0.0, 2.9], [2.3, 2.3, 1.0], CAP);
    model.ellipsoid(upright, [0.0, 0.0, 0.0], [3.1, 3.1, 3.0], glass);
    model.ball(middle + forwards * 1.8, 1.6, flame);
    model.ellipsoid(upright, [0.0, 0.0, -2.7], [2.0, 2.0, 0.8], CAP);
}

fn bell(model: &mut Model, joints: &Joints, frame: GuardFrame) {
    let hand = joints.arms[0][2];
    let rings = frame == GuardFrame::Alert;
    let mouth = if rings { DVec3::new(0.6, -0.6, 0.8) } else { DVec3::NEG_Z };
    let along = joints.chest.transform_vector3(mouth);
    model.limb([hand + along, hand + along * 3.4], [0.9, 2.1], BELL);
}
