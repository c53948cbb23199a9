//! What guards are doing, as others see it.

use serde::{Deserialize, Serialize};

/// What a guard is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mood {
    /// Sleeps.
    Asleep,
    /// Stands, patrols or wanders.
    OnDuty,
    /// Has noticed something, and goes to see.
    Wondering,
    /// Looks for the player in the cells around.
    Searching,
    /// Follows the player.
    Chasing,
    /// Strikes or shoots.
    Attacking,
    /// Lies on the floor.
    Down,
    /// Goes back to duty.
    Returning,
}

/// How much the guards of a level know.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub enum Alarm {
    /// Nobody has noticed anything.
    #[default]
    Calm,
    /// Somebody wonders or searches.
    Wary,
    /// Somebody follows the player.
    Raised,
}

impl Mood {
    /// The alarm of a level in which a guard has this mood, and all others are on duty.
    pub(crate) const fn alarm(self) -> Alarm {
        match self {
            Self::Asleep | Self::OnDuty | Self::Down | Self::Returning => Alarm::Calm,
            Self::Wondering | Self::Searching => Alarm::Wary,
            Self::Chasing | Self::Attacking => Alarm::Raised,
        }
    }
}
