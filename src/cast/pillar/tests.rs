//! Compares pillars with rational arithmetic, for origins and directions of all sizes.

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

use super::*;
use crate::cast::Side;

const CELL: Cell = Cell { column: 1, row: 1 };

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

/// A ray and a pillar in rational numbers.
struct Oracle {
    way: [BigRational; 2],
    direction: [BigRational; 2],
    radius: BigRational,
}

fn dot(a: &[BigRational; 2], b: &[BigRational; 2]) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1]
}

impl Oracle {
    fn new(ray: &Ray, radius: f64) -> Self {
        let center = CELL.center().to_array().map(exact);
        let origin = ray.origin().to_array().map(exact);
        let way = [0, 1].map(|axis| &center[axis] - &origin[axis]);
        Self { way, direction: ray.direction().to_array().map(exact), radius: exact(radius) }
    }

    /// Positive outside of the pillar and negative inside, at `t` on the ray.
    fn outside(&self, t: &BigRational) -> BigRational {
        let way = [0, 1].map(|axis| &self.way[axis] - t * &self.direction[axis]);
        dot(&way, &way) - &self.radius * &self.radius
    }

    /// Whether the ray starts outside or on the pillar, and goes toward it.
    fn is_ahead(&self) -> bool {
        !self.outside(&BigRational::zero()).is_negative()
            && dot(&self.way, &self.direction).is_positive()
    }

    /// The `t` of the point closest to the axis, and whether the line meets the pillar there.
    fn middle(&self) -> (BigRational, bool) {
        let middle = dot(&self.way, &self.direction) / dot(&self.direction, &self.direction);
        let is_met = !self.outside(&middle).is_positive();
        (middle, is_met)
    }

    /// Whether the ray enters the pillar within one unit in the last place of `t`.
    fn starts_near(&self, t: f64) -> bool {
        let (middle, _) = self.middle();
        if t == f64::INFINITY {
            return middle > exact(f64::MAX);
        }
        let is_before = |t: f64| {
            let t = exact(t);
            t <= middle && !self.outside(&t).is_negative()
        };
        let is_after = |t: f64| {
            t == f64::INFINITY || { exact(t) >= middle || !self.outside(&exact(t)).is_positive() }
        };
        is_before(t.next_down().max(0.0)) && is_after(t.next_up())
    }

    /// Whether the ray leaves the pillar within one unit in the last place of `t`.
    fn ends_near(&self, t: f64) -> bool {
        let (middle, _) = self.middle();
        if t == f64::INFINITY {
            return self.outside(&exact(f64::MAX)).is_negative() || middle > exact(f64::MAX);
        }
        let is_before = |t: &BigRational| *t <= middle || !self.outside(t).is_positive();
        let is_after = |t: &BigRational| *t >= middle && !self.outside(t).is_negative();
        let next = t.next_up();
        is_before(&exact(t.next_down())) && (next == f64::INFINITY || is_after(&exact(next)))
    }
}

fn chord(origin: DVec2, direction: DVec2, radius: f64) -> (Ray, Option<Chord>) {
    let ray = Ray::new(origin, direction).unwrap();
    let chord = Chord::new(&ray, CELL, PillarRadius::new(radius).unwrap());
    (ray, chord)
}

/// Compares one ray with the oracle.
fn check(origin: DVec2, direction: DVec2, radius: f64) -> Result<(), TestCaseError> {
    let (ray, chord) = chord(origin, direction, radius);
    let oracle = Oracle::new(&ray, radius);
    prop_assert_eq!(chord.is_some(), oracle.middle().1, "{:?}", ray);
    if let Some(chord) = chord {
        prop_assert_eq!(chord.start.is_some(), oracle.is_ahead(), "{:?}", ray);
        if let Some(t) = chord.start {
            prop_assert!(oracle.starts_near(t), "{ray:?} {t}");
        }
        if let Some(t) = chord.end() {
            prop_assert!(oracle.ends_near(t), "{ray:?} {t}");
        }
    }
    Ok(())
}

fn scaled(part: f64, exponent: i32) -> f64 {
    libm::scalbn(part, exponent)
}

/// A coordinate near the cell, on its lines, a hair from 0, or of any size.
fn coordinate() -> impl Strategy<Value = f64> {
    let special = vec![0.0, 1.0, 1.25, 1.5, 1.75, 2.0, 5e-324, 3e-310, -1e-300, 1e-17];
    prop_oneof![
        4 => -1.0..4.0_f64,
        2 => prop::sample::select(special),
        1 => (-1.0..1.0_f64, 0..1023).prop_map(|(part, exponent)| scaled(part, exponent)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn pillars_are_hit_where_rational_arithmetic_says(
        (x, y) in (coordinate(), coordinate()),
        (dx, dy) in (-1.0..1.0_f64, -1.0..1.0_f64),
        exponents in (-1060..1020, prop_oneof![2 => Just(0), 1 => -2000..2000]),
        radius in prop_oneof![Just(0.25), Just(0.5), 1e-3..0.5],
    ) {
        let direction = DVec2::new(
            scaled(dx, exponents.0),
            scaled(dy, (exponents.0 + exponents.1).clamp(-1070, 1020)),
        );
        prop_assume!(direction != DVec2::ZERO);
        check(DVec2::new(x, y), direction, radius)?;
    }

    /// The rays touch the pillar, or pass a few units in the last place beside it.
    #[test]
    fn grazing_rays_hit_where_rational_arithmetic_says(
        angle in 0.0..7.0_f64,
        tangent in -1.0..1.0_f64,
        exponent in prop_oneof![4 => -3..3, 2 => 0..60, 1 => 0..900],
        ulps in (-9_i64..9, -9_i64..9),
        unit in prop_oneof![Just(0), -900..900],
    ) {
        let axis = CELL.center();
        let normal = DVec2::new(libm::cos(angle), libm::sin(angle));
        let origin = axis + normal * 0.25 + normal.perp() * scaled(tangent, exponent);
        prop_assume!(tangent.abs() > 1e-3);
        let moved = |part: f64, ulps| f64::from_bits((part.to_bits() as i64 + ulps) as u64);
        let direction = -normal.perp() * tangent.signum() * scaled(1.0, unit);
        let direction = DVec2::new(moved(direction.x, ulps.0), moved(direction.y, ulps.1));
        check(origin, direction, 0.25)?;
    }

    #[test]
    fn rays_from_the_surface_hit_where_rational_arithmetic_says(
        angle in 0.0..7.0_f64,
        heading in 0.0..7.0_f64,
    ) {
        let origin = CELL.center() + DVec2::new(libm::cos(angle), libm::sin(angle)) * 0.375;
        check(origin, DVec2::new(libm::cos(heading), libm::sin(heading)), 0.375)?;
    }
}

/// Pythagorean triples have tangents in whole numbers.
#[test]
fn a_ray_that_touches_a_pillar_hits_it() {
    for (direction, radius) in
        [((-5.0, -12.0), 0.5), ((-0.980_580_675_690_920_2, -2.353_393_621_658_208_5), 0.5)]
    {
        let direction = DVec2::from(direction);
        // The pillar in column 6 and row 0, as seen from (7, 3), is here the pillar in column 1 and row 1.
        let (ray, found) = chord(DVec2::new(2.0, 4.0), direction, radius);
        let is_met = Oracle::new(&ray, radius).middle().1;
        assert!(
            is_met
                && found.is_some_and(|it| it
                    .hit(&ray, CELL, PillarRadius::new(radius).unwrap())
                    .is_some())
        );
    }
}

#[test]
fn grazes_nearer_than_any_double_are_told_apart() {
    for (nudge, expected) in [(0.0, true), (1e-300, true), (-1e-300, false)] {
        // Along the northern edge of the pillar, and turned towards it or away from it.
        let (_, found) = chord(DVec2::new(0.0, 1.25), DVec2::new(1.0, nudge), 0.25);
        assert_eq!(found.is_some(), expected, "{nudge}");
    }
}

#[test]
fn a_pillar_is_hit_from_any_distance() {
    for exponent in [16, 50, 99, 101, 150, 200, 300, 308] {
        let far = 10_f64.powi(exponent);
        for unit in [1.0, 1e-300, 1e300] {
            for (y, expected) in [(1.5, true), (1.75, true), (1.75_f64.next_up(), false)] {
                let (ray, found) = chord(DVec2::new(-far, y), DVec2::new(unit, 0.0), 0.25);
                assert_eq!(found.is_some(), expected, "{far} {unit} {y}");
                let hit = found.and_then(|it| it.hit(&ray, CELL, PillarRadius::new(0.25).unwrap()));
                assert_eq!(hit.is_some(), expected, "{far} {unit} {y}");
                if let Some(hit) = hit.filter(|_| y == 1.5) {
                    assert_eq!((hit.cell, hit.side), (CELL, Side::X));
                }
            }
            let (_, behind) = chord(DVec2::new(-far, 1.5), DVec2::new(-unit, 0.0), 0.25);
            assert!(behind.is_some_and(|it| it.start.is_none() && it.end().is_none()));
        }
    }
}
