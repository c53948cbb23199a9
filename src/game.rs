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
use guards::{Act, Guards};
use hazards::Spikes;
use health::Cause;
use mechanisms::Mechanisms;
use player::{FRICTION, Player, RUN, STILL, WALK};
use show::Sprites;
use tally::Counts;
use tools::{Missile, Missiles, Smoke, Supplies};

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

    /// Advances the clocks by `steps` steps in which nothing moves. Has the effect of as many calls
    /// of [`Game::step`] if `steps` is at most [`Game::quiet_steps`].
    pub fn wait(&mut self, steps: u64) {
        if !self.is_finished() && !self.is_dead() {
            self.steps = self.steps.saturating_add(steps);
            self.doors.wait(steps);
            self.player.wait(steps);
            if self.is_mission {
                self.player.hearing.wait(steps);
                self.guards.wait(steps);
            }
            if self.quiet_steps_in_water().is_some() {
                self.player.in_water += steps as u32;
            }
        }
    }

    /// Whether any number of steps with these intents would change nothing but the clock: the
    /// player stands still or pushes against a wall, all doors are closed, nobody else moves, and
    /// there is no message.
    pub fn is_at_rest(&self, intents: Intents) -> bool {
        self.quiet_steps(intents) == u64::MAX
    }

    /// The number of steps with these intents in which nothing changes but clocks: the game's own,
    /// and those of waiting doors and of the message. [`u64::MAX`] if the game is [at
    /// rest](Game::is_at_rest).
    pub fn quiet_steps(&self, intents: Intents) -> u64 {
        if self.is_finished() {
            return u64::MAX;
        }
        let presses = self.presses(intents);
        if self.is_dead() {
            return if presses == self.player.pressed { u64::MAX } else { 0 };
        }
        if self.would_change(intents) {
            return 0;
        }
        let waits = [
            self.doors.quiet_steps(),
            self.player.quiet_steps(),
            self.quiet_steps_in_water(),
            self.spikes.quiet_steps(self.steps),
            self.guards.quiet_steps(),
        ];
        waits.into_iter().flatten().min().unwrap_or(u64::MAX)
    }

    /// Whether anything would change in a step with these intents that is no clock.
    fn would_change(&self, intents: Intents) -> bool {
        let intents = self.at_a_door(intents);
        let motion = self.player.motion;
        motion.stepped(&self.world, intents, self.pace()) != motion
            || self.presses(intents) != self.player.pressed
            || self.door_wanted(intents).is_some_and(|(cell, door)| self.would_answer(cell, door))
            || self.find().is_some()
            || self.is_at_a_new_checkpoint()
            || self.is_in_water() != (self.player.in_water > 0)
            || !self.missiles.is_empty()
            || !self.smoke.is_empty()
            || self.mechanisms_move()
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
        let opens_once = self.mechanisms.has_handles();
        let acts_once =
            |intent: &Intent| intent.acts_once() || opens_once && *intent == Intent::Open;
        intents.iter().filter(acts_once).collect()
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

    fn move_guards(&mut self) {
        if self.guards.is_empty() {
            return;
        }
        let (alarm, target) = (self.guards.alarm(), self.target());
        let acts = self.guards.step(&self.world, &[target], &self.sounds, self.smoke.clouds());
        for act in acts.to_vec() {
            self.answer(act);
        }
        self.revision += u64::from(self.guards.alarm() != alarm);
    }

    /// Does to the rest of the game what a guard does.
    fn answer(&mut self, act: Act) {
        match act {
            Act::Hurt { by, from, points, .. } => {
                let guard = self.guards.views().nth(by);
                self.hurt_by_guard(guard, from, points);
            }
            Act::Open(cell) => self.doors.open(cell),
            Act::Sound(sound) => self.sounds.push(sound),
            Act::Bolt { from, height, direction, slope, points, .. } => {
                self.missiles.launch(Missile::bolt((from, height), direction, slope, points));
            }
            Act::Raised => self.counts.alarms += 1,
        }
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
