//! Offices: corridors with fire doors, rooms, store rooms, halls of desks, and gardens.
//!
//! Each chunk has corridors along its northern and western sides, with a door to the next chunk at
//! the end of each. All corridors are therefore connected, and no view extends beyond the doors.
//! The rest of the chunk is a [`RoomArea`] with doors to the corridors.
//!
//! Walls are in odd columns and rows, doors in even ones, and furniture only in cells whose column
//! and row are both odd. No wall therefore ends at a door, and each door stands between walls. The
//! even columns and rows connect all cells of a room, so furniture never blocks the way, and no
//! check is needed.

use std::iter;
use std::ops::Range;

use super::chunk::{CHUNK_SIDE, Chunk, ChunkArea, Terrain, every_cell};
use super::purpose::{Purpose, generator};
use crate::rng::SplitMix64;

/// The office that belongs to a seed.
#[derive(Clone, Debug)]
pub(crate) struct Office {
    pub(crate) seed: u64,
}

const WALL: u8 = b'#';
const CORRIDOR: u8 = b',';
const CORRIDOR_LAMP: u8 = b'L';
const FIRE_DOOR: u8 = b'=';

/// The floors of rooms, halls and gardens. Store rooms are left out because they are dark.
const ROOM_FLOORS: [u8; 3] = [b'.', b'_', b'"'];

/// The position and width of the corridors, along both axes.
const CORRIDORS: Range<usize> = 1..3;
/// The distance between two lamps in a corridor, in cells.
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
        if let Some(block) = RoomArea::of(area, CORRIDORS.end) {
            block.build(&mut chunk, random);
        }
        chunk
    }

    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)> {
        let corner = (CORRIDORS.start, CORRIDORS.start);
        area.contains(corner.0, corner.1).then_some(corner)
    }

    /// A cell in a room: the one with the farthest view among several random cells.
    fn start(&self, area: &ChunkArea) -> (usize, usize) {
        /// The number of cells that are compared.
        const PLACES: usize = 6;
        let chunk = self.chunk(area);
        let is_in_room = |&(column, row): &(usize, usize)| {
            // There is never furniture in these cells, or beside them along the grid.
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

/// The number of floor cells in a row from a position, in the direction along the grid with the
/// most.
fn longest_view(chunk: &Chunk, (column, row): (usize, usize)) -> usize {
    let is_floor = |&(column, row): &(usize, usize)| {
        column < CHUNK_SIDE && row < CHUNK_SIDE && ROOM_FLOORS.contains(&chunk.get(column, row))
    };
    let along = |across: isize, down: isize| {
        let step = move |&(column, row): &(usize, usize)| {
            Some((column.wrapping_add_signed(across), row.wrapping_add_signed(down)))
        };
        iter::successors(Some((column, row)), step).take_while(is_floor).count()
    };
    [(1, 0), (-1, 0), (0, 1), (0, -1)]
        .map(|(across, down)| along(across, down))
        .into_iter()
        .max()
        .unwrap_or_default()
}

fn carve_corridors(chunk: &mut Chunk, area: &ChunkArea) {
    let inside = |range: &Range<usize>| range.start.max(1)..range.end;
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

/// The area between the corridors of a chunk.
#[derive(Clone, Debug)]
struct RoomArea {
    /// The inside from west to east, between walls in odd columns. The last wall may be in any
    /// column.
    columns: Range<usize>,
    /// The inside from north to south, between walls in odd rows. The last wall may be in any row.
    rows: Range<usize>,
}

const GLASS: u8 = b'G';
const DOOR: u8 = b'+';

/// The minimum inside length of a room along each side.
const MIN_ROOM_SIDE: usize = 3;
/// The length above which an area is always divided.
const MAX_ROOM_SIDE: usize = 11;
/// The number of columns or rows from one pillar of a hall to the next.
const PILLAR_SPACING: usize = 6;

/// The furniture of a room.
#[derive(Clone, Copy, Debug)]
struct Furniture {
    floor: u8,
    /// Each piece of furniture, and how many of [`PLACES`] contain it.
    pieces: &'static [(u8, usize)],
    /// A lamp that hangs from the ceiling over a walkable cell.
    lamp: Option<u8>,
    /// The pillar used in a hall.
    pillar: u8,
}

const PLACES: usize = 32;
/// The distance between two lamps in a room, in cells.
const ROOM_LAMP_SPACING: usize = 8;

const CARPETED: Furniture =
    Furniture { floor: b'.', pieces: &[(b't', 10), (b'p', 3)], lamp: Some(b'l'), pillar: b'o' };
const PANELLED: Furniture =
    Furniture { floor: b'_', pieces: &[(b'T', 6), (b'P', 4)], lamp: None, pillar: b'o' };
const STORE: Furniture = Furniture { floor: b'%', pieces: &[(b'q', 14)], lamp: None, pillar: b'o' };
const HALL: Furniture =
    Furniture { floor: b'.', pieces: &[(b't', 16), (b'p', 2)], lamp: Some(b'l'), pillar: b'o' };
const GARDEN: Furniture =
    Furniture { floor: b'"', pieces: &[(b'y', 10), (b's', 1)], lamp: None, pillar: b'O' };

impl RoomArea {
    /// The block of an area whose corridors end before `first`; `None` if there is no room for it.
    fn of(area: &ChunkArea, first: usize) -> Option<Self> {
        let inside = |range: &Range<usize>| first + 1..range.end;
        let block = Self { columns: inside(&area.columns), rows: inside(&area.rows) };
        (block.columns.len() >= MIN_ROOM_SIDE && block.rows.len() >= MIN_ROOM_SIDE).then_some(block)
    }

    /// Builds the block into `chunk`.
    fn build(self, chunk: &mut Chunk, random: SplitMix64) {
        let mut building = Building { chunk, random };
        match building.random.below(8) {
            0 => building.hall(&self, HALL),
            1 => building.hall(&self, GARDEN),
            _ => building.divide(self.clone()),
        }
        building.open_to_corridors(&self);
    }
}

/// The odd positions that leave enough room on both sides.
fn cuts(inside: &Range<usize>) -> Vec<usize> {
    let places = inside.start + MIN_ROOM_SIDE..(inside.end).saturating_sub(MIN_ROOM_SIDE);
    places.filter(|place| place % 2 == 1).collect()
}

struct Building<'c> {
    chunk: &'c mut Chunk,
    random: SplitMix64,
}

impl Building<'_> {
    /// Builds one room of any size, with pillars.
    fn hall(&mut self, block: &RoomArea, furniture: Furniture) {
        self.furnish(block, furniture);
        let is_pillars = |place: usize| place % PILLAR_SPACING == 1;
        for row in block.rows.clone().filter(|&row| is_pillars(row)) {
            for column in block.columns.clone().filter(|&column| is_pillars(column)) {
                self.chunk.set(column, row, furniture.pillar);
            }
        }
    }

    /// Divides large areas in two with a door between them, and furnishes the small ones.
    fn divide(&mut self, block: RoomArea) {
        let (across, down) = (cuts(&block.columns), cuts(&block.rows));
        let longest = block.columns.len().max(block.rows.len());
        let is_done = longest <= MAX_ROOM_SIDE && self.random.one_in(3);
        let is_wide = block.columns.len() > block.rows.len();
        let (cuts, is_across) = match (across.is_empty(), down.is_empty()) {
            _ if is_done => (Vec::new(), true),
            (false, true) => (across, true),
            (false, false) if is_wide => (across, true),
            _ => (down, false),
        };
        if cuts.is_empty() {
            let kinds = [CARPETED, CARPETED, PANELLED, STORE];
            let furniture = kinds[self.random.below(kinds.len())];
            return self.furnish(&block, furniture);
        }
        let cut = cuts[self.random.below(cuts.len())];
        let RoomArea { columns, rows } = block;
        if is_across {
            self.divide(RoomArea { columns: columns.start..cut, rows: rows.clone() });
            self.divide(RoomArea { columns: cut + 1..columns.end, rows: rows.clone() });
            let wall: Vec<_> = rows.map(|row| (cut, row)).collect();
            self.open_wall(&wall, 1);
        } else {
            self.divide(RoomArea { columns: columns.clone(), rows: rows.start..cut });
            self.divide(RoomArea { columns: columns.clone(), rows: cut + 1..rows.end });
            let wall: Vec<_> = columns.map(|column| (column, cut)).collect();
            self.open_wall(&wall, 1);
        }
    }

    fn open_to_corridors(&mut self, block: &RoomArea) {
        let in_west: Vec<_> =
            block.rows.clone().map(|row| (block.columns.start - 1, row)).collect();
        let in_north: Vec<_> =
            block.columns.clone().map(|column| (column, block.rows.start - 1)).collect();
        for wall in [in_west, in_north] {
            self.open_wall(&wall, 1 + wall.len() / 12);
        }
    }

    /// Places doors into every other cell of a wall, beginning with the first, and glass in some of
    /// the other such cells.
    fn open_wall(&mut self, wall: &[(usize, usize)], doors: usize) {
        let openings: Vec<_> = wall.iter().copied().step_by(2).collect();
        if self.random.one_in(2) {
            for &(column, row) in &openings {
                if !self.random.one_in(3) {
                    self.chunk.set(column, row, GLASS);
                }
            }
        }
        for _ in 0..doors {
            let (column, row) = openings[self.random.below(openings.len())];
            self.chunk.set(column, row, DOOR);
        }
    }

    fn furnish(&mut self, room: &RoomArea, furniture: Furniture) {
        let lamps_in =
            |range: &Range<usize>| ((range.start + range.len() / 2) % ROOM_LAMP_SPACING) & !1;
        let lamps = (lamps_in(&room.columns), lamps_in(&room.rows));
        for row in room.rows.clone() {
            for column in room.columns.clone() {
                let is_out_of_the_way = column % 2 == 1 && row % 2 == 1;
                let is_below_lamp = (column % ROOM_LAMP_SPACING, row % ROOM_LAMP_SPACING) == lamps;
                let piece = if is_out_of_the_way {
                    self.piece(furniture)
                } else {
                    furniture.lamp.filter(|_| is_below_lamp)
                };
                self.chunk.set(column, row, piece.unwrap_or(furniture.floor));
            }
        }
    }

    /// A random piece of furniture, or none.
    fn piece(&mut self, furniture: Furniture) -> Option<u8> {
        let mut number = self.random.below(PLACES);
        furniture.pieces.iter().find_map(|&(character, count)| {
            let is_it = number < count;
            number = number.saturating_sub(count);
            is_it.then_some(character)
        })
    }
}

/// The surfaces of an office, as values in a map file.
#[derive(Clone, Copy, Debug)]
struct Decor {
    wall: &'static str,
    carpet: &'static str,
    corridor: &'static str,
    ceiling: &'static str,
    fog: &'static str,
}

const DECORS: [Decor; 5] = [
    Decor {
        wall: r#""brick""#,
        carpet: r##""#5c5348""##,
        corridor: r##"{ checker = ["wood", "#6f5138"] }"##,
        ceiling: r##"{ checker = ["#c4b8a4", "#b6aa96"], scale = 0.5 }"##,
        fog: "#6a6258",
    },
    Decor {
        wall: r#""plaster""#,
        carpet: r##""#4a5866""##,
        corridor: r##"{ checker = ["marble", "#39444e"] }"##,
        ceiling: r##"{ checker = ["#b4bac0", "#a6adb4"], scale = 0.5 }"##,
        fog: "#59626b",
    },
    Decor {
        wall: r#""wood""#,
        carpet: r##""#6e343a""##,
        corridor: r##"{ checker = ["#7c3b40", "#66302f"] }"##,
        ceiling: r#"{ texture = "coffer", scale = 2 }"#,
        fog: "#5e4c40",
    },
    Decor {
        wall: r#""tile""#,
        carpet: r##""#56787a""##,
        corridor: r##"{ checker = ["tile", "#c3cfcb"], scale = 0.5 }"##,
        ceiling: r##"{ checker = ["#d3dcda", "#c2ccca"], scale = 0.5 }"##,
        fog: "#7b8a8a",
    },
    Decor {
        wall: r#""sandstone""#,
        carpet: r##""#3f5f4c""##,
        corridor: r##"{ checker = ["sandstone", "#7a5a3c"] }"##,
        ceiling: r##"{ checker = ["#cfc3a4", "#c2b494"], scale = 0.5 }"##,
        fog: "#6e6650",
    },
];

impl Decor {
    /// The decor that belongs to a seed. The next seed has a different one.
    fn of(seed: u64) -> Self {
        DECORS[(seed % DECORS.len() as u64) as usize]
    }

    /// The map file `legend` with this decor: its keys above the grid, and its tiles below.
    fn legend(self, legend: &str) -> String {
        let Self { wall, carpet, corridor, ceiling, fog } = self;
        format!(
            "floor = {carpet}\nceiling = {ceiling}\nfog = {{ color = \"{fog}\", distance = 16 }}\n\
             {legend}\n[tiles.\"#\"]\nwall = {wall}\n[tiles.\",\"]\nfloor = {corridor}\n"
        )
    }
}
