//! Mechanisms: switches, and the tiles and doors that they drive.
//!
//! A switch is on while its levers are turned on or somebody stands on one of its plates. Its tiles
//! move to their ends while it is on and back while it is off, a cell a second, and its doors open
//! and close with it.
//!
//! Nothing that moves crushes anybody: a floor lifts those who stand on it and stops where they have
//! no room, and a wall does not rise while somebody touches its cell.
//!
//! A step looks only at the plates that are down, at the cells that somebody stands in, and at the
//! cells that move. Which these are is kept from step to step. A map may have a million others.

mod handles;
mod moving_cell;
mod stored;

use super::Game;
use super::multiplayer::{MOST_PLAYERS, playing_mut};
use super::noise::reach;
use super::player::Motion;
use super::sound::SoundKind;
use super::tally::Share;
use crate::game::stored::stored;
use crate::sort;
use crate::world::{
    Cell, Driver, MovingTile, SwitchId, ThingKind, TileEffect, TileId, TileKind, World,
};
use moving_cell::{MovingCell, Step};

/// The state of all mechanisms of a level.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Mechanisms {
    /// For each switch.
    switches: Vec<Switch>,
    /// All plates, row by row.
    plates: Vec<Plate>,
    /// The plates that are down, from the lowest index to the highest.
    down: Vec<usize>,
    /// The cells of moving tiles, row by row.
    moving: Vec<MovingCell>,
    /// Those of them that do not rest, from the lowest index to the highest.
    active: Vec<usize>,
    /// For each moving tile, its first cell.
    first_cells: Vec<Option<Cell>>,
    /// The doors that switches open.
    doors: Vec<(Cell, SwitchId)>,
    /// Whether there are levers, flames or secret walls.
    has_handles: bool,
    /// Whether there are floors that crumble.
    has_crumbling: bool,
    secrets: Share,
}

#[derive(Clone, Debug, PartialEq, Default)]
struct Switch {
    /// Whether its levers are turned on.
    is_turned: bool,
    /// Whether its doors and tiles have been told that it is on.
    is_on: bool,
    /// The number of its plates that are down.
    plates_down: u32,
    /// The moving cells that it drives, by their indices.
    cells: Vec<usize>,
}

stored! { part of Switch { is_turned, is_on } level { plates_down, cells } }

#[derive(Clone, Copy, Debug, PartialEq)]
struct Plate {
    cell: Cell,
    switch: SwitchId,
    is_down: bool,
}

stored! { part of Plate { is_down } level { cell, switch } }

impl Mechanisms {
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

    /// Finds out anew what is kept from step to step: which plates are down, which cells do not rest,
    /// and which secrets have been found.
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
        self.secrets.found = secrets.filter(|cell| cell.is_driven()).count() as u32;
    }

    /// Whether there is anything to open beside doors.
    pub(crate) fn has_handles(&self) -> bool {
        self.has_handles
    }

    /// Turns the levers of `switch`, and returns whether they are on now.
    pub(crate) fn turn(&mut self, switch: SwitchId) -> bool {
        let Some(state) = self.switches.get_mut(usize::from(switch.0)) else { return false };
        state.is_turned = !state.is_turned;
        state.is_turned
    }

    /// The secret walls, and those of them that have been found.
    pub(crate) fn secrets(&self) -> Share {
        self.secrets
    }

    /// Opens the secret wall that is the moving cell with that index.
    fn open_secret(&mut self, index: usize) {
        self.secrets.found += u32::from(!self.moving[index].is_driven());
        self.moving[index].drive();
        if let Err(place) = self.active.binary_search(&index) {
            self.active.insert(place, index);
        }
    }

    /// The index of the moving cell in `cell`.
    fn moving_in(&self, cell: Cell) -> Option<usize> {
        self.moving.binary_search_by_key(&by_row(cell), |moving| by_row(moving.cell())).ok()
    }

    /// The index of the plate in `cell`.
    fn plate_in(&self, cell: Cell) -> Option<usize> {
        self.plates.binary_search_by_key(&by_row(cell), |plate| by_row(plate.cell)).ok()
    }

    /// Whether a moving cell does not rest, if nobody steps on it.
    fn is_in_motion(&self, index: usize, world: &World) -> bool {
        let cell = self.moving[index];
        cell.step(world, self.is_driven(cell, world)).is_some()
    }

    /// Whether a switch, a hand or a weight drives a moving cell.
    fn is_driven(&self, cell: MovingCell, world: &World) -> bool {
        match cell.driver(world) {
            Driver::Switch(switch) => self.switches[usize::from(switch.0)].is_on,
            Driver::Hand | Driver::Weight => cell.is_driven(),
        }
    }

    /// The position of each plate, the position of each moving cell, and the state of each switch,
    /// as numbers.
    pub(crate) fn words(&self) -> impl Iterator<Item = u64> {
        let switches =
            self.switches.iter().map(|it| u64::from(it.is_turned) << 1 | u64::from(it.is_on));
        let plates = self.plates.iter().map(|plate| u64::from(plate.is_down));
        switches.chain(plates).chain(self.moving.iter().map(MovingCell::word))
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
    /// Moves what is driven by switches, hands and weights.
    pub(crate) fn move_mechanisms(&mut self) {
        let bodies = self.cells_of_all().count();
        *self.work += (bodies + self.mechanisms.down.len()) as u64;
        self.press_plates();
        self.throw_switches();
        self.move_tiles();
    }

    /// Whether a step would change any mechanism but a door.
    pub(crate) fn mechanisms_move(&self) -> bool {
        self.changing_plates().next().is_some()
            || self.mechanisms.switches().any(|switch| {
                self.mechanisms.is_on(switch)
                    != self.mechanisms.switches[usize::from(switch.0)].is_on
            })
            || self.movable_cells().any(|index| self.would_move(self.mechanisms.moving[index]))
    }

    /// The cells of the players who play and of all guards.
    fn cells_of_all(&self) -> impl Iterator<Item = Cell> {
        let players = self.playing().map(|(_, player)| player.motion.cell());
        players.chain(self.guards.cells())
    }

    /// The indices of the plates that go down or up in this step, in no order, some more than once.
    fn changing_plates(&self) -> impl Iterator<Item = usize> {
        let Mechanisms { plates, down, .. } = &self.mechanisms;
        let leaves = |index: &usize| !self.weighs_on(plates[*index].cell);
        let goes_down =
            |index: &usize| !plates[*index].is_down && self.weighs_on(plates[*index].cell);
        let cells = self.cells_of_all().take_while(|_| !plates.is_empty());
        let underfoot = cells.filter_map(|cell| self.mechanisms.plate_in(cell));
        down.iter().copied().filter(leaves).chain(underfoot.filter(goes_down))
    }

    /// The indices of the moving cells that do not rest or that may crumble under somebody, in no
    /// order, some more than once.
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

    /// Whether somebody would be in a wall in `cell`.
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

    /// Lets doors and tiles follow the switches that have changed.
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
            // What has moved may have made room.
            for &index in &movable {
                mechanisms.moving[index].try_again();
            }
        }
        movable.retain(|&index| mechanisms.is_in_motion(index, world));
        mechanisms.active = movable;
    }

    /// The next step of a moving cell, if nothing keeps it from moving.
    fn next_step(&self, cell: MovingCell) -> Option<Step> {
        let is_stepped_on =
            || cell.driver(&self.world) == Driver::Weight && self.weighs_on(cell.cell());
        let is_driven = self.mechanisms.is_driven(cell, &self.world) || is_stepped_on();
        cell.step(&self.world, is_driven)
    }

    /// Whether a step would change a moving cell, where nobody has moved since the last one.
    fn would_move(&self, cell: MovingCell) -> bool {
        self.next_step(cell).is_some_and(|step| step.state.is_none() || !cell.is_blocked())
    }

    /// The cell after `step`, with all who stand on it; the cell as it was, but blocked, if somebody
    /// is in the way.
    fn moved(&mut self, cell: MovingCell, step: Step) -> MovingCell {
        let Some(state) = step.state else { return step.after };
        let before = cell.shown(&self.world);
        let mut stood = [false; MOST_PLAYERS];
        for (index, player) in self.playing() {
            stood[index] = player.motion.stands(&self.world);
        }
        self.world.set_tile(cell.cell(), state);
        let carries = cell.driver(&self.world) != Driver::Weight;
        if self.is_crushing(cell, state, carries) {
            self.world.set_tile(cell.cell(), before);
            self.tell_who_blocks(cell);
            return cell.blocked();
        }
        self.revision += 1;
        self.hear_crumbling(cell, step);
        self.guards.floor_moved(&self.world, cell.cell(), carries);
        let Self { player, members, world, .. } = self;
        for (index, player) in playing_mut(player, members.as_deref_mut()) {
            if let Some(feet) = player.motion.feet_after(world, stood[index] && carries) {
                player.motion = player.motion.carried_to(feet);
                player.fell_from = feet;
            }
        }
        step.after
    }

    /// Says that a cell stops, once, to a player who is in the way.
    fn tell_who_blocks(&mut self, cell: MovingCell) {
        if !cell.is_blocked() {
            self.for_each_player(|game| {
                if game.player.motion.touches(cell.cell()) {
                    game.say("It stops: you are in the way.".to_owned());
                }
            });
        }
    }

    /// A floor that crumbles cracks, and then breaks.
    fn hear_crumbling(&mut self, cell: MovingCell, step: Step) {
        if cell.driver(&self.world) == Driver::Weight {
            if !cell.is_driven() {
                self.sound_in(cell.cell(), SoundKind::Mechanism, reach::CLICK);
            } else if step.after.is_at_the_end(&self.world) {
                self.sound_in(cell.cell(), SoundKind::Crash, reach::CRASH);
            }
        }
    }

    /// Whether somebody has no room in the world, in which `cell` has just become `state` and `carries` those
    /// who stand on it.
    fn is_crushing(&self, cell: MovingCell, state: TileId, carries: bool) -> bool {
        let world = &self.world;
        let tile = world.tile(state);
        let rises = tile.heights.floor() > world.tile(cell.shown(world)).heights.floor();
        if rises && matches!(tile.kind, TileKind::Wall(_)) {
            return self.is_in_the_way(cell.cell());
        }
        let crushes = |motion: &Motion| {
            motion.touches(cell.cell())
                && !(motion.has_room(world) || motion.lifted(world).is_some())
        };
        self.playing().any(|(_, player)| crushes(&player.motion))
            || self.guards.are_crushed(world, cell.cell(), carries)
    }
}

/// Row by row from the north, and within a row from the west.
fn by_row(cell: Cell) -> (u32, u32) {
    (cell.row, cell.column)
}

/// Each of `indices` once, from the lowest to the highest.
fn in_order(indices: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut indices: Vec<usize> = indices.collect();
    sort::by_key(&mut indices, |&index| index);
    indices.dedup();
    indices
}
