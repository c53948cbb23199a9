//! What answers tell of a link: how long they take at least, and how much it carries.

use std::time::Duration;

/// A link, as far as it is known.
#[derive(Debug, Default)]
pub(super) struct Link {
    lowest: Option<Lowest>,
    round_trip: Option<Duration>,
    answered_at: Duration,
    carried: Carried,
}

/// How much the last frames were, and how long they kept the link busy: sums, in which a frame
/// counts the less the longer ago it was.
#[derive(Clone, Copy, Debug, Default)]
struct Carried {
    frames: f64,
    bytes: f64,
    seconds: f64,
}

/// How much of the past counts after one more frame.
const KEPT: f64 = 0.8;
/// What even the fastest link takes for a frame: nobody can measure less.
const LEAST_BUSY: Duration = Duration::from_micros(100);

impl Link {
    /// Takes note of the answer to a frame.
    pub(super) fn answered(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        let round_trip = now.saturating_sub(sent_at);
        let lowest = Lowest::with(self.lowest, now, round_trip);
        // It has the link for itself from when it could be there, and the one before it was through.
        let begun = (sent_at + lowest.get()).max(self.answered_at);
        self.carry(bytes, now.saturating_sub(begun));
        self.lowest = Some(lowest);
        self.round_trip = Some(round_trip);
        self.answered_at = now;
    }

    /// Takes note that the system has taken a frame.
    pub(super) fn taken(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        self.carry(bytes, now.saturating_sub(sent_at));
    }

    fn carry(&mut self, bytes: usize, busy: Duration) {
        if bytes > 0 {
            let Carried { frames, bytes: before, seconds } = self.carried;
            self.carried = Carried {
                frames: frames * KEPT + 1.0,
                bytes: before * KEPT + bytes as f64,
                seconds: seconds * KEPT + busy.max(LEAST_BUSY).as_secs_f64(),
            };
        }
    }

    /// Whether an answer can be there so soon.
    pub(super) fn is_plausible(&self, round_trip: Duration) -> bool {
        self.lowest.is_none_or(|lowest| round_trip >= lowest.get() / 2)
    }

    /// How long the latest answer took.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// How many bytes it carries in a second, as far as it has had to.
    pub(super) fn rate(&self) -> Option<f64> {
        let Carried { frames, bytes, seconds } = self.carried;
        (frames > 0.0).then(|| bytes / seconds)
    }

    /// How long it is busy with so many bytes.
    pub(super) fn time_for(&self, bytes: usize) -> Option<Duration> {
        // The rate is finite, and above zero where there is one.
        Some(Duration::from_secs_f64(bytes as f64 / self.rate()?))
    }

    /// How long the answer to a frame takes that nothing is in the way of.
    pub(super) fn expected_round_trip(&self) -> Duration {
        let Carried { frames, seconds, .. } = self.carried;
        let busy = if frames > 0.0 { seconds / frames } else { 0.0 };
        self.lowest.map(Lowest::get).unwrap_or_default() + Duration::from_secs_f64(busy)
    }
}

/// The lowest of the round trips of late: the way there and back without waiting. One that is
/// the lowest of all times would be wrong for ever once the way has become longer.
#[derive(Clone, Copy, Debug)]
struct Lowest {
    since: Duration,
    of_now: Duration,
    of_before: Duration,
}

/// For how long a round trip counts, at least.
const LATE: Duration = Duration::from_secs(30);

impl Lowest {
    fn with(before: Option<Self>, now: Duration, round_trip: Duration) -> Self {
        match before {
            None => Self { since: now, of_now: round_trip, of_before: round_trip },
            Some(old) if now.saturating_sub(old.since) > LATE => {
                Self { since: now, of_now: round_trip, of_before: old.of_now }
            }
            Some(old) => Self { of_now: old.of_now.min(round_trip), ..old },
        }
    }

    fn get(self) -> Duration {
        self.of_now.min(self.of_before)
    }
}
