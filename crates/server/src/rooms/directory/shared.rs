//! Rooms that this host shares with others: lobbies see them among its own.

use super::{RoomLimits, Rooms};
use crate::lock::locked;
use crate::rooms::summary::RoomSummary;

impl Rooms {
    /// What the host allows.
    pub(crate) fn limits(&self) -> RoomLimits {
        locked(&self.0.limits, |limits| limits.clone())
    }

    /// Shows lobbies the rooms that this host shares with others, too.
    pub(crate) fn show_shared(&self, rooms: Vec<RoomSummary>) {
        locked(&self.0.shared, |shared| *shared = rooms);
        self.publish();
    }
}
