//! Panoramas: pictures of the whole sky.

use super::noise::hash;
use super::shade::mix;
use crate::color::Rgb;

/// The width, all around, and the height from the horizon up, in texels.
pub(crate) const WIDTH: i32 = 512;
pub(crate) const HEIGHT: i32 = 64;

/// Three ranges of hills under a morning sky, the farther the paler.
pub(crate) fn hills() -> impl Fn(i32, i32) -> Rgb {
    let skylines = RANGES.map(|range| (range.color, skyline(&range)));
    move |x, y| {
        let up = HEIGHT - 1 - y;
        match skylines.iter().find(|(_, heights)| up < heights[x as usize]) {
            // The foot of a range is in mist.
            Some(&(color, _)) => mix(MIST, color, 170 + 14 * up.min(6)),
            None => sky(x, up),
        }
    }
}

/// The height of the range at each `x`.
fn skyline(range: &Range) -> Vec<i32> {
    (0..WIDTH).map(|x| range.height_at(x)).collect()
}

const ZENITH: Rgb = Rgb::new(0x4c, 0x82, 0xbe);
const HORIZON: Rgb = Rgb::new(0xf0, 0xd8, 0xb4);
const MIST: Rgb = Rgb::new(0xd2, 0xce, 0xc0);
const CLOUD: Rgb = Rgb::new(0xf8, 0xf0, 0xe4);

fn sky(x: i32, up: i32) -> Rgb {
    // Fast at first, then slower.
    let share = 256 - (HEIGHT - up) * (HEIGHT - up) * 256 / (HEIGHT * HEIGHT);
    let clear = mix(HORIZON, ZENITH, share);
    // Clouds are three times as wide as high.
    let cover = wave(x, up * 3, 64, 21) + wave(x, up * 3, 32, 22) / 2 - 84;
    mix(clear, CLOUD, (cover * 9).clamp(0, 204) / 34 * 34)
}

struct Range {
    color: Rgb,
    base: i32,
    swing: i32,
    spacing: i32,
    seed: u32,
}

/// From near to far.
const RANGES: [Range; 3] = [
    Range { color: Rgb::new(0x3c, 0x5c, 0x34), base: 1, swing: 4, spacing: 64, seed: 31 },
    Range { color: Rgb::new(0x5c, 0x7c, 0x6c), base: 3, swing: 7, spacing: 128, seed: 32 },
    Range { color: Rgb::new(0x8c, 0xa0, 0xb0), base: 4, swing: 16, spacing: 64, seed: 33 },
];

impl Range {
    /// The height of the range at `x`.
    fn height_at(&self, x: i32) -> i32 {
        let broad = wave(x, 0, self.spacing, self.seed);
        let fine = wave(x, 0, self.spacing / 4, self.seed + 50);
        self.base + (broad * 3 + fine) * self.swing / 400
    }
}

/// Smooth noise from 0 to 100 that wraps around, with `spacing` texels between lattice points.
fn wave(x: i32, y: i32, spacing: i32, seed: u32) -> i32 {
    const STEPS: i32 = 256;
    let point =
        |column: i32, row: i32| (hash(column.rem_euclid(WIDTH / spacing), row, seed) % 101) as i32;
    let ease = |step: i32| {
        let t = step * STEPS / spacing;
        t * t * (3 * STEPS - 2 * t) / (STEPS * STEPS)
    };
    let between = |from: i32, to: i32, share: i32| from + (to - from) * share / STEPS;
    let (column, row) = (x / spacing, y / spacing);
    let (across, down) = (ease(x % spacing), ease(y % spacing));
    let upper = between(point(column, row), point(column + 1, row), across);
    let lower = between(point(column, row + 1), point(column + 1, row + 1), across);
    between(upper, lower, down)
}
