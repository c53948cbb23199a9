//! The log, as a replica reads and applies it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use tokio::time::Instant;

use super::Replica;
use super::times::{SECOND, is_due};
use crate::cluster::bus::BusFault;
use crate::cluster::log_message::LogMessage;
use crate::cluster::peer_message::PeerMessage;
use crate::cluster::room_state::Position;
use crate::ops::logging::events;
use crate::rooms::sequencer::{FAULT, message as panic_message};

impl Replica {
    /// Takes a message of the log, and those that it lets in are told. Returns whether the ones before it
    /// were there.
    pub(crate) async fn take(&mut self, number: u64, message: &LogMessage) -> bool {
        if self.is_ahead_of(message) {
            return true;
        }
        if self.is_diverged {
            return false;
        }
        match self.state.position(number, message) {
            Position::Known => return true,
            Position::Later => return false,
            Position::Next => {
                if message.check.is_some() && self.sequencer.is_none() {
                    self.context.load.metrics().checks(true).inc();
                    self.figures.checks(true).inc();
                }
            }
            Position::Differs => {
                let (room, tick) = (self.id, message.tick);
                tracing::error!(%room, tick, "this host's state of a room differs: it is a bug");
                self.context.load.metrics().checks(false).inc();
                self.figures.checks(false).inc();
                _ = self.restore().await;
                return false;
            }
        }
        self.apply(Some(number), message);
        self.times.moved = Instant::now();
        let sequencer = self.sequencer.take_if(|sequencer| sequencer.epoch() >= message.epoch);
        let Some(mut sequencer) = sequencer else {
            // Another host has the room now.
            self.sequencer = None;
            return true;
        };
        let answers = sequencer.note(message, &self.state, self.times.moved);
        self.sequencer = Some(sequencer);
        self.send_answers(answers).await;
        true
    }

    /// Applies a message, and shows the room after it. A fault ends the room on this host.
    pub(crate) fn apply(&mut self, number: Option<u64>, message: &LogMessage) {
        let Self { state, interface, .. } = self;
        let apply = || {
            interface.shown.replace(|| {
                let changes = state.apply(number, message);
                (state.room().view(), changes)
            })
        };
        let changes = match catch_unwind(AssertUnwindSafe(apply)) {
            Ok(changes) => changes,
            Err(panic) => {
                events::room_failed(self.id.0, panic_message(&*panic));
                return self.interface.close(FAULT);
            }
        };
        self.context.load.metrics().entries.inc_by(changes.entries);
        self.figures.entries.inc_by(changes.entries);
        self.figures.steps.inc_by(message.steps);
        if let Some(run) = changes.finished {
            self.interface.inbox.finish(run);
        }
        self.is_changed |= changes.summary;
    }

    /// Reads the log to its end.
    pub(crate) async fn read(&mut self) -> Result<(), BusFault> {
        self.times.read = Some(Instant::now());
        if self.is_diverged {
            self.restore().await?;
        }
        loop {
            let next = self.context.bus.read(self.id, self.state.number()).await?;
            let Some((number, bytes)) = next else { return Ok(()) };
            let Ok(message) = LogMessage::parse(&bytes) else {
                tracing::error!(room = %self.id, number, "a message of a room cannot be read");
                self.interface.close("A host of another version has this room now.");
                return Err(BusFault::Unknown);
            };
            if !self.take(number, &message).await {
                // The messages before it were dropped, since a checkpoint has what they did.
                self.restore().await?;
            }
        }
    }

    /// Takes the newest checkpoint in place of the state.
    async fn restore(&mut self) -> Result<(), BusFault> {
        let now = Instant::now();
        if !is_due(self.times.restored, now, SECOND) {
            return Err(BusFault::Unknown);
        }
        self.times.restored = Some(now);
        let loaded = self.context.load_state(self.id).await;
        let (state, _) = loaded.map_err(|_| BusFault::Unknown)?;
        self.interface.shown.replace(|| (state.room().view(), ()));
        self.state = state;
        self.is_diverged = false;
        // Its lease may be over since long.
        self.sequencer.take_if(|sequencer| sequencer.epoch() < self.state.epoch());
        self.is_changed = true;
        Ok(())
    }

    /// Tells the others of a message that this host has appended.
    pub(crate) async fn announce(&mut self, number: u64, message: LogMessage) {
        self.broadcast(&PeerMessage::Appended(number, message)).await;
    }
}
