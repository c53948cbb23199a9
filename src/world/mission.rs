//! The mission: the parts of a level that only a game uses, such as guards, switches and tiles that move.
//!
//! A moving tile has a list of states, which are tiles themselves. A game replaces the tile of a
//! cell by the next state, so drawing, collision and light need not know that it moves. Rejected: a
//! height for each cell. Every stage would read it in its innermost loop.
//!
//! A guard post is data of the map. The guard, who moves, is part of the game.

use serde::{Deserialize, Serialize};

use super::{Cell, Heading, ThingKind, TileId, World};

/// The parts of a level that only a game uses.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Mission {
    /// The time in which a good player finishes, in seconds.
    pub(crate) par: Option<u32>,
    /// The worth of the treasure that exits require.
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

/// A switch, as an index into the world's list of switch names. Levers and plates set it.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub struct SwitchId(pub u8);

/// A tile whose cells change their height.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingTile {
    /// The tiles that a cell shows in turn, from rest to the end; there are at least two. The map
    /// draws the first state, which belongs to no other moving tile.
    pub states: Vec<TileId>,
    /// The cause of its movement.
    pub driver: Driver,
}

/// A cause of a tile's movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// A switch: all cells of the tile move to the end while it is on, and back while it is off.
    Switch(SwitchId),
    /// A hand: a cell moves to the end, for good, after the player has opened it. It looks like a
    /// wall, and counts as a secret.
    Hand,
    /// A weight: a cell moves to the end, for good, some time after somebody has stepped on it.
    Weight,
}

/// The effect of a tile on anyone who stands on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileEffect {
    /// Cold water: it slows anyone who stands in it, splashes, puts out lamps, and hurts anyone who
    /// stays.
    Water,
    /// A plate: its switch is on while somebody stands on it.
    Plate(SwitchId),
}

/// A guard as the map draws it.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardPost {
    /// The kind of guard.
    pub kind: GuardKind,
    /// The cell in whose middle the guard begins.
    pub cell: Cell,
    /// The direction in which the guard looks at first.
    pub heading: Heading,
    /// The behaviour of the guard when undisturbed.
    pub duty: Duty,
    /// The easiest difficulty at which the guard is there.
    pub from: Difficulty,
}

/// A kind of guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum GuardKind {
    /// Slow and armoured; hits hard.
    Warden,
    /// Blind, with good hearing.
    Listener,
    /// Carries a lamp, and calls the others.
    Lantern,
    /// Fast; follows the player's trail.
    Hound,
    /// Shoots.
    Archer,
}

impl GuardKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Warden, Self::Listener, Self::Lantern, Self::Hound, Self::Archer];

    /// The name in maps, and of the built-in sprite.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Warden => "warden",
            Self::Listener => "listener",
            Self::Lantern => "lantern",
            Self::Hound => "hound",
            Self::Archer => "archer",
        }
    }

    /// The height of the top of the head, in cells. A guard fits into a gap of at least that
    /// height.
    pub const fn height(self) -> f64 {
        match self {
            Self::Warden => 0.9,
            Self::Listener => 0.85,
            Self::Lantern => 0.8,
            Self::Hound => 0.45,
            Self::Archer => 0.82,
        }
    }
}

/// The behaviour of a guard when undisturbed.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Duty {
    /// Stands at the post and looks around.
    #[default]
    Stand,
    /// Sleeps at the post, until a noise wakes them.
    Sleep,
    /// Walks from cell to cell, and from the last to the first again; there is at least one.
    Patrol(Vec<Cell>),
    /// Walks to cells at random, at most this many cells from the post.
    Wander(u8),
}

/// The difficulty of a game. Levels of difficulty differ in their rules, not only in numbers.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub enum Difficulty {
    /// A player without health goes back to the last checkpoint and keeps all possessions. Guards
    /// do not hear walking, and alert no other guards.
    Easy,
    /// A guard who sees the player calls the others.
    #[default]
    Normal,
    /// The same as [`Normal`](Difficulty::Normal), but without checkpoints. Guards who were alarmed
    /// stay wary to the end.
    Hard,
}

impl Difficulty {
    /// All difficulties, from the easiest.
    pub const ALL: [Self; 3] = [Self::Easy, Self::Normal, Self::Hard];

    /// The name in maps, in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Normal => "normal",
            Self::Hard => "hard",
        }
    }

    /// The difficulty with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|difficulty| difficulty.name() == name)
    }
}

impl World {
    /// Returns whether the level contains more than walls, doors, keys and exits: guards,
    /// mechanisms, hazards or items. A level without any of these is only walked through.
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

    /// Returns whether the map has an exit.
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

    /// The time in which a good player finishes, in seconds, if the map specifies it.
    pub fn par(&self) -> Option<u32> {
        self.mission.par
    }

    /// The worth of the treasure that exits require; 0 if they require none.
    pub fn treasure_needed(&self) -> u32 {
        self.mission.treasure_needed
    }

    /// Sets the parts that only a game uses. Its guards are on open floor, in reading order.
    pub(crate) fn set_mission(&mut self, mission: Mission) {
        self.mission = mission;
    }

    /// The tiles that move.
    pub fn moving_tiles(&self) -> &[MovingTile] {
        &self.mission.moving_tiles
    }

    /// The name of the switch `id`.
    ///
    /// # Panics
    /// If `id` comes from another world that has more switches.
    pub fn switch_name(&self, id: SwitchId) -> &str {
        &self.mission.switches[usize::from(id.0)]
    }

    /// The number of switches. Their ids are the numbers below it.
    pub fn switch_count(&self) -> usize {
        self.mission.switches.len()
    }

    /// The effect of the tile of `cell` on anyone who stands there.
    pub fn effect_in(&self, cell: Cell) -> Option<TileEffect> {
        self.tile_in(cell)?.effect
    }
}
