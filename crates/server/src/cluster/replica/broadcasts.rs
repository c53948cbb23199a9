//! What the replicas of a room tell each other.

use tokio::time::Instant;

use super::Replica;
use crate::cluster::peer_message::PeerMessage;

impl Replica {
    /// Handles a broadcast.
    pub(crate) async fn receive_broadcast(&mut self, bytes: &[u8]) {
        let now = Instant::now();
        let message = match PeerMessage::parse(bytes) {
            Ok(message) => message,
            Err(fault) => {
                return tracing::warn!(room = %self.id, "a broadcast that cannot be read: {fault:?}");
            }
        };
        match (message, &mut self.sequencer) {
            (PeerMessage::Appended(number, message), _) => {
                if !self.take(number, &message).await {
                    _ = self.read().await;
                }
            }
            (PeerMessage::Commands(commands), Some(sequencer)) => {
                for (member, command) in commands {
                    sequencer.command(member, command, now);
                }
            }
            (PeerMessage::Claim(members), Some(sequencer)) => {
                let answers = sequencer.claim(&members, now);
                self.send_answers(answers).await;
            }
            (PeerMessage::Join(token, is_kept, name), Some(sequencer)) => {
                if let Some(answer) = sequencer.request_join(token, &name, is_kept, now) {
                    self.broadcast(&answer).await;
                }
            }
            (PeerMessage::Return(token, member), Some(sequencer)) => {
                if let Some(answer) = sequencer.request_return(token, member, now) {
                    self.broadcast(&answer).await;
                }
            }
            // Nobody has to wait until the room is silent.
            (PeerMessage::Released, None) => self.times.leased = None,
            (
                answer @ (PeerMessage::Joined(..) | PeerMessage::Full(_) | PeerMessage::Taken(_)),
                _,
            ) => self.answer(&answer),
            (
                PeerMessage::Commands(_)
                | PeerMessage::Claim(_)
                | PeerMessage::Join(..)
                | PeerMessage::Return(..),
                None,
            )
            | (PeerMessage::Released, Some(_)) => {}
        }
    }

    /// Sends a message to the other hosts. One that is lost is sent again, or read in the log.
    pub(crate) async fn broadcast(&mut self, message: &PeerMessage) {
        _ = self.context.bus.broadcast(self.id, message.to_bytes()).await;
    }

    /// Passes on answers of the sequencer, on all hosts.
    pub(crate) async fn send_answers(&mut self, answers: Vec<PeerMessage>) {
        for answer in answers {
            self.answer(&answer);
            self.broadcast(&answer).await;
        }
    }

    /// Passes on an answer of the sequencer, if the request was made here.
    pub(crate) fn answer(&mut self, answer: &PeerMessage) {
        match *answer {
            PeerMessage::Joined(token, member, color) => self.admit(token, member, color),
            PeerMessage::Full(token) => self.refuse_join(token),
            PeerMessage::Taken(token) => self.refuse_return(token),
            _ => {}
        }
    }
}
