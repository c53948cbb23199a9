//! Shadows: one ray from each visible surface point towards the sun.
//!
//! Spheres and boxes cast shadows. Planes cast none: a plane overhead would put everything in
//! shadow. A body casts no shadow on itself, as the side away from the sun is dark anyway, and none
//! on the bodies that it encloses: a sphere around a whole scene is its sky.
//!
//! All shadow rays have the same direction. Projected along it, a body covers an interval of an
//! axis perpendicular to the light. Only bodies whose interval contains the ray's position are
//! tested. An interval tree in a sorted array finds them; Li and Rong ("Bedtk", 2021) describe this
//! layout. A grid perpendicular to the light, as in the light buffer of Haines and Greenberg
//! (1986), was refused: a few huge bodies would fill all its cells.

use glam::DVec3;

use super::body::{Body, Shape};
use super::light::Sun;

/// The bodies of a scene that cast shadows.
#[derive(Clone, Debug, Default)]
pub(super) struct Shadows {
    toward_sun: DVec3,
    /// An axis perpendicular to the light.
    across: DVec3,
    /// The interval tree, in order: the middle of a range is its root.
    occluders: Vec<Occluder>,
}

/// A body that casts a shadow.
#[derive(Clone, Copy, Debug)]
struct Occluder {
    /// The index in the scene.
    body: usize,
    shape: Shape,
    /// The interval that the body covers on the axis perpendicular to the light, from `low` to
    /// `high`.
    low: f64,
    high: f64,
    /// The greatest `high` in the range whose root this is.
    highest: f64,
}

impl Shadows {
    /// Prepares the tree for `bodies` under `sun`.
    pub(super) fn begin(&mut self, bodies: &[Body], sun: &Sun) {
        self.toward_sun = sun.toward();
        // Bodies are more often side by side than above each other.
        self.across = self.toward_sun.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        self.occluders.clear();
        self.occluders.reserve(bodies.len());
        let across = self.across;
        let occluder = |(body, found): (usize, &Body)| Occluder::new(body, found.shape, across);
        self.occluders.extend(bodies.iter().enumerate().filter_map(occluder));
        self.occluders.sort_unstable_by(|one, other| one.low.total_cmp(&other.low));
        set_highest(&mut self.occluders);
    }

    /// Whether a body is between the sun and `point`, which is on the surface of `body`. Each test
    /// is counted in `tests`.
    pub(super) fn hides_sun(&self, point: DVec3, body: usize, tests: &mut u64) -> bool {
        let place = point.dot(self.across);
        any_at(&self.occluders, place, &mut |occluder| {
            *tests += 1;
            occluder.body != body && is_before(&occluder.shape, point, self.toward_sun)
        })
    }
}

impl Occluder {
    fn new(body: usize, shape: Shape, across: DVec3) -> Option<Self> {
        /// A bound on the rounding of a position, as a fraction of it.
        const MARGIN: f64 = 1e-9;
        let (center, reach) = match shape {
            Shape::Plane(_) => return None,
            Shape::Sphere(sphere) => (sphere.center(), sphere.radius()),
            Shape::Block(block) => {
                let half = (block.high() - block.low()) / 2.0;
                (block.low() + half, half.dot(across.abs()))
            }
        };
        let reach = reach + MARGIN * (reach + center.length());
        let place = center.dot(across);
        let (low, high) = (place - reach, place + reach);
        Some(Self { body, shape, low, high, highest: high })
    }
}

/// Sets the greatest end of each range of `occluders`, and returns that of the whole.
fn set_highest(occluders: &mut [Occluder]) -> f64 {
    let (before, rest) = occluders.split_at_mut(occluders.len() / 2);
    let [root, after @ ..] = rest else { return f64::NEG_INFINITY };
    root.highest = root.high.max(set_highest(before)).max(set_highest(after));
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
        || root.low <= place
            && (place <= root.high && is_such(root) || any_at(after, place, is_such))
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
