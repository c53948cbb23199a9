//! Shapes within a cell: where a ray meets a pillar or a line.
//!
//! Both are solved from the ray's own start, and neither by steps: a line by the quotient of two cross
//! products, whose signs tell without rounding on which side of its ends the ray passes; a pillar by a
//! quadratic equation in numbers of twice the digits. The ends belong to the line, and a ray that
//! just touches a pillar hits it. One that runs along a line, or starts inside a pillar, meets
//! nothing.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{Hit, Ray, Side};
use crate::numeric::{DoubleDouble, cross, sign_of_cross};
use crate::world::{Cell, Line, Outline, PillarRadius};

/// Where a ray passes through a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    /// Where it meets the outside; `None` where it passes by, or starts inside.
    pub(crate) hit: Option<Hit>,
    /// How far along the ray it comes out, if it has been inside: a line has no inside.
    pub(crate) end: Option<f64>,
}

impl Passage {
    pub(crate) const NONE: Self = Self { hit: None, end: None };

    /// The one of `ray`, which is in `cell` for a while, through the shape of that outline there.
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

/// Where `ray`, which is in `cell` for a while, meets the shape of that outline there. `None` where it
/// passes it by.
pub(super) fn meet(ray: &Ray, cell: Cell, outline: Outline) -> Option<Hit> {
    Passage::new(ray, cell, outline).hit
}

fn meet_line(ray: &Ray, cell: Cell, line: Line) -> Option<Hit> {
    let (start, stretch) = (line.start(cell), line.stretch());
    let (direction, exponent) = ray.scaled_direction();
    // How fast the line is approached, from its left or its right; rounded at most once.
    let across = direction.x * stretch.y - direction.y * stretch.x;
    let side_of = |end| sign_of_cross(ray.origin(), ray.direction(), end);
    let (from_start, from_end) = (side_of(start), side_of(start + stretch));
    let is_beside = from_start > 0.0 && from_end > 0.0 || from_start < 0.0 && from_end < 0.0;
    if across == 0.0 || is_beside {
        return None;
    }
    let to_line = cross(ray.origin(), stretch, start);
    let is_ahead = to_line.sign() == 0.0 || (to_line.sign() > 0.0) == (across > 0.0);
    if !is_ahead {
        return None;
    }
    let t = libm::scalbn(to_line.over(across), -exponent).abs();
    let along = cross(ray.origin(), direction, start).over(across).clamp(0.0, 1.0) + 0.0;
    let u = if across > 0.0 { along } else { 1.0 - along };
    Some(Hit { cell, side: facing(stretch.perp()), t, u })
}

/// The part of a line that is in a pillar, in numbers that are larger by the length of the ray's scaled
/// direction.
struct Chord {
    /// The way from the ray's start to the middle of the chord.
    to_closest: f64,
    half_length: f64,
    /// By how much the square of the start's distance from the axis is larger than that of the radius;
    /// not larger by anything.
    outside: f64,
    /// By how much the line misses the axis, to one side.
    miss: f64,
    /// The square of the length that it all is larger by.
    scale_squared: f64,
}

impl Chord {
    /// The chord of the line that `ray` is part of; `None` where that passes by.
    fn new(ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Self> {
        /// From further away than that, squares are beyond what a double holds.
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

    /// Where `ray`, from outside, meets the pillar of that `radius` in `cell`.
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

    /// How far along `ray` it comes out; `None` where that is behind it.
    fn end(&self, ray: &Ray) -> Option<f64> {
        // Of the two ways to write the solution, the one that adds up what has one sign.
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

/// Whether a line along `direction` passes a circle at `way` by more than all rounding of doubles
/// amounts to: most of those that pass it do, and need no more digits.
fn is_clearly_beside(way: DVec2, direction: DVec2, radius: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    let miss = (way.x * direction.y - way.y * direction.x).abs();
    let reach = radius * direction.length();
    miss > reach + (reach + way.x.abs() + way.y.abs()) * ROUNDING
}

/// How far along its paper a pillar shows where it faces `outward`. The paper is pasted around it as
/// many times as lets a cell of it be nearest to a cell wide.
fn around_pillar(outward: DVec2, radius: f64) -> f64 {
    let times = (TAU * radius).round().max(1.0);
    let turn = libm::atan2(-outward.y, outward.x) / TAU * times;
    // What is just below 0 would be rounded to 1, the left edge of the next sheet.
    Some(turn - turn.floor()).filter(|&u| u < 1.0).unwrap_or_default()
}

/// The kind of grid line that something runs along most, which faces along `normal`.
fn facing(normal: DVec2) -> Side {
    if normal.x.abs() >= normal.y.abs() { Side::X } else { Side::Y }
}
