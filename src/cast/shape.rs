//! Shapes within a cell: the hit of a ray on a pillar or a line.
//!
//! Both are solved in closed form from the ray's origin. For a line, the distance is the quotient
//! of two cross products, whose exact signs tell on which side of an end the ray passes. For a
//! pillar, it is the root of a quadratic equation in double-double arithmetic. The ends belong to
//! the line, and a ray that touches a pillar hits it. A ray along the line, or from inside the
//! pillar, hits nothing.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Hit, Ray, Side};
use crate::numeric::{DoubleDouble, cross, sign_of_cross};
use crate::world::{Cell, Line, Outline, PillarRadius};

/// The intersection of a ray with a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    /// The hit on the outside; `None` if the ray misses the shape or starts inside.
    pub(crate) hit: Option<Hit>,
    /// The `t` at which the ray leaves the shape, if it was inside. A line has no inside.
    pub(crate) end: Option<f64>,
}

impl Passage {
    pub(crate) const NONE: Self = Self { hit: None, end: None };

    /// The intersection of `ray`, which passes through `cell`, with the shape of this `outline`
    /// there.
    #[inline]
    pub(super) fn new(ray: &Ray, cell: Cell, outline: Outline) -> Self {
        match outline {
            Outline::Pillar(radius) => {
                let Some(chord) = Chord::new(ray, cell, radius) else { return Self::NONE };
                Self { hit: chord.hit(ray, cell, radius), end: chord.end(ray) }
            }
            Outline::Line(line) => Self { hit: meet_line(ray, cell, line), end: None },
        }
    }
}

/// The hit of `ray`, which passes through `cell`, on the shape of this `outline` there. `None` if
/// it misses.
pub(super) fn meet(ray: &Ray, cell: Cell, outline: Outline) -> Option<Hit> {
    Passage::new(ray, cell, outline).hit
}

fn meet_line(ray: &Ray, cell: Cell, line: Line) -> Option<Hit> {
    let (start, extent) = (line.start(cell), line.stretch());
    let (direction, exponent) = ray.scaled_direction();
    // The speed towards the line, from its left or its right; rounded at most once.
    let across = direction.x * extent.y - direction.y * extent.x;
    let side_of = |end| sign_of_cross(ray.origin(), ray.direction(), end);
    let (from_start, from_end) = (side_of(start), side_of(start + extent));
    let is_beside = from_start > 0.0 && from_end > 0.0 || from_start < 0.0 && from_end < 0.0;
    if across == 0.0 || is_beside {
        return None;
    }
    let to_line = cross(ray.origin(), extent, start);
    let is_ahead = to_line.sign() == 0.0 || (to_line.sign() > 0.0) == (across > 0.0);
    if !is_ahead {
        return None;
    }
    let t = libm::scalbn(to_line.over(across), -exponent).abs();
    let along = cross(ray.origin(), direction, start).over(across).clamp(0.0, 1.0) + 0.0;
    let u = if across > 0.0 { along } else { 1.0 - along };
    Some(Hit { cell, side: facing(extent.perp()), t, u })
}

/// The chord of a pillar on a line. All values are multiplied by the length of the ray's scaled
/// direction.
struct Chord {
    /// The distance from the ray's origin to the middle of the chord.
    to_closest: f64,
    half_length: f64,
    /// The squared distance of the origin from the axis minus the squared radius. This one is not
    /// multiplied.
    outside: f64,
    /// The signed distance of the line from the axis.
    miss: f64,
    /// The square of the factor by which the others are multiplied.
    scale_squared: f64,
}

impl Chord {
    /// The chord on the line of `ray`; `None` if the line misses the pillar.
    fn new(ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Self> {
        /// Beyond this distance, squares overflow.
        const FARTHEST: f64 = 1e100;
        let (center, radius) = (cell.center(), radius.cells());
        let (direction, _) = ray.scaled_direction();
        if is_clearly_beside(center - ray.origin(), direction, radius) {
            return None;
        }
        let x = DoubleDouble::sum(center.x, -ray.origin().x);
        let y = DoubleDouble::sum(center.y, -ray.origin().y);
        if x.rounded().abs().max(y.rounded().abs()) > FARTHEST {
            return None;
        }
        let (along_x, along_y) = (DoubleDouble::from(direction.x), DoubleDouble::from(direction.y));
        let to_closest = (x * along_x + y * along_y).rounded();
        let miss = x * along_y - y * along_x;
        let length_squared = along_x.square() + along_y.square();
        let radius_squared = DoubleDouble::product(radius, radius);
        let half_length_squared = (radius_squared * length_squared - miss.square()).rounded();
        let outside = (x.square() + y.square() - radius_squared).rounded();
        (half_length_squared >= 0.0).then(|| Self {
            to_closest,
            half_length: half_length_squared.sqrt(),
            outside,
            miss: miss.rounded(),
            scale_squared: length_squared.rounded(),
        })
    }

    /// The hit of `ray`, from outside, on the pillar with this `radius` in `cell`.
    fn hit(&self, ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Hit> {
        let &Self { to_closest, half_length, outside, miss, .. } = self;
        if outside < 0.0 || to_closest <= 0.0 {
            return None;
        }
        let (direction, exponent) = ray.scaled_direction();
        let t = libm::scalbn(outside / (to_closest + half_length), -exponent);
        let outward = direction.perp() * miss - direction * half_length;
        Some(Hit { cell, side: facing(outward), t, u: around_pillar(outward, radius.cells()) })
    }

    /// The `t` at which `ray` leaves the pillar; `None` if that is behind the origin.
    fn end(&self, ray: &Ray) -> Option<f64> {
        // Of the two forms of the solution, this one adds terms of the same sign.
        let scaled = if self.to_closest > 0.0 {
            (self.to_closest + self.half_length) / self.scale_squared
        } else {
            -self.outside / (self.half_length - self.to_closest)
        };
        let (_, exponent) = ray.scaled_direction();
        let t = libm::scalbn(scaled, -exponent);
        (t >= 0.0).then_some(t)
    }
}

/// Whether a line along `direction` misses a circle at `way` by more than the rounding of doubles.
/// This holds for most lines that miss, which then need no double-double arithmetic.
fn is_clearly_beside(way: DVec2, direction: DVec2, radius: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    let miss = (way.x * direction.y - way.y * direction.x).abs();
    let reach = radius * direction.length();
    miss > reach + (reach + way.x.abs() + way.y.abs()) * ROUNDING
}

/// The texture coordinate where a pillar faces `outward`. The texture is repeated around the pillar
/// a whole number of times, so that each copy is as close as possible to one cell wide.
fn around_pillar(outward: DVec2, radius: f64) -> f64 {
    let times = (TAU * radius).round().max(1.0);
    let turn = libm::atan2(-outward.y, outward.x) / TAU * times;
    // A value just below 0 would be rounded to 1, the left edge of the next copy.
    Some(turn - turn.floor()).filter(|&u| u < 1.0).unwrap_or_default()
}

/// The kind of grid line closest in direction to a surface with this `normal`.
fn facing(normal: DVec2) -> Side {
    if normal.x.abs() >= normal.y.abs() { Side::X } else { Side::Y }
}
