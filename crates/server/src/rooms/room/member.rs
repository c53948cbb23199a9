//! Members of a room.

use std::fmt;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::mode::SECOND;
use crate::line::Line;
use cellcaster::game::stored::bits;
use cellcaster::game::{Intent, Intents, Look, PlayerColor, PlayerId};

/// The widest name, in columns.
pub(crate) const NAME_COLUMNS: usize = 16;
/// How long a member may be away before they leave, in steps.
pub(crate) const AWAY: u64 = 60 * SECOND;

/// A member's number in a room. It is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "u32")]
pub(crate) struct MemberId(pub(crate) u32);

/// A member of a room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Member {
    pub(crate) id: MemberId,
    #[serde(deserialize_with = "line_within::<NAME_COLUMNS, _>")]
    pub(crate) name: Line,
    /// The colour of the figure. Two members may share a colour.
    pub(crate) color: PlayerColor,
    /// The member's player in the game; `None` if the game had no free slot.
    pub(crate) player: Option<PlayerId>,
    /// The points from earlier rounds.
    pub(crate) points: u32,
    /// The seat that is kept for the member; `None` for a guest.
    pub(crate) kept: Option<KeptPlace>,
    /// The intents for the next step.
    pub(crate) intents: Intents,
    /// The intents of the last step.
    pub(crate) acted: Intents,
    /// The step of the game in the last frame that the member saw.
    pub(crate) seen: u64,
}

/// The seat that is kept for a member with an account.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct KeptPlace {
    /// The token of the latest return; 0 before the first.
    #[serde(with = "bits")]
    pub(crate) token: u64,
    /// The number of steps until the member leaves, if they are away.
    pub(crate) away: Option<u64>,
}

impl MemberId {
    /// The greatest number. A room that somebody joins every second would reach it after 68 years.
    pub(crate) const MAX: Self = Self(i32::MAX as u32);

    /// Parses a number; `None` if it is too large.
    pub(crate) fn parse(word: &str) -> Option<Self> {
        Self::try_from(word.parse::<u32>().ok()?).ok()
    }
}

impl TryFrom<u32> for MemberId {
    type Error = &'static str;

    fn try_from(number: u32) -> Result<Self, &'static str> {
        if number <= Self::MAX.0 { Ok(Self(number)) } else { Err("a member") }
    }
}

impl fmt::Display for MemberId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl KeptPlace {
    /// Returns true if this state is possible: a member who is away has at least one step left, and at most [`AWAY`].
    pub(crate) fn is_possible(self) -> bool {
        self.away.is_none_or(|left| (1..=AWAY).contains(&left))
    }
}

impl Member {
    /// Returns true if the member's host is gone. The member stands still meanwhile.
    pub(crate) fn is_away(&self) -> bool {
        self.kept.is_some_and(|kept| kept.away.is_some())
    }

    /// The intents for the step that begins. Their angles apply in this step only.
    pub(crate) fn begin_step(&mut self) -> Intents {
        self.acted = self.intents;
        self.intents = self.intents.with_look(Look::NONE);
        self.acted
    }
}

/// The part of `intents` that a player who cannot walk may still carry out.
pub(crate) fn looking_only(intents: Intents) -> Intents {
    use Intent::{Aim, LookAhead, LookDown, LookUp, TurnLeft, TurnRight};
    let looks = [Aim, LookAhead, LookDown, LookUp, TurnLeft, TurnRight];
    let kept: Intents = intents.iter().filter(|intent| looks.contains(intent)).collect();
    kept.with_look(intents.look())
}

/// Deserializes a line of at most `COLUMNS` columns, for `#[serde(deserialize_with)]`.
pub(crate) fn line_within<'de, const COLUMNS: usize, D>(from: D) -> Result<Line, D::Error>
where
    D: Deserializer<'de>,
{
    let line = Line::deserialize(from)?;
    if line.fits(COLUMNS) { Ok(line) } else { Err(D::Error::custom("a line is too wide")) }
}
