//! Going on alone: a room continues while the bus does not answer, if all its members are on the sequencer's host.
//!
//! # Rules
//!
//! - **The lease decides.** While the database renews it, no other host appends to the log, so the messages can be
//!   appended later. Without the lease the room waits.
//! - **Nobody joins meanwhile**, because a member who is told that they are in the room must be in the log.
//! - **Messages wait in memory**, each with up to ten seconds, for [`MAX_ALONE`]. Then the room waits.
//! - If members are on other hosts, the sequencer releases the lease instead, and another host goes on.
//!
//! Rejected: a checkpoint in place of the messages. Watchers on other hosts would skip a part of the game, and the log
//! would no longer be the whole history of the room.

use std::collections::VecDeque;
use std::time::Duration;

use tokio::time::Instant;

use super::{Alone, CLAIM_INTERVAL, Replica, STANDSTILL_TIMEOUT, steps_due};
use crate::cluster::bus::BusFault;
use crate::cluster::message::{LogMessage, PeerMessage, to_bytes};
use crate::cluster::sequencer::ClusterSequencer;

/// The longest time for which a room goes on alone.
const MAX_ALONE: Duration = Duration::from_mins(10);

impl Replica {
    /// Goes on alone, or leaves the room to other hosts, if the log has not answered for a while.
    pub(crate) fn lack_bus(&mut self, now: Instant) {
        let is_standing_still = now.duration_since(self.times.moved) >= STANDSTILL_TIMEOUT;
        if !is_standing_still || !self.has_lease(now) {
            return;
        }
        if !self.has_only_own_members() {
            return self.release_lease();
        }
        let Some(first) = self.sequencer.as_mut().and_then(ClusterSequencer::begin_alone) else {
            return;
        };
        tracing::warn!(room = %self.id, "a room goes on without NATS, which does not answer");
        let messages = VecDeque::new();
        self.alone = Some(Alone { since: now, messages, probe: None, probed: now });
        self.times.stepped = now;
        self.advance_alone(first);
    }

    /// Takes the steps that are due, or appends all waiting messages to the log once the bus answers.
    pub(crate) async fn go_on_alone(&mut self, now: Instant) {
        let has_lease = self.has_lease(now);
        let Some(alone) = &mut self.alone else { return };
        if let Some(probe) = alone.probe.take_if(|probe| probe.is_finished()) {
            if probe.await.unwrap_or(false) && self.append_alone().await.is_ok() {
                return;
            }
        } else if alone.probe.is_none() && now.duration_since(alone.probed) >= CLAIM_INTERVAL {
            let (context, id, number) = (self.context.clone(), self.id, self.state.number);
            let probe = async move { context.bus.read(id, number).await.is_ok() };
            (alone.probe, alone.probed) = (Some(tokio::spawn(probe)), now);
        }
        let (Some(alone), Some(sequencer)) = (&self.alone, &mut self.sequencer) else { return };
        if !has_lease || now.duration_since(alone.since) >= MAX_ALONE {
            self.times.stepped = now;
            return;
        }
        let steps = steps_due(&mut self.times.stepped, now);
        if steps > 0 {
            let message = sequencer.message(&self.state, steps);
            self.context.load.metrics.steps_alone.inc_by(steps);
            self.advance_alone(message);
        }
    }

    /// Applies a message that will be appended later.
    fn advance_alone(&mut self, message: LogMessage) {
        self.apply(None, &message);
        self.times.moved = Instant::now();
        let Some(alone) = &mut self.alone else { return };
        let has_unsent = alone.messages.len() > 1;
        match alone.messages.back_mut().filter(|last| has_unsent && last.has_room(&message)) {
            Some(last) => last.merge(message),
            None => alone.messages.push_back(message),
        }
    }

    /// Appends the waiting messages to the log.
    async fn append_alone(&mut self) -> Result<(), BusFault> {
        self.confirm_sent().await?;
        while let Some(first) = self.alone.as_mut().and_then(|it| it.messages.front_mut()) {
            first.last = self.state.number;
            let message = first.clone();
            match self.context.bus.append(self.id, message.last, to_bytes(&message)).await {
                Ok(number) => self.confirm(number).await,
                Err(BusFault::Refused) => self.confirm_sent().await?,
                Err(BusFault::Unknown) => return Err(BusFault::Unknown),
            }
        }
        if self.alone.take().is_some() {
            tracing::info!(room = %self.id, "a room has reached NATS again");
            self.is_append_unknown = false;
            self.is_changed = true;
            let answers = self.sequencer.as_mut().map(ClusterSequencer::end_alone);
            let answers = answers.unwrap_or_default();
            self.send_answers(answers).await;
        }
        Ok(())
    }

    /// Looks in the log for the message that was sent without an answer.
    async fn confirm_sent(&mut self) -> Result<(), BusFault> {
        while let Some((number, bytes)) = self.context.bus.read(self.id, self.state.number).await? {
            let first = self.alone.as_ref().and_then(|it| it.messages.front());
            if first.is_none_or(|first| to_bytes(first) != bytes) {
                self.diverge();
                return Ok(());
            }
            self.confirm(number).await;
        }
        Ok(())
    }

    /// Notes that the log has the first waiting message.
    async fn confirm(&mut self, number: u64) {
        let first = self.alone.as_mut().and_then(|it| it.messages.pop_front());
        self.state.number = number;
        if let Some(message) = first {
            self.broadcast(&PeerMessage::Appended(number, message)).await;
        }
    }

    /// Returns true if the room has gone on alone past a message of the log. If another host wrote the message, the
    /// room is not ahead but has diverged.
    pub(crate) fn is_ahead_of(&mut self, message: &LogMessage) -> bool {
        let Some(sequencer) = self.sequencer.as_ref().filter(|_| self.alone.is_some()) else {
            return false;
        };
        let is_own = message.epoch <= sequencer.epoch();
        if !is_own {
            self.diverge();
        }
        is_own
    }

    /// Gives up the messages that the log does not have, because another host had the lease and has written.
    pub(crate) fn diverge(&mut self) {
        if self.alone.take().is_some() {
            tracing::warn!(room = %self.id, "a room went on without NATS while another host had its lease");
            self.is_diverged = true;
        }
        self.step_down();
    }

    fn has_lease(&self, now: Instant) -> bool {
        self.lease_end().is_some_and(|end| now < end)
    }

    fn has_only_own_members(&self) -> bool {
        let (own, room) = (self.interface.inbox.seated(), &self.state.room);
        // Members who are away have no host.
        room.colors().all(|(member, _)| own.contains(&member) || room.is_away(member))
    }

    /// Leaves the room to hosts that reach the bus.
    fn release_lease(&mut self) {
        if let Some(sequencer) = &self.sequencer {
            drop(self.context.leases.release(&sequencer.lease));
        }
        self.step_down();
        self.reaches_bus = false;
    }
}
