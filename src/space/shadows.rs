//! Shadows: one ray from each visible surface point towards the sun.
//!
//! Spheres and boxes cast shadows. Planes cast none: a plane overhead would put everything in
//! shadow. A body casts no shadow on itself, as the side away from the sun is dark anyway, and none
//! on the bodies that it encloses: a sphere around a whole scene is its sky.
//!
//! All shadow rays have the same direction. Projected along it, a body covers an interval of an
//! axis perpendicular to the light. Only bodies whose interval contains the ray's position are
//! tested: first against boxes around them, which is fast, and then exactly. An interval tree in a sorted array finds them; Li and Rong ("Bedtk", 2021) describe this
//! layout. A grid perpendicular to the light, as in the light buffer of Haines and Greenberg
//! (1986), was refused: a few huge bodies would fill all its cells.

use glam::DVec3;

use super::body::{Body, Shape};
use super::light::Sun;

/// A bound on the rounding of a position, as a fraction of it.
const MARGIN: f64 = 1e-9;

/// The bodies of a scene that cast shadows.
#[derive(Clone, Debug, Default)]
pub(super) struct Shadows {
    light: LightAxes,
    /// The interval tree, in order: the middle of a range is its root.
    occluders: Vec<Occluder>,
}

/// Three perpendicular unit vectors, of which one is the direction of all shadow rays.
#[derive(Clone, Copy, Debug, Default)]
struct LightAxes {
    toward_sun: DVec3,
    /// The axis of the interval tree.
    across: DVec3,
    upwards: DVec3,
    /// The signs of `toward_sun`; zero where it is zero.
    signs: DVec3,
}

/// A body that casts a shadow.
#[derive(Clone, Copy, Debug)]
struct Occluder {
    /// The index in the scene.
    body: usize,
    shape: Shape,
    /// The interval that the body covers on the axis of the tree.
    across: Interval,
    /// The greatest end of `across` in the range whose root this is.
    highest: f64,
    /// The interval that the body covers on the other axis perpendicular to the light.
    upwards: Interval,
    /// The corner towards the sun of the box around the body, as [`LightPoint::sunward`].
    sunward: DVec3,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    low: f64,
    high: f64,
}

/// A point in the coordinates of the light.
#[derive(Clone, Copy, Debug)]
struct LightPoint {
    across: f64,
    upwards: f64,
    /// The point itself; coordinates are negated that decrease towards the sun, and zero if they do
    /// not change.
    sunward: DVec3,
}

impl Shadows {
    /// Prepares the tree for `bodies` under `sun`.
    pub(super) fn begin(&mut self, bodies: &[Body], sun: &Sun) {
        self.light = LightAxes::new(sun.toward());
        self.occluders.clear();
        self.occluders.reserve(bodies.len());
        let light = &self.light;
        let occluder = |(body, found): (usize, &Body)| Occluder::new(body, found.shape, light);
        self.occluders.extend(bodies.iter().enumerate().filter_map(occluder));
        self.occluders.sort_unstable_by(|one, other| one.across.low.total_cmp(&other.across.low));
        set_highest(&mut self.occluders);
    }

    /// Whether a body is between the sun and `point`, which is on the surface of `body`. Each test
    /// is counted in `tests`.
    pub(super) fn hides_sun(&self, point: DVec3, body: usize, tests: &mut u64) -> bool {
        let place = self.light.place_of(point);
        any_at(&self.occluders, place.across, &mut |occluder| {
            *tests += 1;
            occluder.body != body
                && occluder.may_hide(place)
                && is_before(&occluder.shape, point, self.light.toward_sun)
        })
    }
}

impl LightAxes {
    fn new(toward_sun: DVec3) -> Self {
        // Bodies are more often side by side than above each other.
        let across = toward_sun.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        let has_sign = DVec3::select(toward_sun.cmpeq(DVec3::ZERO), DVec3::ZERO, DVec3::ONE);
        let signs = toward_sun.signum() * has_sign;
        Self { toward_sun, across, upwards: toward_sun.cross(across), signs }
    }

    fn place_of(&self, point: DVec3) -> LightPoint {
        let Self { across, upwards, signs, .. } = self;
        LightPoint {
            across: point.dot(*across),
            upwards: point.dot(*upwards),
            sunward: point * signs,
        }
    }
}

impl Occluder {
    fn new(body: usize, shape: Shape, light: &LightAxes) -> Option<Self> {
        let [low, high] = shape.bounds()?;
        let half = (high - low) / 2.0;
        let center = low + half;
        let margin = MARGIN * (half.length() + center.length());
        let interval = |axis: DVec3| {
            let reach = match shape {
                Shape::Sphere(sphere) => sphere.radius(),
                _ => half.dot(axis.abs()),
            };
            let (place, reach) = (center.dot(axis), reach + margin);
            Interval { low: place - reach, high: place + reach }
        };
        let across = interval(light.across);
        Some(Self {
            body,
            shape,
            across,
            highest: across.high,
            upwards: interval(light.upwards),
            sunward: center * light.signs + half + margin,
        })
    }

    /// Whether the body can be between the sun and this place, by boxes around it.
    fn may_hide(&self, place: LightPoint) -> bool {
        self.upwards.low <= place.upwards
            && place.upwards <= self.upwards.high
            && place.sunward.cmple(self.sunward).all()
    }
}

/// Sets the greatest end of each range of `occluders`, and returns that of the whole.
fn set_highest(occluders: &mut [Occluder]) -> f64 {
    let (before, rest) = occluders.split_at_mut(occluders.len() / 2);
    let [root, after @ ..] = rest else { return f64::NEG_INFINITY };
    root.highest = root.across.high.max(set_highest(before)).max(set_highest(after));
    root.highest
}

/// Whether `is_such` holds for any of `occluders` whose interval contains `place`.
fn any_at(occluders: &[Occluder], place: f64, is_such: &mut impl FnMut(&Occluder) -> bool) -> bool {
    let (before, rest) = occluders.split_at(occluders.len() / 2);
    let [root, after @ ..] = rest else { return false };
    if root.highest < place {
        return false;
    }
    any_at(before, place, is_such)
        || root.across.low <= place
            && (place <= root.across.high && is_such(root) || any_at(after, place, is_such))
}

/// Whether a ray from `point` along the unit vector `direction` enters `shape` from outside.
fn is_before(shape: &Shape, point: DVec3, direction: DVec3) -> bool {
    match shape {
        Shape::Plane(_) => false,
        Shape::Sphere(sphere) => {
            let center = sphere.center() - point;
            let square = sphere.radius() * sphere.radius();
            let along = center.dot(direction);
            let beside = center - direction * along;
            center.length_squared() > square && along > 0.0 && beside.length_squared() < square
        }
        Shape::Block(block) => {
            let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
            for axis in 0..3 {
                let [low, high] = [block.low(), block.high()].map(|it| it[axis] - point[axis]);
                if direction[axis] == 0.0 {
                    if low > 0.0 || high < 0.0 {
                        return false;
                    }
                    continue;
                }
                let (one, other) = (low / direction[axis], high / direction[axis]);
                enter = enter.max(one.min(other));
                leave = leave.min(one.max(other));
            }
            enter > 0.0 && enter < leave
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::color::Rgb;
    use crate::space::{Block, Fraction, SolidTexture, Sphere};

    /// Points on a coarse grid, so that bodies share surfaces.
    fn point(reach: i32) -> impl Strategy<Value = DVec3> {
        [-reach..=reach, -reach..=reach, -reach..=reach]
            .prop_map(|place| DVec3::from_array(place.map(|it| f64::from(it) / 2.0)))
    }

    fn body() -> impl Strategy<Value = Body> {
        let texture = SolidTexture::Plain(Rgb::BLACK);
        let shape = prop_oneof![
            (point(12), 1..6).prop_filter_map("a sphere", |(center, radius)| {
                Sphere::new(center, f64::from(radius) / 2.0).map(Shape::Sphere)
            }),
            (point(12), point(12)).prop_filter_map("a box", |(corner, opposite)| {
                Block::new(corner, opposite).map(Shape::Block)
            }),
        ];
        shape.prop_map(move |shape| Body { shape, texture })
    }

    proptest! {
        #[test]
        fn the_tree_and_the_boxes_leave_out_no_shadow(
            bodies in prop::collection::vec(body(), 0..30),
            toward in point(3),
            points in prop::collection::vec(point(14), 1..20),
        ) {
            let ambient = Fraction::new(0.2).unwrap();
            let Some(sun) = Sun::new(toward, ambient) else { return Ok(()) };
            let mut shadows = Shadows::default();
            shadows.begin(&bodies, &sun);
            for point in points {
                let hides = |it: &(usize, &Body)| {
                    it.0 != 0 && is_before(&it.1.shape, point, sun.toward())
                };
                let expected = bodies.iter().enumerate().any(|it| hides(&it));
                prop_assert_eq!(shadows.hides_sun(point, 0, &mut 0), expected);
            }
        }
    }
}
