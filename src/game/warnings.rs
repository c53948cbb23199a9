//! Warnings: what a player who does not see a guard is told before the guard kills them.
//!
//! - A blow from outside the view that would kill leaves one point, and warns of the guard who struck.
//! - For [`GRACE`] steps after the warning, further such blows of that guard leave the point, too.
//!   After them, they kill.
//! - A guard whose last such blow was [`FORGOTTEN`] steps ago warns again.
//!
//! Each guard warns for themselves. One warning for all was refused: the second of two guards would
//! kill a player whom they had not struck before. Sparing the player each time was refused, too: a
//! player who faced a wall could not be killed.

use serde::{Deserialize, Serialize};

use super::stored::{Unrestorable, check};

/// The steps after a warning in which the guard does not kill: 3 seconds.
pub(crate) const GRACE: u16 = 180;
/// The steps after a blow in which the guard is remembered: 10 seconds.
const FORGOTTEN: u64 = 600;

/// The guards of whom a player has been warned.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Warnings {
    list: Vec<Warning>,
}

/// A guard of whom a player has been warned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Warning {
    /// The index of the guard.
    guard: usize,
    /// The step of the blow that warned, and that of the last blow which left the point.
    since: u64,
    last: u64,
}

impl Warnings {
    /// Records a blow of `guard` in the step `now` that would kill from outside the view. Returns the
    /// steps of grace that are left; `None` if it kills.
    pub(crate) fn spare(&mut self, guard: usize, now: u64) -> Option<u16> {
        self.list.retain(|warning| now.saturating_sub(warning.last) < FORGOTTEN);
        let known = self.list.iter_mut().find(|warning| warning.guard == guard);
        let Some(warning) = known else {
            self.list.push(Warning { guard, since: now, last: now });
            return Some(GRACE);
        };
        let passed = u16::try_from(now - warning.since).unwrap_or(u16::MAX);
        let left = GRACE.checked_sub(passed).filter(|&left| left > 0)?;
        warning.last = now;
        Some(left)
    }

    /// Refuses warnings after the step `now`.
    pub fn check(&self, now: u64) -> Result<(), Unrestorable> {
        check(self.list.iter().all(|it| it.since <= it.last && it.last <= now), "a warning")
    }

    /// Forgets all guards.
    pub(crate) fn clear(&mut self) {
        self.list.clear();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_guard_warns_first_and_kills_after_the_grace_whatever_others_do(
            waits in prop::collection::vec(1..700_u64, 1..12),
            others in prop::collection::vec(any::<bool>(), 12),
        ) {
            let mut warnings = Warnings::default();
            let (mut now, mut since, mut last) = (0, 0, None);
            for (wait, is_other_first) in waits.into_iter().zip(others) {
                now += wait;
                if is_other_first {
                    warnings.spare(1, now);
                }
                if last.is_none_or(|last| now - last >= FORGOTTEN) {
                    since = now;
                }
                let passed = now - since;
                let left = warnings.spare(0, now);
                prop_assert_eq!(left.map(u64::from), u64::from(GRACE).checked_sub(passed).filter(|&left| left > 0));
                if left.is_none() {
                    break;
                }
                last = Some(now);
            }
        }
    }
}
