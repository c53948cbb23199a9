//! States along a run, from which the steps after them are played again.
//!
//! If there are too many, every second one is removed, and the least distance doubles. A game in a
//! built-in level takes 3 to 11 kB, so [`MAX_STATES`] of them take at most 6 MB. Any step is then
//! played again from the state before it within 12 ms in a debug build.

use crate::game::STEPS_PER_SECOND;

/// The maximum number of states.
pub(crate) const MAX_STATES: usize = 512;
/// The first distance between two states, in steps.
const FIRST_INTERVAL: u64 = 10 * STEPS_PER_SECOND as u64;

/// States, each with the number of steps before it, in order.
#[derive(Debug)]
pub(crate) struct States<S> {
    states: Vec<(u64, S)>,
    interval: u64,
}

impl<S> Default for States<S> {
    fn default() -> Self {
        Self { states: Vec::new(), interval: FIRST_INTERVAL }
    }
}

impl<S> States<S> {
    /// Keeps `state`, which is after `step` steps of a run that began after `begun` steps, if the
    /// last one is far enough away.
    pub(crate) fn keep(&mut self, begun: u64, step: u64, state: impl FnOnce() -> Option<S>) {
        let last = |states: &[(u64, S)]| states.last().map_or(begun, |state| state.0);
        if step < last(&self.states) + self.interval {
            return;
        }
        if self.states.len() == MAX_STATES {
            self.interval *= 2;
            let mut is_kept = true;
            self.states.retain(|_| {
                is_kept = !is_kept;
                is_kept
            });
            if step < last(&self.states) + self.interval {
                return;
            }
        }
        self.states.extend(state().map(|state| (step, state)));
    }

    /// The states after at most `step` steps, latest first.
    pub(crate) fn before(&self, step: u64) -> impl Iterator<Item = (u64, &S)> {
        let count = self.states.partition_point(|state| state.0 <= step);
        self.states[..count].iter().rev().map(|(step, state)| (*step, state))
    }

    /// Forgets all states after more than `step` steps.
    pub(crate) fn forget_after(&mut self, step: u64) {
        self.states.retain(|state| state.0 <= step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_states_of_a_long_run_are_bounded_and_equally_far_apart() {
        let mut states = States::default();
        for step in 1..=30 * 60 * 60 * 60 {
            states.keep(0, step, || Some(()));
        }
        let steps: Vec<u64> = states.before(u64::MAX).map(|state| state.0).collect();
        assert!((MAX_STATES / 2..=MAX_STATES).contains(&steps.len()), "{}", steps.len());
        assert!(steps.windows(2).all(|pair| pair[0] - pair[1] == states.interval));
        assert!(steps[0] + 2 * states.interval > 30 * 60 * 60 * 60);
        states.forget_after(1_000_000);
        assert!(states.before(u64::MAX).all(|state| state.0 <= 1_000_000));
    }
}
