//! The hound: low, long and red. The red is pure, so that palettes of 256 colours show it in a dim room.

use glam::{DAffine3, DVec3};

use super::super::GuardFrame;
use super::super::model::skeleton::{bend, turned};
use super::super::model::{Model, Paint, glowing, matt};

const COAT: Paint = matt(0xff, 0x40, 0x18);
const BACK: Paint = matt(0xe8, 0x18, 0x10);
const BELLY: Paint = matt(0xff, 0x78, 0x48);
const PAWS: Paint = matt(0xb8, 0x20, 0x14);
const NOSE: Paint = matt(0x28, 0x14, 0x18);
const MOUTH: Paint = matt(0xd0, 0x28, 0x38);
const TEETH: Paint = glowing(0xff, 0xff, 0xff);
const EYES: Paint = glowing(0xff, 0xe8, 0x50);
const LID: Paint = matt(0x40, 0x18, 0x1c);
const COLLAR: Paint = matt(0xff, 0xd8, 0x80);
const TAG: Paint = glowing(0xff, 0xe8, 0xa0);

/// How the hound is posed, in texels from the middle of its feet.
#[derive(Clone, Copy)]
struct Pose {
    /// The shoulders: forwards and upwards.
    shoulders: [f64; 2],
    /// The haunches: forwards and upwards.
    haunches: [f64; 2],
    /// The middle of the head, from the shoulders.
    head: [f64; 3],
    /// How far the head looks upwards, and to the right, in degrees.
    looks: [f64; 2],
    /// How far the jaws are open, in degrees.
    jaws: f64,
    /// How far the ears stand up, from 0 to 1.
    ears: f64,
    /// Where the feet are: the front ones, the hind ones; left and right.
    feet: [[f64; 3]; 4],
    /// The end of the tail, from the haunches.
    tail: [f64; 3],
    eyes_are_open: bool,
}

/// The model of a frame.
pub(crate) fn model(frame: GuardFrame) -> Model {
    let pose = pose(frame);
    let mut model = Model::default();
    body(&mut model, &pose);
    legs(&mut model, &pose);
    head(&mut model, &pose);
    model
}

fn pose(frame: GuardFrame) -> Pose {
    let stand = Pose {
        shoulders: [6.5, 11.0],
        haunches: [-8.5, 10.5],
        head: [7.0, 0.0, 4.2],
        looks: [-6.0, 0.0],
        jaws: 0.0,
        ears: 0.5,
        feet: [[8.0, -2.8, 0.0], [7.0, 2.8, 0.0], [-9.5, -2.8, 0.0], [-8.5, 2.8, 0.0]],
        tail: [-7.0, 0.0, 2.0],
        eyes_are_open: true,
    };
    match frame {
        GuardFrame::Stand => stand,
        // The nose is on the trail.
        GuardFrame::WalkLeft => Pose {
            head: [8.0, 0.0, 0.5],
            looks: [-22.0, 0.0],
            feet: [[12.0, -2.8, 0.0], [3.0, 2.8, 1.0], [-13.0, -2.8, 1.0], [-5.0, 2.8, 0.0]],
            tail: [-7.5, 1.5, 0.5],
            ..stand
        },
        GuardFrame::WalkRight => Pose {
            shoulders: [7.0, 10.5],
            head: [7.4, 0.0, 1.2],
            looks: [-18.0, 0.0],
            feet: [[3.0, -2.8, 1.0], [12.0, 2.8, 0.0], [-5.0, -2.8, 0.0], [-13.0, 2.8, 1.0]],
            tail: [-7.5, -1.5, 0.5],
            ..stand
        },
        GuardFrame::Alert => Pose {
            shoulders: [6.5, 11.5],
            head: [5.5, 0.0, 5.2],
            looks: [10.0, 0.0],
            ears: 1.0,
            tail: [-5.0, 0.0, 7.0],
            ..stand
        },
        // The chest is on the floor, the haunches are high.
        GuardFrame::WindUp => Pose {
            shoulders: [5.0, 5.5],
            haunches: [-9.0, 13.5],
            head: [8.0, 0.0, 3.0],
            looks: [14.0, 0.0],
            jaws: 52.0,
            ears: 0.0,
            feet: [[10.5, -6.0, 0.0], [10.5, 6.0, 0.0], [-10.0, -3.4, 0.0], [-9.0, 3.4, 0.0]],
            tail: [-3.5, 0.0, 5.6],
            ..stand
        },
        GuardFrame::Strike => Pose {
            shoulders: [7.0, 14.0],
            haunches: [-7.0, 10.5],
            head: [6.0, 0.0, 1.5],
            looks: [0.0, 0.0],
            jaws: 50.0,
            ears: 0.0,
            feet: [[16.0, -3.0, 9.0], [15.0, 3.0, 7.5], [-15.0, -3.0, 0.5], [-14.0, 3.0, 1.5]],
            tail: [-7.5, 0.0, -1.0],
            ..stand
        },
        GuardFrame::Fallen => Pose {
            shoulders: [6.5, 4.6],
            haunches: [-8.0, 4.4],
            head: [7.5, 1.5, -1.0],
            looks: [-4.0, 30.0],
            jaws: 14.0,
            ears: 0.0,
            feet: [[9.0, 9.5, 1.5], [5.0, 10.5, 1.0], [-8.0, 10.0, 1.0], [-12.0, 8.5, 1.5]],
            tail: [-7.0, -2.0, -3.0],
            eyes_are_open: false,
        },
        // Curled up.
        GuardFrame::Asleep => Pose {
            shoulders: [4.0, 4.8],
            haunches: [-5.5, 5.4],
            head: [4.5, 5.5, -1.4],
            looks: [-6.0, 120.0],
            ears: 0.2,
            feet: [[6.0, 4.5, 0.5], [4.5, 6.0, 0.5], [-2.0, 5.0, 0.5], [-3.5, 6.5, 0.5]],
            tail: [1.0, 9.0, -3.0],
            eyes_are_open: false,
            ..stand
        },
    }
}

fn body(model: &mut Model, pose: &Pose) {
    let [shoulders, haunches] = [pose.shoulders, pose.haunches].map(|[x, z]| DVec3::new(x, 0.0, z));
    let up = DVec3::Z;
    model.limb([haunches, shoulders], [3.3, 4.2], COAT);
    model.limb([haunches + up * 1.3, shoulders + up * 1.4], [2.6, 3.3], BACK);
    model.ellipsoid(
        DAffine3::from_translation(shoulders),
        [2.2, 0.0, -0.6],
        [3.4, 3.6, 4.2],
        BELLY,
    );
    let rump = DAffine3::from_translation(haunches);
    model.ellipsoid(rump, [-1.4, 0.0, 0.4], [3.0, 3.3, 3.6], BACK);
    let tail = haunches + DVec3::from(pose.tail) + DVec3::new(-2.0, 0.0, 1.0);
    let start = haunches + DVec3::new(-2.0, 0.0, 1.0);
    let middle = bend(start, tail, (tail - start).length() * 0.54, DVec3::NEG_X);
    model.limb([start, middle], [1.6, 1.2], BACK);
    model.limb([middle, tail.with_z(tail.z.max(1.0))], [1.2, 0.8], COAT);
}

fn legs(model: &mut Model, pose: &Pose) {
    for (index, foot) in pose.feet.into_iter().enumerate() {
        let is_front = index < 2;
        let side = if index % 2 == 0 { -1.0 } else { 1.0 };
        let [x, z] = if is_front { pose.shoulders } else { pose.haunches };
        let top = DVec3::new(x, side * 2.4, z - 0.5);
        let foot = DVec3::from(foot) + DVec3::new(0.0, 0.0, 1.2);
        let bone = if is_front { 5.0 } else { 5.8 };
        let towards = if is_front { DVec3::NEG_X } else { DVec3::X };
        let knee = bend(top, foot, bone, towards);
        let thickness = if is_front { 2.2 } else { 2.9 };
        model.limb([top, knee], [thickness, 1.6], COAT);
        model.limb([knee, foot], [1.6, 1.2], COAT);
        model.limb([foot, foot + DVec3::new(1.6, 0.0, 0.0)], [1.4, 1.2], PAWS);
    }
}

fn head(model: &mut Model, pose: &Pose) {
    let [x, z] = pose.shoulders;
    let shoulders = DVec3::new(x, 0.0, z);
    let middle = shoulders + DVec3::from(pose.head);
    model.limb([shoulders + DVec3::new(1.0, 0.0, 1.0), middle], [3.0, 2.4], COAT);
    let collar = shoulders + DVec3::from(pose.head) * 0.6;
    model.ball(collar, 2.9, COLLAR);
    model.ball(collar + DVec3::new(2.2, 0.0, -1.6), 1.7, TAG);
    let [upwards, right] = pose.looks;
    let head = turned(middle, upwards, right);
    let point = |x, y, z| head.transform_point3(DVec3::new(x, y, z));
    model.ellipsoid(head, [0.0, 0.0, 0.0], [3.3, 2.8, 2.8], COAT);
    model.ellipsoid(head, [-0.6, 0.0, 0.9], [2.8, 2.5, 2.4], BACK);
    model.limb([point(1.5, 0.0, -0.2), point(6.2, 0.0, -0.6)], [2.0, 1.3], COAT);
    model.ball(point(7.4, 0.0, 0.0), 0.9, NOSE);
    jaw(model, pose, head);
    for side in [-1.0, 1.0] {
        let ear = DVec3::new(-2.6 - 1.6 * (1.0 - pose.ears), side * 2.4, 1.8 + 3.4 * pose.ears);
        model.limb([point(-0.8, side * 1.8, 1.6), head.transform_point3(ear)], [1.4, 0.6], BACK);
        let eye = if pose.eyes_are_open { EYES } else { LID };
        model.ellipsoid(head, [2.4, side * 1.5, 1.1], [0.8, 0.8, 0.7], eye);
    }
}

/// The lower jaw, and the teeth that show while it is open.
fn jaw(model: &mut Model, pose: &Pose, head: DAffine3) {
    let jaw = head * turned(DVec3::new(1.0, 0.0, -1.4), -pose.jaws, 0.0);
    let point = |x, y, z| jaw.transform_point3(DVec3::new(x, y, z));
    model.limb([point(0.0, 0.0, 0.0), point(4.6, 0.0, 0.0)], [1.3, 0.9], BELLY);
    if pose.jaws < 20.0 {
        return;
    }
    model.limb([point(0.6, 0.0, 0.9), point(4.4, 0.0, 0.7)], [1.1, 0.8], MOUTH);
    for (x, side) in [(4.6, -0.8), (4.6, 0.8)] {
        model.ball(point(x, side, 1.1), 0.9, TEETH);
        model.ball(head.transform_point3(DVec3::new(6.2, side, -1.9)), 1.1, TEETH);
    }
}
