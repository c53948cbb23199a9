//! Joining a room on this host, and members that the sequencer has removed.

use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::Instant;

use super::Replica;
use crate::server::cluster::peer_message::PeerMessage;
use crate::server::line::Line;
use crate::server::room::MemberId;
use crate::server::rooms::RoomRefusal;

/// A request to join.
pub(in crate::server::cluster) struct JoinRequest {
    pub(in crate::server::cluster) name: Line,
    pub(in crate::server::cluster) reply: oneshot::Sender<Result<MemberId, RoomRefusal>>,
}

/// A request to join that the sequencer has not answered.
pub(super) struct PendingJoin {
    token: u64,
    request: JoinRequest,
    since: Instant,
    last: Instant,
}

/// The time after which the request is sent again.
const AGAIN: Duration = Duration::from_millis(500);
/// The time after which the request fails. Another host takes over a room in less.
const PATIENCE: Duration = Duration::from_secs(8);

impl Replica {
    pub(super) async fn receive_join(&mut self, request: JoinRequest) {
        let (now, token) = (Instant::now(), self.context.chance());
        let name = request.name.clone();
        self.pending_joins.push(PendingJoin { token, request, since: now, last: now });
        self.request_join(token, &name, now).await;
    }

    /// Sends requests without an answer again, and fails those that are too old.
    pub(super) async fn repeat_joins(&mut self, now: Instant) {
        let is_late = |pending: &mut PendingJoin| now.duration_since(pending.since) >= PATIENCE;
        for late in self.pending_joins.extract_if(.., is_late) {
            _ = late.request.reply.send(Err(RoomRefusal::NotNow));
        }
        let is_due = |pending: &&mut PendingJoin| now.duration_since(pending.last) >= AGAIN;
        let due = self.pending_joins.iter_mut().filter(is_due).map(|pending| {
            pending.last = now;
            (pending.token, pending.request.name.clone())
        });
        for (token, name) in due.collect::<Vec<_>>() {
            self.request_join(token, &name, now).await;
        }
    }

    async fn request_join(&mut self, token: u64, name: &Line, now: Instant) {
        match &mut self.sequencer {
            Some(sequencer) => {
                if let Some(answer) = sequencer.request_join(token, name, now) {
                    self.answer(&answer);
                }
            }
            None => self.broadcast(&PeerMessage::Join(token, name.clone())).await,
        }
    }

    /// Passes on an answer of the sequencer, if the request was made here.
    pub(super) fn answer(&mut self, answer: &PeerMessage) {
        let (PeerMessage::Joined(token, ..) | PeerMessage::Full(token)) = answer else { return };
        let index = self.pending_joins.iter().position(|pending| pending.token == *token);
        let Some(index) = index else { return };
        let JoinRequest { reply, .. } = self.pending_joins.swap_remove(index).request;
        match *answer {
            PeerMessage::Joined(_, member, color) => {
                self.interface.inbox.admit(member, color);
                if reply.send(Ok(member)).is_err() {
                    self.interface.inbox.leave(member);
                }
            }
            _ => _ = reply.send(Err(RoomRefusal::Full)),
        }
    }

    /// Frees the seats of members whom the sequencer has removed, since this host did not claim them in time.
    pub(super) fn dismiss_removed(&self) {
        let room = self.state.room();
        for member in self.interface.inbox.seated() {
            let is_there = room.colors().any(|(other, _)| other == member);
            // The log has not let in numbers from the next one on yet.
            if !is_there && member < room.next_member() {
                self.interface.inbox.dismiss(member);
            }
        }
    }
}
