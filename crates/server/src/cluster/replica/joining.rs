//! Joining a room on this host.

use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::Instant;

use super::Replica;
use crate::cluster::peer_message::PeerMessage;
use crate::rooms::directory::RoomRefusal;
use crate::rooms::room::MemberId;
use crate::sessions::line::Line;
use cellcaster::game::PlayerColor;

/// A request to be a member.
pub(crate) struct JoinRequest {
    pub(crate) wish: Wish,
    pub(crate) reply: Reply,
}

/// Where the number of the member goes.
pub(crate) type Reply = oneshot::Sender<Result<MemberId, RoomRefusal>>;

/// Which member somebody wants to be.
#[derive(Clone, Debug)]
pub(crate) enum Wish {
    /// A new one.
    Join {
        name: Line,
        /// Whether the place is kept.
        is_kept: bool,
    },
    /// One who is away.
    Return(MemberId),
}

/// A request to join that the sequencer has not answered.
pub(crate) struct PendingJoin {
    token: u64,
    name: Line,
    is_kept: bool,
    reply: Reply,
    since: Instant,
    last: Instant,
}

/// The time after which the request is sent again.
pub(crate) const AGAIN: Duration = Duration::from_millis(500);
/// The time after which the request fails. Another host takes over a room in less.
pub(crate) const PATIENCE: Duration = Duration::from_secs(8);

impl Replica {
    pub(crate) async fn receive_join(&mut self, request: JoinRequest) {
        let (now, token) = (Instant::now(), self.context.chance());
        let JoinRequest { wish, reply } = request;
        let (name, is_kept) = match wish {
            Wish::Join { name, is_kept } => (name, is_kept),
            Wish::Return(member) => return self.receive_return(member, reply, now).await,
        };
        let sent = name.clone();
        let pending = PendingJoin { token, name, is_kept, reply, since: now, last: now };
        self.pending_joins.push(pending);
        self.request_join(token, &sent, is_kept, now).await;
    }

    /// Sends requests without an answer again, and fails those that are too old.
    pub(crate) async fn repeat_joins(&mut self, now: Instant) {
        let is_late = |pending: &mut PendingJoin| now.duration_since(pending.since) >= PATIENCE;
        for late in self.pending_joins.extract_if(.., is_late) {
            _ = late.reply.send(Err(RoomRefusal::NotNow));
        }
        let is_due = |pending: &&mut PendingJoin| now.duration_since(pending.last) >= AGAIN;
        let due = self.pending_joins.iter_mut().filter(is_due).map(|pending| {
            pending.last = now;
            (pending.token, pending.name.clone(), pending.is_kept)
        });
        for (token, name, is_kept) in due.collect::<Vec<_>>() {
            self.request_join(token, &name, is_kept, now).await;
        }
    }

    async fn request_join(&mut self, token: u64, name: &Line, is_kept: bool, now: Instant) {
        match &mut self.sequencer {
            Some(sequencer) => {
                if let Some(answer) = sequencer.request_join(token, name, is_kept, now) {
                    self.answer(&answer);
                }
            }
            None => self.broadcast(&PeerMessage::Join(token, is_kept, name.clone())).await,
        }
    }

    /// Lets in whoever has asked for it here, as a member.
    pub(crate) fn admit(&mut self, token: u64, member: MemberId, color: PlayerColor) {
        let Some(pending) = self.take_pending_join(token) else { return };
        self.interface.inbox.admit(member, color);
        if pending.reply.send(Ok(member)).is_err() {
            self.interface.inbox.leave(member);
        }
    }

    /// Refuses whoever has asked here, since the room is full.
    pub(crate) fn refuse_join(&mut self, token: u64) {
        if let Some(pending) = self.take_pending_join(token) {
            _ = pending.reply.send(Err(RoomRefusal::Full));
        }
    }

    fn take_pending_join(&mut self, token: u64) -> Option<PendingJoin> {
        let index = self.pending_joins.iter().position(|pending| pending.token == token)?;
        Some(self.pending_joins.swap_remove(index))
    }
}
