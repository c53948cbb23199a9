//! Compares shapes with rational arithmetic, for origins and directions of all sizes.

use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use proptest::prelude::*;

use super::*;

const CELL: Cell = Cell { column: 1, row: 1 };

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn cross_of([a, b]: [&BigRational; 2], [c, d]: [&BigRational; 2]) -> BigRational {
    a * d - b * c
}

/// The `t` and the position along `line` at which `ray` meets it; `None` if it misses.
fn expected(ray: &Ray, line: Line) -> Option<(BigRational, BigRational)> {
    let [ox, oy, dx, dy] = [ray.origin(), ray.direction()]
        .map(|vector| vector.to_array())
        .as_flattened()
        .iter()
        .map(|&it| exact(it))
        .collect::<Vec<_>>()
        .try_into()
        .unwrap();
    let (start, extent) = (line.start(CELL), line.stretch());
    let way = [exact(start.x) - ox, exact(start.y) - oy];
    let [way, extent] = [[&way[0], &way[1]], [&exact(extent.x), &exact(extent.y)]];
    let across = cross_of([&dx, &dy], extent);
    if across.is_zero() {
        return None;
    }
    let t = cross_of(way, extent) / &across;
    let along = cross_of(way, [&dx, &dy]) / &across;
    let is_hit = !t.is_negative() && !along.is_negative() && along <= BigRational::one();
    is_hit.then_some((t, along))
}

/// A coordinate in or near the cell, on its lines, or a hair from 0.
fn coordinate() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![0.0, 1.0, 1.5, 2.0, 5e-324, 3e-310, -1e-300, 1e-17]);
    prop_oneof![2 => -1.0..4.0, 2 => special]
}

/// A component of a direction of any size.
fn component() -> impl Strategy<Value = f64> {
    let special = vec![0.0, 1.0, -1.0, 5e-324, -5e-324, 1e-320, 1e-300, -1e300, f64::MAX];
    let scaled =
        (-1.0..1.0_f64, -1073..1023).prop_map(|(part, exponent)| libm::scalbn(part, exponent));
    prop_oneof![-2.0..2.0, scaled, prop::sample::select(special)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2048))]

    #[test]
    fn lines_are_hit_where_rational_arithmetic_says(
        (x, y) in (coordinate(), coordinate()),
        (dx, dy) in (component(), component()),
        line in prop::sample::select(&Line::ALL[..]),
    ) {
        prop_assume!((dx, dy) != (0.0, 0.0));
        let ray = Ray::new(DVec2::new(x, y), DVec2::new(dx, dy)).unwrap();
        let (hit, expected) = (meet_shape(&ray, CELL, Outline::Line(line)), expected(&ray, line));
        prop_assert_eq!(hit.is_some(), expected.is_some());
        if let (Some(hit), Some((t, along))) = (hit, expected) {
            if hit.t.is_finite() {
                let within = [hit.t.next_down().next_down(), hit.t.next_up().next_up()];
                let [least, most] = within.map(|it| it.clamp(-f64::MAX, f64::MAX));
                prop_assert!((exact(least)..=exact(most)).contains(&t), "{}", hit.t);
            } else {
                prop_assert!(t >= exact(f64::MAX));
            }
            let along = along.to_f64().unwrap();
            let off = (hit.u - along).abs().min((hit.u - (1.0 - along)).abs());
            prop_assert!(off < 1e-12, "{} {along}", hit.u);
        }
    }
}

#[test]
fn a_ray_with_the_smallest_component_hits_a_thin_wall() {
    let ray = Ray::new(DVec2::new(1.25, 1.0), DVec2::new(1.0, 5e-324)).unwrap();
    let hit = meet_shape(&ray, CELL, Outline::Line(Line::North)).unwrap();
    assert_eq!((hit.t, hit.u), (0.0, 0.75));
}
