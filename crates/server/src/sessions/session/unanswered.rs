//! The keys that no frame has answered yet.
//!
//! A frame answers a key if it shows the effect. What a key changes on the screen is in the next picture. What it wants
//! of the room is in the first picture of a snapshot in which the room has acted on it, if the room has changed then. Keys
//! without an effect are not answered: with each key counted until the next frame, whatever that showed, the mean of
//! [`Metrics::key_time`](crate::ops::metrics::Metrics::key_time) was 2.5 s.

use std::time::Duration;

/// When the oldest of the keys came that are not answered.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unanswered {
    /// Of those that have changed the screen.
    shown: Option<Duration>,
    /// Of those by which the visitor wants something else of the room.
    wanted: Option<Duration>,
}

/// What a key has changed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effect {
    pub(crate) is_shown: bool,
    pub(crate) is_wanted: bool,
}

impl Unanswered {
    /// Records the effect of a key that came at `now`.
    pub(crate) fn press(&mut self, effect: Effect, now: Duration) {
        if effect.is_shown {
            self.shown.get_or_insert(now);
        }
        if effect.is_wanted {
            self.wanted.get_or_insert(now);
        }
    }

    /// Records that the room has acted on all that was wanted, and that nothing has changed.
    pub(crate) fn forget_wanted(&mut self) {
        self.wanted = None;
    }

    /// When the oldest key came that a new picture answers, where `has_acted` says that the room has acted on all
    /// that was wanted.
    pub(crate) fn answer(&mut self, has_acted: bool) -> Option<Duration> {
        let wanted = self.wanted.take_if(|_| has_acted);
        self.shown.take().into_iter().chain(wanted).min()
    }
}
