//! From time to steps.

use std::time::Duration;

use crate::game::STEP;

/// Cuts time into the steps of the game; what is left over counts for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock {
    /// Up to when time has been cut into steps.
    cut: Duration,
}

impl Clock {
    /// The most steps that are made up for at once, a quarter of a second: a machine that can't keep
    /// up plays slower, rather than later and later.
    pub(super) const MOST_STEPS: u64 = 15;

    /// How many steps have passed between the last call and `now`.
    pub(super) fn steps_until(&mut self, now: Duration) -> u64 {
        let steps = (now.saturating_sub(self.cut).as_nanos() / step().as_nanos()) as u64;
        self.cut = after(self.cut, steps);
        steps
    }

    /// Lets the time up to `now` pass without steps.
    pub(super) fn skip_to(&mut self, now: Duration) {
        self.cut = now;
    }

    /// When the step after `steps` steps to come will have passed.
    pub(super) fn step_after(&self, steps: u64) -> Duration {
        after(self.cut, steps.saturating_add(1))
    }
}

/// The time that many steps after `time`.
pub(super) fn after(time: Duration, steps: u64) -> Duration {
    let nanoseconds = step().as_nanos() as u64;
    time + Duration::from_nanos(nanoseconds.saturating_mul(steps))
}

/// How long a step lasts.
pub(super) fn step() -> Duration {
    Duration::from_secs_f64(STEP)
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
        clock.skip_to(Duration::from_secs(3600));
        assert_eq!(clock.steps_until(Duration::from_secs(3600)), 0);
    }
}
