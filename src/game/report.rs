//! Queries about a game from outside.

use super::guards::{Alarm, GuardView};
use super::health::{Flash, Health};
use super::player::Player;
use super::sound::Heard;
use super::{Game, Rules, STEP};
use crate::generate::Site;
use crate::world::{Camera, Cell, FieldOfView, Supply, Thing, ThingKind, World};

/// The outcome of a game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// The game goes on.
    Playing,
    /// The player is dead, and may [retry](super::Intent::Retry).
    Dead {
        /// The cause of death, as part of a sentence: "a hound".
        cause: &'static str,
    },
    /// The player has reached the exit.
    Won,
}

impl Game {
    /// The player's cell in a generated level; `None` on a map.
    pub fn site(&self) -> Option<Site> {
        Some(self.window.as_ref()?.site(self.player.motion.cell()))
    }

    /// The cell of a generated level at the world's north-west corner; `None` on a map.
    pub fn corner(&self) -> Option<Site> {
        Some(self.window.as_ref()?.site(Cell { column: 0, row: 0 }))
    }

    /// Whether the level has an exit, inside or outside the window.
    pub fn has_exit(&self) -> bool {
        let is_far = self.window.as_ref().is_some_and(|window| window.level().exit().is_some());
        is_far || self.world.has_exit()
    }

    /// The world in its present state: with the current doors and mechanisms, without the things
    /// that were taken, and with guards and missiles as [figures](World::figures).
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The player's camera.
    #[expect(clippy::missing_panics_doc, reason = "the player stands inside the map")]
    pub fn camera(&self, field_of_view: FieldOfView) -> Camera {
        self.player
            .motion
            .camera(&self.world, field_of_view)
            .expect("the player stands inside the map, where all places are finite")
    }

    /// The height of the player's feet, in cells above the map's own floor.
    pub fn feet(&self) -> f64 {
        self.player.motion.feet()
    }

    /// Whether the player is in the air: jumping or falling.
    pub fn is_airborne(&self) -> bool {
        !self.player.motion.stands(&self.world)
    }

    /// The rules of the game.
    pub fn rules(&self) -> Rules {
        self.rules
    }

    /// The number of steps since the start.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The number of cells, doors, spikes, guards and sounds that the last step examined. A
    /// comparison of two of them counts once for each pair. This number measures the run time of
    /// the step and is the same on every machine.
    #[doc(hidden)]
    pub fn work(&self) -> u64 {
        *self.work + self.guards.work()
    }

    /// The time in the game in seconds, counted in steps.
    pub fn elapsed(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// The current message to the player, for example why a door does not open. A message lasts for
    /// a few seconds.
    pub fn message(&self) -> Option<&str> {
        self.player.notice.text()
    }

    /// The names of the keys that the player has.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.player.keys.iter().map(|&key| self.world.key_name(key))
    }

    /// Whether the level contains more than walls, doors, keys and exits. In such a level, the
    /// player can be hurt and has tools.
    pub fn is_mission(&self) -> bool {
        self.is_mission
    }

    /// The player's health.
    pub fn health(&self) -> Health {
        self.player.health
    }

    /// The number of a tool that the player carries, at most 9.
    pub fn supplies(&self, supply: Supply) -> u8 {
        self.player.supplies.count(supply)
    }

    /// Whether the player's lamp is lit.
    pub fn lamp_is_lit(&self) -> bool {
        self.player.has_light
    }

    /// The player's visibility to guards at their position, from 0 for invisible to 255.
    pub fn visibility(&self) -> u8 {
        self.target().visibility
    }

    /// The state of alarm of the guards.
    pub fn alarm(&self) -> Alarm {
        self.guards.alarm()
    }

    /// The guards.
    pub fn guards(&self) -> impl Iterator<Item = GuardView> {
        self.guards.views()
    }

    /// The recent sounds that the player has heard, newest last.
    pub fn heard(&self) -> &[Heard] {
        &self.player.hearing.heard
    }

    /// The current flash at the edge of the screen.
    pub fn flash(&self) -> Option<Flash> {
        self.player.flash
    }

    /// A number that increases with every visible change except changes of the camera. Examples: a
    /// door moves, a key is taken, a guard moves, the message changes.
    pub fn revision(&self) -> u64 {
        self.revision + self.figure_revision
    }

    /// A number that increases with every such change except changes of [figures](Game::figures).
    #[cfg(feature = "terminal")]
    pub(crate) fn revision_without_figures(&self) -> u64 {
        self.revision
    }

    /// The outcome of the game.
    pub fn outcome(&self) -> Outcome {
        match self.player.killed_by {
            Some(cause) => Outcome::Dead { cause: cause.name() },
            None if self.is_finished() => Outcome::Won,
            None => Outcome::Playing,
        }
    }

    /// Whether the player has reached the exit with the treasure that it requires. On the hardest
    /// difficulty, the alarm must not be raised. Once this is true, nothing moves and the clock
    /// stops.
    pub fn is_finished(&self) -> bool {
        !self.is_dead()
            && self.things_reached().any(|thing| thing.kind == ThingKind::Exit)
            && self.treasure_missing() == 0
            && !self.alarm_closes_exits()
    }

    pub(crate) fn is_dead(&self) -> bool {
        self.player.killed_by.is_some()
    }

    /// The things in the player's cell that overlap the height of their body.
    pub(crate) fn things_reached(&self) -> impl Iterator<Item = &Thing> {
        self.things_reached_by(&self.player)
    }

    pub(crate) fn things_reached_by(&self, player: &Player) -> impl Iterator<Item = &Thing> {
        let motion = player.motion;
        let cell = motion.cell();
        let heights = self.world.room_in(cell);
        let (feet, head) = (motion.feet(), motion.head());
        self.world.things_in(cell).iter().filter(move |thing| {
            let sprite = self.world.sprite(thing.sprite);
            let base = sprite.base(heights);
            feet <= base + sprite.height.cells() && base <= head
        })
    }
}
