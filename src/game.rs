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
mod checksum;
mod collision;
mod doors;
mod encounter;
mod exits;
mod fall;
mod flight;
mod flood;
mod guards;
mod hazards;
mod health;
mod intent;
mod locks;
mod look;
mod mechanisms;
mod noise;
mod notice;
mod pickups;
mod pitch_control;
mod player;
mod report;
mod rest;
mod rules;
mod script;
mod show;
mod sound;
mod stance;
mod tally;
mod tools;
mod turning;

use crate::generate::{self, Site, Window};
use crate::world::World;
use checkpoint::Checkpoint;
use doors::Doors;
use guards::Guards;
use hazards::Spikes;
use health::Cause;
use mechanisms::Mechanisms;
use player::{FRICTION, Player, RUN, STILL, WALK};
use show::Sprites;
use tally::Counts;
use tools::{Missiles, Smoke, Supplies};

pub use exits::is_exit_out_of_reach;
pub use flight::Flight;
pub use guards::{Alarm, GuardView, Mood};
pub use health::{Flash, FlashKind, Health};
pub use intent::{Intent, Intents};
pub use look::Look;
pub use report::Outcome;
pub use rules::Rules;
pub use script::{Header, LevelName, Recorder, Script, Section, Stretch};
pub use sound::{Heard, Sound, SoundKind, Source};
pub use tally::{Rank, Share, Tally};

/// The duration of a step, in seconds.
pub const STEP: f64 = 1.0 / STEPS_PER_SECOND as f64;

pub(crate) const STEPS_PER_SECOND: u32 = 60;

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
    player: Player,
    /// What has killed the player, if something has.
    killed_by: Option<Cause>,
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
    counts: Counts,
    steps: u64,
    revision: u64,
}

impl Game {
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
            killed_by: None,
            doors: Doors::default(),
            mechanisms: Mechanisms::new(&world),
            spikes: Spikes::new(&mut world),
            missiles: Missiles::default(),
            smoke: Smoke::default(),
            guards,
            sprites: if is_mission { Sprites::added_to(&mut world) } else { Sprites::default() },
            sounds: Vec::new(),
            checkpoint: Checkpoint::default(),
            counts: Counts::default(),
            steps: 0,
            revision: 0,
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

    /// Advances the game by one step of [`STEP`] seconds with these intents. Nothing moves after
    /// the exit; after death, nothing but what [`Intent::Retry`] does.
    pub fn step(&mut self, intents: Intents) {
        if self.is_finished() {
            return;
        }
        if self.is_dead() {
            return self.step_after_death(intents);
        }
        let intents = self.at_a_door(intents);
        let before = self.player.motion;
        self.move_player(intents);
        self.take_finds();
        self.meet_hazards(&before);
        self.refuse(before.cell());
        self.pass_time();
        self.move_doors();
        self.open_doors(intents);
        self.act(intents);
        self.move_mechanisms();
        self.move_missiles();
        self.move_guards();
        self.hear();
        self.show();
        self.move_window();
        self.reach_checkpoint();
        self.steps = self.steps.saturating_add(1);
    }

    fn step_after_death(&mut self, intents: Intents) {
        let presses = self.presses(intents);
        let retries = self.player.fresh(presses).contains(Intent::Retry);
        self.player.pressed = presses;
        if retries {
            self.retry();
        }
    }

    fn move_player(&mut self, intents: Intents) {
        let before = self.player.motion;
        self.player.motion = before.stepped(&self.world, intents, self.pace());
        if self.is_mission {
            self.hear_steps(&before, intents);
        }
    }

    /// The intents that are recorded from step to step, because each press acts once. A lever turns
    /// once for each press, too.
    fn presses(&self, intents: Intents) -> Intents {
        let mut presses = intents.once();
        if self.mechanisms.has_handles() && intents.contains(Intent::Open) {
            presses.insert(Intent::Open);
        }
        presses
    }

    /// Does what the player begins to want.
    fn act(&mut self, intents: Intents) {
        let presses = self.presses(intents);
        let fresh = self.player.fresh(presses);
        self.player.pressed = presses;
        if fresh.is_empty() {
            return;
        }
        self.use_tools(fresh);
        if fresh.contains(Intent::Open)
            && let Some(handle) = self.handle_ahead()
        {
            self.use_handle(handle);
        }
    }

    /// Advances the player's clocks.
    fn pass_time(&mut self) {
        let has_ended = self.player.wait(1);
        self.revision += u64::from(has_ended);
        if !self.smoke.is_empty() {
            self.smoke.step();
        }
    }

    fn move_doors(&mut self) {
        let (motion, guards) = (self.player.motion, &self.guards);
        let is_occupied = |cell| motion.touches(cell) || guards.touches(cell);
        let has_moved = self.doors.step(&mut self.world, is_occupied);
        self.revision += u64::from(has_moved);
    }

    /// Lets the player hear the sounds of this step.
    fn hear(&mut self) {
        if self.is_mission {
            let position = self.player.motion.position();
            let heard = self.player.hearing.step(&self.world, 0, position, &self.sounds);
            self.revision += u64::from(heard);
            self.sounds.clear();
        }
    }

    /// Moves the window after the player.
    fn move_window(&mut self) {
        let Some(window) = &mut self.window else { return };
        if let Some(shift) = window.follow(&mut self.world, self.player.motion.cell()) {
            self.player.motion = self.player.motion.shifted(shift);
            self.doors.shift(&mut self.world, shift);
            self.missiles.shift(shift);
            self.smoke.shift(shift);
            if self.is_mission {
                self.guards.shift(&self.world, shift);
                self.player.hearing.forget();
            }
            self.show();
        }
    }
}

#[cfg(test)]
mod tests;
