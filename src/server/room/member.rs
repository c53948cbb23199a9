//! Members of a room.

use super::entry::MemberId;
use crate::game::{Intents, PlayerColor, PlayerId};
use crate::server::line::Line;

/// A member of a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    pub(crate) id: MemberId,
    pub(crate) name: Line,
    /// The colour of the figure; two members may have the same.
    pub(crate) color: PlayerColor,
    /// The player in the game; `None` where there was no place.
    pub(crate) player: Option<PlayerId>,
    /// The points of the rounds before.
    pub(crate) points: u32,
    /// What the member wants in the next step.
    pub(super) intents: Intents,
    /// What they wanted in the last one.
    pub(super) acted: Intents,
    /// The step of the game in the picture that the member saw last.
    pub(super) seen: u64,
}
