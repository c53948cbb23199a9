//! Requests to be a member, from visitors of this host, and the seats of this host's members.
//!
//! A request has a token, by which its answer is found. A request to return is granted once the log has the token,
//! whichever host has written it.

use std::time::Duration;

use tokio::time::{Instant, sleep};

use super::{MESSAGE_PERIOD, MemberReply, MemberRequest, PendingRequest, Replica};
use crate::cluster::message::{MemberWish, PeerMessage, Token};
use crate::cluster::sequencer::ClusterSequencer;
use crate::rooms::room::{MemberId, Room};
use crate::rooms::summary::RoomRefusal;
use cellcaster::game::PlayerColor;

/// The time after which a request is sent again.
const RETRY: Duration = Duration::from_millis(500);
/// The time after which a request fails. Another host takes over a room in less.
const TIMEOUT: Duration = Duration::from_secs(8);
/// The most messages in which a host that ends waits for the log to have its last entries.
const MOST_LAST_MESSAGES: usize = 15;

impl PendingRequest {
    /// Whether it asks to return to a member who has left.
    fn is_lost(&self, room: &Room) -> bool {
        matches!(self.wish, MemberWish::Return(member) if room.has_lost(member))
    }

    /// The member to whom `room` lets it return.
    fn granted(&self, room: &Room) -> Option<MemberId> {
        let MemberWish::Return(member) = self.wish else { return None };
        let kept = room.kept_place(member)?;
        (kept.token == self.token.0).then_some(member)
    }

    fn refuse(self, refusal: RoomRefusal) {
        if let Some(reply) = self.reply {
            _ = reply.send(Err(refusal));
        }
    }
}

impl Replica {
    pub(crate) async fn receive_request(&mut self, request: MemberRequest) {
        let MemberRequest { wish, reply } = request;
        if let MemberWish::Return(member) = wish
            && self.interface.inbox.seated().contains(&member)
        {
            _ = reply.send(Err(RoomRefusal::Taken));
            return;
        }
        self.begin_request(wish, Some(reply), Instant::now()).await;
    }

    async fn begin_request(&mut self, wish: MemberWish, reply: Option<MemberReply>, now: Instant) {
        let token = Token(self.context.chance());
        self.pending.push(PendingRequest {
            token,
            wish: wish.clone(),
            reply,
            since: now,
            sent: now,
        });
        self.send_request(token, wish, now).await;
    }

    async fn send_request(&mut self, token: Token, wish: MemberWish, now: Instant) {
        match &mut self.sequencer {
            Some(sequencer) => {
                if let Some(answer) = sequencer.request(token, &wish, now) {
                    self.answer(&answer);
                }
            }
            None => self.broadcast(&PeerMessage::Request(token, wish)).await,
        }
    }

    /// Sends requests without an answer again.
    pub(crate) async fn repeat_requests(&mut self, now: Instant) {
        self.settle_requests(now);
        let is_due = |pending: &&mut PendingRequest| now.duration_since(pending.sent) >= RETRY;
        let due = self.pending.iter_mut().filter(is_due).map(|pending| {
            pending.sent = now;
            (pending.token, pending.wish.clone())
        });
        for (token, wish) in due.collect::<Vec<_>>() {
            self.send_request(token, wish, now).await;
        }
    }

    /// Notes which requests the log has granted, and fails those that are too old.
    fn settle_requests(&mut self, now: Instant) {
        let Self { pending, state, tokens, interface, .. } = self;
        let room = &state.room;
        for granted in pending.extract_if(.., |pending| pending.granted(room).is_some()) {
            let Some(member) = granted.granted(room) else { continue };
            tokens.insert(member, granted.token);
            let color = room.colors().find(|(other, _)| *other == member).map(|it| it.1);
            if let Some((reply, color)) = granted.reply.zip(color) {
                interface.inbox.admit(member, color);
                if reply.send(Ok(member)).is_err() {
                    interface.inbox.part(member);
                }
            }
        }
        let is_over = |pending: &mut PendingRequest| {
            pending.is_lost(room) || now.duration_since(pending.since) >= TIMEOUT
        };
        for pending in pending.extract_if(.., is_over) {
            let is_lost = pending.is_lost(room);
            pending.refuse(if is_lost { RoomRefusal::Gone } else { RoomRefusal::NotNow });
        }
    }

    /// Gives a seat to the visitor who has asked for it here.
    pub(crate) fn admit(&mut self, token: Token, member: MemberId, color: PlayerColor) {
        let Some(pending) = self.take_pending(token) else { return };
        self.interface.inbox.admit(member, color);
        if pending.reply.is_none_or(|reply| reply.send(Ok(member)).is_err()) {
            self.interface.inbox.leave(member);
        }
    }

    /// Refuses a request that was made here.
    pub(crate) fn refuse_request(&mut self, token: Token, refusal: RoomRefusal) {
        // The log may have granted it since.
        self.settle_requests(Instant::now());
        if let Some(pending) = self.take_pending(token) {
            pending.refuse(refusal);
        }
    }

    fn take_pending(&mut self, token: Token) -> Option<PendingRequest> {
        let index = self.pending.iter().position(|pending| pending.token == token)?;
        Some(self.pending.swap_remove(index))
    }

    /// Asks to return for the members of this host who were away while it was cut off.
    pub(crate) async fn return_own(&mut self, now: Instant) {
        self.settle_requests(now);
        let is_pending = |member: &MemberId| {
            self.pending.iter().any(|it| it.wish == MemberWish::Return(*member))
        };
        let room = &self.state.room;
        let mut away = self.interface.inbox.seated();
        away.retain(|member| room.is_away(*member) && self.is_own(*member) && !is_pending(member));
        for member in away {
            self.begin_request(MemberWish::Return(member), None, now).await;
        }
    }

    /// Frees the seats of members who have left the room since this host last claimed them, or who are on another host
    /// now.
    pub(crate) fn dismiss_lost(&mut self) {
        for member in self.interface.inbox.seated() {
            // The log has not let in numbers from the next one on yet.
            if self.state.room.has_lost(member) || !self.is_own(member) {
                self.interface.inbox.dismiss(member);
            }
        }
        let seated = self.interface.inbox.seated();
        self.tokens.retain(|member, _| seated.contains(member));
    }

    /// Whether nobody has returned to a member elsewhere, as far as the log is known.
    fn is_own(&self, member: MemberId) -> bool {
        let token = self.state.room.kept_place(member).map_or(0, |kept| kept.token);
        token == self.tokens.get(&member).map_or(0, |token| token.0)
    }

    /// Marks the members of this host away, since it ends. If it is the sequencer, the log has that afterwards.
    pub(crate) async fn part_with_members(&mut self) {
        for member in self.interface.inbox.seated() {
            self.interface.inbox.part(member);
        }
        self.send_commands().await;
        for _ in 0..MOST_LAST_MESSAGES {
            if self.sequencer.as_ref().is_none_or(ClusterSequencer::is_settled) {
                return;
            }
            sleep(MESSAGE_PERIOD).await;
            self.sequence(Instant::now()).await;
        }
    }
}
