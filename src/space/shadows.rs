//! Shadows: a ray from what a pixel shows towards the sun.
//!
//! Spheres and boxes cast shadows. Planes cast none: they have no end, and one overhead would leave
//! nothing in the light. A body casts none on itself, as what it turns away from the sun gets none
//! of its light anyway, nor on what it encloses: a ball around a whole scene is its sky.
//!
//! All these rays have one direction. Seen along it, a body covers an interval of any axis across,
//! and only bodies whose interval holds the ray's place are tested: an interval tree in a sorted
//! array (Li and Rong, "Bedtk", 2021, describe the layout) finds them. A grid across the
//! light, Haines' light buffer, was refused: a few huge bodies would fill all of its cells.

use glam::DVec3;

use super::body::{Body, Shape};
use super::light::Sun;

/// What casts shadows in a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Shadows {
    toward_sun: DVec3,
    /// At a right angle to that.
    across: DVec3,
    /// A tree in order: the one in the middle of a range is its root.
    casters: Vec<Caster>,
}

/// A body that casts a shadow.
#[derive(Clone, Copy, Debug)]
struct Caster {
    /// Its place in the scene.
    body: usize,
    shape: Shape,
    /// What it covers of the axis across the light, from `low` to `high`.
    low: f64,
    high: f64,
    /// The highest of those in the range that it is the root of.
    highest: f64,
}

impl Shadows {
    /// Begins a frame of `bodies` under `sun`.
    pub(super) fn begin(&mut self, bodies: &[Body], sun: &Sun) {
        self.toward_sun = sun.toward();
        // Bodies lie beside each other more often than above each other.
        self.across = self.toward_sun.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        self.casters.clear();
        self.casters.reserve(bodies.len());
        let across = self.across;
        let caster = |(body, found): (usize, &Body)| Caster::new(body, found.shape, across);
        self.casters.extend(bodies.iter().enumerate().filter_map(caster));
        self.casters.sort_unstable_by(|one, other| one.low.total_cmp(&other.low));
        note_highest(&mut self.casters);
    }

    /// Whether a body is between the sun and `point`, on the surface of `body`. Each test against
    /// one is added to `tests`.
    pub(super) fn hides_sun(&self, point: DVec3, body: usize, tests: &mut u64) -> bool {
        let place = point.dot(self.across);
        any_at(&self.casters, place, &mut |caster| {
            *tests += 1;
            caster.body != body && is_before(&caster.shape, point, self.toward_sun)
        })
    }
}

impl Caster {
    fn new(body: usize, shape: Shape, across: DVec3) -> Option<Self> {
        /// More than rounding takes from a place, as a share of it.
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

/// Notes the highest end in each range of `casters`, and tells that of all.
fn note_highest(casters: &mut [Caster]) -> f64 {
    let (before, rest) = casters.split_at_mut(casters.len() / 2);
    let [root, after @ ..] = rest else { return f64::NEG_INFINITY };
    root.highest = root.high.max(note_highest(before)).max(note_highest(after));
    root.highest
}

/// Whether any of `casters` that are at `place` `is_such`.
fn any_at(casters: &[Caster], place: f64, is_such: &mut impl FnMut(&Caster) -> bool) -> bool {
    let (before, rest) = casters.split_at(casters.len() / 2);
    let [root, after @ ..] = rest else { return false };
    if root.highest < place {
        return false;
    }
    any_at(before, place, is_such)
        || root.low <= place
            && (place <= root.high && is_such(root) || any_at(after, place, is_such))
}

/// Whether a ray from `point` along `direction`, a unit vector, enters `shape` from outside.
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
