//! Health: anything that hurts takes points, and a player without points is dead.
//!
//! A guard outside the player's view warns before they kill:
//!
//! - If a blow from outside the view would kill, it leaves one point and warns of the guard.
//! - For [`GRACE`] steps after the warning, further such blows by that guard also leave the point.
//!   After that, they kill.
//! - A guard whose last such blow was [`FORGOTTEN`] steps ago warns again.
//!
//! Each guard gives a separate warning. Rejected: one warning for all guards. The second of two
//! guards would kill a player that they had not struck before. Rejected: sparing the player each
//! time. A player who faces a wall could not be killed.

use serde::{Deserialize, Serialize};

use super::stored::{RestoreError, check};
use crate::world::{GuardKind, Heading};

/// A player's points of health.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Health {
    /// The current points, at most [`Health::most`].
    pub points: u8,
    /// The points of an unhurt player.
    pub most: u8,
}

/// A flash at the edge of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flash {
    /// The reason for the flash.
    pub kind: FlashKind,
    /// The remaining steps, at least one.
    pub left: u16,
}

/// The reason for a flash.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum FlashKind {
    /// The player was hurt.
    Hurt {
        /// The direction on the map from the player to the cause. `None` if the harm has no
        /// direction, for example a fall.
        bearing: Option<Heading>,
    },
    /// The player picked something up.
    Gain,
}

/// A loss of health.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Harm {
    pub(crate) points: u8,
    /// The direction from the player to the cause.
    pub(crate) bearing: Option<Heading>,
    /// `true` if the last point is left, because the player could not see the attack.
    pub(crate) spares: bool,
    /// The cause of death in the message, if this kills.
    pub(crate) cause: Cause,
}

/// A cause of death.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) enum Cause {
    Guard(GuardKind),
    Bolt,
    Spikes,
    Water,
    Fall,
}

/// The durations of flashes, in steps.
const HURT_STEPS: u16 = 24;
const GAIN_STEPS: u16 = 12;

impl Health {
    /// The points of an unhurt player.
    const MAX: u8 = 6;

    /// Whether no points are left.
    pub fn is_gone(self) -> bool {
        self.points == 0
    }

    /// The health after `harm`.
    pub(crate) fn after(self, harm: &Harm) -> Self {
        let least = u8::from(harm.spares).min(self.points);
        Self { points: self.points.saturating_sub(harm.points).max(least), ..self }
    }

    /// The health after a gain of `points`, up to the maximum.
    pub(crate) fn healed(self, points: u8) -> Self {
        Self { points: self.points.saturating_add(points).min(self.most), ..self }
    }

    /// The health of a player who continues after death: at least half of the maximum.
    pub(crate) fn revived(self) -> Self {
        Self { points: self.points.max(self.most / 2), ..self }
    }

    /// Whether a player can have this health.
    pub(crate) fn is_possible(self) -> bool {
        self.points <= self.most && self.most == Self::MAX
    }

    /// Whether points are missing.
    pub(crate) fn is_hurt(self) -> bool {
        self.points < self.most
    }
}

impl Default for Health {
    /// Full health.
    fn default() -> Self {
        Self { points: Self::MAX, most: Self::MAX }
    }
}

impl Flash {
    /// The steps over which a flash fades at its end.
    pub(crate) const FADE: u16 = 12;

    /// The flash's strength, as a fraction of its full strength from 0 to 1.
    #[cfg(feature = "terminal")]
    pub(crate) fn strength(self) -> f64 {
        f64::from(self.left.min(Self::FADE)) / f64::from(Self::FADE)
    }

    /// A flash for `harm`.
    pub(crate) fn hurt(harm: &Harm) -> Self {
        Self { kind: FlashKind::Hurt { bearing: harm.bearing }, left: HURT_STEPS }
    }

    /// A flash for a blow that leaves `grace` steps of grace.
    pub(crate) fn warning(harm: &Harm, grace: u16) -> Self {
        Self { left: grace.max(HURT_STEPS), ..Self::hurt(harm) }
    }

    /// A flash for another player's blow, which takes no health.
    pub(crate) fn struck(bearing: Option<Heading>) -> Self {
        Self { kind: FlashKind::Hurt { bearing }, left: HURT_STEPS }
    }

    /// A flash for a pickup.
    pub(crate) fn gain() -> Self {
        Self { kind: FlashKind::Gain, left: GAIN_STEPS }
    }

    /// The flash after `steps` steps. `None` if it has ended.
    pub(crate) fn after(self, steps: u16) -> Option<Self> {
        let left = self.left.saturating_sub(steps);
        (left > 0).then_some(Self { left, ..self })
    }
}

impl Cause {
    /// The cause as part of a sentence: "killed by …".
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Guard(GuardKind::Warden) => "a warden",
            Self::Guard(GuardKind::Listener) => "a listener",
            Self::Guard(GuardKind::Lantern) => "a lantern-bearer",
            Self::Guard(GuardKind::Hound) => "a hound",
            Self::Guard(GuardKind::Archer) => "an archer",
            Self::Bolt => "an archer's bolt",
            Self::Spikes => "spikes",
            Self::Water => "cold water",
            Self::Fall => "a fall",
        }
    }
}

/// The number of steps after a warning during which the guard does not kill: 3 seconds.
pub(crate) const GRACE: u16 = 180;
/// The number of steps after a blow during which the guard is remembered: 10 seconds.
const FORGOTTEN: u64 = 600;

/// The guards that a player has been warned of.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Warnings {
    list: Vec<Warning>,
}

/// A guard that a player has been warned of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Warning {
    /// The index of the guard.
    guard: usize,
    /// The step of the blow that gave the warning, and the step of the last blow that left the
    /// point.
    since: u64,
    last: u64,
}

impl Warnings {
    /// Records a blow by `guard` in the step `now` that would kill from outside the view. Returns
    /// the remaining steps of grace, or `None` if the blow kills.
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

    /// Returns an error if a warning is later than the step `now`.
    pub(crate) fn check(&self, now: u64) -> Result<(), RestoreError> {
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
        fn health_stays_between_zero_and_the_maximum(
            changes in prop::collection::vec((any::<bool>(), any::<u8>(), any::<bool>()), 0..20)
        ) {
            let mut health = Health::default();
            for (heals, points, spares) in changes {
                let before = health;
                let harm = Harm { points, bearing: None, spares, cause: Cause::Fall };
                health = if heals { health.healed(points) } else { health.after(&harm) };
                prop_assert!(health.points <= health.most && health.most == Health::MAX);
                prop_assert!(!spares || heals || before.is_gone() || !health.is_gone());
            }
        }
    }

    #[test]
    fn a_flash_ends() {
        let flash = Flash::gain();
        assert_eq!(flash.after(GAIN_STEPS - 1).map(|flash| flash.left), Some(1));
        assert_eq!(flash.after(GAIN_STEPS), None);
    }

    proptest! {
        #[test]
        fn each_guard_warns_first_and_kills_only_after_its_grace(
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
