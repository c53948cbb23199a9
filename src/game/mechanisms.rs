//! Mechanisms: switches, and the tiles and doors that they drive.
//!
//! A switch is on while its levers are on or somebody stands on one of its plates. While it is on,
//! its tiles move to their ends, at one cell per second, and its doors are open. While it is off,
//! the tiles move back and the doors close.
//!
//! Nothing that moves crushes anybody. A floor lifts everybody who stands on it and stops if they
//! have no room. A wall does not rise while somebody touches its cell.
//!
//! A step examines only the plates that are down, the occupied cells, and the cells that move. The
//! indices of these plates and cells are kept from step to step, because a map may have a million
//! others.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::multiplayer::playing_mut;
use super::noise::reach;
use super::player::Motion;
use super::rules::MAX_PLAYERS;
use super::sound::SoundKind;
use super::stored::{OfLevel, RestoreError, check};
use super::tally::Share;
use super::{Game, STEPS_PER_SECOND};
use crate::cast::{Ray, Walk};
use crate::sort;
use crate::world::sprite::builtin::LeverFrame;
use crate::world::{
    Cell, Driver, MovingTile, SwitchId, ThingKind, TileEffect, TileId, TileKind, World,
};

/// The state of all mechanisms of a level.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Mechanisms {
    /// One entry for each switch.
    switches: Vec<Switch>,
    /// All plates, row by row.
    plates: Vec<Plate>,
    /// The indices of the plates that are down, in ascending order.
    #[serde(skip)]
    down: Vec<usize>,
    /// The cells of moving tiles, row by row.
    moving: Vec<MovingCell>,
    /// The indices of the moving cells that are not at rest, in ascending order.
    #[serde(skip)]
    active: Vec<usize>,
    /// The first cell of each moving tile.
    #[serde(skip)]
    first_cells: Vec<Option<Cell>>,
    /// The doors that switches open.
    #[serde(skip)]
    doors: Vec<(Cell, SwitchId)>,
    /// Whether the level has anything to open other than doors: levers, flames or secret walls.
    #[serde(skip)]
    pub(crate) has_handles: bool,
    /// Whether the level has floors that crumble.
    #[serde(skip)]
    has_crumbling: bool,
    /// The number of secret walls found, and their total number.
    #[serde(skip)]
    pub(crate) secrets: Share,
}

#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Switch {
    /// Whether its levers are on.
    is_turned: bool,
    /// The state that its doors and tiles have been set to.
    is_on: bool,
    /// The number of its plates that are down.
    #[serde(skip)]
    plates_down: u32,
    /// The indices of the moving cells that it drives.
    #[serde(skip)]
    cells: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Plate {
    #[serde(skip)]
    cell: Cell,
    #[serde(skip)]
    switch: SwitchId,
    is_down: bool,
}

impl OfLevel for Mechanisms {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        let switches = self.switches.of_level(start.switches)?;
        let plates = self.plates.of_level(start.plates)?;
        let moving = self.moving.of_level(start.moving)?;
        Ok(Self { switches, plates, moving, ..start })
    }
}

impl OfLevel for Switch {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        Ok(Self { is_turned: self.is_turned, is_on: self.is_on, ..start })
    }
}

impl OfLevel for Plate {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        Ok(Self { is_down: self.is_down, ..start })
    }
}

impl Mechanisms {
    /// Applies the moving tiles to `world`, in which they are at rest.
    ///
    /// # Errors
    /// If a tile is beyond its last state.
    pub(crate) fn show(&mut self, world: &mut World) -> Result<(), RestoreError> {
        for moving in &self.moving {
            check(moving.is_possible(world), "a moving tile")?;
            let (cell, shown) = (moving.cell, moving.shown(world));
            if world.grid().tile_in(cell) != Some(shown) {
                world.set_tile(cell, shown);
            }
        }
        self.recollect(world);
        Ok(())
    }

    /// The mechanisms of `world`, at rest.
    pub(crate) fn new(world: &World) -> Self {
        let tiles = world.grid().rows().zip(0..).flat_map(|(line, row)| {
            let columns = line.iter().zip(0..);
            columns.map(move |(&tile, column)| (Cell { column, row }, tile))
        });
        let mut new = Self {
            switches: vec![Switch::default(); world.switch_count()],
            first_cells: vec![None; world.moving_tiles().len()],
            has_handles: world
                .things()
                .iter()
                .any(|thing| matches!(thing.kind, ThingKind::Lever(_) | ThingKind::Flame)),
            ..Self::default()
        };
        for (cell, tile) in tiles {
            let is_it = |moving: &MovingTile| moving.states.first() == Some(&tile);
            if let Some(index) = world.moving_tiles().iter().position(is_it) {
                new.add_moving(cell, index, world.moving_tiles()[index].driver);
            }
            let tile = world.tile(tile);
            if let Some(TileEffect::Plate(switch)) = tile.effect {
                new.plates.push(Plate { cell, switch, is_down: false });
            }
            if let TileKind::Door(door) = tile.kind {
                new.doors.extend(door.switch.map(|switch| (cell, switch)));
            }
        }
        new
    }

    fn add_moving(&mut self, cell: Cell, tile: usize, driver: Driver) {
        match driver {
            Driver::Switch(switch) => {
                self.switches[usize::from(switch.0)].cells.push(self.moving.len());
            }
            Driver::Hand => {
                self.has_handles = true;
                self.secrets.total += 1;
            }
            Driver::Weight => self.has_crumbling = true,
        }
        self.first_cells[tile].get_or_insert(cell);
        self.moving.push(MovingCell::new(cell, tile));
    }

    /// Recomputes the data derived from the state: the plates that are down, the cells that are not
    /// at rest, and the secrets that have been found.
    fn recollect(&mut self, world: &World) {
        let plates = self.plates.iter().enumerate().filter(|(_, plate)| plate.is_down);
        self.down = plates.map(|(index, _)| index).collect();
        self.switches.iter_mut().for_each(|switch| switch.plates_down = 0);
        for &index in &self.down {
            self.switches[usize::from(self.plates[index].switch.0)].plates_down += 1;
        }
        self.active =
            (0..self.moving.len()).filter(|&index| self.is_in_motion(index, world)).collect();
        let secrets = self.moving.iter().filter(|cell| cell.driver(world) == Driver::Hand);
        self.secrets.found = secrets.filter(|cell| cell.is_driven).count() as u32;
    }

    /// Toggles the levers of `switch`. Returns whether they are on now.
    pub(crate) fn turn(&mut self, switch: SwitchId) -> bool {
        let Some(state) = self.switches.get_mut(usize::from(switch.0)) else { return false };
        state.is_turned = !state.is_turned;
        state.is_turned
    }

    /// Opens the secret wall whose moving cell has this index.
    fn open_secret(&mut self, index: usize) {
        self.secrets.found += u32::from(!self.moving[index].is_driven);
        self.moving[index].is_driven = true;
        if let Err(place) = self.active.binary_search(&index) {
            self.active.insert(place, index);
        }
    }

    /// The index of the moving cell in `cell`.
    fn moving_in(&self, cell: Cell) -> Option<usize> {
        self.moving.binary_search_by_key(&by_row(cell), |moving| by_row(moving.cell)).ok()
    }

    /// The index of the plate in `cell`.
    fn plate_in(&self, cell: Cell) -> Option<usize> {
        self.plates.binary_search_by_key(&by_row(cell), |plate| by_row(plate.cell)).ok()
    }

    /// Whether a moving cell is not at rest, provided that nobody steps on it.
    fn is_in_motion(&self, index: usize, world: &World) -> bool {
        let cell = self.moving[index];
        cell.step(world, self.is_driven(cell, world)).is_some()
    }

    /// Whether a switch, a hand or a weight drives a moving cell.
    fn is_driven(&self, cell: MovingCell, world: &World) -> bool {
        match cell.driver(world) {
            Driver::Switch(switch) => self.switches[usize::from(switch.0)].is_on,
            Driver::Hand | Driver::Weight => cell.is_driven,
        }
    }

    fn is_on(&self, switch: SwitchId) -> bool {
        let switch = &self.switches[usize::from(switch.0)];
        switch.is_turned || switch.plates_down > 0
    }

    fn switches(&self) -> impl Iterator<Item = SwitchId> + use<> {
        (0..self.switches.len()).map(|index| SwitchId(index as u8))
    }
}

impl Game {
    /// Moves everything that switches, hands and weights drive.
    pub(crate) fn move_mechanisms(&mut self) {
        let bodies = self.cells_of_all().count();
        *self.work += (bodies + self.mechanisms.down.len()) as u64;
        self.press_plates();
        self.throw_switches();
        self.move_tiles();
    }

    /// Whether a step would change any mechanism except doors.
    pub(crate) fn mechanisms_move(&self) -> bool {
        self.changing_plates().next().is_some()
            || self.mechanisms.switches().any(|switch| {
                self.mechanisms.is_on(switch)
                    != self.mechanisms.switches[usize::from(switch.0)].is_on
            })
            || self.movable_cells().any(|index| self.would_move(self.mechanisms.moving[index]))
    }

    /// The cells of the active players and of all guards.
    fn cells_of_all(&self) -> impl Iterator<Item = Cell> {
        let players = self.playing().map(|(_, player)| player.motion.cell());
        players.chain(self.guards.cells())
    }

    /// The indices of the plates that go down or up in this step. They are unordered, and some
    /// occur more than once.
    fn changing_plates(&self) -> impl Iterator<Item = usize> {
        let Mechanisms { plates, down, .. } = &self.mechanisms;
        let leaves = |index: &usize| !self.weighs_on(plates[*index].cell);
        let goes_down =
            |index: &usize| !plates[*index].is_down && self.weighs_on(plates[*index].cell);
        let cells = self.cells_of_all().take_while(|_| !plates.is_empty());
        let underfoot = cells.filter_map(|cell| self.mechanisms.plate_in(cell));
        down.iter().copied().filter(leaves).chain(underfoot.filter(goes_down))
    }

    /// The indices of the moving cells that are not at rest or that may crumble under somebody.
    /// They are unordered, and some occur more than once.
    fn movable_cells(&self) -> impl Iterator<Item = usize> {
        let mechanisms = &self.mechanisms;
        let crumbles =
            |&index: &usize| mechanisms.moving[index].driver(&self.world) == Driver::Weight;
        let cells = self.cells_of_all().take_while(|_| mechanisms.has_crumbling);
        let underfoot = cells.filter_map(|cell| mechanisms.moving_in(cell)).filter(crumbles);
        mechanisms.active.iter().copied().chain(underfoot)
    }

    /// Whether somebody stands in `cell`.
    fn weighs_on(&self, cell: Cell) -> bool {
        let stands =
            |motion: &Motion| motion.cell() == cell && motion.feet() <= self.world.floor_at(cell);
        self.playing().any(|(_, player)| stands(&player.motion)) || self.guards.weighs_on(cell)
    }

    /// Whether somebody would overlap a wall in `cell`.
    pub(crate) fn is_in_the_way(&self, cell: Cell) -> bool {
        self.playing().any(|(_, it)| it.motion.touches(cell)) || self.guards.touches(cell)
    }

    fn press_plates(&mut self) {
        let changing = in_order(self.changing_plates());
        for index in changing {
            let Mechanisms { plates, down, switches, .. } = &mut self.mechanisms;
            let Plate { cell, switch, is_down } = &mut plates[index];
            let count = &mut switches[usize::from(switch.0)].plates_down;
            *is_down = !*is_down;
            match down.binary_search(&index) {
                Ok(place) => {
                    down.remove(place);
                    *count -= 1;
                }
                Err(place) => {
                    down.insert(place, index);
                    *count += 1;
                }
            }
            let cell = *cell;
            self.sound_in(cell, SoundKind::Mechanism, reach::CLICK);
        }
    }

    /// Makes doors and tiles follow the switches that have changed.
    fn throw_switches(&mut self) {
        for switch in self.mechanisms.switches() {
            let is_on = self.mechanisms.is_on(switch);
            let Mechanisms { switches, active, .. } = &mut self.mechanisms;
            let known = &mut switches[usize::from(switch.0)];
            if known.is_on == is_on {
                continue;
            }
            known.is_on = is_on;
            active.extend(&known.cells);
            *self.work += self.mechanisms.doors.len() as u64;
            self.revision += 1;
            for index in 0..self.mechanisms.doors.len() {
                let (cell, driver) = self.mechanisms.doors[index];
                if driver == switch {
                    self.doors.hold(cell, is_on);
                    self.sound_in(cell, SoundKind::Door, reach::DOOR);
                }
            }
            for index in 0..self.world.moving_tiles().len() {
                let is_driven = self.world.moving_tiles()[index].driver == Driver::Switch(switch);
                let first = self.mechanisms.first_cells[index];
                if let Some(cell) = first.filter(|_| is_driven) {
                    self.sound_in(cell, SoundKind::Mechanism, reach::MECHANISM);
                }
            }
        }
    }

    fn move_tiles(&mut self) {
        let revision = self.revision;
        let mut movable = in_order(self.movable_cells());
        *self.work += (movable.len() * (1 + self.guards.count())) as u64;
        for &index in &movable {
            let cell = self.mechanisms.moving[index];
            if let Some(step) = self.next_step(cell) {
                self.mechanisms.moving[index] = self.moved(cell, step);
            }
        }
        let Self { mechanisms, world, .. } = self;
        if self.revision != revision {
            // The movement may have made room.
            for &index in &movable {
                mechanisms.moving[index].is_blocked = false;
            }
        }
        movable.retain(|&index| mechanisms.is_in_motion(index, world));
        mechanisms.active = movable;
    }

    /// The next step of a moving cell; `None` if the cell is at rest.
    fn next_step(&self, cell: MovingCell) -> Option<MovingCellStep> {
        let is_stepped_on =
            || cell.driver(&self.world) == Driver::Weight && self.weighs_on(cell.cell);
        let is_driven = self.mechanisms.is_driven(cell, &self.world) || is_stepped_on();
        cell.step(&self.world, is_driven)
    }

    /// Whether a step would change a moving cell, provided that nobody has moved since the last
    /// step.
    fn would_move(&self, cell: MovingCell) -> bool {
        self.next_step(cell).is_some_and(|step| step.state.is_none() || !cell.is_blocked)
    }

    /// The cell after `step`, which also moves everybody who stands on it. If somebody is in the
    /// way, the cell before `step`, marked as blocked.
    fn moved(&mut self, cell: MovingCell, step: MovingCellStep) -> MovingCell {
        let Some(state) = step.state else { return step.after };
        let before = cell.shown(&self.world);
        let mut stood = [false; MAX_PLAYERS];
        for (index, player) in self.playing() {
            stood[index] = player.motion.stands(&self.world);
        }
        self.world.set_tile(cell.cell, state);
        let carries = cell.driver(&self.world) != Driver::Weight;
        if self.is_crushing(cell, state, carries) {
            self.world.set_tile(cell.cell, before);
            self.tell_who_blocks(cell);
            return cell.blocked();
        }
        self.revision += 1;
        self.hear_crumbling(cell, step);
        self.guards.floor_moved(&self.world, cell.cell, carries);
        let Self { player, members, world, .. } = self;
        for (index, player) in playing_mut(player, members.as_deref_mut()) {
            if let Some(feet) = player.motion.feet_after(world, stood[index] && carries) {
                player.motion = player.motion.carried_to(feet);
                player.fell_from = feet;
            }
        }
        step.after
    }

    /// Tells the players who are in the way that a cell has stopped. Each stop is announced only
    /// once.
    fn tell_who_blocks(&mut self, cell: MovingCell) {
        if !cell.is_blocked {
            self.for_each_player(|game| {
                if game.player.motion.touches(cell.cell) {
                    game.say("It stops: you are in the way.".to_owned());
                }
            });
        }
    }

    /// Makes the sounds of a floor that cracks and then breaks.
    fn hear_crumbling(&mut self, cell: MovingCell, step: MovingCellStep) {
        if cell.driver(&self.world) == Driver::Weight {
            if !cell.is_driven {
                self.sound_in(cell.cell, SoundKind::Mechanism, reach::CLICK);
            } else if step.after.is_at_the_end(&self.world) {
                self.sound_in(cell.cell, SoundKind::Crash, reach::CRASH);
            }
        }
    }

    /// Whether somebody has no room in the world after `cell` has changed to `state`. If `carries`
    /// is true, the floor carries everybody who stands on it.
    fn is_crushing(&self, cell: MovingCell, state: TileId, carries: bool) -> bool {
        let world = &self.world;
        let tile = world.tile(state);
        let rises = tile.heights.floor() > world.tile(cell.shown(world)).heights.floor();
        if rises && matches!(tile.kind, TileKind::Wall(_)) {
            return self.is_in_the_way(cell.cell);
        }
        let crushes = |motion: &Motion| {
            motion.touches(cell.cell) && !(motion.has_room(world) || motion.lifted(world).is_some())
        };
        self.playing().any(|(_, player)| crushes(&player.motion))
            || self.guards.are_crushed(world, cell.cell, carries)
    }
}

/// The sort key for the order row by row from the north, and within a row from the west.
fn by_row(cell: Cell) -> (u32, u32) {
    (cell.row, cell.column)
}

/// The `indices` in ascending order, without duplicates.
fn in_order(indices: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut indices: Vec<usize> = indices.collect();
    sort::by_key(&mut indices, |&index| index);
    indices.dedup();
    indices
}

/// The number of steps for which a floor cracks after somebody has stepped on it, and the number
/// for which it falls.
const CRACKS: u16 = 30;
const FALLS: u16 = 20;

/// A cell of a [`MovingTile`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct MovingCell {
    #[serde(skip)]
    cell: Cell,
    /// The index of its moving tile.
    #[serde(skip)]
    tile: u16,
    /// The number of steps from the first state, without the steps in which it cracks.
    progress: u16,
    /// The number of steps for which it has cracked.
    cracks: u16,
    /// Whether a hand or a weight has set it in motion.
    is_driven: bool,
    /// Whether somebody was in the way of its last step. Reset when any tile moves.
    is_blocked: bool,
}

/// The effect of a step on a moving cell.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MovingCellStep {
    after: MovingCell,
    /// The new tile, if the cell changes its tile.
    state: Option<TileId>,
}

impl OfLevel for MovingCell {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        Ok(Self { cell: start.cell, tile: start.tile, ..self })
    }
}

impl MovingCell {
    /// A cell of the moving tile `tile`, at rest.
    fn new(cell: Cell, tile: usize) -> Self {
        Self {
            cell,
            tile: tile as u16,
            progress: 0,
            cracks: 0,
            is_driven: false,
            is_blocked: false,
        }
    }

    fn tile(&self) -> usize {
        usize::from(self.tile)
    }

    fn driver(&self, world: &World) -> Driver {
        self.moving_tile(world).driver
    }

    /// The same cell, marked as blocked.
    #[must_use]
    fn blocked(self) -> Self {
        Self { is_blocked: true, ..self }
    }

    /// The tile that the cell shows.
    fn shown(&self, world: &World) -> TileId {
        let moving = self.moving_tile(world);
        let last = moving.states.len().saturating_sub(1);
        let index = usize::from(self.progress) * last / usize::from(steps(moving, world));
        // A floor that cracks sinks a little.
        let index = index.max(usize::from(self.cracks > 0)).min(last);
        moving.states[index]
    }

    /// Whether the cell has reached its last state.
    fn is_at_the_end(&self, world: &World) -> bool {
        self.progress >= steps(self.moving_tile(world), world)
    }

    /// The next step, towards the end if `is_driven` is true and back otherwise. `None` if the cell
    /// is at rest.
    fn step(self, world: &World, is_driven: bool) -> Option<MovingCellStep> {
        let moving = self.moving_tile(world);
        let mut after = Self { is_blocked: false, ..self };
        if moving.driver == Driver::Weight && is_driven && self.cracks < CRACKS {
            after.is_driven = true;
            after.cracks += 1;
        } else if is_driven {
            after.progress = (self.progress + 1).min(steps(moving, world));
        } else {
            after.progress = self.progress.saturating_sub(1);
        }
        let state = Some(after.shown(world)).filter(|&state| state != self.shown(world));
        (after != self).then_some(MovingCellStep { after, state })
    }

    /// Whether the progress is within the states.
    fn is_possible(&self, world: &World) -> bool {
        self.cracks <= CRACKS && self.progress <= steps(self.moving_tile(world), world)
    }

    fn moving_tile<'a>(&self, world: &'a World) -> &'a MovingTile {
        &world.moving_tiles()[self.tile()]
    }
}

/// The number of steps from the first state to the last; at least one.
fn steps(moving: &MovingTile, world: &World) -> u16 {
    if moving.driver == Driver::Weight {
        return FALLS;
    }
    let height = |id: Option<&TileId>| id.map_or(0.0, |&id| world.tile(id).heights.floor());
    let way = (height(moving.states.last()) - height(moving.states.first())).abs();
    (way * f64::from(STEPS_PER_SECOND)).round().clamp(1.0, u16::MAX.into()) as u16
}

/// The largest distance between a handle's cell and the player who opens it, in cells.
const REACH: f64 = 0.9;
/// The cosine of the angle to either side of the view within which a lever or a flame can be used:
/// 50°.
const COSINE: f64 = 0.642_787_609_686_539_3;
/// At smaller distances, the direction does not matter, in cells.
const NEAR: f64 = 0.4;

/// A thing other than a door that the player can open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Handle {
    Lever(Cell, SwitchId),
    Flame(Cell),
    /// The secret wall whose moving cell has this index.
    Secret(usize),
}

impl Game {
    /// The handle in front of the player.
    pub(crate) fn handle_ahead(&self) -> Option<Handle> {
        if !self.mechanisms.has_handles {
            return None;
        }
        self.thing_to_open().or_else(|| self.secret_ahead())
    }

    /// Toggles a lever or a flame, or opens a secret wall.
    pub(crate) fn use_handle(&mut self, handle: Handle) {
        self.revision += 1;
        match handle {
            Handle::Lever(cell, switch) => self.turn_lever(cell, switch),
            Handle::Flame(cell) => {
                let burns = self.burns(cell);
                self.world.set_flame(cell, !burns);
            }
            Handle::Secret(index) => {
                let cell = self.mechanisms.moving[index].cell;
                self.mechanisms.open_secret(index);
                self.sound_in(cell, SoundKind::Mechanism, reach::MECHANISM);
                self.say("You have found a secret.".to_owned());
            }
        }
    }

    fn turn_lever(&mut self, cell: Cell, switch: SwitchId) {
        let is_turned = self.mechanisms.turn(switch);
        let is_it = |kind| kind == ThingKind::Lever(switch);
        let levers = self.world.things().iter().filter(|thing| is_it(thing.kind));
        let cells: Vec<Cell> = levers.map(|thing| thing.cell).collect();
        for lever in cells {
            let frame = if is_turned { LeverFrame::On } else { LeverFrame::Off };
            self.world.set_frame(lever, is_it, frame.index());
        }
        self.sound_in(cell, SoundKind::Mechanism, reach::CLICK);
    }

    fn burns(&self, cell: Cell) -> bool {
        let things = self.world.things_in(cell).iter();
        things.filter(|thing| thing.kind == ThingKind::Flame).any(|thing| thing.frame.is_none())
    }

    /// The nearest lever or flame, in front of the player or at their position.
    fn thing_to_open(&self) -> Option<Handle> {
        let Cell { column, row } = self.player.motion.cell();
        let near = |place: u32| place.saturating_sub(1)..=place.saturating_add(1);
        let cells = near(row).flat_map(|row| near(column).map(move |column| Cell { column, row }));
        let handles = cells.filter(|&cell| self.is_within_reach(cell)).filter_map(|cell| {
            self.world
                .things_in(cell)
                .iter()
                .find_map(|thing| match thing.kind {
                    ThingKind::Lever(switch) => Some(Handle::Lever(cell, switch)),
                    ThingKind::Flame => Some(Handle::Flame(cell)),
                    _ => None,
                })
                .map(|handle| (cell, handle))
        });
        let position = self.player.motion.position();
        let distance = |cell: Cell| cell.center().distance_squared(position);
        let nearest = handles.min_by(|one, other| distance(one.0).total_cmp(&distance(other.0)));
        nearest.map(|(_, handle)| handle)
    }

    /// Whether the player can reach the middle of `cell`.
    fn is_within_reach(&self, cell: Cell) -> bool {
        let motion = &self.player.motion;
        let position = motion.position();
        let way = cell.center() - position;
        let length = way.length();
        if length < NEAR {
            return true;
        }
        let is_ahead = way.dot(motion.heading().direction()) >= COSINE * length;
        is_ahead && to_cell(position, cell) <= REACH && self.is_clear(position, way)
    }

    /// Whether nothing solid is between `position` and `position + way`.
    fn is_clear(&self, position: DVec2, way: DVec2) -> bool {
        let Ok(ray) = Ray::new(position, way) else { return true };
        let solid = Walk::new(self.world.grid(), &ray).first_solid();
        solid.is_none_or(|solid| to_cell(position, solid.cell) >= way.length())
    }

    /// The secret wall that the player looks at, if it is still closed.
    fn secret_ahead(&self) -> Option<Handle> {
        let motion = &self.player.motion;
        let ray = Ray::new(motion.position(), motion.heading().direction()).ok()?;
        let cell = Walk::new(self.world.grid(), &ray).first_solid()?.cell;
        let index = self.mechanisms.moving_in(cell)?;
        let moving = &self.mechanisms.moving[index];
        let is_secret = moving.driver(&self.world) == Driver::Hand && !moving.is_driven;
        let is_near = to_cell(motion.position(), cell) <= REACH;
        (is_secret && is_near).then_some(Handle::Secret(index))
    }
}

/// The distance from a position to the square of `cell`.
fn to_cell(position: DVec2, cell: Cell) -> f64 {
    let middle = cell.center();
    position.distance(position.clamp(middle - 0.5, middle + 0.5))
}
