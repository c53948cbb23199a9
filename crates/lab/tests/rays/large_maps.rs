//! A million rays on maps of 4096 × 4096 cells, on which rays leap by the distance field. Pillars
//! stand on the borders of blocks, where a leap that is one cell too long passes them.
//!
//! The oracle tests every face of every pillar in integers of 128 bits, from the definition of a
//! hit. A few hundred rays have longer integers. They are compared with rational arithmetic, which
//! takes a thousand times as long.

use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::map;
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Grid, World};
use cellcaster_lab::accuracy;

use crate::adversarial::adversarial_ray;
use glam::DVec2;

const SIDE: i32 = 4096;
const PILLARS: usize = 100;

/// The start cell, which a map must have.
const START: (i64, i64) = (1, 2);

/// The world of a map with these pillars. A distance field exists only in a world.
fn world(pillars: &[(i64, i64)]) -> World {
    let side = SIDE as usize;
    let mut cells = vec![vec![b'.'; side]; side];
    for &(column, row) in pillars {
        cells[row as usize][column as usize] = b'#';
    }
    cells[START.1 as usize][START.0 as usize] = b'@';
    let rows: Vec<String> = cells.into_iter().map(|row| String::from_utf8(row).unwrap()).collect();
    map::parse_str(&format!(
        "grid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = '#ffffff' }}\n[things]\n'@' = {{ start = 0 }}\n",
        rows.join("\n")
    ))
    .unwrap()
}

/// A map and the columns and rows of its pillars.
struct Field {
    grid: Grid,
    pillars: Vec<(i64, i64)>,
}

impl Field {
    /// A map with pillars in cells beside multiples of `spacing` in both directions.
    fn new(spacing: i32, random: &mut SplitMix64) -> Self {
        let mut index = || {
            let line = random.whole(0, SIDE / spacing) as i32 * spacing;
            (line - random.pick([0.0, 0.0, 1.0, 2.0]) as i32).clamp(0, SIDE - 1)
        };
        let mut pillars: Vec<(i64, i64)> =
            (0..PILLARS).map(|_| (index().into(), index().into())).collect();
        pillars.sort_unstable();
        pillars.dedup();
        pillars.retain(|&pillar| pillar != START);
        Self { grid: world(&pillars).grid().clone(), pillars }
    }

    /// A ray from a place on a grid whose spacing is a power of two. It leads through a corner of a
    /// pillar or an ulp beside it, along a line beside a pillar, or towards any place.
    fn ray(&self, random: &mut SplitMix64) -> Ray {
        loop {
            let parts = random.pick([1.0, 2.0, 16.0, 1024.0, 1_073_741_824.0]);
            let place = |random: &mut SplitMix64| {
                let coordinate = |random: &mut SplitMix64| {
                    (random.between(-1.0, f64::from(SIDE) + 1.0) * parts).floor() / parts
                };
                DVec2::new(coordinate(random), coordinate(random))
            };
            let (column, row) = self.pillars[(random.bits() % self.pillars.len() as u64) as usize];
            let corner =
                DVec2::new(column as f64 + random.whole(0, 1), row as f64 + random.whole(0, 1));
            let origin = place(random);
            let origin = match random.bits() % 8 {
                0 => origin.with_x(corner.x),
                1 => origin.with_y(corner.y),
                _ => origin,
            };
            let target = if random.bits().is_multiple_of(8) { place(random) } else { corner };
            let direction = (target - origin) * random.pick([1.0, 1.0, 0.3, 1e-3]);
            let nudged = |value: f64, random: &mut SplitMix64| match random.bits() % 8 {
                0 => value.next_up(),
                1 => value.next_down(),
                _ => value,
            };
            let direction = DVec2::new(nudged(direction.x, random), nudged(direction.y, random));
            if let Ok(ray) = Ray::new(origin, direction) {
                return ray;
            }
        }
    }

    /// The hit of a ray whose integers are short enough.
    fn truth(&self, ray: &ExactRay) -> Option<Met> {
        let faces = self.pillars.iter().flat_map(|&pillar| ray.entries(pillar));
        faces.flatten().min_by(Met::compare)
    }
}

/// A ray in integers: positions in units of 1 / `unit` of a cell, the direction in its own unit.
struct ExactRay {
    unit: i128,
    origin: [i128; 2],
    direction: [i128; 2],
}

/// The entry into a pillar: at `way / speed`.
#[derive(Debug)]
struct Met {
    pillar: (i64, i64),
    side: Side,
    way: i128,
    speed: i128,
}

impl Met {
    /// Compares by distance. At equal distances, the y line is crossed first.
    fn compare(&self, other: &Self) -> std::cmp::Ordering {
        let way = |met: &Self| met.way.abs();
        let by_distance = (way(self) * other.speed.abs()).cmp(&(way(other) * self.speed.abs()));
        by_distance.then((self.side == Side::X).cmp(&(other.side == Side::X)))
    }
}

impl ExactRay {
    /// `None` if an integer is too long for products of two integers to fit.
    fn new(ray: &Ray) -> Option<Self> {
        let (origin, exponent) = integers(ray.origin(), 57)?;
        let (direction, _) = integers(ray.direction(), 62)?;
        (-44..=0).contains(&exponent).then(|| Self { unit: 1 << -exponent, origin, direction })
    }

    /// The entries into a cell from its sides: by an x line, and by a y line.
    fn entries(&self, pillar: (i64, i64)) -> [Option<Met>; 2] {
        let (column, row) = pillar;
        [(0, Side::X, column, row), (1, Side::Y, row, column)].map(|(axis, side, across, along)| {
            let (speed, other) = (self.direction[axis], self.direction[1 - axis]);
            if speed == 0 {
                return None;
            }
            let line = i128::from(across) + i128::from(speed < 0);
            let way = line * self.unit - self.origin[axis];
            if way != 0 && (way > 0) != (speed > 0) {
                return None;
            }
            // The position along the line, from the cell's start, times the speed and with a
            // positive sign.
            let sign = speed.signum();
            let place =
                (self.origin[1 - axis] - i128::from(along) * self.unit) * speed + way * other;
            let (place, length) = (place * sign, self.unit * speed * sign);
            // At a corner, the ray has crossed the y line, but not the x line.
            let is_at_end_inside = match side {
                Side::X => other < 0,
                Side::Y => other > 0,
            };
            let is_inside = if is_at_end_inside {
                place > 0 && place <= length
            } else {
                place >= 0 && place < length
            };
            is_inside.then_some(Met { pillar, side, way, speed })
        })
    }
}

/// Two doubles as integers times two to a common exponent, which is at most 0; `None` if one of
/// them has more than `bits` bits.
fn integers(pair: DVec2, bits: u32) -> Option<([i128; 2], i32)> {
    let parts = pair.to_array().map(|value| {
        let exponent = ((value.abs().to_bits() >> 52) as i32).max(1) - 1075;
        let fraction = value.to_bits() & ((1 << 52) - 1);
        let magnitude = if exponent == -1074 { fraction } else { fraction | 1 << 52 };
        let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
        let integer = i128::from(magnitude >> zeros);
        let exponent = if magnitude == 0 { 0 } else { exponent + zeros as i32 };
        (if value < 0.0 { -integer } else { integer }, exponent)
    });
    let exponent = parts[0].1.min(parts[1].1).min(0);
    let shifted = parts.map(|(integer, own)| {
        let shift = u32::try_from(own - exponent).ok().filter(|&shift| shift < 64)?;
        let shifted = integer << shift;
        (shifted.unsigned_abs() < 1 << bits).then_some(shifted)
    });
    Some(([shifted[0]?, shifted[1]?], exponent))
}

/// Describes the difference between a hit and the truth, if there is one.
fn fault(ray: &Ray, exact: &ExactRay, truth: Option<&Met>, hit: Option<&Hit>) -> Option<String> {
    let is_right = match (truth, hit) {
        (None, None) => true,
        (Some(met), Some(hit)) => {
            let cell = (i64::from(hit.cell.column), i64::from(hit.cell.row));
            let speed = if met.side == Side::X { ray.direction().x } else { ray.direction().y };
            let t = (met.way as f64 / exact.unit as f64 / speed).abs();
            (met.pillar, met.side) == (cell, hit.side) && (hit.t - t).abs() <= 1e-15 * t
        }
        _ => false,
    };
    (!is_right).then(|| format!("{ray:?} meets {truth:?}, but the exact caster says {hit:?}"))
}

#[test]
fn a_million_rays_are_exact_on_large_maps() {
    const RAYS: usize = 250_000;
    let mut random = SplitMix64::new(4096);
    for spacing in [8, 64, 128, 1024] {
        let field = Field::new(spacing, &mut random);
        let (mut compared, mut hits) = (0, 0);
        while compared < RAYS {
            let ray = field.ray(&mut random);
            let Some(exact) = ExactRay::new(&ray) else { continue };
            let truth = field.truth(&exact);
            let hit = Exact.cast(&field.grid, &ray);
            assert_eq!(fault(&ray, &exact, truth.as_ref(), hit.as_ref()), None, "{spacing}");
            compared += 1;
            hits += usize::from(truth.is_some());
        }
        assert!(hits > RAYS / 3, "{hits} rays hit something");
    }
}

#[test]
fn adversarial_rays_are_exact_on_a_large_map() {
    const RAYS: usize = 600;
    let mut random = SplitMix64::new(7);
    let field = Field::new(128, &mut random);
    for _ in 0..RAYS {
        let ray = adversarial_ray(&field.grid, &mut random);
        let (truth, hit) = (accuracy::cast(&field.grid, &ray), Exact.cast(&field.grid, &ray));
        let is_right = match (&truth, &hit) {
            (Some(truth), Some(hit)) => truth.is_met_by(hit) && truth.t.error_in_ulps(hit.t) <= 2.0,
            (truth, hit) => truth.is_none() && hit.is_none(),
        };
        assert!(is_right, "{ray:?} hits {truth:?}, but the exact caster says {hit:?}");
    }
}
