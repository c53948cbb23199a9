//! Known hits, and the errors of rationals.

use super::*;

fn truth(rows: &[&str], origin: (f64, f64), direction: (f64, f64)) -> Option<Truth> {
    let ray = Ray::new(DVec2::from(origin), DVec2::from(direction)).unwrap();
    cast(&Grid::sketch(rows).unwrap(), &ray)
}

#[test]
fn simple_rays() {
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
    assert_eq!(third.error(0.0), 1.0 / 3.0);
    let beyond = Rational::new(BigInt::from(1), BigInt::from(1), 1024);
    assert_eq!(beyond.to_f64(), f64::INFINITY);
    assert_eq!(beyond.error_in_ulps(f64::INFINITY), 0.0);
    let least = Rational::new(BigInt::from(1), BigInt::from(1), -1074);
    assert_eq!((least.to_f64(), least.error_in_ulps(0.0)), (5e-324, 1.0));
}
