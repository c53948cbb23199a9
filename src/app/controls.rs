//! Controls: converts time to steps, and keys to the intents of each step.

use std::time::Duration;

use crate::app::bindings::{Action, Bindings};
use crate::game::{Intent, Intents, STEP};
use crate::terminal::{Key, KeyEvent, Phase};
use crate::tui::{HeldKeys, Hold, Press, tap_steps, wanted};

/// Divides time into steps of the game. A remainder counts for the next step.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// The time up to which steps have been counted.
    counted: Duration,
}

impl Clock {
    /// The most steps computed at once, a quarter of a second: a machine that is too slow plays
    /// more slowly and does not fall behind further and further.
    pub const MOST_STEPS: u64 = 15;

    /// The number of steps since the last call.
    pub fn steps_until(&mut self, now: Duration) -> u64 {
        let steps = steps_in(now.saturating_sub(self.counted));
        self.counted = after(self.counted, steps);
        steps
    }

    /// Skips the time up to `now`.
    pub fn skip_to(&mut self, now: Duration) {
        self.counted = now;
    }

    /// The time at which the step after `steps` further steps ends.
    pub fn step_after(&self, steps: u64) -> Duration {
        after(self.counted, steps.saturating_add(1))
    }
}

/// The time `steps` steps after `time`.
pub(crate) fn after(time: Duration, steps: u64) -> Duration {
    time + Duration::from_nanos(STEP_NANOSECONDS.saturating_mul(steps))
}

/// The number of whole steps in `time`.
pub(crate) fn steps_in(time: Duration) -> u64 {
    // More nanoseconds are more than five centuries.
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX) / STEP_NANOSECONDS
}

/// The duration of a step.
#[cfg(any(test, debug_assertions))]
pub(crate) fn step() -> Duration {
    Duration::from_nanos(STEP_NANOSECONDS)
}

/// The duration of a step in nanoseconds, rounded.
const STEP_NANOSECONDS: u64 = (STEP * 1e9 + 0.5) as u64;

/// The modes of motion that are switched on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Toggles {
    /// Running.
    pub runs: bool,
    /// Ducking.
    pub ducks: bool,
    /// Walking on without a key.
    pub keeps_walking: bool,
}

/// The keys that are held, and the modes that are switched on.
#[derive(Clone, Debug, Default)]
pub struct Controls {
    /// The held keys.
    pub held: HeldKeys<Key>,
    /// The modes.
    pub toggles: Toggles,
    /// The key that was pressed with Shift, for terminals that do not report Shift itself.
    shifted: Option<Key>,
}

/// The state of the game that keys depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyContext {
    /// Whether the game runs and is not paused.
    pub plays: bool,
    /// Whether the player is in the air.
    pub is_airborne: bool,
    /// Whether the player flies, so that ducking moves them.
    pub flies: bool,
}

impl Controls {
    /// Handles an event. Returns its meaning, or `None` for a release.
    pub fn handle(
        &mut self,
        event: KeyEvent,
        now: Duration,
        bindings: &Bindings,
        context: KeyContext,
    ) -> Option<Press> {
        let KeyEvent { key, modifiers, phase, .. } = event;
        match phase {
            Phase::Release => {
                self.held.release(key);
                return None;
            }
            Phase::Repeat if self.held.reports_releases() => {
                self.held.repeat(key);
                return Some(Press::Repeat);
            }
            Phase::Press | Phase::Repeat => {}
        }
        let action = bindings.action(key);
        let wants = match action {
            Some(Action::Want(intent)) => Some(intent),
            _ => None,
        };
        let steps = wants.filter(|_| context.plays).map_or(0, tap_steps);
        let opposes = |other| {
            action.zip(bindings.action(other)).is_some_and(|(one, other)| one.opposes(other))
        };
        let press = self.held.press(key, steps, now, opposes);
        self.shifted = if modifiers.shift {
            Some(key)
        } else {
            self.shifted.filter(|&shifted| shifted != key)
        };
        if press == Press::Repeat {
            return Some(press);
        }
        let wants_by = |key, is_meant: fn(Intent) -> bool| matches!(bindings.action(key), Some(Action::Want(intent)) if is_meant(intent));
        if press == Press::Fresh {
            self.held.release_lingering(|key| wants_by(key, Intent::turns));
        }
        if wants.is_some_and(Intent::walks) {
            self.toggles.keeps_walking = false;
        }
        if wants == Some(Intent::LookAhead) {
            self.held.release_each(|key| wants_by(key, tilts));
        }
        if wants == Some(Intent::Jump) && context.plays && !context.is_airborne {
            self.held.join_newest(|key| wants_by(key, Intent::walks));
        }
        Some(press)
    }

    /// Releases the keys that are no longer held at time `now`.
    pub fn advance(&mut self, now: Duration, context: KeyContext) {
        if context.is_airborne {
            self.held.keep(now);
        }
        self.held.advance(now);
    }

    /// The number of steps from `now`, from one to `most`, in which the intents do not change.
    pub(crate) fn steady_steps(&self, now: Duration, context: KeyContext, most: u64) -> u64 {
        if self.held.has_taps() || context.is_airborne {
            return 1;
        }
        let until = self.held.next_expiry().unwrap_or(Duration::MAX);
        steps_in(until.saturating_sub(now)).saturating_add(1).min(most)
    }

    /// The player's intents.
    pub fn intents(&self, bindings: &Bindings, context: KeyContext) -> Intents {
        let keys = self.held.iter().filter_map(|(key, hold)| match bindings.action(key) {
            Some(Action::Want(Intent::Duck)) if context.flies && hold == Hold::Unknown => None,
            Some(Action::Want(intent)) => Some((intent, hold)),
            _ => None,
        });
        let shifted = self.shifted.filter(|_| !self.held.reports_releases());
        let runs = self.toggles.runs || shifted.is_some_and(|key| self.held.hold(key) != Hold::Up);
        let others = [
            runs.then_some(Intent::Run),
            self.toggles.ducks.then_some(Intent::Duck),
            self.toggles.keeps_walking.then_some(Intent::Forward),
        ];
        wanted(keys.chain(others.into_iter().flatten().map(|intent| (intent, Hold::Held))))
    }
}

/// Whether `intent` is to look up or down.
fn tilts(intent: Intent) -> bool {
    matches!(intent, Intent::LookUp | Intent::LookDown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_is_lost_between_calls() {
        let mut clock = Clock::default();
        let steps: u64 = (1..=997).map(|call| clock.steps_until(Duration::from_millis(call))).sum();
        assert_eq!(steps, 59);
        assert!(clock.step_after(0) > Duration::from_millis(997));
        assert_eq!(clock.step_after(2), clock.step_after(0) + 2 * step());
        clock.skip_to(Duration::from_hours(1));
        assert_eq!(clock.steps_until(Duration::from_hours(1)), 0);
    }
}
