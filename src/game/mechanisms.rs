//! Mechanisms: switches, and the tiles and doors that they drive.
//!
//! A switch is on while its levers are turned on or somebody stands on one of its plates. Its tiles
//! move to their ends while it is on and back while it is off, a cell a second, and its doors open
//! and close with it.
//!
//! Nothing that moves crushes anybody: a floor lifts those who stand on it and stops where they have
//! no room, and a wall does not rise while somebody touches its cell.

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
use crate::world::{
    Cell, Driver, MovingTile, SwitchId, ThingKind, TileEffect, TileId, TileKind, World,
};
use moving_cell::{MovingCell, Step};

/// The state of all mechanisms of a level.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Mechanisms {
    /// For each switch.
    switches: Vec<Switch>,
    plates: Vec<Plate>,
    /// The cells of moving tiles, row by row.
    moving: Vec<MovingCell>,
    /// The doors that switches open.
    doors: Vec<(Cell, SwitchId)>,
    /// Whether there are levers, flames or secret walls.
    has_handles: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Switch {
    /// Whether its levers are turned on.
    is_turned: bool,
    /// Whether its doors and tiles have been told that it is on.
    is_on: bool,
}

stored! { part of Switch { is_turned, is_on } level {} }

#[derive(Clone, Copy, Debug, PartialEq)]
struct Plate {
    cell: Cell,
    switch: SwitchId,
    is_down: bool,
}

stored! { part of Plate { is_down } level { cell, switch } }

impl Mechanisms {
    /// The mechanisms of `world`, at rest.
    pub(super) fn new(world: &World) -> Self {
        let tiles = world.grid().rows().zip(0..).flat_map(|(line, row)| {
            let columns = line.iter().zip(0..);
            columns.map(move |(&tile, column)| (Cell { column, row }, tile))
        });
        let mut new = Self {
            switches: vec![Switch::default(); world.switch_count()],
            has_handles: world
                .things()
                .iter()
                .any(|thing| matches!(thing.kind, ThingKind::Lever(_) | ThingKind::Flame)),
            ..Self::default()
        };
        for (cell, tile) in tiles {
            let is_it = |moving: &MovingTile| moving.states.first() == Some(&tile);
            if let Some(index) = world.moving_tiles().iter().position(is_it) {
                new.moving.push(MovingCell::new(cell, index));
                new.has_handles |= world.moving_tiles()[index].driver == Driver::Hand;
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

    /// Whether there is anything to open beside doors.
    pub(super) fn has_handles(&self) -> bool {
        self.has_handles
    }

    /// Whether the levers of `switch` are turned on.
    pub(super) fn is_turned(&self, switch: SwitchId) -> bool {
        self.switches.get(usize::from(switch.0)).is_some_and(|switch| switch.is_turned)
    }

    /// Turns the levers of `switch`, and returns whether they are on now.
    pub(super) fn turn(&mut self, switch: SwitchId) -> bool {
        let Some(state) = self.switches.get_mut(usize::from(switch.0)) else { return false };
        state.is_turned = !state.is_turned;
        state.is_turned
    }

    /// The secret walls, and those of them that have been found.
    pub(super) fn secrets(&self, world: &World) -> Share {
        let secrets = self.moving.iter().filter(|cell| cell.driver(world) == Driver::Hand);
        let found = secrets.clone().filter(|cell| cell.is_driven()).count() as u32;
        Share { found, total: secrets.count() as u32 }
    }

    /// The position of each plate, the position of each moving cell, and the state of each switch,
    /// as numbers.
    pub(super) fn words(&self) -> impl Iterator<Item = u64> {
        let switches =
            self.switches.iter().map(|it| u64::from(it.is_turned) << 1 | u64::from(it.is_on));
        let plates = self.plates.iter().map(|plate| u64::from(plate.is_down));
        switches.chain(plates).chain(self.moving.iter().map(MovingCell::word))
    }

    fn is_on(&self, switch: SwitchId) -> bool {
        let is_down = |plate: &Plate| plate.switch == switch && plate.is_down;
        self.is_turned(switch) || self.plates.iter().any(is_down)
    }

    fn switches(&self) -> impl Iterator<Item = SwitchId> + use<> {
        (0..self.switches.len()).map(|index| SwitchId(index as u8))
    }
}

impl Game {
    /// Moves what is driven by switches, hands and weights.
    pub(super) fn move_mechanisms(&mut self) {
        self.press_plates();
        self.throw_switches();
        self.move_tiles();
    }

    /// Whether a step would change any mechanism but a door.
    pub(super) fn mechanisms_move(&self) -> bool {
        let Mechanisms { plates, moving, .. } = &self.mechanisms;
        plates.iter().any(|plate| plate.is_down != self.weighs_on(plate.cell))
            || self.mechanisms.switches().any(|switch| {
                self.mechanisms.is_on(switch)
                    != self.mechanisms.switches[usize::from(switch.0)].is_on
            })
            || moving.iter().any(|&cell| self.would_move(cell))
    }

    /// Whether somebody stands in `cell`.
    fn weighs_on(&self, cell: Cell) -> bool {
        let stands =
            |motion: &Motion| motion.cell() == cell && motion.feet() <= self.world.floor_at(cell);
        self.playing().any(|(_, player)| stands(&player.motion)) || self.guards.weighs_on(cell)
    }

    /// Whether somebody would be in a wall in `cell`.
    pub(super) fn is_in_the_way(&self, cell: Cell) -> bool {
        self.playing().any(|(_, it)| it.motion.touches(cell)) || self.guards.touches(cell)
    }

    fn press_plates(&mut self) {
        for index in 0..self.mechanisms.plates.len() {
            let Plate { cell, is_down, .. } = self.mechanisms.plates[index];
            let is_pressed = self.weighs_on(cell);
            if is_pressed != is_down {
                self.mechanisms.plates[index].is_down = is_pressed;
                self.sound_in(cell, SoundKind::Mechanism, reach::CLICK);
            }
        }
    }

    /// Lets doors and tiles follow the switches that have changed.
    fn throw_switches(&mut self) {
        for switch in self.mechanisms.switches() {
            let is_on = self.mechanisms.is_on(switch);
            let known = &mut self.mechanisms.switches[usize::from(switch.0)].is_on;
            if *known == is_on {
                continue;
            }
            *known = is_on;
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
                let first = self.mechanisms.moving.iter().find(|it| it.tile() == index);
                if let Some(cell) = first.filter(|_| is_driven).map(MovingCell::cell) {
                    self.sound_in(cell, SoundKind::Mechanism, reach::MECHANISM);
                }
            }
        }
    }

    fn move_tiles(&mut self) {
        let revision = self.revision;
        for index in 0..self.mechanisms.moving.len() {
            let cell = self.mechanisms.moving[index];
            if let Some(step) = self.next_step(cell) {
                self.mechanisms.moving[index] = self.moved(cell, step);
            }
        }
        if self.revision != revision {
            // What has moved may have made room.
            self.mechanisms.moving.iter_mut().for_each(MovingCell::try_again);
        }
    }

    /// The next step of a moving cell, if nothing keeps it from moving.
    fn next_step(&self, cell: MovingCell) -> Option<Step> {
        let is_driven = match cell.driver(&self.world) {
            Driver::Switch(switch) => self.mechanisms.is_on(switch),
            Driver::Hand => cell.is_driven(),
            Driver::Weight => cell.is_driven() || self.weighs_on(cell.cell()),
        };
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
        self.world.set_state(cell.cell(), state);
        if self.is_crushing(cell, state) {
            self.world.set_state(cell.cell(), before);
            self.tell_who_blocks(cell);
            return cell.blocked();
        }
        self.revision += 1;
        self.hear_crumbling(cell, step);
        let falls = cell.driver(&self.world) == Driver::Weight;
        self.guards.floor_moved(&self.world, cell.cell(), !falls);
        let Self { player, members, world, .. } = self;
        for (index, player) in playing_mut(player, members.as_deref_mut()) {
            if let Some(feet) = player.motion.feet_after(world, stood[index] && !falls) {
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

    /// Whether somebody has no room in the world, in which `cell` has just become `state`.
    fn is_crushing(&self, cell: MovingCell, state: TileId) -> bool {
        let world = &self.world;
        let tile = world.tile(state);
        let rises = tile.heights.floor() > world.tile(cell.shown(world)).heights.floor();
        if rises && matches!(tile.kind, TileKind::Wall(_)) {
            return self.is_in_the_way(cell.cell());
        }
        let headroom = tile.gaps().next().map_or(0.0, crate::world::Gap::height);
        let crushes_guards = rises && headroom < 1.0 && self.guards.touches(cell.cell());
        let crushes = |motion: &Motion| {
            motion.touches(cell.cell())
                && !(motion.has_room(world) || motion.lifted(world).is_some())
        };
        crushes_guards || self.playing().any(|(_, player)| crushes(&player.motion))
    }
}
