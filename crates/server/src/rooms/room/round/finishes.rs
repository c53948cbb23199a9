//! Modes that end at the exit: races, and the campaign, alone and together.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Field, Role, Score};
use crate::rooms::room::entry::MemberId;
use crate::rooms::room::mode::Mode;

/// The finish of a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Finish {
    /// The place, from 1. Members who reach the exit in the same step have the same place.
    pub(crate) place: usize,
    /// The steps from the start to the exit.
    pub(crate) steps: u64,
}

/// Who has reached the exit, and when.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Finishes {
    begun: u64,
    /// The steps to the exit, also of members who have left since.
    times: BTreeMap<MemberId, u64>,
}

impl Finishes {
    pub(crate) fn begin(&mut self, step: u64) {
        self.begun = step;
    }

    /// The step in which the play began.
    pub(crate) fn begun(&self) -> u64 {
        self.begun
    }

    pub(crate) fn role(&self, member: MemberId) -> Role {
        if self.times.contains_key(&member) { Role::Done } else { Role::Player }
    }

    pub(crate) fn of(&self, member: MemberId) -> Option<Finish> {
        let steps = *self.times.get(&member)?;
        let before = self.times.values().filter(|&&other| other < steps).count();
        Some(Finish { place: before + 1, steps })
    }

    /// The members who have finished in `step`.
    pub(crate) fn in_step(&self, step: u64) -> impl Iterator<Item = MemberId> {
        let finished = self.times.iter().filter(move |(_, time)| self.begun + **time == step);
        finished.map(|(&member, _)| member)
    }

    /// The step in which the first member has finished.
    pub(crate) fn first(&self) -> Option<u64> {
        self.times.values().min().map(|time| self.begun + time)
    }

    /// Records who has finished; returns whether all have.
    pub(crate) fn step(&mut self, field: Field) -> bool {
        let time = field.step - self.begun;
        for id in field.ids().filter(|&id| field.has_won(id)) {
            self.times.entry(id).or_insert(time);
        }
        field.ids().all(|id| self.times.contains_key(&id))
    }

    /// The scores: all who have not finished are last. The shortest time wins a race; in the campaign, all who are
    /// out are equal.
    pub(crate) fn scores(&self, mode: Mode, field: Field) -> BTreeMap<MemberId, Score> {
        let rank = |time: u64| if mode == Mode::Together { 0 } else { time };
        let score = |id| {
            let steps = self.times.get(&id).copied();
            Score { rank: steps.map_or(u64::MAX, rank), steps }
        };
        field.ids().map(|id| (id, score(id))).collect()
    }
}
