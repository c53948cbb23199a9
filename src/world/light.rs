//! Light, fog and sky, and the light along the face of a cell.
//!
//! Each cell has one light. The middle of a face has the light of the cell in front of it. Towards
//! both ends the light changes linearly into the light of the next cell along the face. Adjoining
//! faces therefore agree on the mean, and no bands show. Light passes only between cells of open
//! floor, masks and glass that have a common open height: not through walls or closed doors.
//!
//! Rejected: interpolation between corners, each with the mean of its four cells. The light would
//! reach around the end of a wall. Floors and ceilings have one light for each cell, because
//! spans are drawn with one light.

use super::{Cell, TextureId, Tile, TileKind, World};
use crate::color::Rgb;
use crate::numeric::rounding::rounded;

/// The light on a surface, in 256ths of full brightness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light(u16);

impl Light {
    /// Full brightness: colours are unchanged.
    pub const FULL: Self = Self(256);
    /// Darkness: every colour is black.
    pub const NONE: Self = Self(0);

    /// A light from 0 (darkness) to 1 (full brightness). `None` outside that range.
    pub fn new(share: f64) -> Option<Self> {
        let full = f64::from(Self::FULL.0);
        (0.0..=1.0).contains(&share).then(|| Self((share * full).round() as u16))
    }

    /// The light as a number from 0 to 256.
    pub const fn in_256ths(self) -> u32 {
        self.0 as u32
    }

    /// A light of this many 256ths, at most full brightness.
    pub(crate) fn saturated(in_256ths: u32) -> Self {
        Self(in_256ths.min(u32::from(Self::FULL.0)) as u16)
    }

    /// The sum of two lights, at most full brightness.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0).min(Self::FULL.0))
    }

    /// A light between this one and `other`: this one if `share` is 0, `other` if it is 1.
    #[must_use]
    pub(crate) fn towards(self, other: Self, share: f64) -> Self {
        let (from, to) = (f64::from(self.0), f64::from(other.0));
        Self(rounded(from + (to - from) * share) as u16)
    }

    /// The light multiplied by a share from 0 to 1.
    #[must_use]
    pub(crate) fn dimmed(self, share: f64) -> Self {
        Self(rounded(f64::from(self.0) * share) as u16)
    }
}

/// A colour that everything fades into with distance.
///
/// At distance `t`, the share of a surface's own colour is `1 / (1 + (t / distance)²)`: nearly 1
/// nearby, a half at `distance`, a fifth at twice that. The function is smooth and costs one
/// division. Rejected: an exponential, which looks much the same and needs a table to be as cheap.
/// `t` is the distance to the camera plane, which is the same for a whole row of the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The colour at an infinite distance.
    pub color: Rgb,
    distance: f64,
}

impl Fog {
    /// Fog that hides half of an object `distance` cells away. `None` unless `distance` is finite
    /// and above 0.
    pub fn new(color: Rgb, distance: f64) -> Option<Self> {
        (distance > 0.0 && distance.is_finite()).then_some(Self { color, distance })
    }

    /// The share of a surface's own colour at distance `t`, in cells: from 1 at 0 down to 0.
    pub fn clearness(&self, t: f64) -> f64 {
        let relative = t / self.distance;
        1.0 / (1.0 + relative * relative)
    }

    /// A distance up to which the clearness is at least `clearness`, a number from 0 to 1. Slightly
    /// beyond it, the clearness is less.
    #[cfg_attr(not(feature = "tui"), expect(dead_code, reason = "only the minimap needs it"))]
    pub(crate) fn clear_to(&self, clearness: f64) -> f64 {
        /// Less than 1, by more than rounding.
        const ALMOST: f64 = 1.0 - 1e-9;
        let distance = self.distance * (1.0 / clearness - 1.0).sqrt() * ALMOST;
        if self.clearness(distance) < clearness { 0.0 } else { distance }
    }
}

/// The sky, which is visible above cells without a ceiling and outside the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sky {
    /// From one colour overhead to another at the horizon.
    Gradient(SkyGradient),
    /// A texture on the inside of a cylinder around the camera. Its left edge is east and its
    /// bottom is the horizon. Above it, the colours of its top edge continue. It turns with the
    /// heading; its texels are square.
    Panorama(TextureId),
}

impl Default for Sky {
    fn default() -> Self {
        Self::Gradient(SkyGradient::default())
    }
}

/// A sky that changes from one colour to another between the horizon and a slope of 1/2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SkyGradient {
    /// The colour at and above a slope of 1/2.
    pub zenith: Rgb,
    /// The colour at and below the height of the eye.
    pub horizon: Rgb,
}

impl Default for SkyGradient {
    /// A blue sky by day.
    fn default() -> Self {
        Self { zenith: Rgb::new(0x5f, 0x97, 0xcc), horizon: Rgb::new(0xb4, 0xd2, 0xe6) }
    }
}

/// The light of a face from its left to its right end, as seen from in front of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FaceLight {
    /// In the middle.
    middle: Light,
    /// In the middle of the next faces to the left and to the right.
    beside: [Light; 2],
}

impl FaceLight {
    /// Full light everywhere.
    pub(crate) const FULL: Self = Self::even(Light::FULL);

    /// The same light everywhere.
    pub(crate) const fn even(light: Light) -> Self {
        Self { middle: light, beside: [light; 2] }
    }

    /// Returns true if the light is the same everywhere.
    pub(crate) fn is_even(self) -> bool {
        self.beside == [self.middle; 2]
    }

    /// The light at `u`, from 0 at the left end to 1 at the right one.
    #[inline]
    pub(crate) fn at(self, u: f64) -> Light {
        let Self { middle, beside: [left, right] } = self;
        if self.is_even() {
            return middle;
        }
        let (next, share) = if u < 0.5 { (left, 0.5 - u) } else { (right, u - 0.5) };
        middle.towards(next, share)
    }
}

impl World {
    /// The light of the face of `cell` as seen from the neighbouring cell `before`, if the tile of
    /// `cell` has no light of its own.
    pub(crate) fn face_light(&self, cell: Cell, before: Cell) -> FaceLight {
        let middle = self.light_in(before);
        let Some(tile) = self.tile_in(before).filter(|_| self.light_varies) else {
            return FaceLight::even(middle);
        };
        let is_lamplit = self.has_lamplight();
        // The right side for an observer who looks from `before` to `cell`, because y grows to the
        // south.
        let ahead = step(before, cell);
        let right = (-ahead.1, ahead.0);
        let beside = [(-right.0, -right.1), right].map(|(columns, rows)| {
            let next =
                before.moved(columns, rows).and_then(|cell| Some((cell, self.tile_in(cell)?)));
            // Most cells beside have the same tile, and with it the same light.
            next.filter(|(_, next)| is_lamplit || !std::ptr::eq(*next, tile))
                .filter(|(_, next)| is_lit_from(tile, next))
                .map_or(middle, |(cell, _)| self.light_in(cell))
        });
        FaceLight { middle, beside }
    }
}

/// Returns whether light passes between two neighbouring tiles: both let it through, and the lowest
/// gap of one overlaps a gap of the other.
fn is_lit_from(one: &Tile, other: &Tile) -> bool {
    let is_clear =
        |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Mask(_) | TileKind::Glass(_));
    is_clear(one) && is_clear(other) && (is_open_to(one, other) || is_open_to(other, one))
}

/// Returns whether the lowest gap of `one` overlaps any gap of `other`.
fn is_open_to(one: &Tile, other: &Tile) -> bool {
    let lowest = one.gaps().next();
    lowest.is_some_and(|lowest| {
        other.gaps().any(|gap| lowest.bottom.max(gap.bottom) < lowest.top.min(gap.top))
    })
}

/// The columns and rows from one cell to another.
fn step(from: Cell, to: Cell) -> (i64, i64) {
    (i64::from(to.column) - i64::from(from.column), i64::from(to.row) - i64::from(from.row))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::map;

    #[test]
    fn light_is_between_zero_and_one() {
        assert_eq!(Light::new(1.0), Some(Light::FULL));
        assert_eq!(Light::new(0.5).unwrap().in_256ths(), 128);
        for share in [-0.1, 1.1, f64::NAN] {
            assert_eq!(Light::new(share), None);
        }
    }

    #[test]
    fn fog_halves_clearness_at_its_distance() {
        let fog = Fog::new(Rgb::BLACK, 8.0).unwrap();
        assert_eq!([0.0, 8.0, f64::INFINITY].map(|t| fog.clearness(t)), [1.0, 0.5, 0.0]);
        for distance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Fog::new(Rgb::BLACK, distance), None);
        }
    }

    const SIDE: u32 = 5;

    fn cell(column: u32, row: u32) -> Cell {
        Cell { column, row }
    }

    /// A floor with several lights, and tiles that let light through or block it.
    fn world(cells: &[char]) -> World {
        let rows: Vec<String> =
            cells.chunks(SIDE as usize).map(|row| row.iter().collect()).collect();
        map::parse_str(&format!(
            "light = 0.5\ngrid = '''\n{}\n@....\n'''\n[tiles]\n'#'.wall = '#ffffff'\n'g'.glass = '#88aaff'\n\
             'a'.light = 0.1\n'b'.light = 0.9\n'h' = {{ floor_height = 9, light = 0.3, ceiling = 'sky' }}\n\
             'o' = {{ pillar = '#ffffff', radius = 0.2 }}\n[things]\n'@'.start = 0\n",
            rows.join("\n")
        ))
        .unwrap()
    }

    proptest! {
        /// Two faces that meet on one line have equal lights at the common end, and no face is
        /// brighter or darker than the cell in front of it and the neighbours of that cell.
        #[test]
        fn faces_that_meet_have_equal_light_at_their_edge(
            cells in prop::collection::vec(prop::sample::select(&['.', 'a', 'b', 'h', '#', 'g', 'o'][..]), 25),
        ) {
            let world = world(&cells);
            let is_open = |cell: Cell| {
                let tile = world.tile_in(cell).unwrap();
                matches!(tile.kind, TileKind::Open | TileKind::Glass(_))
            };
            for row in 1..SIDE {
                for column in 0..SIDE - 1 {
                    // Both face the row in the south; the one in the east is to the left.
                    let [west, east] = [cell(column, row - 1), cell(column + 1, row - 1)];
                    let faces = [(cell(column, row), west), (cell(column + 1, row), east)];
                    let [of_west, of_east] = faces.map(|(cell, before)| world.face_light(cell, before));
                    let (at_west, at_east) = (of_west.at(0.0), of_east.at(1.0));
                    let lights = [west, east].map(|cell| world.light_in(cell));
                    prop_assert_eq!(of_west.at(0.5), lights[0]);
                    if [west, east].into_iter().all(is_open) {
                        let mean = (lights[0].in_256ths() + lights[1].in_256ths()).div_ceil(2);
                        let is_joined = at_west.in_256ths() == mean;
                        prop_assert_eq!(is_joined, at_east.in_256ths() == mean);
                        prop_assert!(is_joined || [at_west, at_east] == lights);
                    } else {
                        prop_assert_eq!([at_west, at_east], lights);
                    }
                }
            }
        }
    }

    #[test]
    fn light_blends_linearly_but_not_through_walls() {
        let cells: Vec<char> = "ab#bag.....#####.........".chars().collect();
        let world = world(&cells);
        let face = world.face_light(cell(1, 1), cell(1, 0));
        // For an observer who looks south, left is east: a wall. It is darker to the right.
        let lights = [0.0, 0.25, 0.5, 0.75, 1.0].map(|u| face.at(u).in_256ths());
        assert_eq!(lights, [230, 230, 230, 179, 128]);
        let across = world.face_light(cell(3, 1), cell(3, 0));
        assert_eq!(across.at(1.0).in_256ths(), 230);
    }

    #[test]
    fn an_evenly_lit_world_asks_no_neighbours() {
        let world = map::parse_str(
            "light = 0.5\ngrid = '''\n@..\n###\n'''\n[tiles]\n'#'.wall = '#ffffff'\n[things]\n'@'.start = 0\n",
        )
        .unwrap();
        assert!(!world.light_varies);
    }
}
