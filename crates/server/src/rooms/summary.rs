//! Summaries of rooms, as lobbies show them.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::line::Line;
use crate::rooms::invitation::RoomCode;
use crate::rooms::room::{Mode, Phase, Room};
use cellcaster::world::Difficulty;

/// A room's number. It is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct RoomId(pub(crate) u32);

impl RoomId {
    /// The text that names the room as a visitor's location.
    pub(crate) fn place(self) -> String {
        format!("room {self}")
    }
}

impl fmt::Display for RoomId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A room as shown in lobbies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RoomSummary {
    pub(crate) id: RoomId,
    /// The name of the level in the catalog.
    pub(crate) level: String,
    pub(crate) mode: Mode,
    pub(crate) difficulty: Difficulty,
    pub(crate) phase: Phase,
    /// The names of the members, in the order of joining.
    pub(crate) members: Arc<[Line]>,
    /// The number of watchers, and of browsers that show the room live.
    pub(crate) watchers: usize,
    pub(crate) browsers: usize,
    /// The code of a private room, which no lobby lists; `None` if the room is open to everybody.
    pub(crate) code: Option<RoomCode>,
}

impl RoomSummary {
    /// The summary of a room without watchers, open to everybody.
    pub(crate) fn of(id: RoomId, room: &Room) -> Self {
        let header = room.header();
        Self {
            id,
            level: header.level.clone(),
            mode: header.mode,
            difficulty: header.difficulty,
            phase: room.phase(),
            members: room.names().cloned().collect(),
            watchers: 0,
            browsers: 0,
            code: None,
        }
    }

    /// Returns true if no further member may join.
    pub(crate) fn is_full(&self) -> bool {
        self.members.len() >= self.mode.most()
    }
}

/// A request to open a room.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomRequest {
    /// The name of the level in the catalog.
    pub level: String,
    pub mode: Mode,
    pub difficulty: Difficulty,
}

/// The reason why a visitor cannot enter or open a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
pub(crate) enum RoomRefusal {
    /// The room no longer exists.
    #[error("This room is closed.")]
    Gone,
    /// It is full.
    #[error("This room is full.")]
    Full,
    /// The room is for a single player.
    #[error("This room has a single player; you can watch.")]
    Alone,
    /// The host has reached its limit of rooms.
    #[error("This server allows no more rooms; enter an open one.")]
    TooMany,
    /// The host does not have the level's map.
    #[error("This host does not have the map of this room.")]
    NoLevel,
    /// The member is already in a room through another connection.
    #[error("You are already in a room through another connection.")]
    Taken,
    /// The hosts cannot agree at the moment.
    #[error("The room does not answer; try again.")]
    NotNow,
}
