//! Rays by chance: such as a camera casts, and such as nobody would.

use std::f64::consts::TAU;

use glam::DVec2;

use super::Chance;
use crate::cast::Ray;
use crate::world::Grid;

/// A ray such as a camera casts: from anywhere on the map, at any heading, about 1 long.
pub fn random_ray(grid: &Grid, chance: &mut Chance) -> Ray {
    one(|| {
        let size = size(grid);
        let origin = DVec2::new(chance.between(0.0, size.x), chance.between(0.0, size.y));
        let (sine, cosine) = libm::sincos(chance.between(0.0, TAU));
        let direction = DVec2::new(cosine, sine);
        (origin, direction + direction.perp() * chance.between(-0.65, 0.65))
    })
}

/// A ray made to be misjudged: through corners of the grid or an ulp beside them, of rational slope,
/// along lines, from afar, or of any doubles at all.
pub fn adversarial_ray(grid: &Grid, chance: &mut Chance) -> Ray {
    let make = [
        through_a_corner,
        of_rational_slope,
        along_a_line,
        beside_a_line,
        from_afar,
        of_unlike_components,
        of_any_doubles,
    ];
    let make = make[(chance.bits() % make.len() as u64) as usize];
    one(|| make(size(grid), chance))
}

/// The first of what `make` makes that is a ray.
fn one(mut make: impl FnMut() -> (DVec2, DVec2)) -> Ray {
    loop {
        let (origin, direction) = make();
        if let Ok(ray) = Ray::new(origin, direction) {
            return ray;
        }
    }
}

fn size(grid: &Grid) -> DVec2 {
    DVec2::new(f64::from(grid.width()), f64::from(grid.height()))
}

fn place(size: DVec2, chance: &mut Chance) -> DVec2 {
    DVec2::new(chance.between(-1.0, size.x + 1.0), chance.between(-1.0, size.y + 1.0))
}

fn corner(size: DVec2, chance: &mut Chance) -> DVec2 {
    DVec2::new(chance.whole(0, size.x as i32), chance.whole(0, size.y as i32))
}

/// `value` or the double beside it.
fn nudged(value: f64, chance: &mut Chance) -> f64 {
    match chance.bits() % 4 {
        0 => value.next_up(),
        1 => value.next_down(),
        _ => value,
    }
}

fn nudged_vector(vector: DVec2, chance: &mut Chance) -> DVec2 {
    DVec2::new(nudged(vector.x, chance), nudged(vector.y, chance))
}

fn through_a_corner(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let coarse = chance.pick([1.0, 2.0, 16.0, 1024.0, 1_099_511_627_776.0]);
    let origin = (place(size, chance) * coarse).floor() / coarse;
    let direction = corner(size, chance) - origin;
    let length = chance.pick([1.0, 1.0, 0.3, 1e-300, 1e300]);
    (nudged_vector(origin, chance), nudged_vector(direction * length, chance))
}

fn of_rational_slope(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let parts = chance.pick([1.0, 2.0, 3.0, 7.0, 8.0, 10.0]);
    let origin = (place(size, chance) * parts).floor() / parts;
    (origin, DVec2::new(chance.whole(-9, 9), chance.whole(-9, 9)))
}

fn along_a_line(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let ahead = chance.pick([1.0, -1.0, 3.7, -1e-300, 5e-324]);
    let aside = chance.pick([0.0, -0.0, 1e-17, -1e-17, 1e-300, -5e-324]);
    let origin = corner(size, chance);
    let away = DVec2::new(chance.between(-3.0, 3.0), chance.between(-3.0, 3.0));
    if chance.bits().is_multiple_of(2) {
        (origin.with_x(origin.x + away.x), DVec2::new(ahead, aside))
    } else {
        (origin.with_y(origin.y + away.y), DVec2::new(aside, ahead))
    }
}

fn beside_a_line(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let origin = corner(size, chance);
    let direction = DVec2::new(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0));
    (nudged_vector(origin, chance), direction)
}

fn from_afar(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let distance = chance.pick([1e2, 1e6, 1e12, 1e15, 1e16, 1e30, 1e300]);
    let way = DVec2::new(chance.between(-1.0, 1.0), chance.pick([0.0, 0.3, 1.0, -1.0, 1e-15]));
    let origin = place(size, chance).round() - way * distance;
    (origin, nudged_vector(way, chance))
}

fn of_unlike_components(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let origin = DVec2::new(
        chance.pick([5e-324, -5e-324, 1.0, 2.5, 1e-300, 3.0]),
        chance.pick([5e-324, -5e-324, 1.0, 2.5, -1e-300, size.y]),
    );
    let component = |chance: &mut Chance| {
        let size = chance.pick([1e300, 1e-300, 5e-324, 1.0, f64::MIN_POSITIVE, f64::MAX]);
        chance.pick([size, -size])
    };
    (origin, DVec2::new(component(chance), component(chance)))
}

fn of_any_doubles(size: DVec2, chance: &mut Chance) -> (DVec2, DVec2) {
    let direction = DVec2::new(chance.double(), chance.double());
    if chance.bits().is_multiple_of(2) {
        (place(size, chance), direction)
    } else {
        (DVec2::new(chance.double(), chance.double()), direction)
    }
}
