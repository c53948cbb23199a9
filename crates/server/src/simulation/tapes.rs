//! Recordings of rooms in memory.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use crate::lock::locked;
use crate::rooms::directory::Logs;
use crate::rooms::room::{Queue, Recorded};
use crate::rooms::summary::RoomId;

/// The recordings of all rooms of a host. Clones share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tapes(Arc<Mutex<BTreeMap<RoomId, Vec<u8>>>>);

impl Tapes {
    /// Logs of rooms that are recorded here.
    pub(crate) fn logs(&self) -> Logs {
        let tapes = self.clone();
        Logs::new(move |room| {
            Box::new(Recorded::new(Queue::default(), Tape { room, tapes: tapes.clone() }))
        })
    }

    /// What was recorded of a room.
    pub(crate) fn text(&self, room: RoomId) -> String {
        let bytes = locked(&self.0, |tapes| tapes.get(&room).cloned()).unwrap_or_default();
        String::from_utf8(bytes).expect("a recording is text")
    }

    /// The rooms of which there is a recording.
    pub(crate) fn rooms(&self) -> Vec<RoomId> {
        locked(&self.0, |tapes| tapes.keys().copied().collect())
    }
}

/// The recording of a room.
struct Tape {
    room: RoomId,
    tapes: Tapes,
}

impl Write for Tape {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        locked(&self.tapes.0, |tapes| tapes.entry(self.room).or_default().extend(bytes));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
