//! Blocks: the area between the corridors of a chunk, divided into rooms or not.

use std::ops::Range;

use super::super::chunk::{Chunk, ChunkArea};
use crate::rng::SplitMix64;

/// The area between the corridors of a chunk.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Its inside, from west to east, between walls in odd columns. The last wall may be in any
    /// column.
    columns: Range<usize>,
    /// The same from north to south.
    rows: Range<usize>,
}

const GLASS: u8 = b'G';
const DOOR: u8 = b'+';

/// The least inside of a room along each side.
const LEAST: usize = 3;
/// Longer or wider areas are always divided.
const LONGEST: usize = 11;
/// The columns and rows between pillars of a hall.
const PILLAR_SPACING: usize = 6;

/// The furniture of a room.
#[derive(Clone, Copy, Debug)]
struct Furniture {
    floor: u8,
    /// The furniture, and how many of [`PLACES`] have it.
    pieces: &'static [(u8, usize)],
    /// What hangs from the ceiling where the player can walk.
    lamp: Option<u8>,
    /// The pillars of a hall.
    pillar: u8,
}

const PLACES: usize = 32;
/// The cells between lamps.
const LAMP_SPACING: usize = 8;

const CARPETED: Furniture =
    Furniture { floor: b'.', pieces: &[(b't', 10), (b'p', 3)], lamp: Some(b'l'), pillar: b'o' };
const PANELLED: Furniture =
    Furniture { floor: b'_', pieces: &[(b'T', 6), (b'P', 4)], lamp: None, pillar: b'o' };
const STORE: Furniture = Furniture { floor: b'%', pieces: &[(b'q', 14)], lamp: None, pillar: b'o' };
const HALL: Furniture =
    Furniture { floor: b'.', pieces: &[(b't', 16), (b'p', 2)], lamp: Some(b'l'), pillar: b'o' };
const GARDEN: Furniture =
    Furniture { floor: b'"', pieces: &[(b'y', 10), (b's', 1)], lamp: None, pillar: b'O' };

impl Block {
    /// The block of a area whose corridors end before `first`, if there is room for it.
    pub(crate) fn of(area: &ChunkArea, first: usize) -> Option<Self> {
        let inside = |range: &Range<usize>| first + 1..range.end;
        let block = Self { columns: inside(&area.columns), rows: inside(&area.rows) };
        (block.columns.len() >= LEAST && block.rows.len() >= LEAST).then_some(block)
    }

    /// Builds the block.
    pub(crate) fn build(self, chunk: &mut Chunk, random: SplitMix64) {
        let mut building = Building { chunk, random };
        match building.random.below(8) {
            0 => building.hall(&self, HALL),
            1 => building.hall(&self, GARDEN),
            _ => building.divide(self.clone()),
        }
        building.open_to_corridors(&self);
    }

    /// The columns where a wall from north to south could divide it.
    fn cuts_across(&self) -> Vec<usize> {
        cuts(&self.columns)
    }

    fn cuts_down(&self) -> Vec<usize> {
        cuts(&self.rows)
    }
}

/// The odd positions that leave enough room on both sides.
fn cuts(inside: &Range<usize>) -> Vec<usize> {
    let places = inside.start + LEAST..(inside.end).saturating_sub(LEAST);
    places.filter(|place| place % 2 == 1).collect()
}

struct Building<'c> {
    chunk: &'c mut Chunk,
    random: SplitMix64,
}

impl Building<'_> {
    /// One room of any size, with pillars.
    fn hall(&mut self, block: &Block, furniture: Furniture) {
        self.furnish(block, furniture);
        let is_pillars = |place: usize| place % PILLAR_SPACING == 1;
        for row in block.rows.clone().filter(|&row| is_pillars(row)) {
            for column in block.columns.clone().filter(|&column| is_pillars(column)) {
                self.chunk.set(column, row, furniture.pillar);
            }
        }
    }

    /// Divides large areas into two, with a door between them, and furnishes the others.
    fn divide(&mut self, block: Block) {
        let (across, down) = (block.cuts_across(), block.cuts_down());
        let longest = block.columns.len().max(block.rows.len());
        let is_done = longest <= LONGEST && self.random.one_in(3);
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
        let Block { columns, rows } = block;
        if is_across {
            self.divide(Block { columns: columns.start..cut, rows: rows.clone() });
            self.divide(Block { columns: cut + 1..columns.end, rows: rows.clone() });
            let wall: Vec<_> = rows.map(|row| (cut, row)).collect();
            self.open_wall(&wall, 1);
        } else {
            self.divide(Block { columns: columns.clone(), rows: rows.start..cut });
            self.divide(Block { columns: columns.clone(), rows: cut + 1..rows.end });
            let wall: Vec<_> = columns.map(|column| (column, cut)).collect();
            self.open_wall(&wall, 1);
        }
    }

    fn open_to_corridors(&mut self, block: &Block) {
        let in_west: Vec<_> =
            block.rows.clone().map(|row| (block.columns.start - 1, row)).collect();
        let in_north: Vec<_> =
            block.columns.clone().map(|column| (column, block.rows.start - 1)).collect();
        for wall in [in_west, in_north] {
            self.open_wall(&wall, 1 + wall.len() / 12);
        }
    }

    /// Places doors into a wall, beginning where it may have one, and glass elsewhere.
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

    fn furnish(&mut self, room: &Block, furniture: Furniture) {
        let lamps_in = |range: &Range<usize>| ((range.start + range.len() / 2) % LAMP_SPACING) & !1;
        let lamps = (lamps_in(&room.columns), lamps_in(&room.rows));
        for row in room.rows.clone() {
            for column in room.columns.clone() {
                let is_out_of_the_way = column % 2 == 1 && row % 2 == 1;
                let is_below_lamp = (column % LAMP_SPACING, row % LAMP_SPACING) == lamps;
                let piece = if is_out_of_the_way {
                    self.piece(furniture)
                } else {
                    furniture.lamp.filter(|_| is_below_lamp)
                };
                self.chunk.set(column, row, piece.unwrap_or(furniture.floor));
            }
        }
    }

    /// One of the pieces, or none.
    fn piece(&mut self, furniture: Furniture) -> Option<u8> {
        let mut number = self.random.below(PLACES);
        furniture.pieces.iter().find_map(|&(character, count)| {
            let is_it = number < count;
            number = number.saturating_sub(count);
            is_it.then_some(character)
        })
    }
}
