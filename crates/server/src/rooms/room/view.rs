//! Snapshots of a room, from which sessions draw.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::entry::{Emote, MemberId};
use super::header::Header;
use super::round::{Finish, Phase, Role, Standing};
use crate::sessions::line::Line;
use cellcaster::game::{Game, Intents, PlayerColor, PlayerId};

/// An immutable snapshot of a room. It shares the game with the room, which copies it only if a
/// snapshot still exists in the next step.
#[derive(Clone, Debug)]
pub(crate) struct RoomView {
    /// The game of the present round.
    pub(crate) game: Arc<Game>,
    /// The state at the start of the round: the level, the mode, and its number.
    pub(crate) header: Arc<Header>,
    /// The step of the round.
    pub(crate) step: u64,
    /// The phase of the round.
    pub(crate) phase: Phase,
    /// The step in which the play began, while it goes on in a mode that ends at the exit.
    pub(crate) begun: Option<u64>,
    /// The members, in the order in which they joined.
    pub(crate) members: Vec<MemberView>,
    /// What each of them wanted in the last step, which no picture shows by itself.
    pub(crate) acted: Vec<Intents>,
    /// The standings of the round, the winner first; empty before its end.
    pub(crate) standings: Arc<[Standing]>,
    /// What was said last, the newest last.
    pub(crate) said: Arc<[Said]>,
}

/// What all know of a member.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MemberView {
    pub(crate) id: MemberId,
    pub(crate) name: Line,
    pub(crate) color: PlayerColor,
    /// The player in the game; `None` where there was no place.
    pub(crate) player: Option<PlayerId>,
    pub(crate) role: Role,
    /// The finish, if the member has reached the exit.
    pub(crate) finish: Option<Finish>,
    pub(crate) points: u32,
    /// Whether the member sees nothing at present, since the others hide.
    pub(crate) is_blind: bool,
    /// The latest emotion, for as long as it is shown.
    pub(crate) emote: Option<Emote>,
    /// Whether their host is gone, so that they stand still.
    pub(crate) is_away: bool,
}

/// Something that was said to all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Said {
    /// The number in the room, from 1, so that a session knows what is new.
    pub(crate) number: u64,
    /// Who said it; `None` for the room itself.
    pub(crate) by: Option<(Line, PlayerColor)>,
    pub(crate) text: String,
}

impl RoomView {
    /// A member.
    pub(crate) fn member(&self, id: MemberId) -> Option<&MemberView> {
        self.members.iter().find(|member| member.id == id)
    }

    /// What a member wanted in the last step.
    pub(crate) fn acted(&self, id: MemberId) -> Option<Intents> {
        let index = self.members.iter().position(|member| member.id == id)?;
        self.acted.get(index).copied()
    }

    /// The winner, if the round has ended with one who is still there.
    pub(crate) fn winner(&self) -> Option<&MemberView> {
        let first = self.standings.first().filter(|standing| standing.steps.is_some());
        self.member(first?.member)
    }

    /// The member whose player that is.
    pub(crate) fn member_of(&self, player: PlayerId) -> Option<&MemberView> {
        self.members.iter().find(|member| member.player == Some(player))
    }
}
