//! What visitors learn of rooms without being in them.

use std::fmt;
use std::sync::Arc;

use crate::rooms::room::{Mode, Phase};
use crate::sessions::line::Line;
use cellcaster::world::Difficulty;

/// The number of a room. It is not used again after the room is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct RoomId(pub(crate) u32);

impl RoomId {
    /// The room as a place where somebody is.
    pub(crate) fn place(self) -> String {
        format!("room {self}")
    }
}

impl fmt::Display for RoomId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A room, as lobbies show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RoomSummary {
    pub(crate) id: RoomId,
    /// The name of the level in the catalog.
    pub(crate) level: String,
    pub(crate) mode: Mode,
    pub(crate) difficulty: Difficulty,
    pub(crate) phase: Phase,
    /// The names of the members, in the order in which they joined.
    pub(crate) members: Arc<[Line]>,
    /// The number of those who watch.
    pub(crate) watchers: usize,
}

impl RoomSummary {
    /// Whether nobody else may join.
    pub(crate) fn is_full(&self) -> bool {
        self.members.len() >= self.mode.most()
    }
}

/// What room a visitor would like to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RoomWish {
    /// The name of the level in the catalog.
    pub(crate) level: String,
    pub(crate) mode: Mode,
    pub(crate) difficulty: Difficulty,
}
