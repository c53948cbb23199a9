//! Offices: corridors with fire doors, rooms, store rooms, halls of desks, and gardens.
//!
//! Each chunk has a corridor along its northern and its western side, with a door to the next chunk
//! at its end. So all corridors are connected, and no view goes beyond the doors. The rest of the
//! chunk is a [`Block`], with doors to the corridors.
//!
//! Walls are in odd columns and rows, doors in even ones, and furniture where both are odd. So no
//! wall ends at a door, each door stands between walls, and the even columns and rows connect all
//! cells of a room: furniture is never in the way, and no check is necessary.

mod block;
mod decor;

use super::Terrain;
use super::chunk::{CHUNK_SIDE, Chunk, ChunkArea, every_cell};
use super::purpose::{Purpose, generator};
use block::Block;
use decor::Decor;

/// The office of a seed.
#[derive(Clone, Debug)]
pub(crate) struct Office {
    pub(crate) seed: u64,
}

const WALL: u8 = b'#';
const CORRIDOR: u8 = b',';
const CORRIDOR_LAMP: u8 = b'L';
const FIRE_DOOR: u8 = b'=';

/// The floors of rooms, halls and gardens; store rooms are dark.
const ROOM_FLOORS: [u8; 3] = [b'.', b'_', b'"'];

/// The place and the width of the corridors.
const CORRIDORS: std::ops::Range<usize> = 1..3;
/// The cells between two lamps of a corridor.
const LAMP_SPACING: usize = 7;

impl Terrain for Office {
    fn seed(&self) -> u64 {
        self.seed
    }

    fn legend(&self) -> String {
        let legend = Decor::of(self.seed).legend(include_str!("office.toml"));
        format!("title = \"Office {}\"\n{legend}", self.seed)
    }

    fn chunk(&self, area: &ChunkArea) -> Chunk {
        let mut chunk = Chunk::full_of(WALL);
        if self.hub(area).is_none() {
            return chunk;
        }
        carve_corridors(&mut chunk, area);
        self.set_fire_doors(&mut chunk, area);
        let random = generator(self.seed, Purpose::Plan, area.chunk.column, area.chunk.row);
        if let Some(block) = Block::of(area, CORRIDORS.end) {
            block.build(&mut chunk, random);
        }
        chunk
    }

    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)> {
        let corner = (CORRIDORS.start, CORRIDORS.start);
        area.contains(corner.0, corner.1).then_some(corner)
    }

    /// In a room, at the one of some cells with the farthest view.
    fn start(&self, area: &ChunkArea) -> (usize, usize) {
        /// The number of cells that are compared.
        const PLACES: usize = 6;
        let chunk = self.chunk(area);
        let is_in_room = |&(column, row): &(usize, usize)| {
            // Furniture is never here or beside it.
            column % 2 == 0 && row % 2 == 0 && ROOM_FLOORS.contains(&chunk.get(column, row))
        };
        let rooms: Vec<_> = every_cell().filter(is_in_room).collect();
        if rooms.is_empty() {
            return (0, 0);
        }
        let mut random = generator(self.seed, Purpose::Start, area.chunk.column, area.chunk.row);
        let places = (0..PLACES).map(|_| rooms[random.below(rooms.len())]);
        places.max_by_key(|&place| longest_view(&chunk, place)).unwrap_or_default()
    }
}

impl Office {
    fn set_fire_doors(&self, chunk: &mut Chunk, area: &ChunkArea) {
        let has_hub = |columns, rows| self.hub(&area.neighbor(columns, rows)).is_some();
        if has_hub(-1, 0) {
            chunk.set(0, CORRIDORS.start, FIRE_DOOR);
        }
        if has_hub(0, -1) {
            chunk.set(CORRIDORS.start, 0, FIRE_DOOR);
        }
    }
}

/// The number of cells of floor in a row from a position along the grid.
fn longest_view(chunk: &Chunk, (column, row): (usize, usize)) -> usize {
    let is_floor = |&(column, row): &(usize, usize)| {
        column < CHUNK_SIDE && row < CHUNK_SIDE && ROOM_FLOORS.contains(&chunk.get(column, row))
    };
    let along = |across: isize, down: isize| {
        let step = move |&(column, row): &(usize, usize)| {
            Some((column.wrapping_add_signed(across), row.wrapping_add_signed(down)))
        };
        std::iter::successors(Some((column, row)), step).take_while(is_floor).count()
    };
    [(1, 0), (-1, 0), (0, 1), (0, -1)]
        .map(|(across, down)| along(across, down))
        .into_iter()
        .max()
        .unwrap_or_default()
}

fn carve_corridors(chunk: &mut Chunk, area: &ChunkArea) {
    let inside = |range: &std::ops::Range<usize>| range.start.max(1)..range.end;
    let lamp_at = |along: usize| along % LAMP_SPACING == LAMP_SPACING / 2;
    let floor = |along, across: usize| {
        if lamp_at(along) && across == CORRIDORS.start { CORRIDOR_LAMP } else { CORRIDOR }
    };
    for across in CORRIDORS {
        for row in inside(&area.rows).filter(|&row| area.contains(across, row)) {
            chunk.set(across, row, floor(row, across));
        }
        for column in inside(&area.columns).filter(|&column| area.contains(column, across)) {
            chunk.set(column, across, floor(column, across));
        }
    }
}
