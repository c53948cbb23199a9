//! The descent: an endless series of floors with guards, treasure and an exit.
//!
//! A floor is a complete [`World`]: a level from one of the generators, in which things and guards
//! are placed. Its size grows with the depth. Rules:
//!
//! - The exit, the treasure, the guards and their waypoints can all be reached from the start on
//!   foot, through doors without locks.
//! - The exit is among the cells farthest from the start, and opens for a third of the treasure.
//! - Guards begin at least [`GUARD_DISTANCE`](population::GUARD_DISTANCE) cells from the start and
//!   out of sight of it. Their number and the variety of their kinds grow with the depth. Normal
//!   difficulty adds half the number of guards on easy, and hard adds the same number again.
//! - A reachable cell is open if neither it nor any of its neighbours is opaque. At most
//!   [`MAX_OPEN`] percent of an office are open. Every fourth small office would otherwise be a
//!   hall or a garden as large as the floor, without corners to hide behind. Caves are naturally
//!   open, up to 70 percent, and mazes hardly at all.
//! - Deeper floors are darker, so lamps and lit rooms matter more.
//! - A floor depends only on the seed and its number. Nothing is carried from floor to floor.
//!
//! Rejected: a window into an endless level, as the generators use. Guards outside the window would
//! have to be simulated or forgotten. Also rejected: a map text for each floor. It would need a
//! character for each waypoint.

mod ground;
mod population;

use std::num::NonZeroU32;

use super::chunk::Extent;
use super::level::{GeneratedLevel, Generator};
use super::purpose::{Purpose, generator, hash};
use super::tileset::Tileset;
use super::window::best_heading;
use crate::fault::Faults;
use crate::rng::SplitMix64;
use crate::world::{Mission, Start, World};
use ground::Ground;
use population::Items;

/// The columns and rows: of the first floor, added by each further floor, and of the largest floor.
const COLUMNS: (u32, u32, u32) = (24, 4, 64);
const ROWS: (u32, u32, u32) = (24, 3, 48);
/// At least one in this many cells of a floor must be reachable.
const REACHABLE: u32 = 6;
/// The maximum percentage of open cells among the reachable cells of an office. Offices that are
/// divided into rooms have 9 to 35.
const MAX_OPEN: usize = 40;
/// The number of attempts after which a floor is used as it is.
const ATTEMPTS: i64 = 16;
/// The fraction of light that each floor loses, and the number of the darkest floor.
const DIMMING: f64 = 0.05;
const DARKEST: u32 = 10;
/// One in this many walls between two passages is opened.
const OPENED: usize = 7;

/// A floor of the descent with this seed. The first floor is 1, and 0 means the same.
///
/// ```
/// use cellcaster::generate::descent;
///
/// let floor = descent(20261122, 3)?;
/// assert_eq!(floor.title(), "Floor 3");
/// assert!(floor.guards().len() > 2 && floor.treasure_needed() > 0);
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
///
/// # Errors
/// None in practice: the tests create floors with all generators.
pub fn descent(seed: u64, floor: u32) -> Result<World, Faults> {
    let floor = floor.max(1);
    let (columns, rows) = size(floor);
    let least = (columns.get() * rows.get() / REACHABLE) as usize;
    let mut attempt = 0;
    loop {
        let draft = Draft::new(seed, floor, attempt)?;
        attempt += 1;
        match draft {
            Some(draft) if draft.is_playable(least) || attempt >= ATTEMPTS => {
                return draft.finish();
            }
            _ => {}
        }
    }
}

/// All floors below `floor` in the descent with this seed.
pub fn floors_below(seed: u64, floor: u32) -> impl Iterator<Item = World> {
    (floor.saturating_add(1)..).map_while(move |number| descent(seed, number).ok())
}

/// The seed of the daily descent, such as 20261122. It is the same for all players.
pub fn daily_seed(year: u32, month: u32, day: u32) -> u32 {
    year * 10_000 + month * 100 + day
}

/// A level before things and guards are placed in it.
struct Draft {
    floor: u32,
    generator: Generator,
    level: GeneratedLevel,
    ground: Ground,
    random: SplitMix64,
}

impl Draft {
    /// The level of one attempt; `None` if it has no start.
    fn new(seed: u64, floor: u32, attempt: i64) -> Result<Option<Self>, Faults> {
        let kind = kind(seed, floor);
        let own_seed = hash(seed, Purpose::Floor, floor.into(), attempt);
        let terrain = kind.terrain(own_seed);
        let legend = legend_of_floor(&terrain.legend(), floor);
        let (columns, rows) = size(floor);
        let extent = Extent::Cells { columns: columns.get(), rows: rows.get() };
        let level = GeneratedLevel::with_legend(terrain, &legend, extent)?;
        let mut random = generator(own_seed, Purpose::Population, 0, 0);
        let Some(start) = level.start() else { return Ok(None) };
        let start = (start.column as u32, start.row as u32);
        let mut cells = level.rows_without_exit(columns, rows);
        if kind == Generator::Maze {
            open_loops(&mut cells, level.tileset(), &mut random);
        }
        let ground = Ground::new(cells, start, level.tileset());
        Ok(Some(Self { floor, generator: kind, level, ground, random }))
    }

    /// Returns true if at least `least` cells are reachable and, in an office, not too many of them
    /// are open.
    fn is_playable(&self, least: usize) -> bool {
        let reachable = self.ground.reachable.len();
        let is_divided = self.generator != Generator::Office
            || self.ground.open_count() * 100 <= reachable * MAX_OPEN;
        reachable >= least && is_divided
    }

    /// The world with its exit, items and guards.
    fn finish(mut self) -> Result<World, Faults> {
        let tileset = self.level.tileset();
        let start = self.ground.start;
        let exit = self.ground.place_exit(tileset, &mut self.random);
        let mut world = tileset.world();
        let items = Items::place(self.floor, &self.ground, exit, &mut world, &mut self.random)?;
        let guards = population::guards(self.floor, &self.ground, &items, &mut self.random);
        let (width, rows) = (self.ground.width(), self.ground.rows());
        tileset.draw(&mut world, width, rows.into_iter(), &items.things, |grid| {
            let heading = best_heading(grid, start);
            Start { cell: start, heading }
        });
        world.set_mission(Mission {
            par: Some(par(self.ground.distance(exit), items.treasure_count())),
            treasure_needed: items.treasure() / 3,
            guards,
            ..Mission::default()
        });
        Ok(world)
    }
}

/// The par time in seconds: twice the time to walk to the exit, and a stop at each treasure.
fn par(way: u32, treasures: usize) -> u32 {
    30 + 2 * way / 3 + 6 * treasures as u32
}

/// The generator of a floor. The generators take turns, in an order that the seed decides.
fn kind(seed: u64, floor: u32) -> Generator {
    let mut order = Generator::ALL;
    let mut random = generator(seed, Purpose::Floor, 0, 0);
    order.swap(0, random.below(3));
    order.swap(1, 1 + random.below(2));
    order[(floor % 3) as usize]
}

/// The number of columns and rows of a floor.
fn size(floor: u32) -> (NonZeroU32, NonZeroU32) {
    let side = |(first, more, most): (u32, u32, u32)| {
        let side = first.saturating_add(more.saturating_mul(floor - 1)).min(most);
        NonZeroU32::new(side).unwrap_or(NonZeroU32::MIN)
    };
    (side(COLUMNS), side(ROWS))
}

/// Opens some walls between the passages of a maze, because a player who meets a guard in a passage
/// needs another way.
fn open_loops(cells: &mut [Vec<u8>], tileset: &Tileset, random: &mut SplitMix64) {
    for row in 1..cells.len().saturating_sub(1) {
        for column in 1..cells[row].len().saturating_sub(1) {
            let bare = |column: usize, row: usize| tileset.is_bare(cells[row][column]);
            let walkable = |column: usize, row: usize| tileset.is_walkable(cells[row][column]);
            let across = (walkable(column - 1, row), walkable(column + 1, row));
            let down = (walkable(column, row - 1), walkable(column, row + 1));
            let floor = match (across, down) {
                _ if walkable(column, row) => None,
                ((true, true), (false, false)) if bare(column - 1, row) => {
                    cells[row].get(column - 1)
                }
                ((false, false), (true, true)) if bare(column, row - 1) => {
                    cells[row - 1].get(column)
                }
                _ => None,
            };
            let floor = floor.copied().filter(|_| random.one_in(OPENED));
            if let Some(floor) = floor {
                cells[row][column] = floor;
            }
        }
    }
}

/// `legend` of a terrain as the legend of a floor: its title is the number, and deeper floors are
/// darker.
fn legend_of_floor(legend: &str, floor: u32) -> String {
    let line =
        |line: &str| match line.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
            Some(("title", _)) => format!("title = \"Floor {floor}\"\n"),
            Some(("light", value)) => {
                let share = 1.0 - DIMMING * f64::from(floor.min(DARKEST) - 1);
                let light = value.parse::<f64>().unwrap_or(1.0) * share;
                format!("light = {light:.3}\n")
            }
            _ => format!("{line}\n"),
        };
    legend.lines().map(line).collect()
}

#[cfg(test)]
mod tests;
