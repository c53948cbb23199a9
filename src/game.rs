//! The rules of the game: a player walks through a world in fixed steps, picks things up, opens
//! doors, avoids guards and reaches the exit.
//!
//! A step lasts [`STEP`] seconds and depends only on the [`Intents`]. The same level, [`Rules`] and
//! intents produce the same states, bit for bit, on every machine. Rejected: steps as long as the
//! last frame. A slow machine would play a different game from a fast one, and no game could be
//! replayed.
//!
//! In a level without guards, mechanisms, hazards and pickups, the player only walks. Nothing hurts
//! them, they have no tools, and the level pays nothing for the features of a mission.

mod checkpoint;
mod collision;
mod distances;
mod doors;
mod exits;
mod fall;
mod flight;
mod guards;
mod hazards;
mod health;
mod intent;
mod locks;
mod mechanisms;
mod multiplayer;
mod noise;
mod pickups;
mod player;
mod report;
mod rest;
mod rules;
mod scratch;
pub(crate) mod script;
mod show;
mod sight;
mod sound;
mod stance;
mod state;
mod step;
pub mod stored;
mod tally;
mod tools;
mod turning;

use crate::generate::{self, Site, Window};
use crate::world::{Start, World};
use checkpoint::Checkpoint;
use doors::Doors;
use guards::Guards;
use hazards::Spikes;
use mechanisms::Mechanisms;
use multiplayer::Members;
use player::{Motion, Player, RUN, STILL, Supplies, WALK};
use scratch::Scratch;
use show::Sprites;
use tools::{Missiles, Smoke};

pub use crate::world::sprite::builtin::PlayerColor;
pub use exits::is_exit_out_of_reach;
pub use flight::Flight;
pub use guards::{Alarm, GuardView, Mood};
pub use health::{Flash, FlashKind, Health};
pub use intent::{Intent, Intents, Look};
pub use multiplayer::view::{OtherPlayer, PlayerView};
pub use player::FRICTION;
pub use report::Outcome;
pub use rules::{
    Input, MAX_LAG, MAX_PLAYERS, MultiplayerRules, PlayerId, Rules, STEP, STEPS_PER_SECOND,
    ShownPlayers, StrikeEffect,
};
pub use script::{Header, LevelName, Script, ScriptWriter, Section, Stretch};
pub use sight::SightCone;
pub use sound::{Heard, Sound, SoundKind, Source};
pub use stored::{RULES_VERSION, RestoreError};
pub use tally::{Rank, Share, Tally};

/// A world, a player in it, and the time since the start.
///
/// ```
/// use cellcaster::game::{Game, Intent};
/// use cellcaster::map::builtin;
/// use cellcaster::world::FieldOfView;
///
/// let mut game = Game::new(builtin::LEVELS[0].world()?);
/// let start = game.camera(FieldOfView::default()).position();
/// for _ in 0..60 {
///     game.step([Intent::Forward].into_iter().collect());
/// }
/// assert_eq!(game.elapsed(), 1.0);
/// assert!(game.camera(FieldOfView::default()).position().x > start.x + 2.0);
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Game {
    rules: Rules,
    world: World,
    /// Whether the world contains more than walls, doors, keys and exits.
    is_mission: bool,
    /// The window of a generated level. `world` is the part of the level in this window.
    window: Option<Window>,
    /// The player. In a multiplayer game, the current player, whose turn it is.
    player: Player,
    /// The players of a multiplayer game.
    members: Option<Box<Members>>,
    doors: Doors,
    mechanisms: Mechanisms,
    spikes: Spikes,
    missiles: Missiles,
    smoke: Smoke,
    guards: Guards,
    sprites: Sprites,
    /// The sounds of the current step; empty between steps.
    sounds: Vec<Sound>,
    checkpoint: Checkpoint,
    steps: u64,
    /// Incremented by every visible change except changes of the viewpoint and of figures.
    revision: u64,
    /// Incremented by every change of figures.
    figure_revision: u64,
    /// See [`Game::work`].
    work: Scratch<u64>,
}

impl Game {
    /// An upper bound on [`Game::work`] for any step on any accepted map. A step does about this
    /// much work in a millisecond.
    #[doc(hidden)]
    pub const MAX_WORK: u64 = 1 << 20;

    /// A game at its start with the default rules. The player stands still at the world's start.
    pub fn new(world: World) -> Self {
        Self::with_rules(world, Rules::default())
    }

    /// A game at its start with these rules.
    pub fn with_rules(world: World, rules: Rules) -> Self {
        Self::begun(world, rules, None)
    }

    /// A game that starts at another place of `world`. `None` if the player has no room to stand there.
    pub fn starting_at(world: World, start: Start) -> Option<Self> {
        world.tile_in(start.cell)?;
        let world = world.starting_at(start);
        Motion::new(&world).placed_in(&world)?;
        Some(Self::new(world))
    }

    /// A game at its start, with the window of a generated level.
    fn begun(mut world: World, rules: Rules, window: Option<Window>) -> Self {
        let is_mission = world.is_mission();
        let guards = Guards::new(&mut world, rules);
        let supplies = if is_mission { Supplies::AT_START } else { Supplies::default() };
        let game = Self {
            rules,
            is_mission,
            window,
            player: Player::new(&world, supplies),
            members: None,
            doors: Doors::default(),
            mechanisms: Mechanisms::new(&world),
            spikes: Spikes::new(&mut world),
            missiles: Missiles::default(),
            smoke: Smoke::default(),
            guards,
            sprites: if is_mission { Sprites::added_to(&mut world) } else { Sprites::default() },
            sounds: Vec::new(),
            checkpoint: Checkpoint::default(),
            steps: 0,
            revision: 0,
            figure_revision: 0,
            work: Scratch::default(),
            world,
        };
        game.shown().with_start()
    }

    /// A game in a generated level, which starts at `site` or near it. `None` if the player can
    /// stand nowhere there, for example outside the level.
    pub fn in_level(level: generate::GeneratedLevel, site: Site) -> Option<Self> {
        let (window, world) = Window::open(level, site)?;
        Some(Self::begun(world, Rules::default(), Some(window)))
    }

    /// A game in another world that continues this one. The player stands still at the same
    /// position with the same heading. If there is no room, or if the position is an exit, the
    /// player stands at the world's start.
    #[must_use]
    pub fn begun_again_in(&self, world: World) -> Self {
        let motion = self.player.motion.placed_in(&world);
        let begun = Self::with_rules(world, self.rules);
        let placed = motion.map(|motion| {
            let player = begun.player.clone().at(motion);
            Self { player, ..begun.clone() }
        });
        match placed {
            Some(game) if !game.is_finished() => game,
            _ => begun,
        }
    }
}

#[cfg(test)]
mod tests;
