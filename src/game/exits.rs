//! The check that the player can reach an exit.
//!
//! The search overestimates the player's reach, so it never reports a reachable exit as out of
//! reach. In the search, the player runs, jumps and flies as far as speed and gravity allow. They
//! pass through every gap that is high enough to duck in, past every shape, and through every door
//! whose key they have found. The search follows a flight only from cells next to a lower floor,
//! because the neighbours of other cells can fly as far.
//!
//! Secret walls are open. Once a lever or a plate of a switch is reached, the tiles that it moves
//! are at both ends, and its doors are open. A plate also counts as reached if a guard may step on
//! it. If an exit requires treasure, as much treasure must be in reach.
//!
//! Rejected: random play. If it finds no path, that proves little.

use std::collections::BTreeSet;

use super::collision::around;
use super::fall::GRAVITY;
use super::player::{JUMP_HEIGHT, RADIUS, RUN, STEP_HEIGHT};
use super::stance::DUCKING;
use crate::sort;
use crate::world::{
    Ceiling, Cell, Door, Driver, Gap, KeyId, SwitchId, Thing, ThingKind, Tile, TileEffect,
    TileKind, World,
};

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
    world.has_exit() && !ExitSearch::new(world).an_exit_that_opens()
}

/// The search with a set of keys and switches.
struct ExitSearch<'a> {
    world: &'a World,
    openers: Openers,
    /// The ways through each tile.
    of_tiles: Vec<EnterableGaps>,
    /// For each cell, the floors that have been reached, as one bit each.
    stood: Vec<u8>,
    /// For each cell, the number of the last flight that has passed it.
    passed: Vec<u32>,
    flights: u32,
    waiting: Vec<ReachedPosition>,
    /// The cells from which the flight continues.
    ahead: Vec<Cell>,
}

/// A position that has been reached.
#[derive(Clone, Copy)]
struct ReachedPosition {
    cell: Cell,
    /// The height of the feet, in cells.
    height: f64,
}

impl<'a> ExitSearch<'a> {
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

    /// Searches everything. Returns true if an exit was found, and as much treasure as it requires.
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
            // A door that opens now may lead on from any cell.
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

    /// Visits the cells beside a position, and the cells that a flight from it reaches.
    fn go_on(&mut self, from: ReachedPosition) {
        self.flights += 1;
        self.pass(from.cell);
        let is_on_a_ledge = from.cell.beside().any(|cell| {
            let highest = highest(from, cell);
            let within = |way: &&EnterableGap| way.least <= highest;
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

    /// Reaches all floors of `cell` up to a height. Returns whether there are any.
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
                self.waiting.push(ReachedPosition { cell, height: way.gap.bottom });
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

    /// The ways through a cell that are high enough to duck in.
    fn gaps(&self, cell: Cell) -> EnterableGaps {
        let Some(id) = self.world.grid().tile_in(cell) else {
            return EnterableGaps::default();
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

/// The greatest height of the feet when a player who leaves a position first touches `cell`.
fn highest(from: ReachedPosition, cell: Cell) -> f64 {
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

/// The keys and switches that the player has found.
#[derive(Clone, PartialEq, Default)]
struct Openers {
    keys: BTreeSet<KeyId>,
    switches: BTreeSet<SwitchId>,
}

impl Openers {
    /// Adds the keys and plates in `cell`, and the levers in and around it.
    fn find_in(&mut self, world: &World, cell: Cell) {
        for thing in world.things_in(cell) {
            if let ThingKind::Key(key) = thing.kind {
                self.keys.insert(key);
            }
        }
        if let Some(TileEffect::Plate(switch)) = world.effect_in(cell) {
            self.switches.insert(switch);
        }
        if world.switch_count() == 0 {
            return;
        }
        for row in cell.row.saturating_sub(1)..=cell.row.saturating_add(1) {
            for column in cell.column.saturating_sub(1)..=cell.column.saturating_add(1) {
                for thing in world.things_in(Cell { column, row }) {
                    if let ThingKind::Lever(switch) = thing.kind {
                        self.switches.insert(switch);
                    }
                }
            }
        }
    }

    /// Whether a tile that `driver` moves may be anywhere between its ends.
    fn can_move(&self, driver: Driver) -> bool {
        match driver {
            Driver::Switch(switch) => self.switches.contains(&switch),
            Driver::Hand | Driver::Weight => true,
        }
    }
}

/// The switches of all plates, if the world has guards who may step on them.
fn pressed_by_guards(world: &World) -> BTreeSet<SwitchId> {
    let plate = |tile: &Tile| match tile.effect {
        Some(TileEffect::Plate(switch)) => Some(switch),
        _ => None,
    };
    let has_guards = !world.guards().is_empty();
    sort::gathered(world.tiles().iter().filter(|_| has_guards).filter_map(plate))
}

/// A gap of a cell, and the lowest height from which the player can enter it. That is the bottom of
/// the gap, or the height at which a floor begins to carry the player up to it.
#[derive(Clone, Copy)]
struct EnterableGap {
    gap: Gap,
    least: f64,
}

/// The ways through a cell. A tile has two gaps, and a moving tile has each of them at two ends. A
/// shape may divide one gap and leave a way beside it, and a thing may divide one more.
type EnterableGaps = [Option<EnterableGap>; 8];

/// The ways through each tile. Moving tiles are at both ends or, if they carry the player, at all
/// heights.
fn of_tiles(world: &World, openers: &Openers) -> Vec<EnterableGaps> {
    let tiles = world.tiles().iter();
    let mut of_tiles: Vec<EnterableGaps> =
        tiles.map(|tile| high_enough(open_in(tile, openers))).collect();
    for moving in world.moving_tiles().iter().filter(|it| openers.can_move(it.driver)) {
        let mut states = moving.states.iter().map(|&state| world.tile(state));
        of_tiles[usize::from(moving.states[0].0)] = match moving.driver {
            Driver::Switch(_) => along(states),
            // These tiles carry nobody up.
            Driver::Hand | Driver::Weight => {
                let ends = [states.next(), states.next_back()];
                let gaps = ends.iter().flatten().flat_map(|tile| open_in(tile, openers));
                high_enough(gaps.collect())
            }
        };
    }
    of_tiles
}

/// The ways through a tile that moves through `states`. A player who gets onto its floor at any
/// height is carried to both ends, but not through the ceiling.
fn along(states: impl Iterator<Item = Tile>) -> EnterableGaps {
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for tile in states {
        let gaps: Vec<Gap> = tile.gaps().collect();
        let is_inside =
            |index: usize| matches!(tile.ceiling, Ceiling::Covered(_)) && index + 1 < gaps.len();
        for (index, &gap) in gaps.iter().enumerate().filter(|(_, gap)| gap.height() >= DUCKING) {
            let side = if is_inside(index) { &mut below } else { &mut above };
            side.push(gap);
        }
    }
    let mut ways = EnterableGaps::default();
    let ends = [below, above].into_iter().flat_map(|gaps| {
        let by_height = |one: &&Gap, other: &&Gap| one.bottom.total_cmp(&other.bottom);
        let lowest = gaps.iter().min_by(by_height).copied();
        let highest = gaps.iter().max_by(by_height).copied();
        let ends = [lowest, highest].into_iter().flatten();
        let way = move |gap| Some(EnterableGap { gap, least: lowest?.bottom });
        ends.filter_map(way).collect::<Vec<_>>()
    });
    ways.iter_mut().zip(ends).for_each(|(way, end)| *way = Some(end));
    ways
}

/// The gaps of a tile for a player who has found `openers`.
fn open_in(tile: &Tile, openers: &Openers) -> Vec<Gap> {
    let gaps: Vec<Gap> = tile.gaps().collect();
    let standing = Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() };
    match tile.kind {
        TileKind::Door(Door { key: Some(key), .. }) if !openers.keys.contains(&key) => {
            without(&gaps, standing)
        }
        TileKind::Door(Door { switch: Some(switch), .. })
            if !openers.switches.contains(&switch) =>
        {
            without(&gaps, standing)
        }
        TileKind::Mask(_) | TileKind::Glass(_) => without(&gaps, standing),
        // The player may pass beside a shape, and its top is a floor.
        TileKind::Shape(_) => [without(&gaps, standing), gaps].concat(),
        TileKind::Open
        | TileKind::Door(_)
        | TileKind::Doorway(_)
        | TileKind::Wall(_)
        | TileKind::Mirror(_) => gaps,
    }
}

/// The ways through the `gaps` that are high enough to duck in.
fn high_enough(gaps: Vec<Gap>) -> EnterableGaps {
    let mut left = EnterableGaps::default();
    let high = gaps.into_iter().filter(|gap| gap.height() >= DUCKING);
    let way = |gap: Gap| EnterableGap { gap, least: gap.bottom };
    left.iter_mut().zip(high).for_each(|(left, gap)| *left = Some(way(gap)));
    left
}

/// The parts of `gaps` below and above `filled`.
fn without(gaps: &[Gap], filled: Gap) -> Vec<Gap> {
    gaps.iter().flat_map(|&gap| around(gap, filled)).collect()
}

#[cfg(test)]
mod tests;
