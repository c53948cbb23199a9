//! Keys that answer a question.
//!
//! Irreversible actions require a certain press, and a repetition never answers. A byte that may be the first
//! repetition of a key counts if no other byte follows within the interval of repetitions.

use std::time::Duration;

use crate::terminal::Key;
use crate::tui::Press;

/// The longest interval between repetitions.
const REPETITION: Duration = Duration::from_millis(150);

/// A key that answers the question on the screen if it does not repeat until a certain time.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PendingKey(Option<(Key, Duration)>);

impl PendingKey {
    /// Handles a press of `key` at `now`. Returns the key if it answers the question at once.
    pub(crate) fn press(&mut self, key: Key, press: Press, now: Duration) -> Option<Key> {
        match press {
            Press::Fresh => return Some(key),
            Press::Unclear => self.0 = Some((key, now + REPETITION)),
            Press::Repeat => {}
        }
        None
    }

    /// Returns the key if it did not repeat until `now`.
    pub(crate) fn settle(&mut self, now: Duration) -> Option<Key> {
        self.0.take_if(|(_, until)| *until <= now).map(|(key, _)| key)
    }

    /// Forgets the key: another one was pressed, or another question is asked.
    pub(crate) fn forget(&mut self) {
        self.0 = None;
    }

    /// The time until which the key is pending.
    pub(crate) fn until(self) -> Option<Duration> {
        self.0.map(|(_, until)| until)
    }
}
