//! Shadows: one ray from each visible surface point towards the sun.
//!
//! Spheres and boxes cast shadows. Planes cast none: a plane overhead would put everything in
//! shadow. A body casts no shadow on itself, because its side away from the sun is dark anyway. It
//! casts none on the bodies that it encloses, because a sphere around a whole scene is the sky of
//! the scene.
//!
//! All shadow rays have the same direction. Projected along it, a body covers an interval of an
//! axis perpendicular to the light. The rays of neighbouring pixels also cover an interval, and
//! only bodies whose interval overlaps it are tested: first with boxes around the body and the
//! pixels, then exactly for each ray. An interval tree in a sorted array finds these bodies. Li and
//! Rong ("Bedtk", 2021) describe this layout. Rejected: a grid perpendicular to the light, as in
//! the light buffer of Haines and Greenberg (1986). A few huge bodies would fill all its cells.

use glam::DVec3;

use super::lanes::{Lanes, Vectors, greatest, in_widest_registers};
use super::relative_shape::RelativeBlock;
use crate::world::scene::{Body, BodyShape, Sun};

/// A bound on the rounding of a position, as a fraction of it.
const MARGIN: f64 = 1e-9;

/// The largest number of occluders that are tested one by one.
const MAX_IN_LEAF: usize = 8;

/// The bodies of a scene that cast shadows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shadows {
    /// The bodies and the sun for which the tree was made.
    bodies: Vec<Body>,
    sun: Option<Sun>,
    light: LightAxes,
    /// The interval tree, in order: the middle of a range is its root.
    occluders: Vec<Occluder>,
}

/// Three perpendicular unit vectors. The first is the direction of all shadow rays.
#[derive(Clone, Copy, Debug, Default)]
struct LightAxes {
    toward_sun: DVec3,
    /// The axis of the interval tree.
    across: DVec3,
    upwards: DVec3,
    /// The signs of the components of `toward_sun`; zero for a component that is zero.
    signs: DVec3,
}

/// A body that casts a shadow.
#[derive(Clone, Copy, Debug)]
struct Occluder {
    /// The index in the scene.
    body: usize,
    shape: BodyShape,
    /// The interval that the body covers on the axis of the tree.
    across: Interval,
    /// The greatest end of `across` in the range with this root.
    highest: f64,
    /// The interval that the body covers on the other axis perpendicular to the light.
    upwards: Interval,
    /// The corner towards the sun of the box around the body, with the signs of
    /// [`LightBox::sunward`].
    sunward: DVec3,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    low: f64,
    high: f64,
}

/// A box around some points, in the coordinates of the light.
#[derive(Clone, Copy, Debug)]
struct LightBox {
    across: Interval,
    upwards: Interval,
    /// The corner away from the sun. A coordinate that decreases towards the sun is negated, and a
    /// coordinate that does not change is zero.
    sunward: DVec3,
}

impl Shadows {
    /// Prepares the tree for `bodies` under `sun`. Keeps the tree of the last frame if both are
    /// unchanged.
    pub(crate) fn begin(&mut self, bodies: &[Body], sun: &Sun) {
        if self.sun == Some(*sun) && self.bodies == bodies {
            return;
        }
        self.sun = Some(*sun);
        self.bodies.clear();
        self.bodies.extend_from_slice(bodies);
        self.light = LightAxes::new(sun.toward());
        self.occluders.clear();
        self.occluders.reserve(bodies.len());
        let light = &self.light;
        let occluder = |(body, found): (usize, &Body)| Occluder::new(body, found.shape, light);
        self.occluders.extend(bodies.iter().enumerate().filter_map(occluder));
        self.occluders.sort_unstable_by(|one, other| one.across.low.total_cmp(&other.across.low));
        set_highest(&mut self.occluders);
    }

    /// Sets the `brightness` of each of `points` to `ambient` if a body is between it and the sun.
    /// All points are on the surface of `body` and, up to rounding, in the box between the two
    /// corners `bounds`. Returns the number of bodies whose boxes are tested, and the number of
    /// bodies against which the points are tested exactly.
    pub(crate) fn darken(
        &self,
        points: &Vectors,
        bounds: [DVec3; 2],
        body: usize,
        ambient: f64,
        brightness: &mut Lanes,
    ) -> (u64, u64) {
        let around = self.light.around(bounds);
        let (mut boxes, mut exact) = (0, 0);
        any_at(&self.occluders, around.across, &mut |occluder| {
            boxes += 1;
            if occluder.body == body || !occluder.may_hide(&around) {
                return false;
            }
            exact += 1;
            let (shape, direction) = (&occluder.shape, self.light.toward_sun);
            in_widest_registers(
                #[inline(always)]
                || darken_behind(shape, points, direction, ambient, brightness),
            );
            greatest(brightness) <= ambient
        });
        (boxes, exact)
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

    fn around(&self, [low, high]: [DVec3; 2]) -> LightBox {
        let (half, center) = ((high - low) / 2.0, (high + low) / 2.0);
        let sum = |vector: DVec3| vector.dot(DVec3::ONE);
        let margin = MARGIN * sum(half + center.abs());
        let interval = |axis: DVec3| {
            let (place, reach) = (center.dot(axis), half.dot(axis.abs()) + margin);
            Interval { low: place - reach, high: place + reach }
        };
        LightBox {
            across: interval(self.across),
            upwards: interval(self.upwards),
            sunward: (low * self.signs).min(high * self.signs) - margin,
        }
    }
}

impl Occluder {
    fn new(body: usize, shape: BodyShape, light: &LightAxes) -> Option<Self> {
        let [low, high] = shape.bounds()?;
        let half = (high - low) / 2.0;
        let center = low + half;
        let margin = MARGIN * (half.length() + center.length());
        let interval = |axis: DVec3| {
            let reach = match shape {
                BodyShape::Sphere(sphere) => sphere.radius(),
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

    /// Whether the body can be between the sun and one of the points in this box.
    fn may_hide(&self, around: &LightBox) -> bool {
        self.upwards.overlaps(around.upwards) && around.sunward.cmple(self.sunward).all()
    }
}

impl Interval {
    fn overlaps(self, other: Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }
}

/// Sets the greatest end of each range of `occluders`, and returns the greatest end of all.
fn set_highest(occluders: &mut [Occluder]) -> f64 {
    let (before, rest) = occluders.split_at_mut(occluders.len() / 2);
    let [root, after @ ..] = rest else { return f64::NEG_INFINITY };
    root.highest = root.across.high.max(set_highest(before)).max(set_highest(after));
    root.highest
}

/// Whether `is_such` holds for any of `occluders` whose interval overlaps `places`.
fn any_at(
    occluders: &[Occluder],
    places: Interval,
    is_such: &mut impl FnMut(&Occluder) -> bool,
) -> bool {
    if occluders.len() <= MAX_IN_LEAF {
        return occluders.iter().any(|it| it.across.overlaps(places) && is_such(it));
    }
    let (before, rest) = occluders.split_at(occluders.len() / 2);
    let [root, after @ ..] = rest else { return false };
    if root.highest < places.low {
        return false;
    }
    any_at(before, places, is_such)
        || root.across.low <= places.high
            && (places.low <= root.across.high && is_such(root) || any_at(after, places, is_such))
}

/// Sets the `brightness` of each of `points` to `ambient` if a ray from this point along the unit
/// vector `direction` enters `shape` from outside.
#[inline(always)]
fn darken_behind(
    shape: &BodyShape,
    points: &Vectors,
    direction: DVec3,
    ambient: f64,
    brightness: &mut Lanes,
) {
    match shape {
        BodyShape::Plane(_) => {}
        BodyShape::Sphere(sphere) => {
            let (center, square) = (sphere.center(), sphere.radius() * sphere.radius());
            darken_if(brightness, ambient, |lane| {
                let center = center - points.get(lane);
                let along = center.dot(direction);
                let beside = center - direction * along;
                (center.dot(center) > square) & (along > 0.0) & (beside.dot(beside) < square)
            });
        }
        BodyShape::Block(block) => darken_if(brightness, ambient, |lane| {
            let (enters, leaves) = RelativeBlock::new(block, points.get(lane)).crossings(direction);
            let enter = enters.max_element();
            (enter > 0.0) & (enter < leaves.min_element())
        }),
    }
}

#[inline(always)]
fn darken_if(brightness: &mut Lanes, ambient: f64, is_dark: impl Fn(usize) -> bool) {
    for (lane, brightness) in brightness.iter_mut().enumerate() {
        *brightness = if is_dark(lane) { ambient } else { *brightness };
    }
}

#[cfg(test)]
mod tests;
