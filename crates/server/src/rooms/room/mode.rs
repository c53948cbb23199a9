//! Modes: the games that can be played in a room, and their rules.

use serde::{Deserialize, Serialize};

use cellcaster::game::{MultiplayerRules, STEPS_PER_SECOND, Sees, Strikes};
use cellcaster::world::World;

/// Steps of a game in a second.
pub(crate) const SECOND: u64 = STEPS_PER_SECOND as u64;

/// A game that can be played in a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Mode {
    /// Walking about, without guards and without an end.
    Roam,
    /// A level of the campaign with its guards, for all together.
    Together,
    /// A level of the campaign for one member, as at home: the result counts on the boards.
    Alone,
    /// The first at the exit wins.
    Race,
    /// Whoever is "it" touches another one, who then is.
    Tag,
    /// Some seek, the others hide; the found ones seek, too.
    Hide,
}

impl Mode {
    /// All of them, in the order of the lobby.
    pub(crate) const ALL: [Self; 6] =
        [Self::Roam, Self::Tag, Self::Hide, Self::Race, Self::Together, Self::Alone];

    /// The name in logs and files.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Roam => "roam",
            Self::Together => "together",
            Self::Alone => "alone",
            Self::Race => "race",
            Self::Tag => "tag",
            Self::Hide => "hide",
        }
    }

    /// The mode with that name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }

    /// The name in menus.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Roam => "Roam",
            Self::Together => "Campaign together",
            Self::Alone => "Alone, for the board",
            Self::Race => "Race",
            Self::Tag => "Tag",
            Self::Hide => "Hide and seek",
        }
    }

    /// A description, in a line.
    pub(crate) const fn about(self) -> &'static str {
        match self {
            Self::Roam => "Walk about and talk. Nobody is in danger.",
            Self::Together => "Steal past the guards together; the level is done when all are out.",
            Self::Alone => "A level as at home. Your best result stands on the board.",
            Self::Race => "The first at the exit wins. The best run so far walks along.",
            Self::Tag => "Touch another one to be rid of it. Who was it least wins.",
            Self::Hide => "Hide for 20 seconds. Who is found seeks, too; the last one wins.",
        }
    }

    /// The fewest members of a round.
    pub(crate) const fn fewest(self) -> usize {
        match self {
            Self::Roam | Self::Together | Self::Alone | Self::Race => 1,
            Self::Tag | Self::Hide => 2,
        }
    }

    /// The most members.
    pub(crate) const fn most(self) -> usize {
        match self {
            Self::Alone => 1,
            Self::Roam => 16,
            Self::Together | Self::Race | Self::Tag | Self::Hide => 8,
        }
    }

    /// Whether there are guards, so that the difficulty matters.
    pub(crate) const fn has_guards(self) -> bool {
        matches!(self, Self::Together | Self::Alone)
    }

    /// Whether the best runs of the level walk along.
    pub(crate) const fn has_ghosts(self) -> bool {
        matches!(self, Self::Race | Self::Alone)
    }

    /// The rules among the players.
    pub(crate) fn multiplayer_rules(self) -> MultiplayerRules {
        let usual = MultiplayerRules::default();
        match self {
            Self::Roam => MultiplayerRules { strikes: Strikes::Push, ..usual },
            Self::Together | Self::Race => usual,
            Self::Alone => MultiplayerRules { respawns: false, ..usual },
            Self::Tag => MultiplayerRules { sees: Sees::InSight, ..usual },
            Self::Hide => MultiplayerRules { sees: Sees::Nobody, ..usual },
        }
    }

    /// The seed of the game's chance. Alone, it is the seed of the built-in levels at home, so that the same script
    /// gives the same result there.
    pub(crate) const fn game_seed(self, of_room: u64) -> u64 {
        if matches!(self, Self::Alone) { 0 } else { of_room }
    }

    /// The level as the mode needs it.
    pub(crate) fn prepared(self, world: World) -> World {
        match self {
            Self::Together | Self::Alone => world,
            Self::Race => world.without_guards(),
            Self::Roam | Self::Tag | Self::Hide => world.without_guards().without_exits(),
        }
    }

    /// Whether the next round is in the next level.
    pub(crate) const fn moves_on(self) -> bool {
        matches!(self, Self::Together | Self::Alone | Self::Race)
    }

    /// The time between the start of a round and its play, in steps.
    pub(crate) const fn countdown(self) -> u64 {
        match self {
            Self::Roam | Self::Together | Self::Alone => 0,
            Self::Race | Self::Tag => 3 * SECOND,
            Self::Hide => 20 * SECOND,
        }
    }

    /// How long a round goes on after the first member has reached the exit, in steps; `None` if it does not.
    pub(crate) const fn after_first(self) -> Option<u64> {
        match self {
            Self::Race => Some(60 * SECOND),
            Self::Together => Some(120 * SECOND),
            Self::Roam | Self::Alone | Self::Tag | Self::Hide => None,
        }
    }

    /// The longest play of a round, in steps.
    pub(crate) const fn longest(self) -> u64 {
        match self {
            Self::Roam => 60 * 60 * SECOND,
            Self::Together | Self::Alone => 20 * 60 * SECOND,
            Self::Race => 10 * 60 * SECOND,
            Self::Tag => 3 * 60 * SECOND,
            Self::Hide => 4 * 60 * SECOND,
        }
    }
}
