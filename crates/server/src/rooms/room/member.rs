//! Members of a room.

use serde::{Deserialize, Serialize};

use super::entry::MemberId;
use super::presence::KeptPlace;
use crate::sessions::line::Line;
use cellcaster::game::{Intent, Intents, Look, PlayerColor, PlayerId};

/// A member of a room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Member {
    pub(crate) id: MemberId,
    pub(crate) name: Line,
    /// The colour of the figure; two members may have the same.
    pub(crate) color: PlayerColor,
    /// The player in the game; `None` where there was no place.
    pub(crate) player: Option<PlayerId>,
    /// The points of the rounds before.
    pub(crate) points: u32,
    /// The place that is kept for the member; `None` if it is not.
    pub(crate) kept: Option<KeptPlace>,
    /// What the member wants in the next step.
    pub(crate) intents: Intents,
    /// What they wanted in the last one.
    pub(crate) acted: Intents,
    /// The step of the game in the picture that the member saw last.
    pub(crate) seen: u64,
}

impl Member {
    /// What the member wants in the step that begins. The angles of it count in no other step.
    pub(crate) fn begin_step(&mut self) -> Intents {
        self.acted = self.intents;
        self.intents = self.intents.with_look(Look::NONE);
        self.acted
    }
}

/// What of `intents` somebody may do who cannot walk.
pub(crate) fn looking_only(intents: Intents) -> Intents {
    use Intent::{Aim, LookAhead, LookDown, LookUp, TurnLeft, TurnRight};
    let looks = [Aim, LookAhead, LookDown, LookUp, TurnLeft, TurnRight];
    let kept: Intents = intents.iter().filter(|intent| looks.contains(intent)).collect();
    kept.with_look(intents.look())
}
