//! The warden: broad, in steel blue, with a mace as large as the head and the chest.

use glam::DVec3;

use super::super::GuardFrame;
use super::super::model::skeleton::{Build, Joints, Pose};
use super::super::model::{Model, Paint, glowing, matt};
use super::{arms, legs};

const STEEL: Paint = matt(0x58, 0xa0, 0xff);
const PALE_STEEL: Paint = matt(0xb4, 0xdc, 0xff);
const DARK_STEEL: Paint = matt(0x3c, 0x6c, 0xd8);
const TABARD: Paint = matt(0xff, 0xff, 0xff);
const CREST: Paint = matt(0xe8, 0x38, 0x38);
const CAPE: Paint = matt(0x24, 0x44, 0xb0);
const BOOTS: Paint = matt(0x44, 0x58, 0xa8);
const SLIT: Paint = glowing(0x10, 0x10, 0x1c);
const EYES: Paint = glowing(0xff, 0xd8, 0x68);
const SHAFT: Paint = matt(0xa8, 0x74, 0x48);
const IRON: Paint = matt(0xdc, 0xdc, 0xe8);
const SPIKES: Paint = matt(0xff, 0xff, 0xff);

const BUILD: Build =
    Build { legs: 7.5, trunk: 9.0, neck: 3.8, shoulder: 6.4, hip: 3.2, arms: 11.0 };

/// The model of a frame.
pub(crate) fn model(frame: GuardFrame) -> Model {
    let joints = Joints::new(&BUILD, &pose(frame));
    let mut model = Model::default();
    legs(&mut model, &joints, [2.9, 2.3], DARK_STEEL, BOOTS);
    trunk(&mut model, &joints);
    arms(&mut model, &joints, [2.5, 2.1], STEEL, DARK_STEEL);
    helmet(&mut model, &joints);
    mace(&mut model, &joints, frame);
    model
}

fn pose(frame: GuardFrame) -> Pose {
    let stand = Pose {
        hands: [[1.5, -7.8, -8.5], [3.5, 8.4, -7.5]],
        feet: [[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]],
        holds: [0.35, 0.25, -1.0],
        ..Pose::UPRIGHT
    };
    let shouldered = Pose {
        hips: [0.0, 0.0, -0.3],
        lean: 5.0,
        hands: [[-3.0, -8.0, -7.7], [4.5, 6.5, -4.5]],
        holds: [-0.65, 0.25, 1.0],
        ..stand
    };
    match frame {
        GuardFrame::Stand => stand,
        GuardFrame::WalkLeft => shouldered.in_stride(4.0),
        GuardFrame::WalkRight => {
            Pose { hands: [[3.5, -8.0, -7.5], shouldered.hands[1]], ..shouldered.in_stride(-4.0) }
        }
        GuardFrame::Alert => Pose {
            hips: [0.0, 0.0, -0.6],
            lean: 8.0,
            hands: [[6.0, -3.5, -5.0], [4.0, 5.5, -6.0]],
            feet: [[1.5, -2.0, 0.0], [-1.5, 2.0, 0.0]],
            holds: [0.45, -1.1, 0.8],
            ..stand
        },
        GuardFrame::WindUp => Pose {
            hips: [0.0, 0.0, -1.8],
            lean: -8.0,
            nod: -4.0,
            hands: [[0.5, -2.5, 6.0], [0.0, 3.5, 6.0]],
            feet: [[2.5, -2.8, 0.0], [-2.5, 2.8, 0.0]],
            holds: [-0.1, 0.1, 1.0],
            ..stand
        },
        GuardFrame::Strike => Pose {
            hips: [0.5, 0.0, -1.5],
            lean: 30.0,
            nod: -16.0,
            hands: [[8.0, -2.0, -5.0], [7.5, 3.0, -5.5]],
            feet: [[5.5, -1.8, 0.0], [-4.0, 1.8, 0.0]],
            holds: [1.0, -0.1, -0.3],
            ..stand
        },
        GuardFrame::Fallen => Pose {
            hips: [1.0, 0.0, -4.2],
            tilt: 90.0,
            hands: [[2.0, -10.5, -1.0], [2.0, 7.5, -4.0]],
            feet: [[0.0, -2.5, 0.0], [0.0, 2.5, 1.0]],
            holds: [0.0, 0.8, 0.6],
            ..stand
        },
        GuardFrame::Asleep => Pose {
            hips: [-2.5, 0.0, -4.5],
            lean: 14.0,
            nod: 38.0,
            hands: [[4.5, -5.0, -7.5], [4.5, 6.5, -8.0]],
            feet: [[6.5, -1.5, 0.0], [6.5, 1.5, 0.0]],
            holds: [0.7, 0.55, -0.25],
            ..stand
        },
    }
}

fn trunk(model: &mut Model, joints: &Joints) {
    let Joints { hips, chest, .. } = *joints;
    model.ellipsoid(hips, [0.0, 0.0, 0.6], [3.6, 5.4, 3.0], DARK_STEEL);
    model.ellipsoid(chest, [0.0, 0.0, -4.6], [4.3, 6.6, 6.0], STEEL);
    // The tabard covers the chest and hangs to the knees, the cape the back.
    model.ellipsoid(chest, [1.6, 0.0, -5.0], [3.6, 3.6, 5.2], TABARD);
    model.block(hips, [3.4, 0.0, -1.6], [0.6, 2.6, 3.0], TABARD);
    model.ellipsoid(chest, [4.6, 0.0, -4.2], [1.0, 1.6, 2.0], CREST);
    model.ellipsoid(chest, [-2.6, 0.0, -5.6], [2.6, 6.8, 7.0], CAPE);
    model.block(hips, [-3.8, 0.0, -1.0], [0.8, 5.2, 4.6], CAPE);
    for [shoulder, ..] in joints.arms {
        let raised = shoulder + chest.transform_vector3(DVec3::new(0.0, 0.0, 0.6));
        model.ball(raised, 3.3, PALE_STEEL);
    }
}

fn helmet(model: &mut Model, joints: &Joints) {
    let head = joints.head;
    model.ellipsoid(head, [0.0, 0.0, 0.6], [3.4, 3.2, 3.7], STEEL);
    model.ellipsoid(head, [0.9, 0.0, -0.6], [3.0, 2.9, 2.9], PALE_STEEL);
    model.block(head, [2.6, 0.0, 0.5], [1.3, 2.3, 0.8], SLIT);
    for side in [-1.2, 1.2] {
        model.ellipsoid(head, [3.8, side, 0.5], [0.7, 0.7, 0.7], EYES);
    }
    model.limb(
        [
            head.transform_point3(DVec3::new(1.5, 0.0, 4.0)),
            head.transform_point3(DVec3::new(-3.6, 0.0, 2.6)),
        ],
        [0.9, 1.1],
        CREST,
    );
}

fn mace(model: &mut Model, joints: &Joints, frame: GuardFrame) {
    let hand = joints.arms[1][2];
    let length = match frame {
        GuardFrame::WindUp => 4.5,
        GuardFrame::Strike | GuardFrame::Fallen => 6.2,
        _ => 7.5,
    };
    let end = hand + joints.holds * length;
    let end = DVec3::new(end.x, end.y, end.z.max(3.5));
    let along = (end - hand).normalize();
    model.limb([hand - along * 3.0, end], [0.9, 0.9], SHAFT);
    model.ball(end, 3.9, IRON);
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        model.limb([end - axis * 4.7, end + axis * 4.7], [0.8, 0.8], SPIKES);
    }
}
