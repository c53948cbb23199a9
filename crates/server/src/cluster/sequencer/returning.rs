//! Requests to return to a member, who may have a host.
//!
//! - A member who is away has no host.
//! - A member whom no host has claimed for [`UNHEARD`] since the request has none, almost certainly: the log does not
//!   show yet that the host is gone. If there is one nevertheless, it sees that the token is not its own, and lets the
//!   member go.
//! - A member who is claimed has a host: nobody takes the place of a member who plays.

use std::time::Duration;

use tokio::time::Instant;

use super::ClusterSequencer;
use crate::cluster::peer_message::PeerMessage;
use crate::rooms::room::MemberId;

/// The time without a claim after which somebody returns to a member.
const UNHEARD: Duration = Duration::from_millis(2_500);
/// The most requests that are remembered.
const MOST_REQUESTS: usize = 64;

/// A request to return.
pub(crate) struct ReturnRequest {
    token: u64,
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
    /// Handles a request to return; returns the answer if it is refused. One that is granted is answered by the
    /// log.
    pub(crate) fn request_return(
        &mut self,
        token: u64,
        member: MemberId,
        now: Instant,
    ) -> Option<PeerMessage> {
        if !self.is_begun || self.is_alone {
            return None;
        }
        if let Some(known) = self.returning.iter().find(|it| it.token == token) {
            match known.decision {
                Decision::Refused => return Some(PeerMessage::Taken(token)),
                Decision::Open if now.duration_since(known.since) >= UNHEARD => {
                    self.take_back(token, member, now);
                }
                Decision::Open | Decision::Granted => {}
            }
            return None;
        }
        let decision = Decision::Open;
        self.returning.push_back(ReturnRequest { token, member, since: now, decision });
        if self.returning.len() > MOST_REQUESTS {
            self.returning.pop_front();
        }
        if self.away.contains(&member) {
            self.take_back(token, member, now);
        }
        None
    }

    /// Refuses the open requests to return to members who have a host; returns the answers.
    pub(crate) fn refuse_returns(&mut self, claimed: &[MemberId]) -> Vec<PeerMessage> {
        let is_refused =
            |it: &&mut ReturnRequest| it.decision == Decision::Open && claimed.contains(&it.member);
        let refused = self.returning.iter_mut().filter(is_refused).map(|request| {
            request.decision = Decision::Refused;
            PeerMessage::Taken(request.token)
        });
        refused.collect()
    }

    /// Grants the open request to return to a member who is away now.
    pub(crate) fn take_back_if_requested(&mut self, member: MemberId, now: Instant) {
        let is_open = |it: &&ReturnRequest| it.decision == Decision::Open && it.member == member;
        if let Some(token) = self.returning.iter().find(is_open).map(|request| request.token) {
            self.take_back(token, member, now);
        }
    }

    fn take_back(&mut self, token: u64, member: MemberId, now: Instant) {
        let is_here = self.away.remove(&member) || self.claimed.contains_key(&member);
        if !is_here {
            return;
        }
        self.claimed.insert(member, now);
        self.inbox.take_back(member, token);
        for request in self.returning.iter_mut().filter(|request| request.token == token) {
            request.decision = Decision::Granted;
        }
    }
}
