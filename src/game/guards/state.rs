//! What a guard is doing, and what they know.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Mood;
use crate::world::Cell;

/// What a guard is doing. Times are in steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum State {
    Asleep,
    OnDuty,
    /// Looks towards a place for some time, and then goes there if it `goes`.
    Wondering {
        about: DVec2,
        looks: u16,
        goes: bool,
        hurries: bool,
        wakes: Option<usize>,
    },
    /// Visits cells around a place.
    Searching {
        around: Cell,
        next: Option<Cell>,
        left: u16,
    },
    /// Follows the trail of a player, up to now to the mark with that number.
    Tracking {
        target: usize,
        mark: u64,
        lost: u16,
    },
    /// Follows a player, after the time of the fright.
    Chasing {
        fright: u16,
    },
    Attacking {
        phase: Phase,
        left: u16,
    },
    Down {
        left: u16,
    },
    Returning,
}

/// The parts of a blow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// The warning.
    Windup,
    /// The blow; whether it has hit.
    Strike { has_hit: bool },
    /// The rest after it.
    Recovery,
}

/// What a guard knows about the player whom they look for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Quarry {
    /// The index of the player.
    pub(crate) target: usize,
    /// Where the player was last perceived.
    pub(crate) position: DVec2,
    /// The steps since then.
    pub(crate) unseen: u16,
}

impl State {
    pub(crate) fn mood(self) -> Mood {
        match self {
            Self::Asleep => Mood::Asleep,
            Self::OnDuty => Mood::OnDuty,
            Self::Wondering { .. } => Mood::Wondering,
            Self::Searching { .. } | Self::Tracking { .. } => Mood::Searching,
            Self::Chasing { .. } => Mood::Chasing,
            Self::Attacking { .. } => Mood::Attacking,
            Self::Down { .. } => Mood::Down,
            Self::Returning => Mood::Returning,
        }
    }

    pub(crate) fn is_down(self) -> bool {
        matches!(self, Self::Down { .. })
    }

    /// Whether the guard follows or strikes a player.
    pub(crate) fn is_alarmed(self) -> bool {
        matches!(self, Self::Chasing { .. } | Self::Attacking { .. })
    }
}
