//! The guards who are awake. Only they are looked at in a step, so that those who sleep cost nothing
//! until a sound or a push wakes them. Those who sleep on a floor that has moved count as
//! awake, since they may fall.
//!
//! Guards who have woken never sleep again. The list is therefore found anew where somebody wakes or
//! the level changes, and not in each step.

use super::Guards;
use super::guard::Guard;
use super::state::State;
use crate::world::GuardKind;

/// What is known about all guards until one wakes, comes or goes.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Awake {
    /// The guards who do not sleep, from the lowest index to the highest.
    pub(crate) indices: Vec<usize>,
    /// Whether there are hounds, awake or asleep.
    pub(crate) has_hounds: bool,
    /// The number of guards who have a sprite.
    pub(crate) figures: usize,
}

impl Guards {
    /// Finds the guards who are awake.
    pub(crate) fn find_awake(&mut self) {
        let guards = self.list.iter().enumerate();
        let awake = guards.filter(|(_, guard)| !guard.is_asleep() || guard.is_unsettled);
        let indices = &mut self.awake.indices;
        indices.clear();
        indices.extend(awake.map(|(index, _)| index));
        self.awake.has_hounds = self.list.iter().any(|guard| guard.kind == GuardKind::Hound);
        self.awake.figures = self.figures().count();
    }

    /// The guards who are awake.
    pub(crate) fn awake(&self) -> impl Iterator<Item = &Guard> + Clone {
        self.awake.indices.iter().map(|&index| &self.list[index])
    }

    /// Records where all guards are. Those who sleep have not moved since the last step.
    pub(crate) fn look_at_others(&mut self) {
        if self.others.len() != self.list.len() {
            self.others.clear();
            self.others.extend(self.list.iter().map(Guard::as_other));
            return;
        }
        for &index in &self.awake.indices {
            self.others[index] = self.list[index].as_other();
        }
    }
}

impl Guard {
    /// Whether the guard does nothing until somebody wakes them.
    pub(crate) fn is_asleep(&self) -> bool {
        self.state == State::Asleep && self.stagger == 0
    }
}
