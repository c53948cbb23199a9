//! When a replica has last done what it does from time to time.

use std::time::Duration;

use tokio::time::Instant;

use crate::server::sequencer::STEP;

/// The time from one claim, or renewal, to the next.
pub(super) const SECOND: Duration = Duration::from_secs(1);
/// The most steps that follow at once after a delay.
const MOST_DUE: u64 = 6;

/// When what is done from time to time was done last.
pub(super) struct Times {
    /// The room has taken steps, or was found to rest.
    pub(super) moved: Instant,
    pub(super) read: Option<Instant>,
    pub(super) restored: Option<Instant>,
    pub(super) claimed: Option<Instant>,
    pub(super) leased: Option<Instant>,
    /// When the lease ends if it is not renewed, by this host's clock.
    pub(super) lease_ends: Option<Instant>,
    pub(super) kept: Option<Instant>,
    pub(super) published: Option<Instant>,
    /// Somebody needed the replica.
    pub(super) needed: Instant,
    /// Up to when the sequencer has taken steps.
    pub(super) stepped: Instant,
}

impl Times {
    /// Nothing was done yet but the start.
    pub(super) fn new(now: Instant) -> Self {
        Self {
            moved: now,
            read: None,
            restored: None,
            claimed: None,
            leased: None,
            lease_ends: None,
            kept: None,
            published: None,
            needed: now,
            stepped: now,
        }
    }
}

/// The steps that are due since `stepped`, which is moved on.
pub(super) fn steps_due(stepped: &mut Instant, now: Instant) -> u64 {
    let due = now.saturating_duration_since(*stepped).div_duration_f64(STEP) as u64;
    *stepped = if due > MOST_DUE { now } else { *stepped + STEP * due as u32 };
    due.min(MOST_DUE)
}

/// Whether `pause` has passed since `last`.
pub(super) fn is_due(last: Option<Instant>, now: Instant, pause: Duration) -> bool {
    last.is_none_or(|last| now.duration_since(last) >= pause)
}
