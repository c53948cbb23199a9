//! The rules of the game: a player walks through a world in fixed steps, takes what they find, opens
//! doors, avoids guards and reaches the exit.
//!
//! A step lasts [`STEP`] seconds and depends on the [`Intents`] only. The same level, [`Rules`] and
//! intents give the same states, bit for bit, on every machine. Steps as long as the last frame were
//! refused: a slow machine would play another game than a fast one, and no game could be repeated.
//!
//! A level without guards, mechanisms, hazards and finds is only walked through: nothing hurts in
//! it, the player has no tools, and it costs nothing that a mission would cost.

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
mod script;
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
use crate::world::World;
use checkpoint::Checkpoint;
use doors::Doors;
use guards::Guards;
use hazards::Spikes;
use mechanisms::Mechanisms;
use multiplayer::Members;
use player::{Player, RUN, STILL, Supplies, WALK};
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
    Input, MOST_LAG, MOST_PLAYERS, MultiplayerRules, PlayerId, Rules, STEP, STEPS_PER_SECOND, Sees,
    Strikes,
};
pub use script::{Header, LevelName, Recorder, Script, Section, Stretch};
pub use sound::{Heard, Sound, SoundKind, Source};
pub use stored::{RULES_VERSION, Unrestorable};
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
    /// Whether there is more in the world than walls, doors, keys and exits.
    is_mission: bool,
    /// The window of a generated level, of which `world` shows a part.
    window: Option<Window>,
    /// The player of a game for one; in a game for several, the one whose turn it is.
    player: Player,
    /// The players of a game for several.
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
    /// Grows with every visible change but those of the viewpoint and of figures.
    revision: u64,
    /// Grows with every change of figures.
    figure_revision: u64,
    /// See [`Game::work`].
    work: Scratch<u64>,
}

impl Game {
    /// More than [`Game::work`] is in any step on any map that is accepted: what a step can do in about
    /// a millisecond.
    #[doc(hidden)]
    pub const MOST_WORK: u64 = 1 << 20;

    /// A game at its start with the usual rules: the player stands still at the world's start.
    pub fn new(world: World) -> Self {
        Self::with_rules(world, Rules::default())
    }

    /// A game at its start with these rules.
    pub fn with_rules(world: World, rules: Rules) -> Self {
        Self::begun(world, rules, None)
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

    /// A game in a generated level, which starts at `site` or near it. `None` if there is nowhere
    /// to stand, such as outside the level.
    pub fn in_level(level: generate::Level, site: Site) -> Option<Self> {
        let (window, world) = Window::open(level, site)?;
        Some(Self::begun(world, Rules::default(), Some(window)))
    }

    /// A game in another world that continues this one: the player stands still at the same
    /// position with the same heading. If there is no room, or if the position is an exit, the
    /// player is at the world's start.
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
