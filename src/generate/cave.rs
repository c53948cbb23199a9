//! Caves: a cellular automaton, tunnels that connect the caverns, and stalagmites.
//!
//! At first, each cell is rock at random. Then, for several generations, each cell takes the state
//! of the majority around it. A cell depends on cells as far away as there are generations. A chunk
//! is therefore computed with a margin of that width, and fits its neighbours without a seam.
//!
//! The caverns of the automaton are not connected. Each chunk therefore has a hub, with winding
//! tunnels to a gate in each of its sides. The place of a gate depends only on the position of its
//! side, so all hubs are connected. Caverns beside the tunnels stay as they are, and some cannot be
//! reached.

use super::chunk::{CHUNK_SIDE, Chunk, ChunkArea, Terrain, every_cell};
use super::purpose::{Purpose, generator, hash};
use crate::rng::SplitMix64;

/// The cave that belongs to a seed.
#[derive(Clone, Debug)]
pub(crate) struct Cave {
    pub(crate) seed: u64,
}

const STONE: u8 = b'#';
const MOSS: u8 = b'M';
const FLOOR: u8 = b'.';
const STALAGMITE: u8 = b'o';
const TORCH: u8 = b't';
const BONES: u8 = b'b';
const CRYSTAL: u8 = b'c';
const HERB: u8 = b'm';
const TUNNEL: u8 = b':';
const POOL: u8 = b'~';

/// The number of generations.
const GENERATIONS: usize = 4;
/// The side in cells of the area from which a chunk is computed.
const WITH_MARGIN: usize = CHUNK_SIDE + 2 * GENERATIONS;
/// The percentage of cells that are rock at first.
const ROCK_IN_100: u64 = 49;
/// The percentage of cells that are dry.
const DRY_IN_100: u64 = 60;
/// A cell becomes rock if at least this many of the nine cells around it, itself included, are
/// rock.
const MAJORITY_OF_NINE: usize = 5;

/// The side in cells of the smallest area with a hub.
const MIN: usize = 6;
/// The radius of the floor around a hub, in cells.
const HUB_RADIUS: usize = 2;
/// The number of steps for which a tunnel may wind before it goes straight.
const WINDING: usize = 160;

type ChunkPosition = (usize, usize);

impl Terrain for Cave {
    fn seed(&self) -> u64 {
        self.seed
    }

    fn legend(&self) -> String {
        format!("title = \"Cave {}\"\n{}", self.seed, include_str!("cave.toml"))
    }

    fn chunk(&self, area: &ChunkArea) -> Chunk {
        let (column, row) = (area.chunk.column, area.chunk.row);
        let rock = self.settled(area, Purpose::Rock, ROCK_IN_100);
        let dry = self.settled(area, Purpose::Dry, DRY_IN_100);
        let mossy = hash(self.seed, Purpose::District, column >> 1, row >> 1).is_multiple_of(3);
        let mut chunk = Chunk::full_of(if mossy { MOSS } else { STONE });
        for (x, y) in every_cell().filter(|&(x, y)| !rock[y + GENERATIONS][x + GENERATIONS]) {
            let is_dry = dry[y + GENERATIONS][x + GENERATIONS];
            chunk.set(x, y, if is_dry { FLOOR } else { POOL });
        }
        let Some(hub) = self.hub(area) else { return chunk };
        carve_around(&mut chunk, area, hub, HUB_RADIUS);
        chunk.set(hub.0, hub.1, FLOOR);
        let mut random = generator(self.seed, Purpose::Plan, column, row);
        for gate in self.gates(area).into_iter().flatten() {
            carve_tunnel(&mut chunk, area, hub, gate, &mut random);
        }
        self.furnish(&mut chunk, area, hub);
        chunk
    }

    fn hub(&self, area: &ChunkArea) -> Option<ChunkPosition> {
        if !area.holds(MIN) {
            return None;
        }
        let mut random = generator(self.seed, Purpose::Hub, area.chunk.column, area.chunk.row);
        let mut within = |range: &std::ops::Range<usize>| {
            range.start + range.len() / 4 + random.below(range.len() / 2)
        };
        Some((within(&area.columns), within(&area.rows)))
    }
}

impl Cave {
    /// Random cells of the chunk and its margin with this initial percentage, after all
    /// generations.
    fn settled(
        &self,
        area: &ChunkArea,
        purpose: Purpose,
        in_100: u64,
    ) -> [[bool; WITH_MARGIN]; WITH_MARGIN] {
        let margin = GENERATIONS as i64;
        let mut rock = [[false; WITH_MARGIN]; WITH_MARGIN];
        for (row, y) in rock.iter_mut().zip(-margin..) {
            for (cell, x) in row.iter_mut().zip(-margin..) {
                let site = area.chunk.site(x, y);
                *cell = hash(self.seed, purpose, site.column, site.row) % 100 < in_100;
            }
        }
        for generation in 1..=GENERATIONS {
            let before = rock;
            let inner = generation..WITH_MARGIN - generation;
            for y in inner.clone() {
                for x in inner.clone() {
                    let around = before[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
                    rock[y][x] = around.filter(|&&is_rock| is_rock).count() >= MAJORITY_OF_NINE;
                }
            }
        }
        rock
    }

    /// The gates in the north, west, south and east; `None` on a side without a connected
    /// neighbour.
    fn gates(&self, area: &ChunkArea) -> [Option<ChunkPosition>; 4] {
        let last = CHUNK_SIDE - 1;
        let (column, row) = (area.chunk.column, area.chunk.row);
        let has_hub = |columns, rows| self.hub(&area.neighbor(columns, rows)).is_some();
        let along = |range: &std::ops::Range<usize>, purpose, column, row| {
            range.start + generator(self.seed, purpose, column, row).below(range.len())
        };
        let across = |column, row| along(&area.columns, Purpose::NorthPassage, column, row);
        let down = |column, row| along(&area.rows, Purpose::WestPassage, column, row);
        let (south, east) = (area.chunk.offset(0, 1).row, area.chunk.offset(1, 0).column);
        [
            has_hub(0, -1).then(|| (across(column, row), 0)),
            has_hub(-1, 0).then(|| (0, down(column, row))),
            has_hub(0, 1).then(|| (across(column, south), last)),
            has_hub(1, 0).then(|| (last, down(east, row))),
        ]
    }

    /// Places stalagmites and things where the player can walk around them, except on the hub.
    fn furnish(&self, chunk: &mut Chunk, area: &ChunkArea, hub: ChunkPosition) {
        let (column, row) = (area.chunk.column, area.chunk.row);
        let mut random = generator(self.seed, Purpose::Furniture, column, row);
        let inner = 1..CHUNK_SIDE - 1;
        let places = inner.clone().flat_map(|y| inner.clone().map(move |x| (x, y)));
        for (x, y) in places.filter(|&place| place != hub) {
            let is_free = (y - 1..=y + 1)
                .all(|row| (x - 1..=x + 1).all(|column| is_floor_of(chunk, area, column, row)));
            if !is_free {
                continue;
            }
            match random.below(60) {
                0..5 => chunk.set(x, y, STALAGMITE),
                5 => chunk.set(x, y, CRYSTAL),
                6..9 => chunk.set(x, y, TORCH),
                9 => chunk.set(x, y, BONES),
                10..14 => chunk.set(x, y, HERB),
                _ => {}
            }
        }
    }
}

fn is_floor_of(chunk: &Chunk, area: &ChunkArea, column: usize, row: usize) -> bool {
    area.contains(column, row) && chunk.get(column, row) == FLOOR
}

/// Clears the rock within `radius` of a cell, inside the area and apart from the corners.
fn carve_around(chunk: &mut Chunk, area: &ChunkArea, (column, row): ChunkPosition, radius: usize) {
    let near = |(x, y): ChunkPosition| {
        let (across, down) = (x.abs_diff(column), y.abs_diff(row));
        across * across + down * down <= radius * radius + 1
    };
    let is_rock =
        |(x, y): ChunkPosition| area.contains(x, y) && [STONE, MOSS].contains(&chunk.get(x, y));
    let carved: Vec<_> = every_cell().filter(|&place| near(place) && is_rock(place)).collect();
    for (x, y) in carved {
        chunk.set(x, y, TUNNEL);
    }
}

/// Clears a winding tunnel between two cells of the area.
fn carve_tunnel(
    chunk: &mut Chunk,
    area: &ChunkArea,
    from: ChunkPosition,
    to: ChunkPosition,
    random: &mut SplitMix64,
) {
    let (mut column, mut row) = from;
    let mut steps = 0;
    while (column, row) != to {
        steps += 1;
        let (across, down) = (to.0.abs_diff(column), to.1.abs_diff(row));
        let goes_across = random.below(across + down) < across;
        if steps < WINDING && random.one_in(3) {
            let back_and_forth = random.one_in(2);
            let beside = |place, range: &std::ops::Range<usize>| {
                stepped(place, if back_and_forth { range.start } else { range.end - 1 })
            };
            if goes_across {
                row = beside(row, &area.rows);
            } else {
                column = beside(column, &area.columns);
            }
        } else if goes_across {
            column = stepped(column, to.0);
        } else {
            row = stepped(row, to.1);
        }
        carve_around(chunk, area, (column, row), usize::from(random.one_in(3)));
    }
}

/// The coordinate after one step from `from` towards `to`.
fn stepped(from: usize, to: usize) -> usize {
    if from < to { from + 1 } else { from - usize::from(from > to) }
}
