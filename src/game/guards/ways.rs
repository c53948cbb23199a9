//! The cells in which guards can walk, and the shortest paths through them.
//!
//! A guard walks on the lowest floor of a cell, and on top of low walls. They climb steps of
//! [`STEP_HEIGHT`], step down by [`DROP`] at most, and never jump. They avoid water, spikes and
//! floors that crumble. A guard who is in one of these, because they were pushed or because the
//! floor has moved, may leave it.
//!
//! For each goal, all guards who go there share the distances of the cells around it. A search
//! begins at the goal and ends when it has found the guards who ask for a path. Guards who follow
//! the same player have the same goal, so twenty of them cost hardly more than one. All searches
//! together find at most [`MAX_CELLS`] cells in a step and continue in the next step. A guard
//! without a path yet continues to the previous point. Rejected: a search for each guard (A*). It
//! finds fewer cells for one guard, but all of them again for the next.
//!
//! Doors and moving floors change paths. A search restarts when one of its steps has become
//! impossible, and when it is old.

use serde::{Deserialize, Serialize};

use crate::game::distances::{Costs, DIAGONAL, Distances, STRAIGHT, neighbor};
use crate::game::player::STEP_HEIGHT;
use crate::game::stored::{RestoreError, at_most, check};
use crate::world::{Ceiling, Cell, Driver, ThingKind, Tile, TileEffect, TileId, TileKind, World};

/// The highest step down, in cells.
pub(crate) const DROP: f64 = 1.0;
/// The additional cost of a closed door, in half cells.
const DOOR: u16 = 6;

/// The properties of tiles and things that guards need.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct GuardTerrain {
    /// One entry for each tile of the world.
    footings: Vec<Footing>,
    /// One bit for each cell, row by row: whether a thing in it blocks or is dangerous. Empty if
    /// there is no such thing.
    things: Vec<u64>,
    pub(crate) size: (u32, u32),
}

/// The floor of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Footing {
    pub(crate) floor: f64,
    ceiling: f64,
    kind: FootingKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FootingKind {
    Free,
    /// A closed door that guards open.
    Door,
    /// A dangerous floor.
    Hazard,
    Blocked,
}

/// The walking abilities of a kind of guard.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Gait {
    pub(crate) opens_doors: bool,
    pub(crate) height: f64,
}

impl GuardTerrain {
    pub(crate) fn new(world: &World) -> Self {
        let crumbles = |id: TileId| {
            let by_weight = world.moving_tiles().iter().filter(|it| it.driver == Driver::Weight);
            by_weight.flat_map(|it| &it.states).any(|&state| state == id)
        };
        let tiles = world.tiles().iter().zip(0..);
        let footings = tiles.map(|(tile, id)| Footing::new(tile, crumbles(TileId(id)))).collect();
        let mut terrain = Self { footings, things: Vec::new(), size: (0, 0) };
        terrain.look_at_things(world);
        terrain
    }

    /// Finds the things that are in the way.
    pub(crate) fn look_at_things(&mut self, world: &World) {
        self.size = (world.grid().width(), world.grid().height());
        self.things.clear();
        let is_in_the_way =
            |kind: ThingKind, blocks| blocks || matches!(kind, ThingKind::Spikes(_));
        for thing in world.things() {
            if is_in_the_way(thing.kind, world.sprite(thing.sprite).blocks) {
                let place = self.place(thing.cell);
                if self.things.is_empty() {
                    self.things
                        .resize((self.size.0 as usize * self.size.1 as usize).div_ceil(64), 0);
                }
                self.things[place / 64] |= 1 << (place % 64);
            }
        }
    }

    /// The floor of `cell`; `None` outside the map and in cells where nobody can walk.
    pub(crate) fn footing(&self, world: &World, cell: Cell) -> Option<Footing> {
        let footing = self.footing_of(tile(world, cell)?);
        (footing.kind != FootingKind::Blocked).then_some(footing)
    }

    /// Whether guards avoid `cell` although they could stand there.
    pub(crate) fn is_hazard(&self, world: &World, cell: Cell) -> bool {
        let is_hazard = |footing: Footing| footing.kind == FootingKind::Hazard;
        self.footing(world, cell).is_some_and(is_hazard) || self.has_thing(cell)
    }

    /// Whether a guard can walk from `from` to its neighbour `to`.
    pub(crate) fn leads(&self, world: &World, gait: Gait, from: Cell, to: Cell) -> bool {
        let to = self.destination(world, gait, to);
        to.is_some_and(|to| self.leads_to(world, gait, &to, from))
    }

    /// `cell` as a destination; `None` if guards do not enter it.
    #[inline]
    fn destination(&self, world: &World, gait: Gait, cell: Cell) -> Option<Destination> {
        let tile = tile(world, cell)?;
        let footing = self.footing_of(tile);
        let is_door = footing.kind == FootingKind::Door;
        let cost = if is_door { STRAIGHT + DOOR } else { STRAIGHT };
        let is_entered = self.is_entered(gait, &footing, cell);
        is_entered.then_some(Destination { cell, tile, footing, cost })
    }

    /// Whether a guard can walk to `to` from its neighbour `from`.
    #[inline]
    fn leads_to(&self, world: &World, gait: Gait, to: &Destination, from: Cell) -> bool {
        // A tile leads to itself if it can be entered.
        tile(world, from).is_some_and(|start| {
            start == to.tile || to.footing.is_reached_from(&self.footing_of(start), gait)
        })
    }

    #[inline]
    fn footing_of(&self, TileId(tile): TileId) -> Footing {
        self.footings[usize::from(tile)]
    }

    /// Whether guards choose to enter `cell`.
    pub(crate) fn is_walkable(&self, world: &World, gait: Gait, cell: Cell) -> bool {
        self.way_through(world, gait, cell).is_some()
    }

    /// The floor of `cell`; `None` if guards do not choose to enter it.
    pub(crate) fn way_through(&self, world: &World, gait: Gait, cell: Cell) -> Option<Footing> {
        let footing = self.footing(world, cell)?;
        self.is_entered(gait, &footing, cell).then_some(footing)
    }

    #[inline]
    fn is_entered(&self, gait: Gait, footing: &Footing, cell: Cell) -> bool {
        let is_open = match footing.kind {
            FootingKind::Free => true,
            FootingKind::Door => gait.opens_doors,
            FootingKind::Hazard | FootingKind::Blocked => false,
        };
        is_open && footing.ceiling - footing.floor >= gait.height && !self.has_thing(cell)
    }

    fn has_thing(&self, cell: Cell) -> bool {
        if self.things.is_empty() {
            return false;
        }
        let place = self.place(cell);
        self.things.get(place / 64).is_some_and(|bits| bits >> (place % 64) & 1 != 0)
    }

    fn place(&self, cell: Cell) -> usize {
        cell.row as usize * self.size.0 as usize + cell.column as usize
    }
}

impl Footing {
    fn new(tile: &Tile, crumbles: bool) -> Self {
        let floor = tile.heights.floor();
        let gap = tile.gaps().find(|gap| gap.bottom == floor);
        let is_dangerous = crumbles || tile.effect == Some(TileEffect::Water);
        let kind = match tile.kind {
            _ if gap.is_none() => FootingKind::Blocked,
            TileKind::Door(door) if door.key.is_none() && door.switch.is_none() => {
                FootingKind::Door
            }
            TileKind::Door(_) | TileKind::Mask(_) | TileKind::Glass(_) | TileKind::Shape(_) => {
                FootingKind::Blocked
            }
            _ if is_dangerous => FootingKind::Hazard,
            _ => FootingKind::Free,
        };
        let is_covered = matches!(tile.ceiling, Ceiling::Covered(_));
        let ceiling = gap.filter(|_| is_covered).map_or(f64::INFINITY, |gap| gap.top);
        Self { floor, ceiling, kind }
    }

    /// Whether a guard can walk the step from `start` up or down to this floor.
    fn is_reached_from(&self, start: &Self, gait: Gait) -> bool {
        if start.kind == FootingKind::Blocked {
            return false;
        }
        let climb = self.floor - start.floor;
        let headroom = self.ceiling.min(start.ceiling) - self.floor.max(start.floor);
        (-DROP..=STEP_HEIGHT).contains(&climb) && headroom >= gait.height
    }

    /// Whether the step between this floor and another floor needs no checks at all.
    pub(crate) fn is_level_with(self, other: Self) -> bool {
        self.floor == other.floor
            && self.kind == FootingKind::Free
            && other.kind == FootingKind::Free
    }
}

/// The costs of a search from a goal back to the guards who walk there.
pub(crate) struct ReverseCosts<'a> {
    pub(crate) terrain: &'a GuardTerrain,
    pub(crate) world: &'a World,
    pub(crate) gait: Gait,
}

/// A cell that guards can walk to from its neighbours.
pub(crate) struct Destination {
    cell: Cell,
    tile: TileId,
    footing: Footing,
    /// The cost of a straight step to it.
    cost: u16,
}

impl Costs for ReverseCosts<'_> {
    /// `None` for a cell that guards do not enter.
    type Origin = Option<Destination>;

    fn origin(&self, cell: Cell) -> Option<Destination> {
        self.terrain.destination(self.world, self.gait, cell)
    }

    #[inline]
    fn straight(&self, from: &Option<Destination>, to: Cell) -> Option<u16> {
        let from = from.as_ref()?;
        self.terrain.leads_to(self.world, self.gait, from, to).then_some(from.cost)
    }

    /// Diagonal steps lead past two cells at the same height.
    fn has_diagonal(&self, from: &Option<Destination>, to: Cell, beside: [bool; 2]) -> bool {
        let Some(from) = from.as_ref().filter(|_| beside == [true, true]) else { return false };
        let corners = [
            to,
            Cell { column: from.cell.column, row: to.row },
            Cell { column: to.column, row: from.cell.row },
        ];
        let Self { terrain, world, gait } = *self;
        let is_level = |cell| {
            let tile = tile(world, cell);
            tile.is_some_and(|tile| from.footing.is_level_with(terrain.footing_of(tile)))
        };
        corners.into_iter().all(|cell| is_level(cell) && !terrain.has_thing(cell))
            && terrain.leads_to(world, gait, from, to)
    }
}

#[inline]
fn tile(world: &World, cell: Cell) -> Option<TileId> {
    world.grid().tile_in(cell)
}

/// The cost of the step between two neighbours, in half cells.
fn cost_between(one: Cell, other: Cell) -> u16 {
    if one.column == other.column || one.row == other.row { STRAIGHT } else { DIAGONAL }
}

/// The number of cells that all searches together find in one step.
pub(crate) const MAX_CELLS: usize = 200;
/// The maximum number of goals at once.
const MAX_FIELDS: usize = 12;
/// The number of steps after which a search restarts: for a goal that could be reached, and for a
/// goal that could not.
const OLD: u64 = 1200;
const OLD_IN_VAIN: u64 = 150;

/// The distances to several goals.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct GuardPaths {
    #[serde(deserialize_with = "at_most::<MAX_FIELDS, _, _>")]
    fields: Vec<GoalDistances>,
    /// The number of the current step.
    now: u64,
    cells_left: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct GoalDistances {
    goal: Cell,
    gait: Gait,
    distances: Distances,
    begun: u64,
    used: u64,
}

/// The result of a query for a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathResult {
    /// The neighbouring cell to go to.
    Next(Cell),
    /// The guard is at the goal.
    Here,
    /// The search has not found the guard yet.
    Unknown,
    /// There is no path.
    Impossible,
}

impl GuardPaths {
    /// Returns an error if a search is later than the current step, or does not fit a map with
    /// `map` columns and rows.
    pub(crate) fn check(&self, map: (u32, u32)) -> Result<(), RestoreError> {
        let is_possible = |it: &GoalDistances| {
            it.begun <= self.now && it.used <= self.now && it.distances.is_around(it.goal, map)
        };
        check(self.fields.iter().all(is_possible), "a search")
    }

    /// Begins a step of the game.
    pub(crate) fn begin_step(&mut self) {
        self.now += 1;
        self.cells_left = MAX_CELLS;
    }

    /// Advances the clock by `steps` steps in which nobody asks for a path.
    pub(crate) fn wait(&mut self, steps: u64) {
        self.now += steps;
        if steps > 0 {
            self.cells_left = MAX_CELLS;
        }
    }

    /// Forgets all paths, for example when the whole map has changed.
    pub(crate) fn forget(&mut self) {
        self.fields.clear();
    }

    /// The next cell on the shortest path from `from` to `goal`.
    pub(crate) fn towards(
        &mut self,
        world: &World,
        terrain: &GuardTerrain,
        gait: Gait,
        from: Cell,
        goal: Cell,
    ) -> PathResult {
        if from == goal {
            return PathResult::Here;
        }
        let Some(index) = self.field(terrain, gait, goal) else { return PathResult::Unknown };
        let (now, field) = (self.now, &mut self.fields[index]);
        field.used = now;
        let costs = ReverseCosts { terrain, world, gait };
        while field.distances.distance(from).is_none() && !field.distances.is_over() {
            if self.cells_left == 0 {
                return PathResult::Unknown;
            }
            self.cells_left -= 1;
            field.distances.advance(&costs);
        }
        let age = now - field.begun;
        let Some(distance) = field.distances.distance(from) else {
            if age > OLD_IN_VAIN {
                field.begin(terrain, now);
            }
            return PathResult::Impossible;
        };
        let next = field.next(&costs, from, distance);
        if next.is_none() || age > OLD {
            field.begin(terrain, now);
        }
        next.map_or(PathResult::Unknown, PathResult::Next)
    }

    /// The cell after `from` on a path that has already been found.
    pub(crate) fn after(
        &self,
        world: &World,
        terrain: &GuardTerrain,
        gait: Gait,
        from: Cell,
        goal: Cell,
    ) -> Option<Cell> {
        let field = self.fields.iter().find(|it| it.goal == goal && it.gait == gait)?;
        let costs = ReverseCosts { terrain, world, gait };
        field.next(&costs, from, field.distances.distance(from)?)
    }

    /// The index of the field for a goal, which may be a new field. `None` if all fields are in
    /// use.
    fn field(&mut self, terrain: &GuardTerrain, gait: Gait, goal: Cell) -> Option<usize> {
        let mut fields = self.fields.iter();
        if let Some(index) = fields.position(|it| it.goal == goal && it.gait == gait) {
            return Some(index);
        }
        let (begun, used) = (self.now, self.now);
        if self.fields.len() < MAX_FIELDS {
            self.fields.push(GoalDistances {
                goal,
                gait,
                distances: Distances::default(),
                begun,
                used,
            });
        } else {
            let oldest = self.fields.iter_mut().min_by_key(|field| field.used)?;
            if oldest.used + 1 >= self.now {
                return None;
            }
            (oldest.goal, oldest.gait) = (goal, gait);
        }
        let index = self.fields.iter().position(|it| it.goal == goal && it.gait == gait)?;
        self.fields[index].begin(terrain, begun);
        Some(index)
    }
}

impl GoalDistances {
    fn begin(&mut self, terrain: &GuardTerrain, now: u64) {
        self.distances.begin(self.goal, terrain.size);
        (self.begun, self.used) = (now, now);
    }

    /// The neighbour of `from` on the shortest path to the goal. `distance` is the distance of
    /// `from` from the goal.
    fn next(&self, costs: &ReverseCosts, from: Cell, distance: u16) -> Option<Cell> {
        let neighbors = (0..8).filter_map(|side| neighbor(from, side));
        let nearer = neighbors.filter_map(|cell| {
            let there = self.distances.distance(cell).filter(|&there| there < distance)?;
            Some((there.saturating_add(cost_between(from, cell)), cell))
        });
        let possible = nearer.filter(|&(_, cell)| costs.leads(from, cell));
        Some(possible.min_by_key(|&(distance, _)| distance)?.1)
    }
}

impl ReverseCosts<'_> {
    /// Whether the step from `from` to its neighbour `to` is possible now.
    fn leads(&self, from: Cell, to: Cell) -> bool {
        let straight = |from, to| self.straight(&self.origin(to), from).is_some();
        if from.column == to.column || from.row == to.row {
            return straight(from, to);
        }
        let beside =
            [Cell { column: from.column, row: to.row }, Cell { column: to.column, row: from.row }];
        self.has_diagonal(&self.origin(to), from, beside.map(|cell| straight(cell, to)))
    }
}
