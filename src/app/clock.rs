//! The clock: converts time to steps of the game.

use std::time::Duration;

use crate::game::STEP;

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
pub fn after(time: Duration, steps: u64) -> Duration {
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
