//! The flight: a sweep that knows from [shafts](crate::world::Shafts) how far it is clear ahead.
//!
//! A shaft takes it across a strip of the map, or to the line where something solid begins in the shaft.
//! Only there it looks at the cell, and leaps as others do until the shaft has nothing more.

use super::{Course, FAR, Progress};
use crate::cast::Side;
use crate::world::{Bundle, Clearance, STRIP, Shafts};

impl Course {
    /// As [`Course::leap`], and across all that is clear ahead.
    #[inline]
    pub(super) fn fly(
        self,
        clearance: &Clearance,
        [along_rows, along_columns]: &[Shafts; 2],
        from: Progress,
    ) -> (i64, Progress) {
        let shafts = match self.side {
            Side::X => along_rows,
            Side::Y => along_columns,
        };
        let bundle = shafts.bundle(self.slope * self.step, self.step < 0);
        let Progress { mut line, mut band, mut looks } = from;
        let mut clear = 1;
        loop {
            line += clear;
            // The shaft is asked about what is before the line, too: on the other side of it, the ray may have
            // crossed into another band.
            let (end, shafts_seen) = self.end_of_flight(bundle, line - 1);
            let is_landing = end >= line;
            line = line.max(end);
            looks += shafts_seen + 1;
            let mut band_before = band;
            band = self.band_at(self.place + self.slope * line, line);
            if is_landing {
                // What is beside the cell is clear, too.
                band_before = band;
            } else {
                let along = self.start + self.step * line;
                clear = clearance.lines_of_block([along, band], self.block_strides);
                if clear >= FAR {
                    continue;
                }
            }
            let ahead = self.corner + self.line_stride * line + self.band_stride * band;
            clear = clearance.lines_at(ahead);
            let is_clear_beside =
                || is_landing || clear >= 2 || clearance.is_clear(ahead - self.line_stride);
            if clear == 0 || !is_clear_beside() {
                return (band_before, Progress { line, band, looks });
            }
        }
    }

    /// The first line that shafts cannot take it across that is at `line`, and how many shafts it asks.
    #[inline]
    fn end_of_flight(self, bundle: Bundle<'_>, mut line: i64) -> (i64, u64) {
        let along = self.start + self.step * line;
        let within = along.rem_euclid(STRIP);
        let mut within = if self.step > 0 { within } else { STRIP - 1 - within };
        let mut strip = along.div_euclid(STRIP);
        let mut place = self.place + self.slope * (line + STRIP / 2 - within);
        let mut shafts_seen = 0;
        loop {
            shafts_seen += 1;
            let ahead = bundle.lines_ahead(strip, within, place);
            line += ahead;
            if ahead < STRIP - within {
                return (line, shafts_seen);
            }
            within = 0;
            strip += self.step;
            place += self.slope * STRIP;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use crate::cast::sweep::Sweep;
    use crate::cast::{Ray, Walk};
    use crate::world::{Grid, TileId};

    const DOORWAY: TileId = TileId(1);
    const WALL: TileId = TileId(2);

    /// Places on a map of that size, of which many are on lines, or an ulp beside them, where strips begin.
    fn place(size: u32) -> impl Strategy<Value = f64> {
        let line = prop_oneof![(0..size), (0..=size / 64).prop_map(|index| index * 64)];
        let beside = |(line, ulps): (u32, i64)| {
            f64::from_bits((f64::from(line).to_bits() as i64 + ulps).max(0) as u64)
        };
        prop_oneof![
            0.0..f64::from(size),
            (line.clone(), -2..3_i64).prop_map(beside),
            line.prop_map(|line| f64::from(line) + 0.5),
        ]
    }

    /// Directions to all sides; along the axes and the diagonals, as steep as a slope begins, and nearly so.
    fn direction() -> impl Strategy<Value = DVec2> {
        let slope = prop_oneof![
            -1.0..1.0_f64,
            (-16..=16_i32, -1..2_i32)
                .prop_map(|(part, off)| f64::from(part) / 16.0 + f64::from(off) * 1e-10),
            Just(f64::MIN_POSITIVE),
        ];
        (slope, any::<bool>(), any::<bool>()).prop_map(|(slope, is_steep, is_backward)| {
            let direction = if is_steep { DVec2::new(slope, 1.0) } else { DVec2::new(1.0, slope) };
            if is_backward { -direction } else { direction }
        })
    }

    /// What stands on an open map: from a place to the south and to the east.
    type Block = (TileId, (u32, u32), (u32, u32));

    fn block() -> impl Strategy<Value = Block> {
        let extent = prop_oneof![
            8 => Just((1, 1)),
            1 => (1..90_u32, Just(1)),
            1 => (Just(1), 1..90_u32),
            1 => (1..9_u32, 1..9_u32),
        ];
        let tile = prop_oneof![3 => Just(WALL), 1 => Just(DOORWAY)];
        (tile, any::<(u32, u32)>(), extent)
    }

    fn grid([width, height]: [u32; 2], blocks: &[Block]) -> Grid {
        let mut cells = vec![TileId(0); (width * height) as usize];
        for &(tile, (column, row), (columns, rows)) in blocks {
            let (column, row) = (column % width, row % height);
            for row in row..(row + rows).min(height) {
                let start = (row * width) as usize;
                let (first, end) = (column as usize, (column + columns).min(width) as usize);
                cells[start + first..start + end].fill(tile);
            }
        }
        let [width, height] = [width, height].map(|side| side.try_into().unwrap());
        Grid::new(width, height, WALL, cells).unwrap()
    }

    /// Maps of some strips, and of some groups of strips, with a ray in each.
    fn scene() -> impl Strategy<Value = ([u32; 2], Vec<Block>, DVec2, DVec2)> {
        let side = || prop_oneof![4 => 1..600_u32, 1 => Just(128_u32), 1 => Just(256_u32)];
        let long = prop_oneof![900..2400_u32, Just(1024_u32)];
        let size = prop_oneof![
            4 => (side(), side()),
            1 => (long.clone(), side()),
            1 => (side(), long),
        ];
        size.prop_map(<[u32; 2]>::from).prop_flat_map(|size| {
            let origin = (place(size[0]), place(size[1])).prop_map(DVec2::from);
            let blocks = prop::collection::vec(block(), 0..50);
            (Just(size), blocks, origin, direction())
        })
    }

    proptest! {
        /// Through all that is solid, as far as there is map.
        #[test]
        fn it_meets_what_the_walk_meets((size, blocks, origin, direction) in scene()) {
            let mut grid = grid(size, &blocks);
            grid.make_shafts(|tile| tile == DOORWAY);
            let ray = Ray::new(origin, direction).unwrap();
            let walk = Walk::new(&grid, &ray).filter(|met| grid.is_solid_tile(met.tile));
            let Some(sweep) = Sweep::new(&grid, &ray) else { return Ok(()) };
            prop_assert_eq!(sweep.collect::<Vec<_>>(), walk.collect::<Vec<_>>());
        }
    }

    /// One at each strip, and a few more where something stands in the shaft.
    #[test]
    fn it_looks_little_where_it_passes_a_pillar() {
        let mut grid = grid([1024, 100], &[(WALL, (700, 50), (1, 1))]);
        grid.make_shafts(|_| false);
        for (y, met) in [(50.5, Some(700)), (49.5, None), (48.5, None), (40.5, None)] {
            let ray = Ray::new(DVec2::new(1.5, y), DVec2::X).unwrap();
            let mut sweep = Sweep::new(&grid, &ray).unwrap();
            assert_eq!(sweep.next().map(|met| met.cell.column), met);
            assert!(sweep.looks() <= 14, "{} looks along y = {y}", sweep.looks());
        }
    }
}
