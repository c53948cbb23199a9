//! The rules of the game: a player walks through a world in fixed steps, finds keys, opens doors
//! and reaches the exit.
//!
//! A step lasts [`STEP`] seconds and depends on the [`Intents`] only. The same intents give the
//! same states, bit for bit, on every machine. Steps as long as the last frame were refused: a slow
//! machine would play another game than a fast one, and no game could be repeated.

mod collision;
mod doors;
mod exits;
mod fall;
mod flight;
mod guards;
mod intent;
mod locks;
mod look;
mod notice;
mod pitch_control;
mod player;
mod rules;
mod script;
mod sound;
mod stance;
mod turning;

use std::collections::BTreeSet;

use crate::generate::{self, Site, Window};
use crate::world::{Camera, Cell, FieldOfView, KeyId, Thing, ThingKind, World};
use doors::Doors;
use notice::Notice;
use player::{FRICTION, Player, RUN, STILL, WALK};

pub use exits::is_exit_out_of_reach;
pub use flight::Flight;
pub use guards::{Alarm, GuardView, Mood};
pub use intent::{Intent, Intents};
pub use look::Look;
pub use rules::Rules;
pub use script::{Header, LevelName, Recorder, Script, Section, Stretch};
pub use sound::{Heard, Sound, SoundKind, Source};

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
    world: World,
    /// The window of a generated level, of which `world` shows a part.
    window: Option<Window>,
    player: Player,
    doors: Doors,
    keys: BTreeSet<KeyId>,
    notice: Notice,
    steps: u64,
    revision: u64,
}

impl Game {
    /// A game at its start: the player stands still at the world's start.
    pub fn new(world: World) -> Self {
        Self {
            player: Player::new(&world),
            world,
            window: None,
            doors: Doors::default(),
            keys: BTreeSet::new(),
            notice: Notice::default(),
            steps: 0,
            revision: 0,
        }
    }

    /// A game in a generated level, which starts at `site` or near it. `None` if there is nowhere
    /// to stand, such as outside the level.
    pub fn in_level(level: generate::Level, site: Site) -> Option<Self> {
        let (window, world) = Window::open(level, site)?;
        Some(Self { window: Some(window), ..Self::new(world) })
    }

    /// A game in another world that continues this one: the player stands still at the same
    /// position with the same heading. If there is no room, or if the position is an exit, the
    /// player is at the world's start.
    #[must_use]
    pub fn begun_again_in(&self, world: World) -> Self {
        let player = self.player.placed_in(&world);
        let begun = Self::new(world);
        match player.map(|player| Self { player, ..begun.clone() }) {
            Some(game) if !game.is_finished() => game,
            _ => begun,
        }
    }

    /// The cell of a generated level that the player is in; `None` on a map.
    pub fn site(&self) -> Option<Site> {
        Some(self.window.as_ref()?.site(self.player.cell()))
    }

    /// The cell of a generated level that is the world's north-west cell; `None` on a map.
    pub fn corner(&self) -> Option<Site> {
        Some(self.window.as_ref()?.site(Cell { column: 0, row: 0 }))
    }

    /// Whether the level has an exit, inside or outside the window.
    pub fn has_exit(&self) -> bool {
        let is_far = self.window.as_ref().is_some_and(|window| window.level().exit().is_some());
        is_far || self.world.things().iter().any(|thing| thing.kind == ThingKind::Exit)
    }

    /// The world in its present state: with its doors as they are, and without the keys that were
    /// taken.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The player's camera.
    #[expect(clippy::missing_panics_doc, reason = "the player stands inside the map")]
    pub fn camera(&self, field_of_view: FieldOfView) -> Camera {
        self.player
            .camera(&self.world, field_of_view)
            .expect("the player stands inside the map, where all places are finite")
    }

    /// The height of the player's feet, in cells above the map's own floor.
    pub fn feet(&self) -> f64 {
        self.player.feet()
    }

    /// Whether the player is in the air: jumping or falling.
    pub fn is_airborne(&self) -> bool {
        !self.player.stands(&self.world)
    }

    /// The time in the game in seconds, counted in steps.
    pub fn elapsed(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// A message to the player, such as why a door does not open. It lasts for a few seconds.
    pub fn message(&self) -> Option<&str> {
        self.notice.text()
    }

    /// The names of the keys that the player has.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.keys.iter().map(|&key| self.world.key_name(key))
    }

    /// A number that grows with every visible change other than the camera: a door moves, a key is
    /// taken, the message changes.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the player has reached the exit. Nothing moves after that, and the clock stops.
    pub fn is_finished(&self) -> bool {
        self.things_reached().any(|thing| thing.kind == ThingKind::Exit)
    }

    /// The things in the player's cell that are neither above the player's head nor below their
    /// feet.
    fn things_reached(&self) -> impl Iterator<Item = &Thing> {
        let cell = self.player.cell();
        let heights = self.world.room_in(cell);
        let (feet, head) = (self.player.feet(), self.player.head());
        self.world.things_in(cell).iter().filter(move |thing| {
            let sprite = self.world.sprite(thing.sprite);
            let base = sprite.base(heights);
            feet <= base + sprite.height.cells() && base <= head
        })
    }

    /// Whether any number of steps with these intents would change nothing but the clock: the
    /// player stands still or pushes against a wall, all doors are closed, and there is no message.
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
        let intents = self.at_a_door(intents);
        if self.player.stepped(&self.world, intents) != self.player {
            return 0;
        }
        if self.door_wanted(intents).is_some_and(|(cell, door)| self.would_answer(cell, door)) {
            return 0;
        }
        let waits = [self.doors.quiet_steps(), self.notice.quiet_steps()];
        waits.into_iter().flatten().min().unwrap_or(u64::MAX)
    }

    /// Advances the game by one step of [`STEP`] seconds with these intents.
    pub fn step(&mut self, intents: Intents) {
        if self.is_finished() {
            return;
        }
        let intents = self.at_a_door(intents);
        self.player = self.player.stepped(&self.world, intents);
        self.take_keys();
        let is_silent = self.notice.wait(1);
        let player = self.player;
        let has_moved = self.doors.step(&mut self.world, |cell| player.touches(cell));
        self.revision += u64::from(is_silent) + u64::from(has_moved);
        if let Some((cell, door)) = self.door_wanted(intents) {
            self.try_to_open(cell, door);
        }
        self.move_window();
        self.steps = self.steps.saturating_add(1);
    }

    /// Moves the window after the player.
    fn move_window(&mut self) {
        let Some(window) = &mut self.window else { return };
        if let Some(shift) = window.follow(&mut self.world, self.player.cell()) {
            self.player = self.player.shifted(shift);
            self.doors.shift(&mut self.world, shift);
        }
    }

    /// Advances the clocks by `steps` steps in which nothing moves. Has the effect of as many calls
    /// of [`Game::step`] if `steps` is at most [`Game::quiet_steps`].
    pub fn wait(&mut self, steps: u64) {
        if !self.is_finished() {
            self.steps = self.steps.saturating_add(steps);
            self.doors.wait(steps);
            self.notice.wait(steps);
        }
    }
}

#[cfg(test)]
mod tests;
