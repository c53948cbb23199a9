//! The figures of each room that a host of a cluster runs.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use super::{Counter, Gauge};
use crate::lock::locked;

/// The rooms that this host runs, by their numbers.
#[derive(Debug, Default)]
pub struct EachRoom(Mutex<BTreeMap<u32, Arc<RoomFigures>>>);

/// The figures of a room.
#[derive(Debug, Default)]
pub struct RoomFigures {
    /// Members on all hosts.
    pub members: Gauge,
    /// Visitors on this host who watch it.
    pub watchers: Gauge,
    /// Steps that the room has taken on this host.
    pub steps: Counter,
    /// Entries of its log.
    pub entries: Counter,
    /// 1 while this host writes the log, otherwise 0.
    pub writes: Gauge,
    /// Checksums that were the same on another host.
    pub checks_equal: Counter,
    /// Checksums that differed from those of another host, which is a bug.
    pub checks_different: Counter,
}

impl EachRoom {
    /// Adds a room, whose figures begin anew.
    pub(crate) fn add(&self, room: u32) -> Arc<RoomFigures> {
        let figures = Arc::<RoomFigures>::default();
        locked(&self.0, |rooms| _ = rooms.insert(room, Arc::clone(&figures)));
        figures
    }

    /// Removes a room that was added with these figures.
    pub(crate) fn remove(&self, room: u32, figures: &Arc<RoomFigures>) {
        locked(&self.0, |rooms| {
            if rooms.get(&room).is_some_and(|own| Arc::ptr_eq(own, figures)) {
                rooms.remove(&room);
            }
        });
    }

    /// The rooms whose logs this host writes.
    pub(crate) fn written(&self) -> Vec<u32> {
        self.all().iter().filter(|(_, it)| it.writes.get() > 0).map(|(room, _)| *room).collect()
    }

    /// All rooms.
    pub(crate) fn all(&self) -> Vec<(u32, Arc<RoomFigures>)> {
        locked(&self.0, |rooms| rooms.iter().map(|(id, it)| (*id, Arc::clone(it))).collect())
    }
}
