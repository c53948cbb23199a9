//! Timed endings of a session: the visitor is idle, or the server shuts down.

use std::time::Duration;

use crate::config::Config;

/// The limits on the time without a key. A session keeps the limits that it begins with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IdleLimits {
    /// How long a member of a room may be idle before returning to the lobby.
    pub(crate) in_room: Duration,
    /// How long other visitors may be idle before the session ends.
    pub(crate) elsewhere: Duration,
}

/// How long before a limit visitors get a warning.
const WARNING: Duration = Duration::from_mins(1);

/// The time since the last key.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Idle {
    since: Duration,
    is_warned: bool,
}

/// The consequence of being idle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum IdleAction {
    /// The visitor gets a warning.
    Warn,
    /// The visitor leaves the room, or the session ends.
    End,
}

impl IdleLimits {
    pub(crate) fn of(config: &Config) -> Self {
        Self { in_room: config.idle_room, elsewhere: config.idle_lobby }
    }
}

impl Idle {
    /// Restarts the count at `now`. Returns whether a warning was shown, which is now hidden.
    pub(crate) fn restart(&mut self, now: Duration) -> bool {
        let was_warned = self.is_warned;
        *self = Self { since: now, is_warned: false };
        was_warned
    }

    /// Returns true while the warning is shown.
    pub(crate) fn is_warned(&self) -> bool {
        self.is_warned
    }

    /// The consequence that is due at `now` if the visitor may be idle for `limit`.
    pub(crate) fn step(&mut self, limit: Duration, now: Duration) -> Option<IdleAction> {
        if self.next_at(limit) > now {
            return None;
        }
        if now >= self.since + limit {
            return Some(IdleAction::End);
        }
        self.is_warned = true;
        Some(IdleAction::Warn)
    }

    /// The time of the next consequence if no key is pressed.
    pub(crate) fn next_at(&self, limit: Duration) -> Duration {
        let wait = if self.is_warned { limit } else { limit.saturating_sub(WARNING) };
        self.since + wait
    }
}

/// The server's shutdown, with a countdown for the visitors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Draining {
    pub(crate) ends_at: Duration,
    /// Whether the visitor can return to the room through another host.
    pub(crate) can_return: bool,
}

impl Draining {
    /// The number of seconds left, rounded up.
    pub(crate) fn seconds(self, now: Duration) -> u64 {
        let left = self.ends_at.saturating_sub(now).as_millis();
        u64::try_from(left.div_ceil(1000)).unwrap_or(u64::MAX)
    }

    /// The time at which the number of seconds changes; `None` once it is 0.
    pub(crate) fn next_at(self, now: Duration) -> Option<Duration> {
        let after = Duration::from_secs(self.seconds(now).checked_sub(1)?);
        Some(self.ends_at.saturating_sub(after))
    }

    pub(crate) fn sentence(self, now: Duration) -> String {
        let then = if self.can_return { " Connect again to continue where you were." } else { "" };
        match self.seconds(now) {
            0 => format!("The server ends now.{then}"),
            1 => format!("The server ends in 1 second.{then}"),
            seconds => format!("The server ends in {seconds} seconds.{then}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_comes_before_the_end() {
        let at = Duration::from_secs;
        let mut idle = Idle::default();
        let step = |idle: &mut Idle, seconds| idle.step(at(300), at(seconds));
        assert_eq!(step(&mut idle, 239), None);
        assert_eq!(step(&mut idle, 240), Some(IdleAction::Warn));
        assert_eq!(step(&mut idle, 299), None);
        assert!(idle.is_warned());
        assert!(idle.restart(at(299)));
        assert_eq!(step(&mut idle, 300), None);
        assert_eq!(step(&mut idle, 539), Some(IdleAction::Warn));
        assert_eq!(step(&mut idle, 599), Some(IdleAction::End));
    }
}
