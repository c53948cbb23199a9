//! The mission: what a level asks of the player, and who and what is there beside tiles and things.

use super::{Cell, GuardPost, MovingTile, ThingKind, World};

/// The parts of a level that only a game uses.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Mission {
    /// The time in which a good player finishes, in seconds.
    pub(crate) par: Option<u32>,
    /// The treasure without which exits do not let anybody out.
    pub(crate) treasure_needed: u32,
    /// The texts of notes.
    pub(crate) notes: Vec<String>,
    /// The names of switches.
    pub(crate) switches: Vec<String>,
    /// The tiles that move.
    pub(crate) moving_tiles: Vec<MovingTile>,
    /// The guards.
    pub(crate) guards: Vec<GuardPost>,
}

impl World {
    /// Whether there is anything but walls, doors, keys and exits: guards, mechanisms, hazards or
    /// finds. A level without them is only walked through.
    pub fn is_mission(&self) -> bool {
        let Mission { par, treasure_needed, moving_tiles, guards, switches, .. } = &self.mission;
        let is_plain =
            |kind| matches!(kind, ThingKind::Exit | ThingKind::Key(_) | ThingKind::Ornament);
        par.is_some()
            || *treasure_needed > 0
            || !moving_tiles.is_empty()
            || !guards.is_empty()
            || !switches.is_empty()
            || self.tiles.iter().any(|tile| tile.effect.is_some())
            || self.things().iter().any(|thing| !is_plain(thing.kind))
    }

    /// The guards of the map, in reading order.
    pub fn guards(&self) -> &[GuardPost] {
        &self.mission.guards
    }

    /// The world without its guards.
    #[must_use]
    pub fn without_guards(mut self) -> Self {
        self.mission.guards.clear();
        self
    }

    /// Whether the map has an exit.
    pub fn has_exit(&self) -> bool {
        self.things().iter().any(|thing| thing.kind == ThingKind::Exit)
    }

    /// The same world without exits.
    #[must_use]
    pub fn without_exits(mut self) -> Self {
        let exits: Vec<Cell> = self
            .things()
            .iter()
            .filter(|thing| thing.kind == ThingKind::Exit)
            .map(|thing| thing.cell)
            .collect();
        for cell in exits {
            self.take_things(cell, |kind| kind == ThingKind::Exit);
        }
        self
    }

    /// The time in which a good player finishes, in seconds, if the map gives one.
    pub fn par(&self) -> Option<u32> {
        self.mission.par
    }

    /// The treasure without which exits do not let anybody out; 0 if they always do.
    pub fn treasure_needed(&self) -> u32 {
        self.mission.treasure_needed
    }

    /// Sets the parts that only a game uses. Its guards are on open floor, in reading order.
    pub(crate) fn set_mission(&mut self, mission: Mission) {
        self.mission = mission;
    }
}
