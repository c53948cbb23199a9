//! Tag: one member is "it" until they touch another one.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Field, Role, SECOND, Score};
use crate::rooms::room::entry::MemberId;
use cellcaster::rng::SplitMix64;

/// How long a new "it" stands still, so that the others get away.
const PAUSE: u64 = SECOND + SECOND / 2;
/// How long whoever was "it" cannot be touched by the next one.
const SPARED: u64 = 4 * SECOND;

/// The state of a round of tag.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Tag {
    it: Option<MemberId>,
    /// The step in which "it" last changed.
    since: u64,
    /// Who was "it" before.
    before: Option<MemberId>,
    /// How long each member was "it", in steps.
    times: BTreeMap<MemberId, u64>,
}

impl Tag {
    /// Chooses the first "it".
    pub(crate) fn choose(&mut self, field: Field, chance: &mut SplitMix64) {
        let ids: Vec<MemberId> = field.ids().collect();
        self.it = ids.get(chance.below(ids.len())).copied();
        self.since = field.step;
    }

    pub(crate) fn begins_until(&self, step: u64) -> bool {
        self.since <= step
    }

    pub(crate) fn role(&self, member: MemberId) -> Role {
        if self.it == Some(member) { Role::Seeker } else { Role::Player }
    }

    /// Whether a member stands still since they have just been touched.
    pub(crate) fn holds(&self, member: MemberId, step: u64) -> bool {
        self.it == Some(member) && step < self.since + PAUSE
    }

    pub(crate) fn step(&mut self, field: Field) {
        let Some(it) = self.it.filter(|&it| field.member(it).is_some()) else {
            // Whoever was "it" has left; the one of the longest time follows, so that nobody gains.
            let longest = field.ids().max_by_key(|id| self.time(*id));
            return self.become_it(longest, field.step);
        };
        *self.times.entry(it).or_default() += 1;
        if self.holds(it, field.step) {
            return;
        }
        let is_spared = |id| self.before == Some(id) && field.step < self.since + SPARED;
        let touched = field.ids().find(|&id| id != it && !is_spared(id) && field.touches(it, id));
        if touched.is_some() {
            self.become_it(touched, field.step);
        }
    }

    /// The scores: who was "it" for the shortest time wins.
    pub(crate) fn scores(&self, field: Field) -> BTreeMap<MemberId, Score> {
        field
            .ids()
            .map(|id| (id, Score { rank: self.time(id), steps: Some(self.time(id)) }))
            .collect()
    }

    fn become_it(&mut self, next: Option<MemberId>, step: u64) {
        self.before = self.it;
        self.it = next;
        self.since = step;
    }

    fn time(&self, id: MemberId) -> u64 {
        self.times.get(&id).copied().unwrap_or(0)
    }
}
