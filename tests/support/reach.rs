//! The places in a level that a player may reach, and the places that a player surely reaches.
//!
//! A place to stand is a cell and a height in it. The set of places that a player
//! [may](Gait::Jumps) reach is too large: the player flies as far as speed and jump allow, over
//! everything that leaves a gap. The set of places that a player [surely](Gait::IsSure) reaches is
//! too small: only easy steps, ledges and jumps count. Rejected: a search by random play. If it
//! found no way, that would prove little.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use cellcaster::world::{Cell, Driver, Gap, KeyId, MovingTile, ThingKind, TileId, TileKind, World};

/// The player's greatest speed in cells per second, the acceleration in falling, and the speed at
/// take-off.
const RUN: f64 = 5.5;
const GRAVITY: f64 = 12.0;
const TAKE_OFF: f64 = 3.98;
const RADIUS: f64 = 0.25;
/// The player's smallest height, and the height of a step that needs no jump.
const DUCKING: f64 = 0.5;
const STEP: f64 = 0.35;
/// The height of a ledge that is easy to jump onto.
const LEDGE: f64 = 0.6;
const HAIR: f64 = 1e-9;

/// A place to stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) cell: Cell,
    /// The height of the feet, in cells.
    pub(crate) height: f64,
}

impl Eq for Place {}

impl Ord for Place {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cell.cmp(&other.cell).then(self.height.total_cmp(&other.height))
    }
}

impl PartialOrd for Place {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The keys that a player has.
pub(crate) type Keys = BTreeSet<u8>;

/// The abilities of a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gait {
    /// Run, and fall.
    Walks,
    /// Run, fall and jump.
    Jumps,
    /// Easy moves: steps, ledges, and jumps over one cell, or over two cells with a run-up.
    IsSure,
}

/// A level and the keys of the player in it.
#[derive(Clone, Debug)]
pub(crate) struct Reach<'a> {
    pub(crate) world: &'a World,
    pub(crate) gait: Gait,
    pub(crate) keys: Keys,
    /// `true` if the player picks up keys on the way.
    pub(crate) takes_keys: bool,
}

impl Reach<'_> {
    /// The place where the player starts.
    pub(crate) fn start(&self) -> Place {
        let cell = self.world.start().cell;
        Place { cell, height: self.world.floor_at(cell) }
    }

    /// The places that the player reaches from `start`. Picks up keys.
    pub(crate) fn from(&mut self, start: Place) -> BTreeSet<Place> {
        self.until(start, |_| false)
    }

    /// Returns whether the player gets from `start` to one of the `goals` or to the exit.
    pub(crate) fn gets_out(&mut self, start: Place, goals: &BTreeSet<Place>) -> bool {
        let world = self.world;
        let is_goal = |place: &Place| goals.contains(place) || is_exit(world, place.cell);
        self.until(start, is_goal).iter().any(is_goal)
    }

    /// The places that the player reaches from `start`, up to the first goal.
    fn until(&mut self, start: Place, is_goal: impl Fn(&Place) -> bool) -> BTreeSet<Place> {
        loop {
            let mut seen = BTreeSet::from([start]);
            let mut waiting = vec![start];
            while let Some(place) = waiting.pop() {
                if is_goal(&place) {
                    return seen;
                }
                let next = match self.gait {
                    Gait::Walks | Gait::Jumps => self.flights(place),
                    Gait::IsSure => self.sure_steps(place),
                };
                waiting.extend(next.into_iter().filter(|&place| seen.insert(place)));
            }
            let found: Keys = seen.iter().flat_map(|place| self.keys_in(place.cell)).collect();
            if !self.takes_keys || found.is_subset(&self.keys) {
                return seen;
            }
            self.keys.extend(found);
        }
    }

    /// Returns whether the exit is at one of `places`.
    pub(crate) fn has_exit(&self, places: &BTreeSet<Place>) -> bool {
        places.iter().any(|place| is_exit(self.world, place.cell))
    }

    fn keys_in(&self, cell: Cell) -> impl Iterator<Item = u8> {
        self.world.things_in(cell).iter().filter_map(|thing| match thing.kind {
            ThingKind::Key(KeyId(key)) => Some(key),
            _ => None,
        })
    }

    /// The places that the player may reach from `from` by one flight or one step.
    fn flights(&self, from: Place) -> Vec<Place> {
        let mut seen = BTreeSet::from([from.cell]);
        let mut waiting = vec![from.cell];
        let mut places = Vec::new();
        while let Some(cell) = waiting.pop() {
            for next in TURNS.into_iter().filter_map(|way| moved(cell, way)) {
                let highest = self.highest(from, next);
                let gaps = self.gaps(next);
                if gaps.iter().any(|gap| gap.bottom <= highest) && seen.insert(next) {
                    waiting.push(next);
                }
            }
            // A player at the corner of two cells stands on both.
            for next in AROUND.into_iter().filter_map(|way| moved(cell, way)) {
                let highest = self.highest(from, next);
                let floors = self.gaps(next).into_iter().map(|gap| gap.bottom);
                let within = floors.filter(|&floor| floor <= highest);
                places.extend(within.map(|height| Place { cell: next, height }));
            }
        }
        places
    }

    /// The greatest height of the feet at the moment when a player from `from` first touches
    /// `cell`.
    fn highest(&self, from: Place, cell: Cell) -> f64 {
        let apart = |one: u32, other: u32| f64::from(one.abs_diff(other).saturating_sub(1));
        let way = libm::hypot(apart(from.cell.column, cell.column), apart(from.cell.row, cell.row));
        let seconds = (way - 2.0 * RADIUS).max(0.0) / RUN;
        let speed = if self.gait == Gait::Jumps { TAKE_OFF } else { 0.0 };
        let seconds = seconds.max(speed / GRAVITY);
        let flown = from.height + speed * seconds - GRAVITY / 2.0 * seconds * seconds;
        if way == 0.0 { flown.max(from.height + STEP) } else { flown }
    }

    /// The places that the player surely reaches from `from`.
    fn sure_steps(&self, from: Place) -> Vec<Place> {
        let mut places = Vec::new();
        for (leap, turn) in LEAPS.iter().flat_map(|leap| TURNS.map(|turn| (leap, turn))) {
            let rise = leap.rise;
            let mut over = leap.over.iter().filter_map(|&way| moved(from.cell, turned(way, turn)));
            if !over.all(|cell| self.leaves_room(from, cell)) {
                continue;
            }
            let Some(cell) = moved(from.cell, turned(leap.to, turn)) else { continue };
            let gaps = self.gaps(cell).into_iter().filter(|gap| {
                let feet = from.height.max(gap.bottom);
                gap.bottom <= from.height + rise + HAIR && gap.top - feet >= DUCKING
            });
            places.extend(gaps.map(|gap| Place { cell, height: gap.bottom }));
        }
        places
    }

    /// Returns whether a player who jumps from `from` gets over `cell` without touching anything.
    fn leaves_room(&self, from: Place, cell: Cell) -> bool {
        let is_open =
            |gap: Gap| gap.bottom <= from.height && gap.top - from.height >= DUCKING + LEDGE;
        self.gaps(cell).into_iter().any(is_open)
    }

    /// The last state of a tile that a player can open by hand; for any other tile, the tile
    /// itself.
    fn opened(&self, tile: TileId) -> TileId {
        let by_hand = |moving: &&MovingTile| moving.driver == Driver::Hand;
        let moving = self.world.moving_tiles().iter().filter(by_hand);
        let mut ends = moving.filter(|moving| moving.states[0] == tile);
        ends.next().and_then(|moving| moving.states.last().copied()).unwrap_or(tile)
    }

    /// The gaps of a cell that are open to the player and high enough to stand in.
    fn gaps(&self, cell: Cell) -> Vec<Gap> {
        let grid = self.world.grid();
        let Some(id) = grid.tile(i64::from(cell.column), i64::from(cell.row)) else {
            return Vec::new();
        };
        let tile = self.world.tile(self.opened(id));
        let standing = Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() };
        let is_shape = matches!(tile.kind, TileKind::Shape(_));
        let filled = match tile.kind {
            TileKind::Door(door) => {
                door.key.is_some_and(|KeyId(key)| !self.keys.contains(&key)).then_some(standing)
            }
            TileKind::Mask(_) | TileKind::Glass(_) | TileKind::Shape(_) => Some(standing),
            TileKind::Open | TileKind::Doorway(_) | TileKind::Wall(_) | TileKind::Mirror(_) => None,
        };
        let things = self.world.things_in(cell).iter();
        let sprites = things.map(|thing| self.world.sprite(thing.sprite)).filter(|it| it.blocks);
        let blocking = sprites.map(|sprite| {
            let bottom = sprite.base(tile.heights);
            Gap { bottom, top: bottom + sprite.height.cells() }
        });
        let mut gaps: Vec<Gap> = tile.gaps().collect();
        for filled in filled.into_iter().chain(blocking) {
            gaps = gaps.into_iter().flat_map(|gap| without(gap, filled)).collect();
        }
        if is_shape && self.gait != Gait::IsSure {
            // The player may get past it.
            gaps.extend(tile.gaps());
        }
        gaps.retain(|gap| gap.height() >= DUCKING);
        gaps
    }
}

fn is_exit(world: &World, cell: Cell) -> bool {
    world.things_in(cell).iter().any(|thing| thing.kind == ThingKind::Exit)
}

/// An easy step or jump.
struct Leap {
    /// The offset of the target in cells ahead and to the right.
    to: (i64, i64),
    /// The offsets of the cells on the way.
    over: &'static [(i64, i64)],
    /// The largest height by which the target may be higher.
    rise: f64,
}

const LEAPS: [Leap; 5] = [
    Leap { to: (1, 0), over: &[], rise: LEDGE },
    Leap { to: (2, 0), over: &[(1, 0)], rise: 0.55 },
    Leap { to: (2, 1), over: &[(1, 0), (1, 1)], rise: 0.55 },
    Leap { to: (2, -1), over: &[(1, 0), (1, -1)], rise: 0.55 },
    Leap { to: (3, 0), over: &[(1, 0), (2, 0)], rise: 0.0 },
];

/// The four directions, each as the offset of the cell ahead.
const TURNS: [(i64, i64); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// Converts an offset ahead and to the right into columns and rows, given the direction ahead.
fn turned((ahead, right): (i64, i64), (column, row): (i64, i64)) -> (i64, i64) {
    (ahead * column - right * row, ahead * row + right * column)
}

const AROUND: [(i64, i64); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// The cell at this offset from `cell`, if its coordinates are not negative.
fn moved(cell: Cell, (columns, rows): (i64, i64)) -> Option<Cell> {
    let column = u32::try_from(i64::from(cell.column) + columns).ok()?;
    let row = u32::try_from(i64::from(cell.row) + rows).ok()?;
    Some(Cell { column, row })
}

/// The parts of `gap` below and above `filled`.
fn without(gap: Gap, filled: Gap) -> impl Iterator<Item = Gap> {
    let below = Gap { top: gap.top.min(filled.bottom), ..gap };
    let above = Gap { bottom: gap.bottom.max(filled.top), ..gap };
    [below, above].into_iter().filter(|gap| gap.bottom < gap.top)
}
