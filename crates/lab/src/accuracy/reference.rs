//! The reference: the hit of a ray in rational arithmetic.
//!
//! A double is an integer times a power of two. Origin and direction are each converted to integers
//! with one common power. Crossings are computed from their definition: for each x line of the map,
//! the exact point where the ray meets it, and from that the row; for each y line, the column. The
//! hit is the nearer of two cells: the first solid cell behind an x line, and the first behind a y
//! line. No state is carried from one crossing to the next, and nothing is rounded.
//!
//! Rejected: fractions in lowest terms. Greatest common divisors would take most of the time, and
//! nothing needs them.

use std::cmp::Ordering;

use glam::DVec2;
use num_bigint::{BigInt, Sign};

use cellcaster::cast::{Hit, Ray, Side};
use cellcaster::world::{Cell, Grid};

/// The exact hit of a ray.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The cell.
    pub cell: Cell,
    /// The kind of line that the ray crosses to enter the cell.
    pub side: Side,
    /// The distance along the ray, in lengths of its direction.
    pub t: Rational,
    /// The texture coordinate, from 0 to 1.
    pub u: Rational,
}

impl Truth {
    /// Returns whether `hit` has the same cell and side.
    pub fn is_met_by(&self, hit: &Hit) -> bool {
        (self.cell, self.side) == (hit.cell, hit.side)
    }
}

/// An exact rational number: `numerator` / `denominator` · 2^`exponent`.
#[derive(Clone, Debug)]
pub struct Rational {
    numerator: BigInt,
    /// Greater than 0.
    denominator: BigInt,
    exponent: i64,
}

impl Rational {
    fn new(numerator: BigInt, denominator: BigInt, exponent: i64) -> Self {
        match denominator.sign() {
            Sign::Minus => Self { numerator: -numerator, denominator: -denominator, exponent },
            _ => Self { numerator, denominator, exponent },
        }
    }

    /// The nearest double, or the next one to it; infinite beyond the largest double.
    pub fn to_f64(&self) -> f64 {
        const QUOTIENT_BITS: i64 = 60;
        let excess = self.numerator.bits() as i64 - self.denominator.bits() as i64 - QUOTIENT_BITS;
        let (numerator, denominator) = if excess > 0 {
            (self.numerator.clone(), &self.denominator << excess)
        } else {
            (&self.numerator << -excess, self.denominator.clone())
        };
        let quotient = numerator / denominator;
        // A number of 59 to 61 bits has one digit of 64 bits.
        let magnitude = quotient.iter_u64_digits().next().unwrap_or(0) as f64;
        let quotient = if quotient.sign() == Sign::Minus { -magnitude } else { magnitude };
        libm::scalbn(quotient, (excess + self.exponent).clamp(-5000, 5000) as i32)
    }

    /// Returns whether the number is 0.
    pub fn is_zero(&self) -> bool {
        self.numerator.sign() == Sign::NoSign
    }

    /// The absolute error of a finite `value`.
    pub fn error(&self, value: f64) -> f64 {
        self.difference(value).to_f64().abs()
    }

    /// The error of a finite `value` relative to this number, which is not 0.
    pub fn relative_error(&self, value: f64) -> f64 {
        let Self { numerator, denominator, exponent } = self.difference(value);
        let share = Self::new(
            numerator * &self.denominator,
            denominator * &self.numerator,
            exponent - self.exponent,
        );
        share.to_f64().abs()
    }

    /// The absolute error of `value`, in units of its last place. Infinity counts as the number
    /// after the largest double.
    pub fn error_in_ulps(&self, value: f64) -> f64 {
        let finite = value.min(f64::MAX);
        let (_, ulp) = integer(finite);
        let mut difference = self.difference(finite);
        difference.exponent -= ulp;
        if value.is_finite() {
            return difference.to_f64().abs();
        }
        // Beyond the largest double, infinity is the nearest value.
        if difference.numerator.sign() == Sign::Plus {
            0.0
        } else {
            difference.to_f64().abs() + 1.0
        }
    }

    /// This number minus `value`.
    fn difference(&self, value: f64) -> Self {
        let (value, value_exponent) = integer(value);
        let value = value * &self.denominator;
        let shift = self.exponent - value_exponent;
        let (numerator, exponent) = if shift >= 0 {
            ((&self.numerator << shift) - value, value_exponent)
        } else {
            (&self.numerator - (value << -shift), self.exponent)
        };
        Self { numerator, denominator: self.denominator.clone(), exponent }
    }
}

/// A finite double as an integer times a power of two. The power is the value of its last place;
/// its exponent is returned.
pub(crate) fn integer(value: f64) -> (BigInt, i64) {
    const LEADING_ONE: u64 = 1 << 52;
    let biased_exponent = value.abs().to_bits() / LEADING_ONE;
    let fraction = value.to_bits() % LEADING_ONE;
    let magnitude = if biased_exponent == 0 { fraction } else { fraction + LEADING_ONE };
    let magnitude = BigInt::from(magnitude);
    let exponent = biased_exponent.max(1) as i64 - 1075;
    (if value < 0.0 { -magnitude } else { magnitude }, exponent)
}

/// Two doubles as integers times a common power of two, which is at most 2⁰.
fn integers(pair: DVec2) -> (BigInt, BigInt, i64) {
    let without_trailing_zeros = |value: f64| {
        let (integer, exponent) = integer(value);
        let zeros = integer.trailing_zeros();
        zeros.map_or((BigInt::ZERO, 0), |zeros| (integer >> zeros, exponent + zeros as i64))
    };
    let ((x, x_exponent), (y, y_exponent)) =
        (without_trailing_zeros(pair.x), without_trailing_zeros(pair.y));
    let exponent = x_exponent.min(y_exponent).min(0);
    (x << (x_exponent - exponent), y << (y_exponent - exponent), exponent)
}

/// The first hit of `ray` in `grid`, or `None` if the ray escapes.
pub fn cast(grid: &Grid, ray: &Ray) -> Option<Truth> {
    let (x, y, exponent) = integers(ray.origin());
    let (dx, dy, direction_exponent) = integers(ray.direction());
    let unit = BigInt::from(1) << -exponent;
    let t_exponent = exponent - direction_exponent;
    let x_lines = Lines {
        side: Side::X,
        count: grid.width(),
        breadth: grid.height(),
        unit: unit.clone(),
        across: (x.clone(), dx.clone()),
        along: (y.clone(), dy.clone()),
        t_exponent,
    };
    let y_lines = Lines {
        side: Side::Y,
        count: grid.height(),
        breadth: grid.width(),
        unit,
        across: (y, dy),
        along: (x, dx),
        t_exponent,
    };
    match (x_lines.first_wall(grid), y_lines.first_wall(grid)) {
        (Some(x), Some(y)) => {
            let x_is_first = compare_positive(&x.t, &y.t) == Ordering::Less;
            Some(if x_is_first { x } else { y })
        }
        (x, y) => x.or(y),
    }
}

/// Compares two nonnegative numbers with equal exponents.
fn compare_positive(a: &Rational, b: &Rational) -> Ordering {
    (&a.numerator * &b.denominator).cmp(&(&b.numerator * &a.denominator))
}

/// The lines of one kind. Positions are integers in units of a fraction of a cell; directions have
/// their own unit.
struct Lines {
    side: Side,
    /// The number of cells across the lines.
    count: u32,
    /// The number of cells along the lines.
    breadth: u32,
    /// The length of a cell.
    unit: BigInt,
    /// The origin and the direction across the lines.
    across: (BigInt, BigInt),
    /// The origin and the direction along the lines.
    along: (BigInt, BigInt),
    /// The exponent that turns a position divided by a direction into a `t`.
    t_exponent: i64,
}

impl Lines {
    /// The first solid cell that the ray enters by one of these lines.
    fn first_wall(&self, grid: &Grid) -> Option<Truth> {
        let (origin, direction) = &self.across;
        let (along, along_direction) = &self.along;
        let is_forward = direction.sign() == Sign::Plus;
        if direction.sign() == Sign::NoSign {
            return None;
        }
        for index in 0..self.count {
            // The cell behind the line, as seen along the ray, and the line itself.
            let (cell, line) = if is_forward {
                (index, index)
            } else {
                (self.count - 1 - index, self.count - index)
            };
            let way = line * &self.unit - origin;
            if (&way * direction).sign() == Sign::Minus {
                continue;
            }
            let place = Rational::new(
                along * direction + &way * along_direction,
                direction * &self.unit,
                0,
            );
            let other = self.cell_along(&place);
            if self.has_left(&other) {
                return None;
            }
            let Ok(other_cell) = u32::try_from(&other) else { continue };
            let (column, row) = match self.side {
                Side::X => (cell, other_cell),
                Side::Y => (other_cell, cell),
            };
            if !grid.is_solid(column.into(), row.into()) {
                continue;
            }
            let from_left = match self.side {
                Side::X => is_forward,
                Side::Y => !is_forward,
            };
            let Rational { numerator, denominator, .. } = place;
            let in_cell = numerator - other * &denominator;
            let u = if from_left { in_cell } else { &denominator - in_cell };
            return Some(Truth {
                cell: Cell { column, row },
                side: self.side,
                t: Rational::new(way, direction.clone(), self.t_exponent),
                u: Rational::new(u, denominator, 0),
            });
        }
        None
    }

    /// The row or column of the ray at `place` on one of these lines. At a corner, the ray has
    /// crossed the y line, but not the x line.
    fn cell_along(&self, place: &Rational) -> BigInt {
        let Rational { numerator, denominator, .. } = place;
        let mut floor = numerator / denominator;
        if &floor * denominator > *numerator {
            floor -= 1;
        }
        let is_corner = &floor * denominator == *numerator;
        let comes_from_below = match self.side {
            Side::X => self.along.1.sign() == Sign::Minus,
            Side::Y => self.along.1.sign() == Sign::Plus,
        };
        if is_corner && comes_from_below { floor - 1 } else { floor }
    }

    /// Returns whether the ray cannot return to the map from this row or column.
    fn has_left(&self, cell: &BigInt) -> bool {
        match self.along.1.sign() {
            Sign::Plus => *cell >= BigInt::from(self.breadth),
            Sign::Minus => cell.sign() == Sign::Minus,
            Sign::NoSign => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Truth> {
        let ray = Ray::new(DVec2::from(origin), DVec2::from(direction)).unwrap();
        cast(&Grid::sketch(rows).unwrap(), &ray)
    }

    #[test]
    fn simple_rays_have_known_hits() {
        let room = ["###", "#.#", "###"];
        for (origin, direction, cell, side, t, u) in [
            ((1.5, 1.25), (1.0, 0.0), (2, 1), Side::X, 0.5, 0.25),
            ((1.5, 1.25), (-1.0, 0.0), (0, 1), Side::X, 0.5, 0.75),
            ((1.25, 1.5), (0.0, 1.0), (1, 2), Side::Y, 0.5, 0.75),
            ((1.25, 1.5), (-0.0, -2.0), (1, 0), Side::Y, 0.25, 0.25),
            ((1.5, 1.5), (1.0, 1.0), (1, 2), Side::Y, 0.5, 0.0),
            ((1.5, 1.5), (-4.0, -4.0), (1, 0), Side::Y, 0.125, 0.0),
            ((2.0, 1.5), (1.0, 0.0), (2, 1), Side::X, 0.0, 0.5),
            ((0.5, 0.5), (1.0, 0.0), (1, 0), Side::X, 0.5, 0.5),
            ((-7.0, 1.5), (2.0, 0.0), (0, 1), Side::X, 3.5, 0.5),
        ] {
            let truth = truth(&room, origin, direction).unwrap();
            assert_eq!((truth.cell.column, truth.cell.row, truth.side), (cell.0, cell.1, side));
            assert_eq!((truth.t.to_f64(), truth.u.to_f64()), (t, u));
        }
        assert!(truth(&room, (-7.0, 1.5), (-1.0, 0.0)).is_none());
    }

    #[test]
    fn errors_are_exact() {
        let third = Rational::new(BigInt::from(1), BigInt::from(-3), 0);
        assert!(third.error_in_ulps(-1.0 / 3.0) < 0.5);
        assert!((third.error_in_ulps((-1.0_f64 / 3.0).next_up()) - 1.0).abs() < 0.5);
        assert_eq!((third.error(0.0), third.relative_error(0.0)), (1.0 / 3.0, 1.0));
        let beyond = Rational::new(BigInt::from(1), BigInt::from(1), 1024);
        assert_eq!(beyond.to_f64(), f64::INFINITY);
        assert_eq!(beyond.error_in_ulps(f64::INFINITY), 0.0);
        let least = Rational::new(BigInt::from(1), BigInt::from(1), -1074);
        assert_eq!((least.to_f64(), least.error_in_ulps(0.0)), (5e-324, 1.0));
        // Relative errors do not underflow, of numbers below the least double, either.
        let tiny = Rational::new(BigInt::from(1), BigInt::from(3), -1074);
        assert_eq!((tiny.relative_error(5e-324), tiny.relative_error(0.0)), (2.0, 1.0));
    }
}
