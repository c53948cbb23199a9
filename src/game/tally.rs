//! The tally of a game, and the rank for it.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::Game;
use super::rules::STEPS_PER_SECOND;

/// A part of a total.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Share {
    /// The part that has been found.
    pub found: u32,
    /// The total.
    pub total: u32,
}

impl Share {
    /// Whether everything has been found.
    pub fn is_all(self) -> bool {
        self.found >= self.total
    }
}

/// A player's results in a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct Tally {
    /// The time in steps.
    pub steps: u64,
    /// The value of the treasure.
    pub treasure: Share,
    /// The number of secret walls.
    pub secrets: Share,
    /// The number of times that guards have begun to follow the player.
    pub alarms: u32,
    /// The number of times that the player has died.
    pub deaths: u32,
    /// The number of guards that the player has stunned.
    pub stunned: u32,
    /// The number of times that the player has taken time back. A game does not count that: the
    /// script of the run does.
    #[serde(default)]
    pub taken_back: u32,
}

/// A rank for a level, from the worst to the best.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Rank {
    /// The player reached the exit.
    Burglar,
    /// Within the par time, or with at most two alarms.
    Thief,
    /// Without an alarm, and within the par time or with all treasure.
    Shadow,
    /// Without an alarm, with all treasure, and nobody stunned.
    Ghost,
}

impl Tally {
    /// The rank for a game that was won, in a level with a par time of `par` seconds, if any.
    pub fn rank(&self, par: Option<u32>) -> Rank {
        let most = |seconds: u32| u64::from(seconds) * u64::from(STEPS_PER_SECOND);
        let is_fast = par.is_some_and(|seconds| self.steps <= most(seconds));
        let has_all = self.treasure.is_all();
        match (self.alarms, self.stunned) {
            (0, 0) if has_all => Rank::Ghost,
            (0, _) if is_fast || has_all => Rank::Shadow,
            (0..=2, _) => Rank::Thief,
            _ if is_fast => Rank::Thief,
            _ => Rank::Burglar,
        }
    }
}

impl Rank {
    /// All ranks, from the worst.
    pub const ALL: [Self; 4] = [Self::Burglar, Self::Thief, Self::Shadow, Self::Ghost];

    /// The name on the screen and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Burglar => "Burglar",
            Self::Thief => "Thief",
            Self::Shadow => "Shadow",
            Self::Ghost => "Ghost",
        }
    }

    /// The rank with that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rank| rank.name() == name)
    }
}

impl fmt::Display for Rank {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Counts that a retry does not reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct RunCounts {
    pub(crate) alarms: u32,
    pub(crate) deaths: u32,
    pub(crate) stunned: u32,
}

impl Game {
    /// The value of the treasure: the part found by all players, and the total in the level.
    pub fn treasure(&self) -> Share {
        let found = self.treasure_found();
        let left = u32::try_from(self.world.treasure()).unwrap_or(u32::MAX);
        Share { found, total: found.saturating_add(left) }
    }

    /// The secret walls: the number found, and the total in the level.
    pub fn secrets(&self) -> Share {
        self.mechanisms.secrets
    }

    /// The player's current results.
    pub fn tally(&self) -> Tally {
        let RunCounts { alarms, deaths, stunned } = self.player.counts;
        let (treasure, secrets) = (self.treasure(), self.secrets());
        Tally { steps: self.steps, treasure, secrets, alarms, deaths, stunned, taken_back: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_result_has_a_rank() {
        let all = Share { found: 50, total: 50 };
        let some = Share { found: 10, total: 50 };
        let tally = |steps, treasure, alarms, stunned| {
            Tally { steps, treasure, alarms, stunned, ..Tally::default() }.rank(Some(10))
        };
        assert_eq!(tally(9999, all, 0, 0), Rank::Ghost);
        assert_eq!(tally(9999, all, 0, 1), Rank::Shadow);
        assert_eq!(tally(600, some, 0, 3), Rank::Shadow);
        assert_eq!(tally(601, some, 0, 0), Rank::Thief);
        assert_eq!(tally(600, some, 9, 0), Rank::Thief);
        assert_eq!(tally(601, all, 2, 0), Rank::Thief);
        assert_eq!(tally(601, all, 3, 0), Rank::Burglar);
        assert_eq!(Tally { treasure: some, ..Tally::default() }.rank(None), Rank::Thief);
        assert!(
            Rank::ALL.is_sorted()
                && Rank::ALL.map(|rank| Rank::named(rank.name()).unwrap()) == Rank::ALL
        );
    }
}
