//! Random rays that are hard to cast.

use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;
use cellcaster::world::Grid;
use glam::DVec2;

/// A ray that is hard to cast correctly: through corners of the grid or an ulp beside them, with a
/// rational slope, along lines, from far away, or with random bits.
pub(crate) fn adversarial_ray(grid: &Grid, random: &mut SplitMix64) -> Ray {
    let make = [
        through_a_corner,
        of_rational_slope,
        along_a_line,
        beside_a_line,
        from_afar,
        of_unlike_components,
        of_any_doubles,
    ];
    let make = make[(random.bits() % make.len() as u64) as usize];
    one(|| make(size(grid), random))
}

/// The first valid ray that `make` returns.
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

fn place(size: DVec2, random: &mut SplitMix64) -> DVec2 {
    DVec2::new(random.between(-1.0, size.x + 1.0), random.between(-1.0, size.y + 1.0))
}

fn corner(size: DVec2, random: &mut SplitMix64) -> DVec2 {
    DVec2::new(random.whole(0, size.x as i32), random.whole(0, size.y as i32))
}

/// `value` or an adjacent double.
fn nudged(value: f64, random: &mut SplitMix64) -> f64 {
    match random.bits() % 4 {
        0 => value.next_up(),
        1 => value.next_down(),
        _ => value,
    }
}

fn nudged_vector(vector: DVec2, random: &mut SplitMix64) -> DVec2 {
    DVec2::new(nudged(vector.x, random), nudged(vector.y, random))
}

fn through_a_corner(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let coarse = random.pick([1.0, 2.0, 16.0, 1024.0, 1_099_511_627_776.0]);
    let origin = (place(size, random) * coarse).floor() / coarse;
    let direction = corner(size, random) - origin;
    let length = random.pick([1.0, 1.0, 0.3, 1e-300, 1e300]);
    (nudged_vector(origin, random), nudged_vector(direction * length, random))
}

fn of_rational_slope(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let parts = random.pick([1.0, 2.0, 3.0, 7.0, 8.0, 10.0]);
    let origin = (place(size, random) * parts).floor() / parts;
    (origin, DVec2::new(random.whole(-9, 9), random.whole(-9, 9)))
}

fn along_a_line(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let ahead = random.pick([1.0, -1.0, 3.7, -1e-300, 5e-324]);
    let aside = random.pick([0.0, -0.0, 1e-17, -1e-17, 1e-300, -5e-324]);
    let origin = corner(size, random);
    let away = DVec2::new(random.between(-3.0, 3.0), random.between(-3.0, 3.0));
    if random.bits().is_multiple_of(2) {
        (origin.with_x(origin.x + away.x), DVec2::new(ahead, aside))
    } else {
        (origin.with_y(origin.y + away.y), DVec2::new(aside, ahead))
    }
}

fn beside_a_line(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let origin = corner(size, random);
    let direction = DVec2::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    (nudged_vector(origin, random), direction)
}

fn from_afar(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let distance = random.pick([1e2, 1e6, 1e12, 1e15, 1e16, 1e30, 1e300]);
    let way = DVec2::new(random.between(-1.0, 1.0), random.pick([0.0, 0.3, 1.0, -1.0, 1e-15]));
    let origin = place(size, random).round() - way * distance;
    (origin, nudged_vector(way, random))
}

fn of_unlike_components(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let origin = DVec2::new(
        random.pick([5e-324, -5e-324, 1.0, 2.5, 1e-300, 3.0]),
        random.pick([5e-324, -5e-324, 1.0, 2.5, -1e-300, size.y]),
    );
    let component = |random: &mut SplitMix64| {
        let size = random.pick([1e300, 1e-300, 5e-324, 1.0, f64::MIN_POSITIVE, f64::MAX]);
        random.pick([size, -size])
    };
    (origin, DVec2::new(component(random), component(random)))
}

fn of_any_doubles(size: DVec2, random: &mut SplitMix64) -> (DVec2, DVec2) {
    let direction = DVec2::new(random.double(), random.double());
    if random.bits().is_multiple_of(2) {
        (place(size, random), direction)
    } else {
        (DVec2::new(random.double(), random.double()), direction)
    }
}
