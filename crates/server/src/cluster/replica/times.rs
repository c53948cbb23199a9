//! When a replica has last done what it does from time to time.

use std::time::Duration;

use tokio::time::Instant;

use crate::rooms::sequencer::STEP;

/// The time from one claim, or renewal, to the next.
pub(crate) const SECOND: Duration = Duration::from_secs(1);
/// The most steps that follow at once after a delay.
const MOST_DUE: u64 = 6;

/// When what is done from time to time was done last.
pub(crate) struct Times {
    /// The room has taken steps, or was found to rest.
    pub(crate) moved: Instant,
    pub(crate) read: Option<Instant>,
    pub(crate) restored: Option<Instant>,
    pub(crate) claimed: Option<Instant>,
    pub(crate) leased: Option<Instant>,
    /// When the lease ends if it is not renewed, by this host's clock.
    pub(crate) lease_ends: Option<Instant>,
    pub(crate) kept: Option<Instant>,
    pub(crate) published: Option<Instant>,
    /// Somebody needed the replica.
    pub(crate) needed: Instant,
    /// Up to when the sequencer has taken steps.
    pub(crate) stepped: Instant,
}

impl Times {
    /// Nothing was done yet but the start.
    pub(crate) fn new(now: Instant) -> Self {
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
pub(crate) fn steps_due(stepped: &mut Instant, now: Instant) -> u64 {
    let due = now.saturating_duration_since(*stepped).div_duration_f64(STEP) as u64;
    *stepped = if due > MOST_DUE { now } else { *stepped + STEP * due as u32 };
    due.min(MOST_DUE)
}

/// Whether `pause` has passed since `last`.
pub(crate) fn is_due(last: Option<Instant>, now: Instant, pause: Duration) -> bool {
    last.is_none_or(|last| now.duration_since(last) >= pause)
}
