//! The minimum of recent round-trip times: the delay of the link in both directions, without queues.
//!
//! The minimum of all times would stay wrong after the route has become longer. This is the
//! windowed minimum filter of BBR (draft-cardwell-iccrg-bbr-congestion-control, "`BBR.min_rtt`"),
//! over two halves of a window.

use std::time::Duration;

/// The minimum of this half of the window and of the one before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MinRoundTrip {
    since: Duration,
    current: Duration,
    previous: Duration,
}

/// The length of half of the window.
const HALF_WINDOW: Duration = Duration::from_secs(30);

impl MinRoundTrip {
    /// The minimum after a `round_trip` that ended at `now`.
    pub(crate) fn with(before: Option<Self>, now: Duration, round_trip: Duration) -> Self {
        match before {
            None => Self { since: now, current: round_trip, previous: round_trip },
            Some(old) if now.saturating_sub(old.since) > HALF_WINDOW => {
                Self { since: now, current: round_trip, previous: old.current }
            }
            Some(old) => Self { current: old.current.min(round_trip), ..old },
        }
    }

    pub(crate) fn get(self) -> Duration {
        self.current.min(self.previous)
    }
}
