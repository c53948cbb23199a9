//! What answers tell of a link: how long they take at least, and how much it carries.

use std::time::Duration;

use super::fit::Fit;

/// A link, as far as it is known.
#[derive(Debug, Default)]
pub(super) struct Link {
    lowest: Option<Lowest>,
    round_trip: Option<Duration>,
    answered_at: Duration,
    fit: Fit,
    /// A frame that took far longer than expected, where it was the latest one.
    surprise: Option<Busy>,
    stalled_at: Option<Duration>,
}

/// What a frame was, and how long it kept the link busy.
#[derive(Clone, Copy, Debug)]
struct Busy {
    bytes: f64,
    seconds: f64,
}

/// What even the fastest link takes for a frame: nobody can measure less.
const LEAST_BUSY: Duration = Duration::from_micros(100);
/// A frame is surprising that takes longer than expected by so many standard deviations, and by so
/// many seconds.
const SURPRISING: f64 = 4.0;
const SURPRISING_SECONDS: f64 = 0.25;
/// A surprise of so many seconds is a stall; one of fewer may be jitter.
const STALL_SECONDS: f64 = 1.0;
/// How many standard errors steeper than the likeliest line the one is that counts. Where nobody can tell
/// delay from rate, it is the rate that is doubted: too much on a line that others share delays all of them.
const DOUBT: f64 = 0.75;
/// What may be in flight on a link that has stalled: so many bytes, or what it carries in so many seconds.
/// When it stalls again, all of that has to arrive before anything new does.
const CAREFUL_BYTES: f64 = 16_000.0;
const CAREFUL_SECONDS: f64 = 0.024;
/// For how long a stall counts.
const CAREFUL_FOR: Duration = Duration::from_secs(60);

impl Link {
    /// Takes note of the answer to a frame.
    pub(super) fn answered(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        let round_trip = now.saturating_sub(sent_at);
        let lowest = Lowest::with(self.lowest, now, round_trip);
        // It has the link for itself from when it could be there, and the one before it was through.
        let begun = (sent_at + lowest.get()).max(self.answered_at);
        self.carry(now, bytes, now.saturating_sub(begun));
        self.lowest = Some(lowest);
        self.round_trip = Some(round_trip);
        self.answered_at = now;
    }

    /// Takes note that the system has taken a frame.
    pub(super) fn taken(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        self.carry(now, bytes, now.saturating_sub(sent_at));
        self.answered_at = now;
    }

    /// One frame that takes far too long has met a stall, and says nothing of the rate; two in a row
    /// are a link that has changed.
    fn carry(&mut self, now: Duration, bytes: usize, busy: Duration) {
        if bytes == 0 {
            return;
        }
        let seconds = busy.max(LEAST_BUSY).as_secs_f64();
        let busy = Busy { bytes: bytes as f64, seconds };
        match self.surprise.take() {
            None if self.is_surprising(busy) => {
                self.surprise = Some(busy);
                if seconds >= STALL_SECONDS {
                    self.stalled_at = Some(now);
                }
            }
            Some(before) if self.is_surprising(busy) => {
                self.fit = Fit::default();
                self.fit.add(before.bytes, before.seconds);
                self.fit.add(busy.bytes, busy.seconds);
            }
            _ => self.fit.add(busy.bytes, busy.seconds),
        }
    }

    fn is_surprising(&self, Busy { bytes, seconds }: Busy) -> bool {
        self.fit.line().is_some_and(|line| {
            let expected = line.constant + line.per_byte * bytes;
            seconds > expected + (SURPRISING * line.deviation).max(SURPRISING_SECONDS)
        })
    }

    /// Whether it has carried a frame.
    pub(super) fn is_known(&self) -> bool {
        self.fit.mean().is_some()
    }

    /// Whether an answer can be there so soon.
    pub(super) fn is_plausible(&self, round_trip: Duration) -> bool {
        self.lowest.is_none_or(|lowest| round_trip >= lowest.get() / 2)
    }

    /// How long the latest answer took.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.round_trip
    }

    /// How many seconds it is busy with a byte.
    fn seconds_per_byte(&self) -> f64 {
        let usual = self
            .fit
            .line()
            .map_or(0.0, |line| (line.per_byte + DOUBT * line.error).min(line.through_origin));
        self.surprise.map_or(usual, |busy| usual.max(busy.seconds / busy.bytes))
    }

    /// How many bytes a second are to be sent at the most; `None` for any number.
    pub(super) fn usable_rate(&self) -> Option<f64> {
        let seconds = self.seconds_per_byte();
        let rate = (seconds > 0.0).then(|| seconds.recip());
        let is_past = |at| self.answered_at.saturating_sub(at) > CAREFUL_FOR;
        if self.stalled_at.is_none_or(is_past) {
            return rate;
        }
        let in_flight = (CAREFUL_SECONDS * rate.unwrap_or(0.0)).max(CAREFUL_BYTES);
        let careful = in_flight / self.expected_round_trip().as_secs_f64().max(1e-3);
        Some(rate.map_or(careful, |rate| rate.min(careful)))
    }

    /// How long it is busy with so many bytes.
    pub(super) fn time_for(&self, bytes: usize) -> Duration {
        Duration::from_secs_f64((bytes as f64 * self.seconds_per_byte()).min(LONGEST))
    }

    /// How long the answer to a frame takes that nothing is in the way of.
    pub(super) fn expected_round_trip(&self) -> Duration {
        let bytes = self.fit.mean().map_or(0.0, |(bytes, _)| bytes);
        self.lowest.map(Lowest::get).unwrap_or_default() + self.time_for(bytes as usize)
    }

    /// How much longer than that it takes of late, in the mean.
    pub(super) fn jitter(&self) -> Duration {
        Duration::from_secs_f64(self.fit.line().map_or(0.0, |line| line.constant))
    }
}

/// No link is busy with anything for longer: seconds in a day.
const LONGEST: f64 = 86_400.0;

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
