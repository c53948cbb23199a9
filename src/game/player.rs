//! A player: everything in the game that belongs to one of them, so that a game may have several.

mod motion;

use std::collections::BTreeSet;

use super::health::{Cause, Flash, Health};
use super::intent::Intents;
use super::notice::Notice;
use super::sound::Hearing;
use super::stored::{Unrestorable, check, stored};
use super::tally::Counts;
use super::tools::Supplies;
use super::warnings::Warnings;
use crate::world::{KeyId, World};
pub(crate) use motion::FRICTION;
pub(super) use motion::{JUMP_HEIGHT, Motion, RADIUS, RUN, STEP_HEIGHT, STILL, WALK};

/// More than a player ever counts: it grows for years before it overflows.
const MOST_COUNT: u32 = u32::MAX / 2;

/// A player.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Player {
    pub(super) motion: Motion,
    pub(super) health: Health,
    pub(super) supplies: Supplies,
    pub(super) keys: BTreeSet<KeyId>,
    /// The worth of the treasure found.
    pub(super) treasure: u32,
    pub(super) has_light: bool,
    /// The steps until the player can strike again.
    pub(super) strike_wait: u16,
    /// The intents of the last step that act once for each press.
    pub(super) pressed: Intents,
    /// The height from which the player falls: the highest since they last stood.
    pub(super) fell_from: f64,
    /// How far the player has walked since the last audible step, in cells.
    pub(super) stride: f64,
    /// The number of steps in cold water, without a break.
    pub(super) in_water: u32,
    /// The last thrust of spikes that hurt the player, by the step in which it began.
    pub(super) last_thrust: Option<u64>,
    pub(super) warnings: Warnings,
    pub(super) hearing: Hearing,
    pub(super) flash: Option<Flash>,
    pub(super) notice: Notice,
    /// What has killed the player, if something has.
    pub(super) killed_by: Option<Cause>,
    pub(super) counts: Counts,
}

stored! {
    struct Player {
        motion, health, supplies, keys, treasure, has_light, strike_wait, pressed, fell_from, stride,
        in_water, last_thrust, warnings, hearing, flash, notice, killed_by, counts,
    }
}

impl Player {
    /// A player at the start of `world`, with these supplies.
    pub(super) fn new(world: &World, supplies: Supplies) -> Self {
        let motion = Motion::new(world);
        Self {
            fell_from: motion.feet(),
            motion,
            health: Health::default(),
            supplies,
            keys: BTreeSet::new(),
            treasure: 0,
            has_light: false,
            strike_wait: 0,
            pressed: Intents::new(),
            stride: 0.0,
            in_water: 0,
            last_thrust: None,
            warnings: Warnings::default(),
            hearing: Hearing::default(),
            flash: None,
            notice: Notice::default(),
            killed_by: None,
            counts: Counts::default(),
        }
    }

    /// Refuses a state in which a step after the step `now` could fail.
    pub(super) fn check(&self, world: &World, now: u64) -> Result<(), Unrestorable> {
        let has_key = |key: &KeyId| usize::from(key.0) < world.key_count();
        check(self.keys.iter().all(has_key), "a key")?;
        let Counts { alarms, deaths, stunned } = self.counts;
        let counts = [alarms, deaths, stunned, self.in_water];
        check(counts.iter().all(|&count| count < MOST_COUNT), "a count")?;
        self.motion.check(world)?;
        self.warnings.check(now)?;
        self.hearing.check()
    }

    /// The same player at another place.
    #[must_use]
    pub(super) fn at(self, motion: Motion) -> Self {
        Self { motion, fell_from: motion.feet(), ..self }
    }

    /// Those of `presses` that begin in this step.
    pub(super) fn fresh(&self, presses: Intents) -> Intents {
        presses.without(self.pressed)
    }

    /// The number of steps in which nothing changes but the player's clocks; `None` if nothing ever
    /// will.
    pub(super) fn quiet_steps(&self) -> Option<u64> {
        let flash = self.flash.map(Flash::quiet_steps);
        let quiet = [self.notice.quiet_steps(), self.hearing.quiet_steps(), flash];
        quiet.into_iter().flatten().min()
    }

    /// Advances the player's clocks by `steps`, except those of what they hear. Returns whether a
    /// message ended, or a flash faded.
    pub(super) fn wait(&mut self, steps: u64) -> bool {
        let short = u16::try_from(steps).unwrap_or(u16::MAX);
        self.strike_wait = self.strike_wait.saturating_sub(short);
        let shown = |flash: Option<Flash>| flash.map_or(0, |flash| flash.left.min(Flash::FADE));
        let before = shown(self.flash);
        self.flash = self.flash.and_then(|flash| flash.after(short));
        self.notice.wait(steps) | (shown(self.flash) != before)
    }
}
