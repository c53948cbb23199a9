//! Race: the first at the exit wins.

use std::collections::BTreeMap;

use super::{Field, Role, SECOND, Score};
use crate::game::stored::stored;
use crate::server::room::entry::MemberId;

/// How long the others may go on after the first has arrived.
const AFTER_FIRST: u64 = 60 * SECOND;

/// The state of a race.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Race {
    begun: u64,
    /// The steps to the exit.
    arrived: BTreeMap<MemberId, u64>,
}

stored! { struct Race { begun, arrived } }

impl Race {
    pub(super) fn begin(&mut self, step: u64) {
        self.begun = step;
    }

    pub(super) fn begins_until(&self, step: u64) -> bool {
        self.begun <= step
    }

    pub(super) fn role(&self, member: MemberId) -> Role {
        if self.arrived.contains_key(&member) { Role::Done } else { Role::Player }
    }

    /// Records who has arrived; returns whether the race is decided.
    pub(super) fn step(&mut self, field: Field) -> bool {
        let time = field.step - self.begun;
        for id in field.ids().filter(|&id| field.has_won(id)) {
            self.arrived.entry(id).or_insert(time);
        }
        let first = self.arrived.values().min();
        let all = field.ids().all(|id| self.arrived.contains_key(&id));
        all || first.is_some_and(|first| first + AFTER_FIRST <= time)
    }

    /// The scores: the shortest time wins, and all who have not arrived are last.
    pub(super) fn scores(&self, field: Field) -> BTreeMap<MemberId, Score> {
        let time = |id| self.arrived.get(&id).copied();
        let score = |id| Score { rank: time(id).unwrap_or(u64::MAX), steps: time(id).unwrap_or(0) };
        field.ids().map(|id| (id, score(id))).collect()
    }
}
