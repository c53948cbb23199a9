//! Leaps along beams: how a traversal uses the [beam tables](crate::world::BeamTable) of a large map.
//!
//! A beam takes the ray across a strip of the map, or to the line at which something solid begins in the
//! beam. There the ray reads the distance field, and leaps by it until the beam is clear again.

use super::{FAR, Path, Progress};
use crate::cast::Side;
use crate::world::{BeamTable, Beams, DistanceField, STRIP};

impl Path {
    /// As [`Path::leap`], and across everything that a beam says is clear.
    #[inline]
    pub(crate) fn leap_along_beams(
        self,
        distance_field: &DistanceField,
        [along_rows, along_columns]: &[BeamTable; 2],
        from: Progress,
    ) -> (i64, Progress) {
        let table = match self.side {
            Side::X => along_rows,
            Side::Y => along_columns,
        };
        let beams = table.beams(self.slope * self.step, self.step < 0);
        let Progress { mut line, mut band, mut lookups } = from;
        let mut clear = 1;
        loop {
            line += clear;
            // The beam is read one line back, because behind `line` the ray may have entered
            // another band.
            let (end, beams_read) = self.end_of_beam(beams, line - 1);
            let is_past_beam = end >= line;
            line = line.max(end);
            lookups += beams_read + 1;
            let mut band_before = band;
            band = self.band_at(self.position + self.slope * line, line);
            if is_past_beam {
                // The beam is wider than the cell, so that the neighbouring cell is clear, too.
                band_before = band;
            } else {
                let along = self.start + self.step * line;
                clear = distance_field.lines_of_block([along, band], self.block_strides);
                if clear >= FAR {
                    continue;
                }
            }
            let ahead = self.corner + self.line_stride * line + self.band_stride * band;
            clear = distance_field.lines_at(ahead);
            let is_clear_beside =
                || is_past_beam || clear >= 2 || distance_field.is_clear(ahead - self.line_stride);
            if clear == 0 || !is_clear_beside() {
                return (band_before, Progress { line, band, lookups });
            }
        }
    }

    /// The first line from `line` on that no beam crosses, and the number of beams read.
    #[inline]
    fn end_of_beam(self, beams: Beams<'_>, mut line: i64) -> (i64, u64) {
        let along = self.start + self.step * line;
        let within = along.rem_euclid(STRIP);
        let mut within = if self.step > 0 { within } else { STRIP - 1 - within };
        let mut strip = along.div_euclid(STRIP);
        let mut position = self.position + self.slope * (line + STRIP / 2 - within);
        let mut beams_read = 0;
        loop {
            beams_read += 1;
            let ahead = beams.lines_ahead(strip, within, position);
            line += ahead;
            if ahead < STRIP - within {
                return (line, beams_read);
            }
            within = 0;
            strip += self.step;
            position += self.slope * STRIP;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use crate::cast::major_axis::MajorAxisTraversal;
    use crate::cast::{Ray, Walk};
    use crate::world::{Grid, TileId};

    const DOORWAY: TileId = TileId(1);
    const WALL: TileId = TileId(2);

    /// Positions on a map of that size, many of them on a line where a strip begins, or an ulp beside it.
    fn position(size: u32) -> impl Strategy<Value = f64> {
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

    /// Directions to all sides: along the axes and diagonals, at the bounds of slopes, and close to those.
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

    /// A solid block on an open map, from a cell to the south and to the east.
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

    /// Maps of several strips, and of several groups of strips, each with a ray.
    fn scene() -> impl Strategy<Value = ([u32; 2], Vec<Block>, DVec2, DVec2)> {
        let side = || prop_oneof![4 => 1..600_u32, 1 => Just(128_u32), 1 => Just(256_u32)];
        let long = prop_oneof![900..2400_u32, Just(1024_u32)];
        let size = prop_oneof![
            4 => (side(), side()),
            1 => (long.clone(), side()),
            1 => (side(), long),
        ];
        size.prop_map(<[u32; 2]>::from).prop_flat_map(|size| {
            let origin = (position(size[0]), position(size[1])).prop_map(DVec2::from);
            let blocks = prop::collection::vec(block(), 0..50);
            (Just(size), blocks, origin, direction())
        })
    }

    proptest! {
        /// Through every solid cell, up to the end of the map.
        #[test]
        fn it_hits_the_same_cells_as_the_walk((size, blocks, origin, direction) in scene()) {
            let mut grid = grid(size, &blocks);
            grid.measure_with_beams(|tile| tile == DOORWAY);
            let ray = Ray::new(origin, direction).unwrap();
            let walk = Walk::new(&grid, &ray).filter(|met| grid.is_solid_tile(met.tile));
            let Some(traversal) = MajorAxisTraversal::new(&grid, &ray) else { return Ok(()) };
            prop_assert_eq!(traversal.collect::<Vec<_>>(), walk.collect::<Vec<_>>());
        }
    }

    /// One position for each strip, and a few more where the beam has a solid cell.
    #[test]
    fn it_computes_few_positions_where_it_passes_a_pillar() {
        let mut grid = grid([1024, 100], &[(WALL, (700, 50), (1, 1))]);
        grid.measure_with_beams(|_| false);
        for (y, met) in [(50.5, Some(700)), (49.5, None), (48.5, None), (40.5, None)] {
            let ray = Ray::new(DVec2::new(1.5, y), DVec2::X).unwrap();
            let mut traversal = MajorAxisTraversal::new(&grid, &ray).unwrap();
            assert_eq!(traversal.next().map(|met| met.cell.column), met);
            assert!(traversal.lookups() <= 14, "{} lookups along y = {y}", traversal.lookups());
        }
    }
}
