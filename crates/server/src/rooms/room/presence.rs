//! Who is in a room: members join, are away while their host is gone, return, and leave.
//!
//! A member with an account may return from another host. So their place is kept: when their host is gone they
//! stand still, for [`AWAY`] at most. A return has a token, by which hosts know who plays for the member now: a
//! host that was cut off may still take itself for it.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Room;
use super::entry::MemberId;
use super::header::Seat;
use super::member::Member;
use super::round::SECOND;
use crate::sessions::line::Line;
use cellcaster::game::stored::bits;
use cellcaster::game::{Intents, PlayerColor};

/// The longest time for which a member is away, in steps. Then they leave.
pub(crate) const AWAY: u64 = 60 * SECOND;

/// The place that is kept for a member with an account.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct KeptPlace {
    /// The token of the last return; 0 before the first one.
    #[serde(with = "bits")]
    pub(crate) token: u64,
    /// The steps until the member leaves, if they are away.
    pub(crate) away: Option<u64>,
}

impl KeptPlace {
    /// Whether such a place may be kept: nobody has more time to return than those who have just gone.
    pub(crate) fn is_possible(self) -> bool {
        self.away.is_none_or(|left| (1..=AWAY).contains(&left))
    }
}

impl Room {
    /// Whether a member is away.
    pub(crate) fn is_away(&self, id: MemberId) -> bool {
        self.kept_place(id).is_some_and(|kept| kept.away.is_some())
    }

    /// The place that is kept for a member; `None` if it is not.
    pub(crate) fn kept_place(&self, id: MemberId) -> Option<KeptPlace> {
        self.members.iter().find(|member| member.id == id)?.kept
    }

    /// Whether a member has been in the room, and is not any more.
    pub(crate) fn has_lost(&self, id: MemberId) -> bool {
        id < self.next_member() && !self.members.iter().any(|member| member.id == id)
    }

    pub(crate) fn join(&mut self, id: MemberId, color: PlayerColor, name: &Line) {
        if self.is_full() || self.members.iter().any(|member| member.id == id) {
            return;
        }
        self.next_member = self.next_member.max(id.0.saturating_add(1));
        self.seat(&Seat { id, color, points: 0, name: name.clone(), kept: None });
        self.announce(format!("{name} comes in."));
    }

    pub(crate) fn seat(&mut self, seat: &Seat) {
        let game = Arc::make_mut(&mut self.game);
        let player = game.join(seat.color);
        self.members.push(Member {
            id: seat.id,
            name: seat.name.clone(),
            color: seat.color,
            player,
            points: seat.points,
            kept: seat.kept,
            intents: Intents::new(),
            acted: Intents::new(),
            seen: game.steps(),
        });
    }

    pub(crate) fn leave(&mut self, id: MemberId) {
        let Some(index) = self.members.iter().position(|member| member.id == id) else { return };
        let member = self.members.remove(index);
        self.again.remove(&id);
        if let Some(player) = member.player {
            Arc::make_mut(&mut self.game).leave(player);
        }
        self.announce(format!("{} leaves.", member.name));
    }

    /// From now on, the place of a member is kept.
    pub(crate) fn keep(&mut self, id: MemberId) {
        if let Some(member) = self.member_mut(id) {
            member.kept.get_or_insert_default();
        }
    }

    /// The host of a member is gone. They leave if their place is not kept.
    pub(crate) fn go_away(&mut self, id: MemberId) {
        let Some(member) = self.member_mut(id) else { return };
        let Some(kept) = &mut member.kept else { return self.leave(id) };
        if kept.away.is_none() {
            kept.away = Some(AWAY);
            member.intents = Intents::new();
            let line = format!("{} is away.", member.name);
            self.again.remove(&id);
            self.announce(line);
        }
    }

    /// A member is on another host now.
    pub(crate) fn take_back(&mut self, id: MemberId, token: u64) {
        let Some(member) = self.member_mut(id) else { return };
        let Some(kept) = &mut member.kept else { return };
        kept.token = token;
        if kept.away.take().is_some() {
            let line = format!("{} is back.", member.name);
            self.announce(line);
        }
    }

    /// Counts a step for those who are away. Who has been for too long leaves.
    pub(crate) fn count_away(&mut self) {
        let kept = self.members.iter_mut().filter_map(|member| member.kept.as_mut());
        for left in kept.filter_map(|kept| kept.away.as_mut()) {
            *left = left.saturating_sub(1);
        }
        let is_late = |member: &Member| member.kept.is_some_and(|kept| kept.away == Some(0));
        while let Some(id) = self.members.iter().find(|it| is_late(it)).map(|member| member.id) {
            self.leave(id);
        }
    }

    pub(crate) fn member_mut(&mut self, id: MemberId) -> Option<&mut Member> {
        self.members.iter_mut().find(|member| member.id == id)
    }
}

#[cfg(test)]
mod tests;
