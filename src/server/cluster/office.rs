//! The office of a room's sequencer: what the members on all hosts want, until it is in the log.
//!
//! Each host passes on what its own members want, the sequencer's host as well, see
//! [`Station`](super::station::Station). Here it is gathered in an [`Inbox`], which has a seat for each member
//! and keeps the rules of a room in one process. The message that is on its way to the log is kept, unchanged,
//! until it is known whether the log has it.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use tokio::time::Instant;

use super::message::Message;
use super::replica::Replica;
use super::talk::Talk;
use crate::game::PlayerColor;
use crate::server::line::Line;
use crate::server::room::{Deed, Entry, MemberId};
use crate::server::sequencer::Inbox;
use crate::store::host::Lease;

/// The time after which a member is removed whom no host claims.
pub(super) const UNCLAIMED: Duration = Duration::from_secs(4);
/// The questions whose answers are remembered, in case that they are asked again.
const MOST_ANSWERS: usize = 64;

/// What a sequencer has to do.
pub(super) struct Office {
    lease: Lease,
    gathered: Inbox,
    /// When a host has claimed a member last.
    claimed: BTreeMap<MemberId, Instant>,
    /// Those who have asked to join, the newest last.
    guests: VecDeque<Guest>,
    /// Whether the log has the first message of the epoch.
    is_begun: bool,
    /// The message that may be in the log.
    sending: Option<Message>,
    /// The step of the checksum that was told last.
    checked: u64,
}

/// Somebody who has asked to join.
struct Guest {
    token: u64,
    member: MemberId,
    /// Once they are in a message.
    color: Option<PlayerColor>,
    /// Whether the log has them.
    is_in: bool,
}

impl Office {
    /// The office of an epoch whose first message is still to be sent. What somebody wants until then is lost:
    /// the room may still change by what the predecessor appends.
    pub(super) fn new(lease: Lease, replica: &Replica) -> Self {
        let room = replica.room();
        let gathered = Inbox::new(room.header().mode, room.next_member());
        let mut office = Self {
            lease,
            gathered,
            claimed: BTreeMap::new(),
            guests: VecDeque::new(),
            is_begun: false,
            sending: None,
            checked: replica.tick(),
        };
        office.sending = Some(office.message(replica, 0));
        office
    }

    pub(super) fn lease(&self) -> &Lease {
        &self.lease
    }

    pub(super) fn epoch(&self) -> u64 {
        self.lease.epoch()
    }

    /// The message that is on its way; otherwise the next one, of `steps`.
    pub(super) fn next(&mut self, replica: &Replica, steps: u64) -> Message {
        let message = match self.sending.take() {
            Some(sent) if sent.last == replica.number() => sent,
            // The predecessor has written before it was fenced off.
            Some(sent) => {
                Message { last: replica.number(), tick: replica.tick(), check: None, ..sent }
            }
            None => self.message(replica, steps),
        };
        self.sending = Some(message.clone());
        message
    }

    /// Whether a message is on its way.
    pub(super) fn is_sending(&self) -> bool {
        self.sending.is_some()
    }

    /// Notes that the log has a message, which the replica has taken; returns what is to be said to those whom
    /// it lets in.
    pub(super) fn note(&mut self, message: &Message, replica: &Replica, now: Instant) -> Vec<Talk> {
        if self.sending.as_ref() != Some(message) {
            return Vec::new();
        }
        self.sending = None;
        if !self.is_begun {
            self.begin(replica, now);
        }
        let mut answers = Vec::new();
        for guest in self.guests.iter_mut().filter(|guest| !guest.is_in) {
            guest.is_in = guest.color.is_some();
            answers.extend(guest.answer());
        }
        answers
    }

    /// Somebody asks to join; returns the answer, if there is one by now.
    pub(super) fn ask(&mut self, token: u64, name: &Line, now: Instant) -> Option<Talk> {
        if let Some(known) = self.guests.iter().find(|guest| guest.token == token) {
            return known.answer();
        }
        if !self.is_begun {
            return None;
        }
        let Ok(member) = self.gathered.join(name) else { return Some(Talk::Full(token)) };
        self.claimed.insert(member, now);
        self.guests.push_back(Guest { token, member, color: None, is_in: false });
        if self.guests.len() > MOST_ANSWERS {
            self.guests.pop_front();
        }
        None
    }

    /// A member on some host wants something.
    pub(super) fn want(&mut self, member: MemberId, deed: Deed) {
        match deed {
            Deed::Leave => self.leave(member),
            // What comes too often was refused on the member's own host.
            deed => _ = self.gathered.act(member, deed),
        }
    }

    /// A host has these members.
    pub(super) fn claim(&mut self, members: &[MemberId], now: Instant) {
        for member in members {
            self.claimed.entry(*member).and_modify(|time| *time = now);
        }
    }

    /// Removes the members whom no host claims any more.
    pub(super) fn remove_unclaimed(&mut self, now: Instant) {
        let is_lost = |time: &Instant| now.duration_since(*time) >= UNCLAIMED;
        let lost: Vec<MemberId> =
            self.claimed.iter().filter(|(_, time)| is_lost(time)).map(|(id, _)| *id).collect();
        for member in lost {
            self.leave(member);
        }
    }

    /// Whether nobody is in the room, or on the way to it or out of it.
    pub(super) fn is_empty(&self) -> bool {
        self.sending.is_none() && self.gathered.is_empty()
    }

    /// Begins with the members as they are, each of whom has the usual time to be claimed.
    fn begin(&mut self, replica: &Replica, now: Instant) {
        let room = replica.room();
        self.is_begun = true;
        self.gathered = Inbox::new(room.header().mode, room.next_member());
        room.colors().for_each(|(member, color)| self.gathered.admit(member, color));
        self.claimed = room.colors().map(|(member, _)| (member, now)).collect();
    }

    fn leave(&mut self, member: MemberId) {
        self.claimed.remove(&member);
        self.gathered.leave(member);
    }

    fn message(&mut self, replica: &Replica, steps: u64) -> Message {
        let mut entries = Vec::new();
        let Self { gathered, guests, .. } = self;
        for step in 0..steps {
            gathered.take(|member, deed| {
                if let Deed::Join { color, .. } = &deed
                    && let Some(guest) = guests.iter_mut().find(|guest| guest.member == member)
                {
                    guest.color = Some(*color);
                }
                entries.push(Entry { step, member, deed });
            });
        }
        let check = replica.sum().filter(|check| check.tick > self.checked);
        self.checked = check.map_or(self.checked, |check| check.tick);
        let (epoch, last, tick) = (self.epoch(), replica.number(), replica.tick());
        Message { epoch, last, tick, steps, check, entries }
    }
}

impl Guest {
    fn answer(&self) -> Option<Talk> {
        let color = self.color.filter(|_| self.is_in)?;
        Some(Talk::Joined(self.token, self.member, color))
    }
}
