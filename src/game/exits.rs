//! Whether the player can reach an exit.
//!
//! The search overestimates what the player can reach, so that it never reports a reachable exit as
//! out of reach: the player runs, jumps and flies as far as speed and gravity allow, through every
//! gap high enough to duck into, past every shape, and through every door whose key they have
//! found. A flight is followed only from cells next to a lower floor; the neighbours of other cells
//! can fly as far.
//!
//! Secret walls are open. Tiles that a switch moves are at both ends, and its doors open, once a
//! lever or a plate of it is reached; a plate counts as reached where a guard may step on it. An
//! exit that asks for treasure needs as much of it in reach.
//!
//! Random play was refused: not finding a way proves little.

mod openers;
mod ways;

use std::collections::BTreeSet;

use super::fall::GRAVITY;
use super::player::{JUMP_HEIGHT, RADIUS, RUN, STEP_HEIGHT};
use crate::world::{Cell, Gap, Thing, ThingKind, World};
use openers::{Openers, pressed_by_guards};
use ways::{Way, Ways, high_enough, of_tiles, open_in, without};

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
    world.has_exit() && !Reach::new(world).an_exit_that_opens()
}

/// The search with a set of keys and switches.
struct Reach<'a> {
    world: &'a World,
    openers: Openers,
    /// The gaps of each tile.
    of_tiles: Vec<Ways>,
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

impl<'a> Reach<'a> {
    fn new(world: &'a World) -> Self {
        let cells = world.grid().width() as usize * world.grid().height() as usize;
        Self {
            world,
            openers: Openers { keys: BTreeSet::new(), switches: pressed_by_guards(world) },
            of_tiles: Vec::new(),
            stood: vec![0; cells],
            passed: vec![0; cells],
            flights: 0,
            waiting: Vec::new(),
            ahead: Vec::new(),
        }
    }

    /// Searches everything; returns whether an exit was found, and the treasure that it asks for.
    fn an_exit_that_opens(mut self) -> bool {
        loop {
            let before = self.openers.clone();
            let cell = self.world.start().cell;
            self.stood.fill(0);
            self.of_tiles = of_tiles(self.world, &self.openers);
            self.land(cell, self.world.floor_at(cell));
            while let Some(place) = self.waiting.pop() {
                if self.world.treasure_needed() == 0 && self.is_exit(place.cell) {
                    return true;
                }
                self.openers.find_in(self.world, place.cell);
                self.go_on(place);
            }
            if self.has_reached_an_exit_that_opens() {
                return true;
            }
            // A door that opens now may lead on from anywhere.
            if self.openers == before {
                return false;
            }
        }
    }

    fn is_exit(&self, cell: Cell) -> bool {
        self.world.things_in(cell).iter().any(|thing| thing.kind == ThingKind::Exit)
    }

    fn has_reached_an_exit_that_opens(&self) -> bool {
        let is_reached =
            |thing: &&Thing| self.index(thing.cell).is_some_and(|index| self.stood[index] != 0);
        let (mut treasure, mut has_exit) = (0_u64, false);
        for thing in self.world.things().iter().filter(is_reached) {
            match thing.kind {
                ThingKind::Exit => has_exit = true,
                ThingKind::Treasure(worth) => treasure += u64::from(worth),
                _ => {}
            }
        }
        has_exit && treasure >= u64::from(self.world.treasure_needed())
    }

    /// Visits the cells beside a position, and those that a flight from it reaches.
    fn go_on(&mut self, from: Place) {
        self.flights += 1;
        self.pass(from.cell);
        let is_on_a_ledge = from.cell.beside().any(|cell| {
            let highest = highest(from, cell);
            let within = |way: &&Way| way.least <= highest;
            let gaps = self.gaps(cell);
            let mut within = gaps.iter().flatten().filter(within).peekable();
            within.peek().is_some() && within.all(|way| way.least < from.height)
        });
        self.ahead.push(from.cell);
        while let Some(cell) = self.ahead.pop() {
            for next in cell.beside() {
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
        let gaps = gaps.iter().flatten().enumerate().filter(|(_, way)| way.least <= highest);
        let before = self.stood[index];
        let mut stood = before;
        let mut is_open = false;
        for (number, way) in gaps {
            is_open = true;
            stood |= 1 << number;
            if before >> number & 1 == 0 {
                self.waiting.push(Place { cell, height: way.gap.bottom });
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
    fn gaps(&self, cell: Cell) -> Ways {
        let Some(id) = self.world.grid().tile_in(cell) else {
            return Ways::default();
        };
        let moves = || self.world.moving_tiles().iter().any(|moving| moving.states[0] == id);
        if !self.world.grid().is_occupied(cell.column.into(), cell.row.into()) || moves() {
            return self.of_tiles[usize::from(id.0)];
        }
        let tile = self.world.tile(id);
        let mut gaps = open_in(&tile, &self.openers);
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

#[cfg(test)]
mod tests;
