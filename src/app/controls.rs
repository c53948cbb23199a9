//! From keys to what the player wants, step by step.

use std::time::Duration;

use super::clock::step;
use super::status::Gait;
use crate::app::bindings::{Action, Bindings};
use crate::game::{Intent, Intents};
use crate::terminal::{Key, KeyEvent, Phase};
use crate::tui::{HeldKeys, Hold, Press, tap_steps, wanted};

/// The keys that are held, and what was switched on.
#[derive(Clone, Debug, Default)]
pub(super) struct Controls {
    pub(super) held: HeldKeys<Key>,
    pub(super) gait: Gait,
    /// The key that was pressed with Shift, where only that shows that Shift is held.
    shifted: Option<Key>,
}

/// What of a game matters for its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stance {
    /// Whether the game is played, and not waiting.
    pub(super) plays: bool,
    /// Whether the player has no floor under their feet.
    pub(super) is_airborne: bool,
    /// Whether the player flies: ducking moves them.
    pub(super) flies: bool,
}

impl Controls {
    /// Takes note of an event, and says what it means for its key; `None` for a release.
    pub(super) fn note(
        &mut self,
        event: KeyEvent,
        now: Duration,
        bindings: &Bindings,
        stance: Stance,
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
        let steps = wants.filter(|_| stance.plays).map_or(0, tap_steps);
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
        if wants.is_some_and(walks) {
            self.gait.walks_on = false;
        }
        if wants == Some(Intent::Jump) && stance.plays && !stance.is_airborne {
            self.held.join_newest();
        }
        Some(press)
    }

    /// Lets go of what is no longer held at time `now`.
    pub(super) fn advance(&mut self, now: Duration, stance: Stance) {
        if stance.is_airborne {
            self.held.keep(now);
        }
        self.held.advance(now);
    }

    /// For how many steps from `now` on, at most `most` and at least one, the player wants the same.
    pub(super) fn steady_steps(&self, now: Duration, stance: Stance, most: u64) -> u64 {
        if self.held.has_taps() || stance.is_airborne {
            return 1;
        }
        let until = self.held.next_expiry().unwrap_or(Duration::MAX);
        let steps = until.saturating_sub(now).as_nanos() / step().as_nanos();
        u64::try_from(steps).unwrap_or(u64::MAX).saturating_add(1).min(most)
    }

    /// What the player wants.
    pub(super) fn intents(&self, bindings: &Bindings, stance: Stance) -> Intents {
        let keys = self.held.iter().filter_map(|(key, hold)| match bindings.action(key) {
            Some(Action::Want(Intent::Duck)) if stance.flies && hold == Hold::Unknown => None,
            Some(Action::Want(intent)) => Some((intent, hold)),
            _ => None,
        });
        let shifted = self.shifted.filter(|_| !self.held.reports_releases());
        let runs = self.gait.runs || shifted.is_some_and(|key| self.held.hold(key) != Hold::Up);
        let others = [
            runs.then_some(Intent::Run),
            self.gait.ducks.then_some(Intent::Duck),
            self.gait.walks_on.then_some(Intent::Forward),
        ];
        wanted(keys.chain(others.into_iter().flatten().map(|intent| (intent, Hold::Held))))
    }
}

/// Whether `intent` takes the player elsewhere.
fn walks(intent: Intent) -> bool {
    use Intent::{Back, Forward, StrafeLeft, StrafeRight};
    matches!(intent, Forward | Back | StrafeLeft | StrafeRight)
}
