//! The duties of the sequencer: the lease, the messages, the checkpoints.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::oneshot::error::TryRecvError;
use tokio::time::Instant;

use super::{Replica, is_due};
use crate::accounts::Lease;
use crate::cluster::bus::{BusFault, Key};
use crate::cluster::leases::LEASE_TIME;
use crate::cluster::message::{PeerMessage, to_bytes};
use crate::cluster::sequencer::ClusterSequencer;
use crate::rooms::sequencer::{MOST_CAUGHT_UP, STEP};

/// The time from one checkpoint to the next.
const CHECKPOINTS: Duration = Duration::from_secs(5);
/// The time after which the lease is asked for again.
const RETRY: Duration = Duration::from_millis(500);

impl Replica {
    /// Renews the lease, or asks for it if nobody seems to have it.
    pub(crate) async fn keep_lease(&mut self, now: Instant) {
        if let Some(reply) = &mut self.leasing.renewing {
            match reply.try_recv() {
                Err(TryRecvError::Empty) => {}
                Ok(Ok(false)) => self.diverge(),
                Ok(Ok(true)) => {
                    self.note_lease();
                    self.leasing.renewing = None;
                }
                // Without the database nobody else gets the lease; and the log refuses a host that has lost it.
                _ => self.leasing.renewing = None,
            }
        }
        if let Some(reply) = &mut self.leasing.acquiring {
            match reply.try_recv() {
                Err(TryRecvError::Empty) => return,
                Ok(Ok(Some(lease))) => {
                    self.note_lease();
                    self.take_over(lease).await;
                }
                _ => {}
            }
            self.leasing.acquiring = None;
        }
        let leases = &self.context.leases;
        match &self.sequencer {
            Some(sequencer) if self.leasing.renewing.is_none() => {
                if self.is_next_second(now) {
                    self.leasing.renewing = Some(leases.renew(&sequencer.lease));
                    self.times.leased = Some(now);
                }
            }
            Some(_) => {}
            None => {
                let is_first = self.times.leased.is_none();
                let is_time =
                    is_first || self.is_silent(now) && is_due(self.times.leased, now, RETRY);
                // A host that cannot write the log would keep the room from hosts that can.
                if is_time && self.reaches_bus {
                    self.leasing.acquiring =
                        Some(leases.acquire(&self.id.place(), self.state.epoch));
                    self.times.leased = Some(now);
                }
            }
        }
    }

    /// Whether a second of the host has begun since the lease was asked for. So all rooms of a host renew their
    /// leases at the same time.
    fn is_next_second(&self, now: Instant) -> bool {
        let second = |time: Instant| time.duration_since(self.context.begun).as_secs();
        self.times.leased.is_none_or(|leased| second(leased) < second(now))
    }

    /// Becomes the sequencer: its first message, of a new epoch, goes to the end of the log.
    async fn take_over(&mut self, lease: Lease) {
        let is_read = self.read().await.is_ok();
        if self.state.epoch >= lease.epoch {
            // The answer has come so late that others have had the room since.
            return;
        }
        let now = Instant::now();
        tracing::info!(room = %self.id, epoch = lease.epoch, "this host has a room now");
        self.sequencer = Some(ClusterSequencer::new(lease, &self.state));
        self.times.stepped = now;
        self.is_append_unknown = !is_read;
        self.is_changed = true;
    }

    /// Notes that the lease lasts from when it was asked for.
    fn note_lease(&mut self) {
        self.times.lease_ends = self.times.leased.map(|asked| asked + LEASE_TIME);
    }

    pub(crate) fn step_down(&mut self) {
        if let Some(sequencer) = self.sequencer.take() {
            tracing::warn!(room = %self.id, epoch = sequencer.epoch(), "this host has lost a room");
        }
        self.leasing.renewing = None;
        self.times.lease_ends = None;
    }

    /// Appends the next message to the log, if one is due.
    pub(crate) async fn sequence(&mut self, now: Instant) {
        if self.alone.is_some() {
            return self.go_on_alone(now).await;
        }
        if self.is_append_unknown {
            if self.read().await.is_err() {
                return self.lack_bus(now);
            }
            self.is_append_unknown = false;
        }
        let Some(sequencer) = &mut self.sequencer else { return };
        if self.state.room.len() == 0 && sequencer.is_empty() {
            (self.times.stepped, self.times.moved) = (now, now);
            return;
        }
        let steps = steps_due(&mut self.times.stepped, now);
        if steps == 0 && !sequencer.is_sending() {
            return;
        }
        let message = sequencer.next(&self.state, steps);
        match self.context.bus.append(self.id, message.last, to_bytes(&message)).await {
            Ok(number) => {
                self.times.published = Some(now);
                self.take(number, &message).await;
                self.broadcast(&PeerMessage::Appended(number, message)).await;
            }
            Err(BusFault::Refused) => self.is_append_unknown = self.read().await.is_err(),
            Err(BusFault::Unknown) => self.is_append_unknown = true,
        }
    }

    /// Keeps a checkpoint every few seconds, and the record of the room when it changes.
    pub(crate) async fn keep(&mut self, now: Instant) {
        let is_time = is_due(self.times.kept, now, CHECKPOINTS);
        // A host that was replaced and has not noticed has appended nothing now, and must not keep an old state.
        let is_surely_sequencer = self.times.published == Some(now);
        if self.sequencer.is_none() || self.is_append_unknown || !(is_time || self.is_changed) {
            return;
        }
        if is_time && is_surely_sequencer && self.keep_checkpoint().await.is_err() {
            return;
        }
        if is_time {
            self.times.kept = Some(now);
        }
        self.is_changed = self.keep_record(true).await.is_err();
    }

    async fn keep_checkpoint(&mut self) -> Result<(), BusFault> {
        let bus = &self.context.bus;
        bus.put(Key::Checkpoint(self.id), self.state.checkpoint()).await?;
        bus.drop_before(self.id, self.state.number).await
    }

    async fn keep_record(&mut self, is_running: bool) -> Result<(), BusFault> {
        let record = self.record.clone().next(&self.state.room, is_running);
        self.context.bus.put(Key::Room(self.id), to_bytes(&record)).await?;
        self.record = record;
        Ok(())
    }

    /// Leaves the room to other hosts, or closes it if nobody needs it.
    pub(crate) async fn end(mut self) {
        if *self.ending.borrow() {
            self.requests.close();
            self.part_with_members().await;
        }
        let is_broken = self.interface.inbox.is_closed();
        if let Some(sequencer) = self.sequencer.take_if(|_| !self.is_append_unknown) {
            let is_empty = self.state.room.len() == 0;
            let (context, mut is_gone) = (Arc::clone(&self.context), false);
            if is_broken || is_empty && !self.record.stands {
                // A standing room is made again under its number, and others may go on with a room that is broken or
                // was not removed.
                is_gone = self.close().await.is_ok() && !is_broken && !self.record.stands;
            } else {
                // The first call is refused if the predecessor has put the last checkpoint.
                for _ in 0..2 {
                    if self.keep_checkpoint().await.is_ok() {
                        break;
                    }
                }
                if self.keep_record(!is_empty).await.is_err() {
                    _ = self.keep_record(!is_empty).await;
                }
            }
            let lease = &sequencer.lease;
            let leases = &context.leases;
            _ = if is_gone { leases.forget(lease) } else { leases.release(lease) }.await;
            self.broadcast(&PeerMessage::Released).await;
        }
        let ends = *self.ending.borrow();
        let sentence =
            if ends { "The server has ended." } else { "The room was empty and is closed." };
        self.interface.close(sentence);
    }

    /// Removes everything of the room.
    async fn close(&mut self) -> Result<(), BusFault> {
        let bus = &self.context.bus;
        let mut removed = Ok(());
        for key in [Key::Room(self.id), Key::Checkpoint(self.id)] {
            removed = removed.and(bus.remove(key).await);
        }
        removed.and(bus.drop_log(self.id).await)
    }
}

/// The steps that are due since `stepped`, which is moved on.
pub(crate) fn steps_due(stepped: &mut Instant, now: Instant) -> u64 {
    const MOST: u64 = MOST_CAUGHT_UP as u64;
    let due = now.saturating_duration_since(*stepped).div_duration_f64(STEP) as u64;
    *stepped = if due > MOST { now } else { *stepped + STEP * due as u32 };
    due.min(MOST)
}
