//! The chord of a pillar on the line of a ray: whether there is one, and where it starts and ends.
//!
//! Both ends are roots of a quadratic equation. Its discriminant is a difference of two squares, which loses all
//! digits of a double where the ray barely touches the pillar.
//!
//! - A ray that touches the pillar in one point hits it. A ray from inside hits nothing.
//! - Double-double arithmetic finds the ends for nearly all rays. A sign or a distance that its rounding might
//!   change is found by integers of any length instead, for every finite ray. So the answer is exact, and
//!   distances are within one unit in their last place.
//! - Integers take some microseconds, and allocate. Of the rays that pass a pillar ten cells away, one in 10¹⁰
//!   needs them.
//!
//! Rejected: expansions of doubles (Shewchuk, 1997). Their products overflow and underflow at the ends of the
//! range, where the exact answer is needed most.

use std::f64::consts::TAU;

use glam::DVec2;
use num_bigint::{BigInt, Sign};

use super::through::facing;
use super::{Hit, Ray};
use crate::numeric::DoubleDouble;
use crate::world::{Cell, PillarRadius};

/// The chord of a pillar on the line of a ray.
pub(crate) struct Chord {
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
    pub(crate) fn new(ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Self> {
        let (center, radius) = (cell.center(), radius.cells());
        let (direction, _) = ray.scaled_direction();
        if is_clearly_beside(center - ray.origin(), direction, radius) {
            return None;
        }
        Self::by_doubles(ray, center, radius)
            .unwrap_or_else(|Doubt| Self::by_integers(ray, center, radius))
    }

    /// The chord by double-double arithmetic, unless the rounding of its 2⁻¹⁰⁰ may change the result.
    fn by_doubles(ray: &Ray, center: DVec2, radius: f64) -> Result<Option<Self>, Doubt> {
        /// The least share that is left of numbers after a subtraction. Both subtractions together then leave 55
        /// bits of a distance.
        const LEAST_SHARE: f64 = 1.0 / (1_u64 << 44) as f64;
        let (direction, exponent) = ray.scaled_direction();
        let x = DoubleDouble::sum(center.x, -ray.origin().x);
        let y = DoubleDouble::sum(center.y, -ray.origin().y);
        let (along_x, along_y) = (DoubleDouble::from(direction.x), DoubleDouble::from(direction.y));
        let (right, left) = (x * along_y, y * along_x);
        let miss = right - left;
        let length_squared = along_x.square() + along_y.square();
        let radius_squared = DoubleDouble::product(radius, radius);
        let reach_squared = radius_squared * length_squared;
        let half_length_squared = reach_squared - miss.square();
        let way_squared = x.square() + y.square();
        // The squared distance of the origin from the axis minus the squared radius.
        let outside = way_squared - radius_squared;
        let products = right.rounded().abs() + left.rounded().abs();
        let is_clear =
            |difference: DoubleDouble, of: f64| difference.rounded().abs() > of * LEAST_SHARE;
        // Not true for numbers that overflow, either.
        if !is_clear(half_length_squared, reach_squared.rounded() + products * products)
            || !is_clear(outside, way_squared.rounded() + radius_squared.rounded())
        {
            return Err(Doubt);
        }
        if half_length_squared.rounded() < 0.0 {
            return Ok(None);
        }
        let half_length = half_length_squared.sqrt();
        let to_middle = x * along_x + y * along_y;
        let is_toward = to_middle.rounded() > 0.0;
        let unscaled = |t: f64| libm::scalbn(t, -exponent);
        // Each solution has two forms. These forms add terms of the same sign.
        let end = if is_toward {
            (to_middle + half_length).over(length_squared)
        } else {
            -outside.over(half_length - to_middle)
        };
        let is_ahead = is_toward && outside.rounded() > 0.0;
        Ok(Some(Self {
            start: is_ahead.then(|| unscaled(outside.over(to_middle + half_length))),
            end: unscaled(end),
            half_length: half_length.rounded(),
            miss: miss.rounded(),
        }))
    }

    /// The chord by integers, with the same formulas. Lengths have a power of two as their unit, and so have the
    /// direction's components.
    fn by_integers(ray: &Ray, center: DVec2, radius: f64) -> Option<Self> {
        /// The bits of half the chord below the unit.
        const FRACTION: u32 = 64;
        let (origin, direction) = (ray.origin(), ray.direction());
        let unit = unit_of(&[center.x, center.y, origin.x, origin.y, radius]);
        let speed_unit = unit_of(&direction.to_array());
        let length = |value| in_units(value, unit);
        let (x, y) = (length(center.x) - length(origin.x), length(center.y) - length(origin.y));
        let radius_squared = length(radius).pow(2);
        let [along_x, along_y] = direction.to_array().map(|it| in_units(it, speed_unit));
        let miss = &x * &along_y - &y * &along_x;
        let length_squared = along_x.pow(2) + along_y.pow(2);
        let half_length_squared = &radius_squared * &length_squared - miss.pow(2);
        if half_length_squared.sign() == Sign::Minus {
            return None;
        }
        let half_length = (half_length_squared << (2 * FRACTION)).sqrt();
        let to_middle: BigInt = (&x * along_x + &y * along_y) << FRACTION;
        let outside: BigInt = (x.pow(2) + y.pow(2) - radius_squared) << FRACTION;
        let is_toward = to_middle.sign() == Sign::Plus;
        let is_ahead = is_toward && outside.sign() != Sign::Minus;
        let unit_of_t = unit - speed_unit;
        let start = is_ahead.then(|| quotient(&outside, &(&to_middle + &half_length), unit_of_t));
        let end = if is_toward {
            quotient(&(to_middle + &half_length), &(length_squared << FRACTION), unit_of_t)
        } else {
            -quotient(&outside, &(&half_length - to_middle), unit_of_t)
        };
        let (_, exponent) = ray.scaled_direction();
        let unit_of_product = unit + speed_unit - exponent;
        Some(Self {
            start,
            end,
            half_length: to_double(&half_length, unit_of_product - FRACTION as i32),
            miss: to_double(&miss, unit_of_product),
        })
    }

    /// The hit of `ray`, from outside, on the pillar with this `radius` in `cell`.
    pub(crate) fn hit(&self, ray: &Ray, cell: Cell, radius: PillarRadius) -> Option<Hit> {
        let t = self.start?;
        let (direction, _) = ray.scaled_direction();
        let outward = direction.perp() * self.miss - direction * self.half_length;
        Some(Hit { cell, side: facing(outward), t, u: around_pillar(outward, radius.cells()) })
    }

    /// The `t` at which the ray leaves the pillar; `None` if that is behind the origin.
    pub(crate) fn end(&self) -> Option<f64> {
        Some(self.end).filter(|&t| t >= 0.0)
    }
}

/// Rounding may change a result.
struct Doubt;

/// Returns whether a line along `direction` misses a circle at `way` by more than the rounding of
/// doubles. This holds for most lines that miss, which then need no double-double arithmetic.
fn is_clearly_beside(way: DVec2, direction: DVec2, radius: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    let miss = (way.x * direction.y - way.y * direction.x).abs();
    let reach = radius * direction.length();
    miss > reach + (reach + way.x.abs() + way.y.abs()) * ROUNDING
}

/// The texture coordinate of a pillar's surface with the normal `outward`. The texture repeats
/// around the pillar a whole number of times, so that each copy is as close as possible to one cell
/// wide.
fn around_pillar(outward: DVec2, radius: f64) -> f64 {
    let times = (TAU * radius).round().max(1.0);
    let turn = libm::atan2(-outward.y, outward.x) / TAU * times;
    // A value just below 0 would be rounded to 1, the left edge of the next copy.
    Some(turn - turn.floor()).filter(|&u| u < 1.0).unwrap_or_default()
}

/// An integer and the exponent of two whose product is `value`.
fn integer_and_exponent(value: f64) -> (i64, i32) {
    const BITS: i32 = f64::MANTISSA_DIGITS as i32;
    let (part, exponent) = libm::frexp(value);
    (libm::scalbn(part, BITS) as i64, exponent - BITS)
}

/// The exponent of a power of two of which all `values` are multiples. At least one is not 0.
pub(crate) fn unit_of(values: &[f64]) -> i32 {
    let exponents = values.iter().filter(|&&it| it != 0.0).map(|&it| integer_and_exponent(it).1);
    exponents.min().expect("a length or a direction that is not 0")
}

/// `value` in units of 2^`unit`, of which it is a multiple.
pub(crate) fn in_units(value: f64, unit: i32) -> BigInt {
    let (integer, exponent) = integer_and_exponent(value);
    if integer == 0 { BigInt::ZERO } else { BigInt::from(integer) << (exponent - unit) }
}

/// `dividend` / `divisor` · 2^`exponent`; 0 if the dividend is 0.
fn quotient(dividend: &BigInt, divisor: &BigInt, exponent: i32) -> f64 {
    /// More bits than a double has.
    const BITS: u64 = 66;
    if *dividend == BigInt::ZERO {
        return 0.0;
    }
    let shift = (divisor.bits() + BITS).saturating_sub(dividend.bits());
    to_double(&((dividend << shift) / divisor), exponent - shift as i32)
}

/// `integer` · 2^`exponent`.
fn to_double(integer: &BigInt, exponent: i32) -> f64 {
    let excess = integer.bits().saturating_sub(64);
    let top = i128::try_from(integer >> excess).expect("64 bits are left");
    libm::scalbn(top as f64, exponent + excess as i32)
}

#[cfg(test)]
mod tests;
