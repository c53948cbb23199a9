//! The sequencer of a room in a cluster. It orders the commands of the members on all hosts into messages.
//!
//! Each [`Replica`](super::replica::Replica) sends the commands of its own members. They wait in an [`Inbox`], which
//! has a seat for each member, and the same limits as a room in one process. A message that was sent to the log stays
//! unchanged until it is known whether the log has it. Otherwise another message in its place could become the second
//! one with its number.
//!
//! When somebody asks to return to a member, the member may still have a host:
//!
//! - A member who is away has no host.
//! - A member who was not claimed for [`CLAIM_TIMEOUT`] since the request almost certainly has no host; the log does not show
//!   yet that the host is gone. If there is a host nevertheless, it sees that the token is not its own, and lets the
//!   member go.
//! - A member who is claimed has a host. The sequencer refuses the request, because nobody takes the place of a member
//!   who plays.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::time::Duration;

use tokio::time::Instant;

use super::message::{LogMessage, PeerMessage, RequestedMember, Token};
use super::room_state::RoomState;
use crate::accounts::Lease;
use crate::line::Line;
use crate::queue::push_within;
use crate::rooms::room::{Command, Entry, MemberId, Room};
use crate::rooms::sequencer::Inbox;
use crate::rooms::summary::RoomRefusal;
use cellcaster::game::PlayerColor;

/// How long a member may go unclaimed before they are marked away.
const AWAY_TIMEOUT: Duration = Duration::from_secs(4);
/// How long a member must go unclaimed before somebody else may return to them.
const CLAIM_TIMEOUT: Duration = Duration::from_millis(2_500);
/// The most requests of each kind that are remembered, with their answers.
const MAX_REQUESTS: usize = 64;

/// The waiting commands, the claimed members, and the message that is being appended.
pub(crate) struct ClusterSequencer {
    pub(crate) lease: Lease,
    inbox: Inbox,
    /// When each member was last claimed.
    claimed: BTreeMap<MemberId, Instant>,
    /// The members who are away and need no claim.
    away: BTreeSet<MemberId>,
    /// The requests to join, oldest first.
    joining: VecDeque<Joining>,
    /// The requests to return, oldest first.
    returning: VecDeque<Returning>,
    /// `true` once the log has the first message of the epoch.
    is_begun: bool,
    /// `true` while messages are applied that the log does not have yet. Nobody joins meanwhile, because a new member
    /// must be in the log.
    is_alone: bool,
    /// The message that was sent, while it is unknown whether the log has it.
    sending: Option<LogMessage>,
    /// The step of the last checksum that was sent.
    checked: u64,
}

/// A request to join.
struct Joining {
    token: Token,
    member: MemberId,
    /// Set once a message contains the new member.
    color: Option<PlayerColor>,
    /// `true` once the log has that message.
    is_in: bool,
}

/// A request to return.
struct Returning {
    token: Token,
    member: MemberId,
    since: Instant,
    decision: Decision,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Decision {
    Open,
    Granted,
    Refused,
}

impl ClusterSequencer {
    /// Starts the sequencer of an epoch whose first message must still be appended. Commands until then are lost,
    /// because the predecessor may still append messages that change who is in the room.
    pub(crate) fn new(lease: Lease, state: &RoomState) -> Self {
        let room = &state.room;
        let inbox = Inbox::new(room.header().mode, room.next_member());
        let mut sequencer = Self {
            lease,
            inbox,
            claimed: BTreeMap::new(),
            away: BTreeSet::new(),
            joining: VecDeque::new(),
            returning: VecDeque::new(),
            is_begun: false,
            is_alone: false,
            sending: None,
            checked: state.tick,
        };
        sequencer.sending = Some(sequencer.message(state, 0));
        sequencer
    }

    pub(crate) fn epoch(&self) -> u64 {
        self.lease.epoch
    }

    /// The message that is being appended, or otherwise the next one, of `steps` steps.
    pub(crate) fn next(&mut self, state: &RoomState, steps: u64) -> LogMessage {
        let message = match self.sending.take() {
            Some(sent) if sent.last == state.number => sent,
            // The predecessor wrote before it was fenced off.
            Some(sent) => LogMessage { last: state.number, tick: state.tick, check: None, ..sent },
            None => self.message(state, steps),
        };
        self.sending = Some(message.clone());
        message
    }

    /// Returns true while a message is being appended.
    pub(crate) fn is_sending(&self) -> bool {
        self.sending.is_some()
    }

    /// Notes that the log has a message, which was applied to `state`. Returns the answers to the requests that it
    /// fulfils.
    pub(crate) fn note(
        &mut self,
        message: &LogMessage,
        state: &RoomState,
        now: Instant,
    ) -> Vec<PeerMessage> {
        if self.sending.as_ref() != Some(message) {
            return Vec::new();
        }
        self.sending = None;
        if !self.is_begun {
            self.begin(state, now);
        }
        self.forget_lost(&state.room);
        self.answers()
    }

    /// Goes on alone if the epoch has begun. Returns the message that the log may have.
    pub(crate) fn begin_alone(&mut self) -> Option<LogMessage> {
        let message = self.sending.take_if(|_| self.is_begun)?;
        self.is_alone = true;
        Some(message)
    }

    /// Goes on as usual once the log has all messages. Returns the answers to the requests that they fulfil.
    pub(crate) fn end_alone(&mut self) -> Vec<PeerMessage> {
        self.is_alone = false;
        self.answers()
    }

    /// The answers to the requests to join that are now in the log.
    fn answers(&mut self) -> Vec<PeerMessage> {
        let mut answers = Vec::new();
        for joining in self.joining.iter_mut().filter(|joining| !joining.is_in) {
            joining.is_in = joining.color.is_some();
            answers.extend(joining.answer());
        }
        answers
    }

    /// Handles a request to be a member. Returns the answer if it is known.
    pub(crate) fn request(
        &mut self,
        token: Token,
        requested: &RequestedMember,
        now: Instant,
    ) -> Option<PeerMessage> {
        match requested {
            RequestedMember::Join { name, is_kept } => {
                self.request_join(token, name, *is_kept, now)
            }
            RequestedMember::Return(member) => self.request_return(token, *member, now),
        }
    }

    fn request_join(
        &mut self,
        token: Token,
        name: &Line,
        is_kept: bool,
        now: Instant,
    ) -> Option<PeerMessage> {
        if let Some(known) = self.joining.iter().find(|joining| joining.token == token) {
            return known.answer();
        }
        if !self.is_begun || self.is_alone {
            return None;
        }
        let Ok(member) = self.inbox.join(name) else {
            return Some(PeerMessage::Refused(token, RoomRefusal::Full));
        };
        if is_kept {
            self.inbox.push_move(member, Command::Keep);
        }
        self.claimed.insert(member, now);
        let request = Joining { token, member, color: None, is_in: false };
        push_within(&mut self.joining, request, MAX_REQUESTS);
        None
    }

    fn request_return(
        &mut self,
        token: Token,
        member: MemberId,
        now: Instant,
    ) -> Option<PeerMessage> {
        if !self.is_begun || self.is_alone {
            return None;
        }
        if let Some(known) = self.returning.iter().find(|it| it.token == token) {
            match known.decision {
                Decision::Refused => return Some(known.refusal()),
                Decision::Open if now.duration_since(known.since) >= CLAIM_TIMEOUT => {
                    self.take_back(token, member, now);
                }
                Decision::Open | Decision::Granted => {}
            }
            return None;
        }
        let request = Returning { token, member, since: now, decision: Decision::Open };
        push_within(&mut self.returning, request, MAX_REQUESTS);
        if self.away.contains(&member) {
            self.take_back(token, member, now);
        }
        None
    }

    /// Takes a command of a member on any host.
    pub(crate) fn command(&mut self, member: MemberId, command: Command, now: Instant) {
        match command {
            Command::Leave => self.leave(member),
            Command::Away => self.set_away(member, now),
            // The member's own host has refused the commands that came too often.
            command => _ = self.inbox.act(member, command),
        }
    }

    /// Notes that a host has these members. Refuses the requests to return to them, and returns the answers.
    pub(crate) fn claim(&mut self, members: &[MemberId], now: Instant) -> Vec<PeerMessage> {
        for member in members {
            self.claimed.entry(*member).and_modify(|time| *time = now);
        }
        let is_refused =
            |it: &&mut Returning| it.decision == Decision::Open && members.contains(&it.member);
        let refused = self.returning.iter_mut().filter(is_refused).map(|request| {
            request.decision = Decision::Refused;
            request.refusal()
        });
        refused.collect()
    }

    /// Marks members away who are no longer claimed.
    pub(crate) fn set_unclaimed_away(&mut self, now: Instant) {
        let is_lost = |time: &Instant| now.duration_since(*time) >= AWAY_TIMEOUT;
        let lost: Vec<MemberId> =
            self.claimed.iter().filter(|(_, time)| is_lost(time)).map(|(id, _)| *id).collect();
        for member in lost {
            self.set_away(member, now);
        }
    }

    /// Returns true if nobody is in the room and no message is being appended.
    pub(crate) fn is_empty(&self) -> bool {
        self.sending.is_none() && self.inbox.is_empty()
    }

    /// Returns true if the log has all actions of the members.
    pub(crate) fn is_settled(&self) -> bool {
        self.sending.is_none() && !self.inbox.has_moves()
    }

    /// Begins the epoch with the present members. They must be claimed within the usual time.
    fn begin(&mut self, state: &RoomState, now: Instant) {
        let room = &state.room;
        self.is_begun = true;
        self.inbox = Inbox::new(room.header().mode, room.next_member());
        room.colors().for_each(|(member, color)| self.inbox.admit(member, color));
        let members = room.colors().map(|(member, _)| member);
        let (away, here): (BTreeSet<MemberId>, BTreeSet<MemberId>) =
            members.partition(|member| room.is_away(*member));
        self.away = away;
        self.claimed = here.into_iter().map(|member| (member, now)).collect();
    }

    fn leave(&mut self, member: MemberId) {
        self.claimed.remove(&member);
        self.away.remove(&member);
        self.inbox.leave(member);
    }

    fn set_away(&mut self, member: MemberId, now: Instant) {
        if self.claimed.remove(&member).is_some() {
            self.away.insert(member);
            self.inbox.set_away(member);
            let is_open = |it: &&Returning| it.decision == Decision::Open && it.member == member;
            if let Some(token) = self.returning.iter().find(is_open).map(|request| request.token) {
                self.take_back(token, member, now);
            }
        }
    }

    fn take_back(&mut self, token: Token, member: MemberId, now: Instant) {
        let is_here = self.away.remove(&member) || self.claimed.contains_key(&member);
        if !is_here {
            return;
        }
        self.claimed.insert(member, now);
        self.inbox.push_move(member, Command::Return { token: token.0 });
        for request in self.returning.iter_mut().filter(|request| request.token == token) {
            request.decision = Decision::Granted;
        }
    }

    /// Forgets the members that the room itself has removed: guests, and members who were away too long.
    fn forget_lost(&mut self, room: &Room) {
        for member in self.inbox.seated().into_iter().filter(|member| room.has_lost(*member)) {
            self.claimed.remove(&member);
            self.away.remove(&member);
            self.inbox.dismiss(member);
        }
    }

    /// Builds the next message, of `steps` steps.
    pub(crate) fn message(&mut self, state: &RoomState, steps: u64) -> LogMessage {
        let mut entries = Vec::new();
        let Self { inbox, joining, .. } = self;
        for step in 0..steps {
            inbox.take(|member, command| {
                if let Command::Join { color, .. } = &command
                    && let Some(joining) =
                        joining.iter_mut().find(|joining| joining.member == member)
                {
                    joining.color = Some(*color);
                }
                entries.push(Entry { step, member, command });
            });
        }
        let check = state.sum().filter(|check| check.tick > self.checked);
        self.checked = check.map_or(self.checked, |check| check.tick);
        let (epoch, last, tick) = (self.epoch(), state.number, state.tick);
        LogMessage { epoch, last, tick, steps, check, entries }
    }
}

impl Joining {
    fn answer(&self) -> Option<PeerMessage> {
        let color = self.color.filter(|_| self.is_in)?;
        Some(PeerMessage::Joined(self.token, self.member, color))
    }
}

impl Returning {
    fn refusal(&self) -> PeerMessage {
        PeerMessage::Refused(self.token, RoomRefusal::Taken)
    }
}
