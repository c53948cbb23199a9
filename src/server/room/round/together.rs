//! The campaign together: a level is done when all are out.

use std::collections::{BTreeMap, BTreeSet};

use super::{Field, Role, SECOND, Score};
use crate::game::stored::stored;
use crate::server::room::entry::MemberId;

/// How long the others may go on after the first is out.
const AFTER_FIRST: u64 = 120 * SECOND;

/// The state of a level.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(super) struct Together {
    out: BTreeSet<MemberId>,
    first_out: Option<u64>,
}

stored! { struct Together { out, first_out } }

impl Together {
    pub(super) fn role(&self, member: MemberId) -> Role {
        if self.out.contains(&member) { Role::Done } else { Role::Player }
    }

    /// Records who is out; returns whether the level is done.
    pub(super) fn step(&mut self, field: Field) -> bool {
        self.out.extend(field.ids().filter(|&id| field.has_won(id)));
        if self.out.is_empty() {
            return false;
        }
        let first = *self.first_out.get_or_insert(field.step);
        field.ids().all(|id| self.out.contains(&id)) || first + AFTER_FIRST <= field.step
    }

    /// The scores: all who are out are equal.
    pub(super) fn scores(&self, field: Field) -> BTreeMap<MemberId, Score> {
        let score = |id| Score { rank: u64::from(!self.out.contains(&id)), steps: field.step };
        field.ids().map(|id| (id, score(id))).collect()
    }
}
