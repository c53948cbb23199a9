//! The archer: a green hood and a long bow.

use glam::DVec3;

use super::super::GuardFrame;
use super::super::model::skeleton::{Build, Joints, Pose, bend};
use super::super::model::{Model, Paint, glowing, matt};
use super::{arms, legs};

const HOOD: Paint = matt(0x78, 0xff, 0x58);
const CLOAK: Paint = matt(0x0c, 0x58, 0x20);
const TUNIC: Paint = matt(0xff, 0xff, 0xec);
const SLEEVES: Paint = matt(0x70, 0xf0, 0x78);
const TROUSERS: Paint = matt(0x24, 0x4c, 0x34);
const LEATHER: Paint = matt(0x94, 0x58, 0x30);
const SKIN: Paint = matt(0xf4, 0xc4, 0x9c);
const SHADE: Paint = matt(0x2c, 0x24, 0x20);
const EYES: Paint = glowing(0xf4, 0xf0, 0xc8);
const BOW: Paint = matt(0xff, 0x9c, 0x38);
const STRING: Paint = matt(0xe8, 0xe0, 0xc8);
const ARROW: Paint = matt(0xd8, 0xc8, 0xa0);
const TIP: Paint = glowing(0xff, 0xff, 0xff);
const FEATHERS: Paint = matt(0xf4, 0xf4, 0xf0);

const BUILD: Build =
    Build { legs: 9.0, trunk: 8.5, neck: 3.6, shoulder: 3.6, hip: 1.7, arms: 10.0 };

/// The model of a frame.
pub(crate) fn model(frame: GuardFrame) -> Model {
    let joints = Joints::new(&BUILD, &pose(frame));
    let mut model = Model::default();
    legs(&mut model, &joints, [1.9, 1.4], TROUSERS, LEATHER);
    trunk(&mut model, &joints);
    arms(&mut model, &joints, [1.7, 1.4], SLEEVES, SKIN);
    hood(&mut model, &joints);
    bow(&mut model, &joints, frame);
    model
}

fn pose(frame: GuardFrame) -> Pose {
    // The bow is in the left hand.
    let stand = Pose {
        hands: [[3.0, -6.2, -6.0], [1.0, 4.6, -7.5]],
        holds: [0.45, -0.2, 1.0],
        ..Pose::UPRIGHT
    };
    // Sideways, with the left arm forwards and the right hand at the cheek.
    let drawn = Pose {
        twist: 55.0,
        look: -55.0,
        hands: [[5.0, -9.0, 1.6], [2.5, 2.6, 1.8]],
        feet: [[3.2, -1.5, 0.0], [-3.2, 1.5, 0.0]],
        holds: [0.75, 0.5, 1.0],
        ..stand
    };
    match frame {
        GuardFrame::Stand => stand,
        GuardFrame::WalkLeft => {
            Pose { hands: [stand.hands[0], [4.0, 4.6, -6.8]], lean: 5.0, ..stand.in_stride(4.2) }
        }
        GuardFrame::WalkRight => {
            Pose { hands: [stand.hands[0], [-3.0, 4.6, -6.8]], lean: 5.0, ..stand.in_stride(-4.2) }
        }
        GuardFrame::Alert => Pose {
            hands: [[6.5, -4.5, -3.5], [4.5, 1.5, -4.0]],
            feet: [[1.5, -1.0, 0.0], [-1.5, 1.0, 0.0]],
            holds: [0.2, -0.7, 1.0],
            ..stand
        },
        GuardFrame::WindUp => drawn,
        GuardFrame::Strike => {
            Pose { hands: [[5.0, -9.0, 1.0], [-2.0, 7.0, 2.6]], holds: [0.2, -0.5, 1.0], ..drawn }
        }
        GuardFrame::Fallen => Pose {
            hips: [3.0, 0.0, -6.8],
            tilt: 90.0,
            hands: [[0.5, -7.5, -4.0], [1.0, 7.5, -3.0]],
            feet: [[0.0, -1.0, 0.0], [1.0, 1.5, 0.5]],
            holds: [0.05, -0.5, 1.0],
            ..stand
        },
        GuardFrame::Asleep => Pose {
            hips: [-2.0, 0.0, -6.6],
            lean: 10.0,
            nod: 36.0,
            hands: [[3.5, -5.0, -5.5], [4.0, 3.0, -6.5]],
            feet: [[6.5, -0.8, 0.0], [5.0, 0.8, 0.0]],
            holds: [0.3, -0.3, 1.0],
            ..stand
        },
    }
}

fn trunk(model: &mut Model, joints: &Joints) {
    let Joints { hips, chest, .. } = *joints;
    model.limb([hips.translation, chest.translation], [2.5, 2.5], TUNIC);
    model.ellipsoid(chest, [0.2, 0.0, -1.6], [2.6, 3.8, 2.6], TUNIC);
    model.ellipsoid(hips, [0.2, 0.0, -0.9], [2.9, 3.0, 2.6], HOOD);
    model.ellipsoid(hips, [0.2, 0.0, 1.6], [2.8, 2.9, 0.8], LEATHER);
    // The cloak covers shoulders and back.
    model.ellipsoid(chest, [-0.8, 0.0, 0.2], [2.8, 4.4, 2.0], HOOD);
    model.ellipsoid(chest, [-2.0, 0.0, -4.0], [2.2, 4.2, 6.0], CLOAK);
    model.ellipsoid(hips, [-2.2, 0.0, -2.0], [1.8, 3.6, 4.4], CLOAK);
    let quiver = [DVec3::new(-4.0, -1.4, -6.0), DVec3::new(-4.0, 1.6, 0.4)];
    model.limb(quiver.map(|point| chest.transform_point3(point)), [1.3, 1.4], LEATHER);
    for (across, above) in [(1.4, 1.8), (2.6, 1.4), (2.2, 2.6)] {
        model.ball(chest.transform_point3(DVec3::new(-4.0, across, above)), 0.9, FEATHERS);
    }
}

fn hood(model: &mut Model, joints: &Joints) {
    let head = joints.head;
    model.ellipsoid(head, [-0.4, 0.0, 0.2], [3.1, 3.1, 3.2], HOOD);
    // The hood ends in a point.
    let peak = [DVec3::new(-0.6, 0.0, 1.6), DVec3::new(-3.4, 0.0, 3.4)];
    model.limb(peak.map(|point| head.transform_point3(point)), [2.2, 0.6], HOOD);
    model.ellipsoid(head, [1.5, 0.0, -0.2], [1.6, 2.1, 2.3], SHADE);
    model.ellipsoid(head, [1.9, 0.0, -1.5], [1.5, 1.6, 1.4], SKIN);
    for side in [-0.9, 0.9] {
        model.ellipsoid(head, [2.9, side, 0.4], [0.5, 0.6, 0.5], EYES);
    }
}

/// The bow, two limbs that bend away from the string, and the arrow while it is drawn.
fn bow(model: &mut Model, joints: &Joints, frame: GuardFrame) {
    const HALF: f64 = 8.5;
    let [[_, _, grip], [_, _, other]] = joints.arms;
    let forwards = match frame {
        GuardFrame::WindUp | GuardFrame::Strike => (grip - joints.arms[0][0]).normalize(),
        _ => joints.chest.transform_vector3(DVec3::new(0.6, -0.6, 0.0)).normalize(),
    };
    let along = (joints.holds - forwards * joints.holds.dot(forwards)).normalize();
    let is_drawn = frame == GuardFrame::WindUp;
    let back = if is_drawn { 4.0 } else { 2.4 };
    let above_floor = |point: DVec3| point.with_z(point.z.clamp(0.8, 28.0));
    let tips = [HALF, -HALF].map(|half| above_floor(grip + along * half - forwards * back));
    for tip in tips {
        let middle = bend(grip, tip, (tip - grip).length() / 2.0 * 1.06, forwards);
        model.limb([grip, middle], [1.1, 1.0], BOW);
        model.limb([middle, tip], [1.0, 0.7], BOW);
    }
    let nock = if is_drawn { other } else { (tips[0] + tips[1]) / 2.0 };
    for tip in tips {
        model.limb([nock, tip], [0.45, 0.45], STRING);
    }
    if is_drawn {
        let point = grip + (grip - nock).normalize() * 3.0;
        model.limb([nock, point], [0.6, 0.6], ARROW);
        model.ball(point, 2.3, TIP);
        model.ball(nock, 1.0, FEATHERS);
    }
}
