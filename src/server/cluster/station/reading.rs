//! The log, as a station reads and applies it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use tokio::time::Instant;

use super::{SECOND, Station, is_due};
use crate::server::cluster::bus::BusFault;
use crate::server::cluster::message::Message;
use crate::server::cluster::replica::Position;
use crate::server::cluster::talk::Talk;
use crate::server::logging::events;
use crate::server::sequencer::{FAULT, message as panic_message};

impl Station {
    /// Takes a message of the log, and those that it lets in are told. Returns whether the ones before it
    /// were there.
    pub(super) async fn take(&mut self, number: u64, message: &Message) -> bool {
        match self.replica.position(number, message) {
            Position::Known => return true,
            Position::Later => return false,
            Position::Next => {
                if message.check.is_some() && self.office.is_none() {
                    self.company.load.metrics().checks_equal.count();
                }
            }
            Position::Differs => {
                let (room, tick) = (self.id, message.tick);
                tracing::error!(%room, tick, "this host's state of a room differs: it is a bug");
                self.company.load.metrics().checks_different.count();
                _ = self.restore().await;
                return false;
            }
        }
        let caught = catch_unwind(AssertUnwindSafe(|| self.apply(number, message)));
        if let Err(panic) = caught {
            events::room_failed(self.id.0, panic_message(&*panic));
            self.doorway.close(FAULT);
            return true;
        }
        self.times.moved = Instant::now();
        let office = self.office.take_if(|office| office.epoch() >= message.epoch);
        let Some(mut office) = office else {
            // Another host has the room now.
            self.office = None;
            return true;
        };
        let answers = office.note(message, &self.replica, self.times.moved);
        self.office = Some(office);
        for answer in answers {
            self.answer(&answer);
            self.say(&answer).await;
        }
        true
    }

    fn apply(&mut self, number: u64, message: &Message) {
        let Self { replica, doorway, .. } = self;
        let changes = doorway.shown.replace(|| {
            let changes = replica.apply(number, message);
            (replica.room().view(), changes)
        });
        self.company.load.metrics().entries.add(changes.entries);
        if let Some(run) = changes.finished {
            self.doorway.inbox.finish(run);
        }
        self.is_changed |= changes.summary;
    }

    /// Reads the log to its end.
    pub(super) async fn read(&mut self) -> Result<(), BusFault> {
        self.times.read = Some(Instant::now());
        loop {
            let next = self.company.bus.read(self.id, self.replica.number()).await?;
            let Some((number, bytes)) = next else { return Ok(()) };
            let Ok(message) = Message::parse(&bytes) else {
                tracing::error!(room = %self.id, number, "a message of a room cannot be read");
                self.doorway.close("A host of another version has this room now.");
                return Err(BusFault::Unknown);
            };
            if !self.take(number, &message).await {
                // The messages before it were dropped, since a checkpoint has what they did.
                self.restore().await?;
            }
        }
    }

    /// Takes the newest checkpoint in place of the replica.
    async fn restore(&mut self) -> Result<(), BusFault> {
        let now = Instant::now();
        if !is_due(self.times.restored, now, SECOND) {
            return Err(BusFault::Unknown);
        }
        self.times.restored = Some(now);
        let loaded = self.company.load_replica(self.id).await;
        let (replica, _) = loaded.map_err(|_| BusFault::Unknown)?;
        self.doorway.shown.replace(|| (replica.room().view(), ()));
        self.replica = replica;
        // Its lease may be over since long.
        self.office.take_if(|office| office.epoch() < self.replica.epoch());
        self.is_changed = true;
        Ok(())
    }

    /// Tells the others of a message that this host has appended.
    pub(super) async fn announce(&mut self, number: u64, message: Message) {
        self.say(&Talk::News(number, message)).await;
    }
}
