//! Modes: the kinds of game that a room can play, and their rules.

use serde::{Deserialize, Serialize};

use cellcaster::game::{MultiplayerRules, STEPS_PER_SECOND, ShownPlayers, StrikeEffect};
use cellcaster::world::World;

/// The number of steps per second.
pub(crate) const SECOND: u64 = STEPS_PER_SECOND as u64;

/// A kind of game that a room can play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Mode {
    /// Free roaming, without guards and without an end.
    Roam,
    /// A campaign level with its guards, played together.
    Together,
    /// A campaign level for one member, as at home. The result counts on the boards.
    Alone,
    /// A race: the first member at the exit wins.
    Race,
    /// Tag: the member who is "it" passes that role on by touching another member.
    Tag,
    /// Hide and seek: some members seek and the others hide. Found members become seekers.
    Hide,
}

impl Mode {
    /// All modes, in lobby order.
    pub(crate) const ALL: [Self; 6] =
        [Self::Roam, Self::Tag, Self::Hide, Self::Race, Self::Together, Self::Alone];

    /// The name used in logs and files.
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

    /// The mode with this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }

    /// The title in menus.
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

    /// A description in one line.
    pub(crate) const fn about(self) -> &'static str {
        match self {
            Self::Roam => "Walk around and talk. Nobody is in danger.",
            Self::Together => "Sneak past the guards together. The level ends when all are out.",
            Self::Alone => "Play a level alone. Your best result is listed on the board.",
            Self::Race => "The first at the exit wins. A ghost shows the best run.",
            Self::Tag => "Touch anybody to pass it on. The least time as \"it\" wins.",
            Self::Hide => "You have 20 seconds to hide. If found, you seek too. The last one wins.",
        }
    }

    /// The minimum number of members for a round.
    pub(crate) const fn fewest(self) -> usize {
        match self {
            Self::Roam | Self::Together | Self::Alone | Self::Race => 1,
            Self::Tag | Self::Hide => 2,
        }
    }

    /// The maximum number of members.
    pub(crate) const fn most(self) -> usize {
        match self {
            Self::Alone => 1,
            Self::Roam => 16,
            Self::Together | Self::Race | Self::Tag | Self::Hide => 8,
        }
    }

    /// Returns true if the mode has guards, which makes the difficulty matter.
    pub(crate) const fn has_guards(self) -> bool {
        matches!(self, Self::Together | Self::Alone)
    }

    /// Returns true if the best runs of the level walk along as ghosts.
    pub(crate) const fn has_ghosts(self) -> bool {
        matches!(self, Self::Race | Self::Alone)
    }

    /// The multiplayer rules of the mode.
    pub(crate) fn multiplayer_rules(self) -> MultiplayerRules {
        let usual = MultiplayerRules::default();
        match self {
            Self::Roam => MultiplayerRules { strikes: StrikeEffect::Push, ..usual },
            Self::Together | Self::Race => usual,
            Self::Alone => MultiplayerRules { respawns: false, ..usual },
            Self::Tag => MultiplayerRules { shows_on_map: ShownPlayers::InSight, ..usual },
            Self::Hide => MultiplayerRules { shows_on_map: ShownPlayers::Nobody, ..usual },
        }
    }

    /// The seed for the game's chance. A member who plays alone gets the seed that built-in levels use at
    /// home, so that a script has the same result in both places.
    pub(crate) const fn game_seed(self, of_room: u64) -> u64 {
        if matches!(self, Self::Alone) { 0 } else { of_room }
    }

    /// Adapts a level to the mode.
    pub(crate) fn prepared(self, world: World) -> World {
        match self {
            Self::Together | Self::Alone => world,
            Self::Race => world.without_guards(),
            Self::Roam | Self::Tag | Self::Hide => world.without_guards().without_exits(),
        }
    }

    /// Returns true if the next round is played in the next level.
    pub(crate) const fn moves_on(self) -> bool {
        matches!(self, Self::Together | Self::Alone | Self::Race)
    }

    /// The countdown before the play, in steps.
    pub(crate) const fn countdown(self) -> u64 {
        match self {
            Self::Roam | Self::Together | Self::Alone => 0,
            Self::Race | Self::Tag => 3 * SECOND,
            Self::Hide => 20 * SECOND,
        }
    }

    /// How long a round continues after the first member has reached the exit, in steps; `None` if the mode
    /// has no such limit.
    pub(crate) const fn after_first(self) -> Option<u64> {
        match self {
            Self::Race => Some(60 * SECOND),
            Self::Together => Some(120 * SECOND),
            Self::Roam | Self::Alone | Self::Tag | Self::Hide => None,
        }
    }

    /// The maximum length of the play, in steps.
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
