//! How long a visitor has pressed no key.

use std::time::Duration;

use super::IdleLimits;

/// The time since the last key.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Idle {
    since: Duration,
    is_warned: bool,
}

/// What happens to those who press no key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Patience {
    /// They are warned.
    Warns,
    /// They are put out.
    Ends,
}

impl Idle {
    /// Counts from `now` on. Returns whether a warning was shown, which now is not any more.
    pub(crate) fn restart(&mut self, now: Duration) -> bool {
        let was_warned = self.is_warned;
        *self = Self { since: now, is_warned: false };
        was_warned
    }

    /// Whether the warning is shown.
    pub(crate) fn is_warned(&self) -> bool {
        self.is_warned
    }

    /// What happens at `now`, after which no key may be missing for longer than `limit`.
    pub(crate) fn step(
        &mut self,
        limits: &IdleLimits,
        limit: Duration,
        now: Duration,
    ) -> Option<Patience> {
        if self.next_at(limits, limit) > now {
            return None;
        }
        if now >= self.since + limit {
            return Some(Patience::Ends);
        }
        self.is_warned = true;
        Some(Patience::Warns)
    }

    /// The time of the next thing that happens if no key is pressed.
    pub(crate) fn next_at(&self, limits: &IdleLimits, limit: Duration) -> Duration {
        let wait = if self.is_warned { limit } else { limit.saturating_sub(limits.warning) };
        self.since + wait
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_comes_before_the_end() {
        let limits = IdleLimits::default();
        let at = Duration::from_secs;
        let mut idle = Idle::default();
        let step = |idle: &mut Idle, seconds| idle.step(&limits, limits.in_room, at(seconds));
        assert_eq!(step(&mut idle, 239), None);
        assert_eq!(step(&mut idle, 240), Some(Patience::Warns));
        assert_eq!(step(&mut idle, 299), None);
        assert!(idle.is_warned());
        assert!(idle.restart(at(299)));
        assert_eq!(step(&mut idle, 300), None);
        assert_eq!(step(&mut idle, 539), Some(Patience::Warns));
        assert_eq!(step(&mut idle, 599), Some(Patience::Ends));
    }
}
