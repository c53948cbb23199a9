//! Hide and seek: a quarter of the members seek the others, and whoever is found seeks, too.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Field, Role, Score};
use crate::rooms::room::entry::MemberId;
use cellcaster::rng::SplitMix64;

/// Members for each seeker at the start.
const MEMBERS_A_SEEKER: usize = 4;

/// The state of a round of hide and seek.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Hide {
    /// The seekers, with the steps for which they stayed hidden; `None` for those of the start.
    seekers: BTreeMap<MemberId, Option<u64>>,
    /// The step in which the search began.
    since: Option<u64>,
}

impl Hide {
    /// Chooses the first seekers.
    pub(crate) fn choose(&mut self, field: Field, chance: &mut SplitMix64) {
        let mut ids: Vec<MemberId> = field.ids().collect();
        let count = ids.len().div_ceil(MEMBERS_A_SEEKER).min(ids.len().saturating_sub(1));
        for _ in 0..count {
            let chosen = ids.remove(chance.below(ids.len()));
            self.seekers.insert(chosen, None);
        }
    }

    pub(crate) fn begins_until(&self, step: u64) -> bool {
        self.since.is_none_or(|since| since <= step)
    }

    pub(crate) fn role(&self, member: MemberId) -> Role {
        if self.seekers.contains_key(&member) { Role::Seeker } else { Role::Player }
    }

    /// Finds whom a seeker touches; returns whether the round is decided: all are found, or nobody
    /// seeks any more.
    pub(crate) fn step(&mut self, field: Field) -> bool {
        let since = *self.since.get_or_insert(field.step);
        let is_seeker = |id: &MemberId| self.seekers.contains_key(id);
        let (seekers, hidden): (Vec<MemberId>, Vec<MemberId>) = field.ids().partition(is_seeker);
        let is_found = |id: &&MemberId| seekers.iter().any(|&seeker| field.touches(seeker, **id));
        let found: Vec<MemberId> = hidden.iter().filter(is_found).copied().collect();
        let left = hidden.len() - found.len();
        self.seekers.extend(found.into_iter().map(|id| (id, Some(field.step - since))));
        left == 0 || seekers.is_empty()
    }

    /// The scores: who stayed hidden longest wins, and the first seekers are last.
    pub(crate) fn scores(&self, field: Field) -> BTreeMap<MemberId, Score> {
        let whole = field.step - self.since.unwrap_or(field.step);
        let hidden = |id| match self.seekers.get(&id) {
            None => whole,
            Some(found) => found.unwrap_or(0),
        };
        field
            .ids()
            .map(|id| (id, Score { rank: u64::MAX - hidden(id), steps: Some(hidden(id)) }))
            .collect()
    }
}
