//! Keys that answer a question, and the time from which on they do.
//!
//! Irreversible actions require a certain press, and a repetition never answers. A byte that may be the first
//! repetition of a key counts if no other byte follows within the interval of repetitions.

use std::time::Duration;

use crate::terminal::Key;
use crate::tui::{HeldKeys, Press};

/// The least time for which a result is shown, and the time after which held keys no longer matter.
const LEAST_SHOWN: Duration = Duration::from_millis(500);
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// Whether a result that is shown since `shown_since` can be answered at `now`: half a second later, once the
/// keys that were held for the game have been released, or a second later.
pub fn is_answerable(held: &HeldKeys<Key>, shown_since: Duration, now: Duration) -> bool {
    let shown_for = now.saturating_sub(shown_since);
    let is_released = shown_for >= LEAST_SHOWN && !held.is_any_down_since(shown_since);
    is_released || shown_for >= LONGEST_WAIT
}

/// The longest interval between repetitions.
const REPETITION: Duration = Duration::from_millis(150);

/// A key that answers the question on the screen if it does not repeat until a certain time.
#[derive(Clone, Copy, Debug, Default)]
pub struct PendingKey(Option<(Key, Duration)>);

impl PendingKey {
    /// Handles a press of `key` at `now`. Returns the key if it answers the question at once.
    pub fn press(&mut self, key: Key, press: Press, now: Duration) -> Option<Key> {
        match press {
            Press::Fresh => return Some(key),
            Press::Unclear => self.0 = Some((key, now + REPETITION)),
            Press::Repeat => {}
        }
        None
    }

    /// Returns the key if it did not repeat until `now`.
    pub fn settle(&mut self, now: Duration) -> Option<Key> {
        self.0.take_if(|(_, until)| *until <= now).map(|(key, _)| key)
    }

    /// Forgets the key: another one was pressed, or another question is asked.
    pub fn forget(&mut self) {
        self.0 = None;
    }

    /// The time until which the key is pending.
    pub fn until(self) -> Option<Duration> {
        self.0.map(|(_, until)| until)
    }
}
