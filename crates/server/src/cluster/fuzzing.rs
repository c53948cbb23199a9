//! A room of a cluster on one host without a bus, for a fuzz target.

use std::sync::{Arc, LazyLock};
use std::time::Duration;

use tokio::time::Instant;

use super::message::{LogMessage, PeerMessage, Record, reader, to_bytes, version};
use super::room_state::{Position, RoomState};
use super::sequencer::ClusterSequencer;
use crate::accounts::HostStore;
use crate::rooms::room::{Catalog, Entry, Header, Mode};
use cellcaster::world::Difficulty;

/// Read once, because that takes longer than most inputs.
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::builtin()));

/// The duration of a lease.
const LEASE: Duration = Duration::from_secs(5);

/// A room on a host that may become its sequencer.
pub struct SharedRoom {
    state: RoomState,
    sequencer: Option<ClusterSequencer>,
    record: Record,
    leases: HostStore,
    now: Instant,
}

impl SharedRoom {
    /// A new room in the smallest level.
    ///
    /// # Panics
    /// If the catalog has no such level.
    pub fn new(seed: u64) -> Self {
        let mode = Mode::ALL[seed as usize % Mode::ALL.len()];
        let header = Header::new("cellar", mode, Difficulty::Normal, seed);
        Self::of(Record::new(header, false, None)).expect("the level is built in")
    }

    /// The room of a record; `None` if the bytes are not a record, or if its level is unknown.
    pub fn of_record(bytes: &[u8]) -> Option<Self> {
        Self::of(Record::parse(&versioned(bytes)).ok()?)
    }

    fn of(record: Record) -> Option<Self> {
        let state = RoomState::new(&CATALOG, record.header.clone())?;
        Some(Self::with(state, record))
    }

    fn with(state: RoomState, record: Record) -> Self {
        let (leases, now) = (HostStore::in_memory(), Instant::now());
        Self { state, sequencer: None, record, leases, now }
    }

    /// Restores the room from its own checkpoint, with another head.
    ///
    /// # Errors
    /// If the checkpoint is invalid.
    ///
    /// # Panics
    /// If a checkpoint of the restored room is invalid.
    pub fn restored(self, head: &[u8]) -> Result<Self, String> {
        let bytes = self.state.checkpoint();
        let mut input = reader(&bytes).expect("it has the versions");
        let _numbers: (u64, u64, u64) = input.read().expect("it has a head");
        let state = RoomState::restore(&CATALOG, &[&versioned(head), input.rest()].concat())?;
        let again = RoomState::restore(&CATALOG, &state.checkpoint());
        assert!(again.is_ok(), "a checkpoint of a restored room");
        Ok(Self::with(state, self.record))
    }

    /// Reads a message of the log, without the versions.
    ///
    /// # Panics
    /// If the message does not read as it was written.
    pub fn read(&mut self, bytes: &[u8]) {
        let Ok(message) = LogMessage::parse(&versioned(bytes)) else { return };
        assert_eq!(LogMessage::parse(&to_bytes(&message)).as_ref(), Ok(&message));
        self.apply(self.state.number + 1, &message);
    }

    /// Applies a message of another sequencer with these entries, and with the numbers that the
    /// room expects.
    pub fn follow(&mut self, steps: u64, entries: &str) {
        let message = LogMessage {
            epoch: self.state.epoch,
            last: self.state.number,
            tick: self.state.tick,
            steps,
            check: None,
            entries: entries.lines().filter_map(Entry::parse).collect(),
        };
        if LogMessage::parse(&to_bytes(&message)).as_ref() == Ok(&message) {
            self.apply(self.state.number + 1, &message);
        }
    }

    /// Receives a broadcast, without the versions.
    ///
    /// # Panics
    /// If the message does not read as it was written.
    pub fn hear(&mut self, bytes: &[u8]) {
        let Ok(message) = PeerMessage::parse(&versioned(bytes)) else { return };
        assert_eq!(PeerMessage::parse(&to_bytes(&message)).as_ref(), Ok(&message));
        let now = self.now;
        let sequencer = self.sequencer.as_mut();
        match message {
            PeerMessage::Appended(number, message) => self.apply(number, &message),
            PeerMessage::Commands(commands) => {
                if let Some(sequencer) = sequencer {
                    for (member, command) in commands {
                        sequencer.command(member, command, now);
                    }
                }
            }
            PeerMessage::Claim(members) => {
                sequencer.map(|it| it.claim(&members, now));
            }
            PeerMessage::Request(token, requested) => {
                sequencer.map(|it| it.request(token, &requested, now));
            }
            PeerMessage::Joined(..) | PeerMessage::Refused(..) | PeerMessage::Released => {}
        }
    }

    /// Makes the host write a message of that many steps, as the sequencer.
    ///
    /// # Panics
    /// If the message does not read as it was written.
    pub fn lead(&mut self, steps: u64) {
        self.now += Duration::from_millis(500);
        if self.sequencer.is_none() {
            self.leases.pass(LEASE);
            let lease = self.leases.acquire("room", "host", LEASE, self.state.epoch);
            let lease = lease.expect("it is in memory").expect("the last one is over");
            self.sequencer = Some(ClusterSequencer::new(lease, &self.state));
        }
        let Some(sequencer) = &mut self.sequencer else { return };
        sequencer.set_unclaimed_away(self.now);
        let message = sequencer.next(&self.state, steps);
        assert_eq!(LogMessage::parse(&to_bytes(&message)).as_ref(), Ok(&message));
        let number = self.state.number + 1;
        self.state.apply(Some(number), &message);
        for answer in sequencer.note(&message, &self.state, self.now) {
            assert_eq!(PeerMessage::parse(&to_bytes(&answer)), Ok(answer));
        }
    }

    /// Updates the record of the room, which must read as it is written.
    ///
    /// # Panics
    /// If it does not.
    #[must_use]
    pub fn put(self) -> Self {
        let record = self.record.next(&self.state.room, self.sequencer.is_some());
        assert_eq!(Record::parse(&to_bytes(&record)).as_ref(), Ok(&record));
        Self { record, ..self }
    }

    fn apply(&mut self, number: u64, message: &LogMessage) {
        if self.state.position(number, message) == Position::Next {
            if self.sequencer.as_ref().is_some_and(|own| own.epoch() < message.epoch) {
                self.sequencer = None;
            }
            self.state.apply(Some(number), message);
        }
    }
}

/// `bytes` after the versions with which all messages begin.
fn versioned(bytes: &[u8]) -> Vec<u8> {
    [version().as_bytes(), b"\n", bytes].concat()
}
