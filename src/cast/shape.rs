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
    pub(crate) fn new(ray: &Ray, cell: Cell, outline: Outline) -> Self {
        match outline {
            Outline::Pillar(radius) => {
                let Some(chord) = Chord::new(ray, cell, radius) else { return Self::NONE };
                Self { hit: chord.hit(ray, cell, radius), end: chord.end() }
            }
            Outline::Line(line) => Self { hit: meet_line(ray, cell, line), end: None },
        }
    }
}

/// The hit of `ray`, which passes through `cell`, on the shape of this `outline` there. `None` if
/// it misses.
pub(crate) fn meet(ray: &Ray, cell: Cell, outline: Outline) -> Option<Hit> {
    Passage::new(ray, cell, outline).hit
}

fn meet_line(ray: &Ray, cell: Cell, line: Line) -> Option<Hit> {
    let (start, extent) = (line.start(cell), line.stretch());
    let (across, exponent) = speed_across(ray, extent);
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
    let t = to_line.over_scaled(across, exponent).abs();
    let along = cross(ray.origin(), ray.direction(), start).over_scaled(across, exponent);
    let along = along.clamp(0.0, 1.0) + 0.0;
    let u = if across > 0.0 { along } else { 1.0 - along };
    Some(Hit { cell, side: facing(extent.perp()), t, u })
}

/// The speed of `ray` towards a line with this `extent`, from its left or its right, rounded at most once,
/// and the exponent of a power of two by which it is divided.
fn speed_across(ray: &Ray, extent: DVec2) -> (f64, i32) {
    let across = |direction: DVec2| direction.x * extent.y - direction.y * extent.x;
    if extent.x == 0.0 || extent.y == 0.0 {
        // This is one of the components, which underflows in no other unit.
        return (across(ray.direction()), 0);
    }
    let (direction, exponent) = ray.scaled_direction();
    (across(direction), exponent)
}

/// The chord of a pillar on the line of a ray.
struct Chord {
    /// The `t` of the ray at its start; `None` if that is behind the ray's origin.
    start: Option<f64>,
    /// The `t` of the ray at its end.
    end: f64,
    /// Half its length, and the signed distance of the line from the axis, both multiplied by the length of the
    /// ray's scaled direction.
    half_length: f64,
    miss: f64,
}

impl Chord {
    /// The chord on the line of `ray`; `None` if the line misses the pillar.
    fn new(ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Self> {
        /// From further away, squares overflow.
        const FARTHEST: f64 = 1e100;
        let (center, radius) = (cell.center(), radius.cells());
        let (direction, _) = ray.scaled_direction();
        let way = center - ray.origin();
        if way.abs().max_element() > FARTHEST {
            return Self::from_afar(ray, center, radius);
        }
        if is_clearly_beside(way, direction, radius) {
            return None;
        }
        Self::from_near(ray, center, radius)
    }

    fn from_near(ray: &Ray, center: DVec2, radius: f64) -> Option<Self> {
        let (direction, exponent) = ray.scaled_direction();
        let x = DoubleDouble::sum(center.x, -ray.origin().x);
        let y = DoubleDouble::sum(center.y, -ray.origin().y);
        let (along_x, along_y) = (DoubleDouble::from(direction.x), DoubleDouble::from(direction.y));
        let to_middle = (x * along_x + y * along_y).rounded();
        let miss = x * along_y - y * along_x;
        let length_squared = along_x.square() + along_y.square();
        let radius_squared = DoubleDouble::product(radius, radius);
        let half_length_squared = (radius_squared * length_squared - miss.square()).rounded();
        if half_length_squared < 0.0 {
            return None;
        }
        let half_length = half_length_squared.sqrt();
        // The squared distance of the origin from the axis minus the squared radius.
        let outside = (x.square() + y.square() - radius_squared).rounded();
        let unscaled = |t: f64| libm::scalbn(t, -exponent);
        let is_ahead = outside >= 0.0 && to_middle > 0.0;
        // Of the two forms of each solution, these add terms of the same sign.
        let end = if to_middle > 0.0 {
            (to_middle + half_length) / length_squared.rounded()
        } else {
            -outside / (half_length - to_middle)
        };
        Some(Self {
            start: is_ahead.then(|| unscaled(outside / (to_middle + half_length))),
            end: unscaled(end),
            half_length,
            miss: miss.rounded(),
        })
    }

    /// The chord on the line of a ray from so far away that its ends are at the same distance.
    fn from_afar(ray: &Ray, center: DVec2, radius: f64) -> Option<Self> {
        /// The exponent of a unit of length in which no distance overflows.
        const UNIT: i32 = 8;
        let (direction, exponent) = ray.scaled_direction();
        let miss = cross(ray.origin(), ray.direction(), center).over_scaled(1.0, exponent);
        let length_squared = direction.length_squared();
        let half_length_squared = radius * radius * length_squared - miss * miss;
        if half_length_squared < 0.0 {
            return None;
        }
        let way = (center - ray.origin()) * libm::scalbn(1.0, -UNIT);
        let t = libm::scalbn(way.dot(direction) / length_squared, UNIT - exponent);
        let half_length = half_length_squared.sqrt();
        Some(Self { start: Some(t).filter(|&t| t > 0.0), end: t, half_length, miss })
    }

    /// The hit of `ray`, from outside, on the pillar with this `radius` in `cell`.
    fn hit(&self, ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Hit> {
        let t = self.start?;
        let (direction, _) = ray.scaled_direction();
        let outward = direction.perp() * self.miss - direction * self.half_length;
        Some(Hit { cell, side: facing(outward), t, u: around_pillar(outward, radius.cells()) })
    }

    /// The `t` at which the ray leaves the pillar; `None` if that is behind the origin.
    fn end(&self) -> Option<f64> {
        Some(self.end).filter(|&t| t >= 0.0)
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

#[cfg(test)]
mod tests;
