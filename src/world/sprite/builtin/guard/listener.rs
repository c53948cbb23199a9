//! The listener: tall and thin, in a pale robe, with a blindfold and large ears.

use glam::DVec3;

use super::super::GuardFrame;
use super::super::model::skeleton::{Build, Joints, Pose};
use super::super::model::{Model, Paint, matt};
use super::arms;

const ROBE: Paint = matt(0xff, 0xff, 0xff);
const SHOES: Paint = matt(0xa0, 0x84, 0x70);
const STOLE: Paint = matt(0xb4, 0xa0, 0xc0);
const SASH: Paint = matt(0x8c, 0x24, 0x34);
const SKIN: Paint = matt(0xf4, 0xc4, 0xa8);
const EAR: Paint = matt(0xff, 0xa4, 0x94);
const BLINDFOLD: Paint = matt(0x90, 0x18, 0x28);
const MOUTH: Paint = matt(0x38, 0x14, 0x20);
const HAIR: Paint = matt(0x74, 0x68, 0x78);
const NAILS: Paint = matt(0x40, 0x14, 0x1c);

const BUILD: Build =
    Build { legs: 11.0, trunk: 9.5, neck: 4.4, shoulder: 3.4, hip: 1.6, arms: 12.0 };

/// The model of a frame.
pub(crate) fn model(frame: GuardFrame) -> Model {
    let joints = Joints::new(&BUILD, &pose(frame));
    let mut model = Model::default();
    robe(&mut model, &joints);
    arms(&mut model, &joints, [1.7, 1.9], ROBE, SKIN);
    fingers(&mut model, &joints);
    head(&mut model, &joints);
    model
}

fn pose(frame: GuardFrame) -> Pose {
    let stand = Pose {
        hands: [[3.5, -3.0, -5.0], [3.5, 3.0, -5.0]],
        feet: [[0.0, -0.8, 0.0], [0.0, 0.8, 0.0]],
        nod: 8.0,
        ..Pose::UPRIGHT
    };
    // The hands feel the way.
    let feeling = Pose { lean: 9.0, nod: 0.0, ..stand };
    match frame {
        GuardFrame::Stand => stand,
        GuardFrame::WalkLeft => Pose {
            hands: [[8.0, -3.5, -2.0], [9.5, 3.0, -4.0]],
            look: 14.0,
            ..feeling.in_stride(3.4)
        },
        GuardFrame::WalkRight => Pose {
            hands: [[9.5, -3.0, -4.0], [8.0, 3.5, -2.0]],
            look: -14.0,
            ..feeling.in_stride(-3.4)
        },
        // A hand behind an ear, the other one stretched out.
        GuardFrame::Alert => {
            Pose { look: -35.0, nod: -4.0, hands: [[9.0, -5.0, 0.0], [2.5, 5.0, 4.6]], ..stand }
        }
        GuardFrame::WindUp => Pose {
            hips: [-1.0, 0.0, -1.0],
            lean: -10.0,
            nod: -12.0,
            hands: [[2.0, -8.5, 5.0], [2.0, 8.5, 5.0]],
            feet: [[3.0, -1.5, 0.0], [-3.0, 1.5, 0.0]],
            ..stand
        },
        GuardFrame::Strike => Pose {
            hips: [-1.2, 0.0, -2.0],
            lean: 34.0,
            nod: -30.0,
            hands: [[8.5, -3.5, 3.0], [8.5, 3.5, 3.0]],
            feet: [[5.0, -1.5, 0.0], [-5.0, 1.5, 0.0]],
            ..stand
        },
        GuardFrame::Fallen => Pose {
            hips: [2.3, 0.0, -8.4],
            tilt: 90.0,
            hands: [[-0.5, -7.5, 1.0], [0.5, 7.5, -5.0]],
            ..stand
        },
        GuardFrame::Asleep => Pose {
            hips: [-2.0, 0.0, -8.2],
            lean: 12.0,
            nod: 42.0,
            hands: [[4.5, -3.0, -7.5], [4.5, 3.0, -7.5]],
            feet: [[7.0, -1.0, 0.5], [7.0, 1.0, 0.5]],
            ..stand
        },
    }
}

/// The robe, which widens to the floor.
fn robe(model: &mut Model, joints: &Joints) {
    let Joints { hips, chest, legs, .. } = *joints;
    let waist = hips.transform_point3(DVec3::new(0.0, 0.0, 1.0));
    let neck = chest.transform_point3(DVec3::new(0.0, 0.0, 0.4));
    for [_, _, foot] in legs {
        // The hem follows the feet, and shows their tips.
        let hem = hips.translation.lerp(foot, 0.55).with_z(2.0);
        model.limb([waist, hem], [2.9, 4.2], ROBE);
        model.ball(foot + hips.transform_vector3(DVec3::new(2.6, 0.0, 1.0)), 1.5, SHOES);
    }
    model.limb([waist, neck], [3.0, 2.5], ROBE);
    model.ellipsoid(chest, [0.0, 0.0, -0.8], [2.4, 4.2, 2.2], ROBE);
    model.ellipsoid(hips, [0.0, 0.0, 1.6], [3.3, 3.3, 1.0], SASH);
    model.block(hips, [3.1, -0.6, -2.4], [0.5, 0.8, 3.2], SASH);
    // The stole covers the back.
    model.ellipsoid(chest, [-1.6, 0.0, -3.6], [2.0, 4.0, 5.2], STOLE);
    model.limb(
        [chest, hips].map(|frame| frame.transform_point3(DVec3::new(-2.2, 0.0, -3.0))),
        [2.2, 2.7],
        STOLE,
    );
}

fn fingers(model: &mut Model, joints: &Joints) {
    for [_, elbow, hand] in joints.arms {
        let along = (hand - elbow).normalize();
        model.limb([hand, hand + along * 1.4], [1.7, 1.2], SKIN);
        let across = joints.chest.transform_vector3(DVec3::Y);
        for spread in [-1.0, 0.0, 1.0] {
            let start = hand + along * 1.2 + across * spread;
            model.limb([start, start + along * 2.0 + across * spread * 0.6], [0.7, 0.5], NAILS);
        }
    }
}

fn head(model: &mut Model, joints: &Joints) {
    let head = joints.head;
    model.ellipsoid(head, [0.0, 0.0, 0.3], [2.8, 2.5, 3.4], SKIN);
    model.ellipsoid(head, [-0.9, 0.0, 1.0], [2.5, 2.6, 3.2], HAIR);
    model.ellipsoid(head, [0.2, 0.0, 0.7], [2.9, 2.8, 1.1], BLINDFOLD);
    model.ellipsoid(head, [2.4, 0.0, -1.9], [0.6, 1.0, 0.6], MOUTH);
    for side in [-1.0, 1.0] {
        model.ellipsoid(head, [-0.2, side * 3.5, 0.4], [1.0, 1.6, 2.6], EAR);
        let knot = [(-2.6, 0.6), (-4.6, -2.6)];
        let tie = knot.map(|(x, z)| head.transform_point3(DVec3::new(x, side * 0.6, z)));
        model.limb(tie, [0.8, 0.7], BLINDFOLD);
    }
}
