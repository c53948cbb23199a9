//! Members whose host ends, and who return from another one, in the rooms of a cluster.

use super::Inbox;
use crate::lock::locked;
use crate::rooms::room::{Command, MemberId};

impl Inbox {
    /// The number of a member's seat, which no other seat ever has; `None` if they have none.
    pub(crate) fn seat_number(&self, id: MemberId) -> Option<u64> {
        locked(&self.waiting, |waiting| {
            waiting.seats.iter().find(|seat| seat.id == id).map(|seat| seat.number)
        })
    }

    /// Whether somebody is about to come or go.
    pub(crate) fn has_moves(&self) -> bool {
        locked(&self.waiting, |waiting| !waiting.moves.is_empty())
    }

    /// A member has no host any more: they lose their seat here, and the room keeps their place.
    pub(crate) fn part(&self, id: MemberId) {
        locked(&self.waiting, |waiting| {
            let count = waiting.seats.len();
            waiting.seats.retain(|seat| seat.id != id);
            if waiting.seats.len() < count {
                waiting.moves.push_back((id, Command::Away));
            }
        });
    }

    /// A member is away from now on. They have their seat until the room does not have them any more.
    pub(crate) fn set_away(&self, id: MemberId) {
        locked(&self.waiting, |waiting| {
            if let Some(seat) = waiting.seats.iter_mut().find(|seat| seat.id == id) {
                seat.intents.clear();
                seat.talk.clear();
            }
            waiting.moves.push_back((id, Command::Away));
        });
    }

    /// The place of a member who has just joined is kept.
    pub(crate) fn keep(&self, id: MemberId) {
        locked(&self.waiting, |waiting| waiting.moves.push_back((id, Command::Keep)));
    }

    /// A member is on another host from now on.
    pub(crate) fn take_back(&self, id: MemberId, token: u64) {
        locked(&self.waiting, |waiting| waiting.moves.push_back((id, Command::Return { token })));
    }
}
