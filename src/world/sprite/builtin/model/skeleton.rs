//! Joints of a body with two legs and two arms, and of limbs that bend in the middle.

use glam::{DAffine3, DQuat, DVec3};

/// The proportions of a body, in texels.
#[derive(Clone, Copy)]
pub(crate) struct Build {
    /// From the hips to the floor.
    pub(crate) legs: f64,
    /// From the hips to the shoulders.
    pub(crate) trunk: f64,
    /// From the shoulders to the middle of the head.
    pub(crate) neck: f64,
    /// From the middle to a shoulder.
    pub(crate) shoulder: f64,
    /// From the middle to a hip.
    pub(crate) hip: f64,
    /// From a shoulder to its hand.
    pub(crate) arms: f64,
}

/// How a body is posed. Pairs are of the left side and of the right one.
#[derive(Clone, Copy)]
pub(crate) struct Pose {
    /// Where the middle of the hips is, from where it is when the body stands.
    pub(crate) hips: [f64; 3],
    /// The turn of the whole body about the axis from left to right, backwards, in degrees.
    pub(crate) tilt: f64,
    /// How far the trunk leans forwards, in degrees.
    pub(crate) lean: f64,
    /// How far the trunk turns to the right, in degrees.
    pub(crate) twist: f64,
    /// How far the head nods, in degrees.
    pub(crate) nod: f64,
    /// How far the head turns to the right, in degrees.
    pub(crate) look: f64,
    /// Where the hands are, from the middle of the shoulders: forwards, to the right, upwards.
    pub(crate) hands: [[f64; 3]; 2],
    /// Where the feet are on the floor, from below the hips of a body that stands.
    pub(crate) feet: [[f64; 3]; 2],
    /// The direction from the hand to the end of what it holds, in the coordinates of the trunk.
    pub(crate) holds: [f64; 3],
}

impl Pose {
    /// Upright, with the hands at the sides.
    pub(crate) const UPRIGHT: Self = Self {
        hips: [0.0; 3],
        tilt: 0.0,
        lean: 0.0,
        twist: 0.0,
        nod: 0.0,
        look: 0.0,
        hands: [[1.0, -6.0, -9.0], [1.0, 6.0, -9.0]],
        feet: [[0.0; 3]; 2],
        holds: [1.0, 0.0, 0.0],
    };

    /// The pose with one foot `length` texels in front and the other one behind: the left one in
    /// front if `length` is positive, else the right one.
    pub(crate) fn in_stride(self, length: f64) -> Self {
        let [left, right] = self.feet;
        let moved = |[x, y, z]: [f64; 3], by: f64| [x + by, y, z + (-by).max(0.0) * 0.25];
        Self {
            twist: self.twist + length * 1.6,
            feet: [moved(left, length), moved(right, -length)],
            ..self
        }
    }
}

/// The joints of a posed body. Pairs are of the left side and of the right one.
pub(crate) struct Joints {
    /// The hips: their middle, and the axes of the body.
    pub(crate) hips: DAffine3,
    /// The middle of the shoulders, and the axes of the trunk.
    pub(crate) chest: DAffine3,
    /// The middle of the head, and its axes.
    pub(crate) head: DAffine3,
    /// Shoulder, elbow and hand.
    pub(crate) arms: [[DVec3; 3]; 2],
    /// Hip, knee and foot.
    pub(crate) legs: [[DVec3; 3]; 2],
    /// The direction of what a hand holds, of length 1.
    pub(crate) holds: DVec3,
}

impl Joints {
    /// The joints of a body of that build in that pose.
    pub(crate) fn new(build: &Build, pose: &Pose) -> Self {
        let stands = DVec3::new(0.0, 0.0, build.legs);
        let hips = turned(DVec3::from(pose.hips) + stands, pose.tilt, 0.0);
        let chest = hips
            * turned(DVec3::ZERO, -pose.lean, pose.twist)
            * DAffine3::from_translation(DVec3::new(0.0, 0.0, build.trunk));
        let head = chest * turned(DVec3::new(0.0, 0.0, build.neck), -pose.nod, pose.look);
        let sides = [(-1.0, 0), (1.0, 1)];
        let arms = sides.map(|(side, index)| {
            let shoulder = chest.transform_point3(DVec3::new(0.0, side * build.shoulder, 0.0));
            let hand = chest.transform_point3(pose.hands[index].into());
            let outwards = chest.transform_vector3(DVec3::new(-0.5, side, -0.8));
            [shoulder, bend(shoulder, hand, build.arms / 2.0, outwards), hand]
        });
        let legs = sides.map(|(side, index)| {
            let hip = hips.transform_point3(DVec3::new(0.0, side * build.hip, 0.0));
            let on_floor = DVec3::new(0.0, side * build.hip, -build.legs);
            let lying = turned(hips.translation, pose.tilt, 0.0);
            let standing = DAffine3::from_translation(stands);
            let base = if pose.tilt == 0.0 { standing } else { lying };
            let foot = base.transform_point3(on_floor + DVec3::from(pose.feet[index]));
            let forwards = hips.transform_vector3(DVec3::new(1.0, side * 0.2, 0.0));
            [hip, bend(hip, foot, build.legs / 2.0, forwards), foot]
        });
        let holds = chest.transform_vector3(pose.holds.into()).normalize();
        Self { hips, chest, head, arms, legs, holds }
    }
}

/// The axes at `origin` after a turn backwards and one to the right, in degrees.
pub(crate) fn turned(origin: DVec3, backwards: f64, right: f64) -> DAffine3 {
    let turn = DQuat::from_rotation_z(right.to_radians())
        * DQuat::from_rotation_y(-backwards.to_radians());
    DAffine3::from_rotation_translation(turn, origin)
}

/// The joint between two bones of that length, from `start` to `end`. It is on the side of
/// `towards`. Bones that are too short are stretched.
pub(crate) fn bend(start: DVec3, end: DVec3, bone: f64, towards: DVec3) -> DVec3 {
    let along = end - start;
    let squared = bone * bone - along.length_squared() / 4.0;
    let across = (towards - along * (towards.dot(along) / along.length_squared().max(1e-9)))
        .normalize_or_zero();
    start + along / 2.0 + across * squared.max(0.0).sqrt()
}
