//! Members who return to this host, and those whom it has lost.
//!
//! A request to return has a token. It is granted once the log has the token, whichever host has written it.

use tokio::time::{Instant, sleep};

use super::joining::{AGAIN, PATIENCE, Reply};
use super::{MESSAGE_PERIOD, Replica};
use crate::cluster::peer_message::PeerMessage;
use crate::cluster::sequencer::ClusterSequencer;
use crate::rooms::directory::RoomRefusal;
use crate::rooms::room::MemberId;

/// A request to return that is neither granted nor refused.
pub(crate) struct PendingReturn {
    token: u64,
    member: MemberId,
    /// `None` for a member of this host, who was away since the host was cut off.
    reply: Option<Reply>,
    since: Instant,
    last: Instant,
}

/// The most messages in which a host that ends waits for the log to have its last entries.
const MOST_LAST_MESSAGES: usize = 15;

impl Replica {
    pub(crate) async fn receive_return(&mut self, member: MemberId, reply: Reply, now: Instant) {
        if self.interface.inbox.seated().contains(&member) {
            _ = reply.send(Err(RoomRefusal::Taken));
            return;
        }
        self.begin_return(member, Some(reply), now).await;
    }

    async fn begin_return(&mut self, member: MemberId, reply: Option<Reply>, now: Instant) {
        let token = self.context.chance();
        let pending = PendingReturn { token, member, reply, since: now, last: now };
        self.pending_returns.push(pending);
        self.request_return(token, member, now).await;
    }

    /// Notes what the log has granted, sends the other requests again, and fails those that are too old.
    pub(crate) async fn repeat_returns(&mut self, now: Instant) {
        self.settle_returns(now);
        let is_due = |pending: &&mut PendingReturn| now.duration_since(pending.last) >= AGAIN;
        let due = self.pending_returns.iter_mut().filter(is_due).map(|pending| {
            pending.last = now;
            (pending.token, pending.member)
        });
        for (token, member) in due.collect::<Vec<_>>() {
            self.request_return(token, member, now).await;
        }
    }

    async fn request_return(&mut self, token: u64, member: MemberId, now: Instant) {
        match &mut self.sequencer {
            Some(sequencer) => {
                if sequencer.request_return(token, member, now).is_some() {
                    self.refuse_return(token);
                }
            }
            None => self.broadcast(&PeerMessage::Return(token, member)).await,
        }
    }

    fn settle_returns(&mut self, now: Instant) {
        let Self { pending_returns, state, tokens, interface, .. } = self;
        let room = state.room();
        let has_token = |pending: &PendingReturn| {
            room.kept_place(pending.member).is_some_and(|kept| kept.token == pending.token)
        };
        for PendingReturn { token, member, reply, .. } in
            pending_returns.extract_if(.., |pending| has_token(pending))
        {
            tokens.insert(member, token);
            let color = room.colors().find(|(other, _)| *other == member).map(|it| it.1);
            if let Some((reply, color)) = reply.zip(color) {
                interface.inbox.admit(member, color);
                if reply.send(Ok(member)).is_err() {
                    interface.inbox.part(member);
                }
            }
        }
        for pending in pending_returns.extract_if(.., |it| {
            room.has_lost(it.member) || now.duration_since(it.since) >= PATIENCE
        }) {
            let is_lost = room.has_lost(pending.member);
            let refusal = if is_lost { RoomRefusal::Gone } else { RoomRefusal::NotNow };
            pending.refuse(refusal);
        }
    }

    /// Passes on that a member has a host.
    pub(crate) fn refuse_return(&mut self, token: u64) {
        // The log knows better.
        self.settle_returns(Instant::now());
        let index = self.pending_returns.iter().position(|pending| pending.token == token);
        if let Some(index) = index {
            self.pending_returns.swap_remove(index).refuse(RoomRefusal::Taken);
        }
    }

    /// Has the members of this host return who were away while it was cut off.
    pub(crate) async fn return_own(&mut self, now: Instant) {
        self.settle_returns(now);
        let is_pending =
            |member: &MemberId| self.pending_returns.iter().any(|it| it.member == *member);
        let room = self.state.room();
        let mut away = self.interface.inbox.seated();
        away.retain(|member| room.is_away(*member) && self.is_own(*member) && !is_pending(member));
        for member in away {
            self.begin_return(member, None, now).await;
        }
    }

    /// Frees the seats of members who have left the room since this host did not claim them, or who are on
    /// another host now.
    pub(crate) fn dismiss_lost(&mut self) {
        for member in self.interface.inbox.seated() {
            // The log has not let in numbers from the next one on yet.
            if self.state.room().has_lost(member) || !self.is_own(member) {
                self.interface.inbox.dismiss(member);
            }
        }
        let seated = self.interface.inbox.seated();
        self.tokens.retain(|member, _| seated.contains(member));
    }

    /// Whether nobody has returned to a member elsewhere, as far as the log is known.
    fn is_own(&self, member: MemberId) -> bool {
        let token = self.state.room().kept_place(member).map_or(0, |kept| kept.token);
        token == self.tokens.get(&member).copied().unwrap_or_default()
    }

    /// The members of this host are away, since it ends. If it is the sequencer, the log has that then.
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

impl PendingReturn {
    fn refuse(self, refusal: RoomRefusal) {
        if let Some(reply) = self.reply {
            _ = reply.send(Err(refusal));
        }
    }
}
