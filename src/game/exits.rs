//! Whether the player can reach an exit.
//!
//! The search overestimates what the player can reach, so that it never reports a reachable exit as
//! out of reach: the player runs, jumps and flies as far as speed and gravity allow, through every
//! gap high enough to duck into, past every shape, and through every door whose key they have
//! found. A flight is followed only from cells next to a lower floor; the neighbours of other cells
//! can fly as far.
//!
//! Random play was refused: not finding a way proves little.

use std::collections::BTreeSet;

use super::fall::GRAVITY;
use super::player::{JUMP_HEIGHT, RADIUS, RUN, STEP_HEIGHT};
use super::stance::DUCKING;
use crate::world::{Cell, Door, Gap, KeyId, ThingKind, Tile, TileKind, World};

/// Whether `world` has an exit and the player cannot reach any. `false` if there is no exit.
///
/// ```
/// let level = |grid: &str| {
///     cellcaster::map::parse_str(&format!(
///         "grid = '{grid}'\n[tiles]\n'#'.wall = 'brick'\n[things]\n'@'.start = 0\nX.exit = true"
///     ))
/// };
/// assert!(!cellcaster::game::is_exit_out_of_reach(&level("@.X").unwrap()));
/// assert!(cellcaster::game::is_exit_out_of_reach(&level("@#X").unwrap()));
/// ```
pub fn is_exit_out_of_reach(world: &World) -> bool {
    let is_exit = |cell: Cell| world.things_in(cell).iter().any(|it| it.kind == ThingKind::Exit);
    let has_exit = world.things().iter().any(|thing| thing.kind == ThingKind::Exit);
    has_exit && !Reach::new(world).everywhere(is_exit)
}

/// The search with a set of keys.
struct Reach<'a> {
    world: &'a World,
    keys: BTreeSet<KeyId>,
    /// The gaps of each tile.
    of_tiles: Vec<Gaps>,
    /// For each cell, the floors that have been reached, one bit for each.
    stood: Vec<u8>,
    /// For each cell, the last flight that has passed it.
    passed: Vec<u32>,
    flights: u32,
    waiting: Vec<Place>,
    /// The cells from which the flight goes on.
    ahead: Vec<Cell>,
}

/// A position that has been reached.
#[derive(Clone, Copy)]
struct Place {
    cell: Cell,
    /// The height of the feet, in cells.
    height: f64,
}

/// The gaps of a cell. A tile has two. A shape may divide one and leave a way beside it, and a
/// thing may divide one more.
type Gaps = [Option<Gap>; 8];

impl<'a> Reach<'a> {
    fn new(world: &'a World) -> Self {
        let cells = world.grid().width() as usize * world.grid().height() as usize;
        Self {
            world,
            keys: BTreeSet::new(),
            of_tiles: Vec::new(),
            stood: vec![0; cells],
            passed: vec![0; cells],
            flights: 0,
            waiting: Vec::new(),
            ahead: Vec::new(),
        }
    }

    /// Searches everything, or until `is_goal`; returns whether it was found.
    fn everywhere(mut self, is_goal: impl Fn(Cell) -> bool) -> bool {
        loop {
            let keys = self.keys.len();
            let cell = self.world.start().cell;
            self.stood.fill(0);
            let tiles = self.world.tiles().iter();
            self.of_tiles = tiles.map(|tile| high_enough(open_in(tile, &self.keys))).collect();
            self.land(cell, self.world.floor_at(cell));
            while let Some(place) = self.waiting.pop() {
                if is_goal(place.cell) {
                    return true;
                }
                for thing in self.world.things_in(place.cell) {
                    if let ThingKind::Key(key) = thing.kind {
                        self.keys.insert(key);
                    }
                }
                self.go_on(place);
            }
            // A door that opens now may lead on from anywhere.
            if self.keys.len() == keys {
                return false;
            }
        }
    }

    /// Visits the cells beside a position, and those that a flight from it reaches.
    fn go_on(&mut self, from: Place) {
        self.flights += 1;
        self.pass(from.cell);
        let is_on_a_ledge = beside(from.cell).any(|cell| {
            let highest = highest(from, cell);
            let within = |gap: &&Gap| gap.bottom <= highest;
            let gaps = self.gaps(cell);
            let mut within = gaps.iter().flatten().filter(within).peekable();
            within.peek().is_some() && within.all(|gap| gap.bottom < from.height)
        });
        self.ahead.push(from.cell);
        while let Some(cell) = self.ahead.pop() {
            for next in beside(cell) {
                let Some(index) = self.index(next) else { continue };
                if self.passed[index] == self.flights {
                    continue;
                }
                if self.land(next, highest(from, next)) && is_on_a_ledge {
                    self.pass(next);
                    self.ahead.push(next);
                }
            }
        }
    }

    /// Reaches all floors of `cell` up to a height; returns whether there are any.
    fn land(&mut self, cell: Cell, highest: f64) -> bool {
        let Some(index) = self.index(cell) else { return false };
        let gaps = self.gaps(cell);
        let gaps = gaps.iter().flatten().enumerate().filter(|(_, gap)| gap.bottom <= highest);
        let before = self.stood[index];
        let mut stood = before;
        let mut is_open = false;
        for (number, gap) in gaps {
            is_open = true;
            stood |= 1 << number;
            if before >> number & 1 == 0 {
                self.waiting.push(Place { cell, height: gap.bottom });
            }
        }
        self.stood[index] = stood;
        is_open
    }

    fn pass(&mut self, cell: Cell) {
        if let Some(index) = self.index(cell) {
            self.passed[index] = self.flights;
        }
    }

    fn index(&self, cell: Cell) -> Option<usize> {
        let (width, height) = (self.world.grid().width(), self.world.grid().height());
        let is_on_map = cell.column < width && cell.row < height;
        is_on_map.then(|| cell.row as usize * width as usize + cell.column as usize)
    }

    /// The gaps of a cell that are high enough to duck in.
    fn gaps(&self, cell: Cell) -> Gaps {
        let Some(id) = self.world.grid().tile(cell.column.into(), cell.row.into()) else {
            return Gaps::default();
        };
        if !self.world.grid().is_occupied(cell.column.into(), cell.row.into()) {
            return self.of_tiles[usize::from(id.0)];
        }
        let tile = self.world.tile(id);
        let mut gaps = open_in(&tile, &self.keys);
        for thing in self.world.things_in(cell) {
            let sprite = self.world.sprite(thing.sprite);
            if sprite.blocks {
                let bottom = sprite.base(tile.heights);
                gaps = without(&gaps, Gap { bottom, top: bottom + sprite.height.cells() });
            }
        }
        high_enough(gaps)
    }
}

/// The gaps of a tile for a player with these keys.
fn open_in(tile: &Tile, keys: &BTreeSet<KeyId>) -> Vec<Gap> {
    let gaps: Vec<Gap> = tile.gaps().collect();
    let standing = Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() };
    match tile.kind {
        TileKind::Door(Door { key: Some(key), .. }) if !keys.contains(&key) => {
            without(&gaps, standing)
        }
        TileKind::Mask(_) | TileKind::Glass(_) => without(&gaps, standing),
        // There may be a way beside it, and its top is a floor.
        TileKind::Shape(_) => [without(&gaps, standing), gaps].concat(),
        TileKind::Open
        | TileKind::Door(_)
        | TileKind::Doorway(_)
        | TileKind::Wall(_)
        | TileKind::Mirror(_) => gaps,
    }
}

/// The `gaps` that are high enough to duck in.
fn high_enough(gaps: Vec<Gap>) -> Gaps {
    let mut left = Gaps::default();
    let high = gaps.into_iter().filter(|gap| gap.height() >= DUCKING);
    left.iter_mut().zip(high).for_each(|(left, gap)| *left = Some(gap));
    left
}

/// How high the feet may be when a player who leaves a position first touches `cell`.
fn highest(from: Place, cell: Cell) -> f64 {
    let apart = |one: u32, other: u32| f64::from(one.abs_diff(other).saturating_sub(1));
    let columns = apart(from.cell.column, cell.column);
    let rows = apart(from.cell.row, cell.row);
    let way = libm::hypot(columns, rows);
    if way == 0.0 {
        return from.height + JUMP_HEIGHT.max(STEP_HEIGHT);
    }
    let seconds = (way - 2.0 * RADIUS.cells()).max(0.0) / RUN;
    let to_top = (2.0 * JUMP_HEIGHT / GRAVITY).sqrt();
    let falling = (seconds - to_top).max(0.0);
    from.height + JUMP_HEIGHT - GRAVITY / 2.0 * falling * falling
}

/// The neighbours of a cell in the west, east, north and south.
fn beside(Cell { column, row }: Cell) -> impl Iterator<Item = Cell> {
    let at = |column: Option<u32>, row: Option<u32>| Some(Cell { column: column?, row: row? });
    [
        at(column.checked_sub(1), Some(row)),
        at(column.checked_add(1), Some(row)),
        at(Some(column), row.checked_sub(1)),
        at(Some(column), row.checked_add(1)),
    ]
    .into_iter()
    .flatten()
}

/// The parts of gaps below and above what fills a part of them.
fn without(gaps: &[Gap], filled: Gap) -> Vec<Gap> {
    let left = gaps.iter().flat_map(|&gap| {
        let is_apart = filled.top <= gap.bottom || gap.top <= filled.bottom;
        let below = Gap { top: filled.bottom, ..gap };
        let above = Gap { bottom: filled.top, ..gap };
        if is_apart { [Some(gap), None] } else { [Some(below), Some(above)] }
    });
    left.flatten().filter(|gap| gap.bottom < gap.top).collect()
}

#[cfg(test)]
mod tests;
