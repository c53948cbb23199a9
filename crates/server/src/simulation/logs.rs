//! In-memory recordings of rooms, and their replay.

use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Mutex};

use crate::lock::locked;
use crate::rooms::directory::Recordings;
use crate::rooms::room::{Catalog, Entry, Header, Room, RoomView, parse_log};
use crate::rooms::sequencer::Recording;
use crate::rooms::summary::RoomId;

/// The recordings of all rooms of a host. Clones share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct RoomLogs(Arc<Mutex<BTreeMap<RoomId, String>>>);

impl RoomLogs {
    /// Recordings that store into these logs.
    pub(crate) fn recordings(&self) -> Recordings {
        let logs = self.clone();
        Recordings::new(move |room, _| Some(Box::new(RoomLog { room, logs: logs.clone() })))
    }

    /// The recording of a room.
    pub(crate) fn text(&self, room: RoomId) -> String {
        locked(&self.0, |logs| logs.get(&room).cloned()).unwrap_or_default()
    }

    /// The recorded rooms.
    pub(crate) fn rooms(&self) -> Vec<RoomId> {
        locked(&self.0, |logs| logs.keys().copied().collect())
    }
}

/// The recording of a room.
struct RoomLog {
    room: RoomId,
    logs: RoomLogs,
}

impl RoomLog {
    fn write(&self, text: &str) {
        locked(&self.logs.0, |logs| *logs.entry(self.room).or_default() += text);
    }
}

impl Recording for RoomLog {
    fn begin(&mut self, header: &Header) -> io::Result<()> {
        self.write(&header.to_string());
        Ok(())
    }

    fn append(&mut self, entry: &Entry) -> io::Result<()> {
        self.write(&format!("{entry}\n"));
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Replays a recording up to `step` of its last round. Asserts that each round begins with its recorded header.
pub(crate) fn replayed(text: &str, catalog: &Arc<Catalog>, step: u64) -> Room {
    let rounds = parse_log(text).expect("a recording");
    let mut room = Room::new(catalog, rounds[0].0.clone()).expect("a level");
    for (index, (header, entries)) in rounds.iter().enumerate() {
        assert_eq!(room.header(), header);
        let is_last = index + 1 == rounds.len();
        let mut entries = entries.iter().peekable();
        loop {
            if is_last && room.step() == step {
                break;
            }
            if !is_last && room.is_over() {
                room.begin_next();
                break;
            }
            while let Some(entry) = entries.next_if(|entry| entry.step <= room.step()) {
                room.apply(entry);
            }
            room.advance();
        }
        assert!(entries.peek().is_none(), "an entry is of a later step");
    }
    room
}

/// Asserts that two rooms are in the same state, bit for bit.
pub(crate) fn assert_same(room: &RoomView, again: &Room) {
    let other = again.view();
    assert_eq!((room.step, &room.header), (other.step, &other.header));
    assert_eq!(room.game.checksum(), other.game.checksum());
    assert!(room.game == other.game, "the games differ");
    assert_eq!((room.phase, &room.members), (other.phase, &other.members));
    assert_eq!((&room.standings, &room.said), (&other.standings, &other.said));
}
