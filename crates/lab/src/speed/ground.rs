//! Open maps of any size, and rays across them.

use std::fmt::Write;

use glam::{DVec2, Vec2Swizzles};

use cellcaster::cast::Ray;
use cellcaster::map;
use cellcaster::world::World;

/// The contents of an open map, besides the walls around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Nothing.
    Hall,
    /// A pillar in one cell of 4096.
    Plain,
}

/// The number of rays cast in a map.
pub(crate) const RAYS: u32 = 256;

impl Ground {
    /// All grounds.
    pub const ALL: [Self; 2] = [Self::Hall, Self::Plain];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hall => "hall",
            Self::Plain => "plain",
        }
    }

    /// The text of the map of `side` × `side` cells; `side` is at least 4.
    pub fn map(self, side: u32) -> String {
        let last = side - 1;
        let mut text = String::from("grid = '''\n");
        text.reserve(side as usize * (side as usize + 1));
        for row in 0..side {
            text.extend((0..side).map(|column| {
                let is_edge = row == 0 || column == 0 || row == last || column == last;
                match self {
                    _ if is_edge => '#',
                    Self::Plain if is_pillar(column, row) => '#',
                    _ if (column, row) == (1, side / 2) => '@',
                    _ => '.',
                }
            }));
            text.push('\n');
        }
        // Writing to a string cannot fail.
        _ = writeln!(text, "'''\n[tiles]\n'#'.wall = 'brick'\n[things]\n'@'.start = 0");
        text
    }

    /// The same map, parsed.
    ///
    /// # Panics
    /// Panics if a map cannot have this size.
    pub fn world(self, side: u32) -> World {
        map::parse_str(&self.map(side)).expect("the map is sound, but for its size")
    }
}

/// Whether a plain has a pillar there: one in each block of 64 × 64 cells, at or near its middle.
fn is_pillar(column: u32, row: u32) -> bool {
    let (within, block) = (|place: u32| place % 64, |place: u32| place / 64);
    let moved = |by: u32| 16 + (block(column) * 37 + block(row) * 101 + by * 53) % 32;
    (within(column), within(row)) == (moved(0), moved(1))
}

/// Rays that cross a map of `side` × `side` cells, half of them along rows and half along columns.
/// On a plain, pillars stop some of them.
///
/// # Panics
/// Never: their directions are not zero.
pub fn crossing_rays(side: u32) -> Vec<Ray> {
    let ray = |index: u32| {
        let share = f64::from(index) / f64::from(RAYS);
        let start = DVec2::new(1.5, f64::from(side) * (0.45 + 0.1 * share));
        let direction = DVec2::new(1.0, 0.8 * (share * 7.3).fract() - 0.4);
        if index.is_multiple_of(2) { (start, direction) } else { (start.yx(), direction.yx()) }
    };
    let cast = |index| {
        let (start, direction) = ray(index);
        Ray::new(start, direction).expect("both are finite, and it goes somewhere")
    };
    (0..RAYS).map(cast).collect()
}
