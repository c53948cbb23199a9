//! A player: all state that belongs to one player, so that a game can have several.

mod motion;

use std::collections::BTreeSet;

pub use motion::FRICTION;
pub(crate) use motion::{JUMP_HEIGHT, Motion, RADIUS, RUN, STEP_HEIGHT, STILL, WALK};
use serde::{Deserialize, Serialize};

use super::health::{Cause, Flash, Health, Warnings};
use super::intent::Intents;
use super::sound::Hearing;
use super::stored::{RestoreError, check};
use super::tally::RunCounts;
use crate::world::{KeyId, Supply, World};

/// An upper bound on a player's counts. A count needs years to grow from here to an overflow.
const MAX_COUNT: u32 = u32::MAX / 2;

/// A player.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Player {
    pub(crate) motion: Motion,
    pub(crate) health: Health,
    pub(crate) supplies: Supplies,
    pub(crate) keys: BTreeSet<KeyId>,
    /// The total value of the treasure found.
    pub(crate) treasure: u32,
    pub(crate) has_light: bool,
    /// `true` if the player has done more than look around since they came into the level or back to life. Until
    /// then, guards do not notice them.
    pub(crate) has_acted: bool,
    /// The number of steps until the player can strike again.
    pub(crate) strike_wait: u16,
    /// The intents of the last step that act once for each press.
    pub(crate) pressed: Intents,
    /// The height from which the player falls: the greatest height since they last stood.
    pub(crate) fell_from: f64,
    /// The distance walked since the last audible footstep, in cells.
    pub(crate) stride: f64,
    /// The number of consecutive steps in cold water.
    pub(crate) in_water: u32,
    /// The last thrust of spikes that hurt the player, identified by the step in which it began.
    pub(crate) last_thrust: Option<u64>,
    pub(crate) warnings: Warnings,
    pub(crate) hearing: Hearing,
    pub(crate) flash: Option<Flash>,
    pub(crate) notice: Notice,
    /// The cause of death, if the player is dead.
    pub(crate) killed_by: Option<Cause>,
    pub(crate) counts: RunCounts,
}

impl Player {
    /// A player at the start of `world`, with these supplies.
    pub(crate) fn new(world: &World, supplies: Supplies) -> Self {
        let motion = Motion::new(world);
        Self {
            fell_from: motion.feet(),
            motion,
            health: Health::default(),
            supplies,
            keys: BTreeSet::new(),
            treasure: 0,
            has_light: false,
            has_acted: false,
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
            counts: RunCounts::default(),
        }
    }

    /// Returns an error if a step after the step `now` could fail in this state.
    pub(crate) fn check(&self, world: &World, now: u64) -> Result<(), RestoreError> {
        let has_key = |key: &KeyId| usize::from(key.0) < world.key_count();
        check(self.keys.iter().all(has_key), "a key")?;
        check(self.health.is_possible(), "the health")?;
        check(self.supplies.are_possible(), "the number of a tool")?;
        let RunCounts { alarms, deaths, stunned } = self.counts;
        let counts = [alarms, deaths, stunned, self.in_water];
        check(counts.iter().all(|&count| count < MAX_COUNT), "a count")?;
        self.motion.check(world)?;
        self.warnings.check(now)?;
        self.hearing.check(world)
    }

    /// The same player at another position, where they have not acted yet.
    #[must_use]
    pub(crate) fn at(self, motion: Motion) -> Self {
        Self { motion, fell_from: motion.feet(), has_acted: false, ..self }
    }

    /// The part of `presses` that begins in this step.
    pub(crate) fn fresh(&self, presses: Intents) -> Intents {
        presses.without(self.pressed)
    }

    /// Returns true if the player sees a message or a flash, or hears a sound.
    pub(crate) fn is_shown_anything(&self) -> bool {
        self.notice.text().is_some() || self.flash.is_some() || !self.hearing.heard.is_empty()
    }

    /// Advances the player's clocks by `steps` steps, except the clocks of their hearing. Returns
    /// whether a message ended or a flash faded.
    pub(crate) fn wait(&mut self, steps: u64) -> bool {
        let short = u16::try_from(steps).unwrap_or(u16::MAX);
        self.strike_wait = self.strike_wait.saturating_sub(short);
        let shown = |flash: Option<Flash>| flash.map_or(0, |flash| flash.left.min(Flash::FADE));
        let before = shown(self.flash);
        self.flash = self.flash.and_then(|flash| flash.after(short));
        self.notice.wait(steps) | (shown(self.flash) != before)
    }
}

/// The duration of a message in steps: 3 seconds.
const DURATION: u64 = 180;

/// The tools that a player carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Supplies([u8; Supply::ALL.len()]);

impl Supplies {
    /// The maximum of each tool.
    pub(crate) const MAX: u8 = 9;

    /// The tools of a player at the start.
    pub(crate) const AT_START: Self = Self([3, 0, 0]);

    /// Whether a player can carry these tools.
    pub(crate) fn are_possible(self) -> bool {
        self.0.iter().all(|&count| count <= Self::MAX)
    }

    /// The number of `supply`.
    pub(crate) fn count(self, supply: Supply) -> u8 {
        self.0[supply as usize]
    }

    /// Adds `more` of `supply`, up to the maximum.
    pub(crate) fn add(&mut self, supply: Supply, more: u8) {
        let count = &mut self.0[supply as usize];
        *count = count.saturating_add(more).min(Self::MAX);
    }

    /// The larger of the two numbers for each tool.
    #[must_use]
    pub(crate) fn or_more(mut self, other: Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(count, other)| *count = other.max(*count));
        self
    }

    /// Takes one of `supply`. Returns whether there was one.
    pub(crate) fn take(&mut self, supply: Supply) -> bool {
        let count = &mut self.0[supply as usize];
        let has_one = *count > 0;
        *count -= u8::from(has_one);
        has_one
    }
}

/// A message that is shown for a limited number of steps.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Notice {
    text: String,
    steps_left: u64,
}

impl Notice {
    /// A message that is shown from now on.
    pub(crate) fn new(text: String) -> Self {
        Self { text, steps_left: DURATION }
    }

    /// The current message.
    pub(crate) fn text(&self) -> Option<&str> {
        (self.steps_left > 0).then_some(&self.text)
    }

    /// Advances by `steps` steps. Returns whether the message ended.
    pub(crate) fn wait(&mut self, steps: u64) -> bool {
        let was_said = self.steps_left > 0;
        self.steps_left = self.steps_left.saturating_sub(steps);
        if self.steps_left == 0 {
            self.text.clear();
        }
        was_said && self.steps_left == 0
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn supplies_stay_between_zero_and_nine(
            changes in prop::collection::vec((prop::sample::select(&Supply::ALL[..]), any::<Option<u8>>()), 0..40)
        ) {
            let mut supplies = Supplies::AT_START;
            for (supply, more) in changes {
                let before = supplies.count(supply);
                if let Some(more) = more {
                    supplies.add(supply, more);
                } else {
                    prop_assert_eq!(supplies.take(supply), before > 0);
                }
                prop_assert!(Supply::ALL.iter().all(|&supply| supplies.count(supply) <= Supplies::MAX));
            }
        }
    }
}
