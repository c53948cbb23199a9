//! How a keyboard repeats: how long it waits, and how often it repeats then.

use std::time::Duration;

/// No keyboard begins to repeat sooner, nor later.
const SHORTEST_DELAY: Duration = Duration::from_millis(200);
const LONGEST_DELAY: Duration = Duration::from_secs(1);
/// The longest delay that is a system's default, X11's 660 ms, and an interval more.
const USUAL_DELAY: Duration = Duration::from_millis(750);
/// Most systems' default.
const USUAL_SILENCE: Duration = Duration::from_millis(500);
/// People do not tap the same key twice so soon, nor more often in such times and a bit more each.
const SHORTEST_TAP: Duration = Duration::from_millis(80);
const PATIENCE: Duration = Duration::from_millis(10);
const MOST_PATIENCE: u32 = 2;
/// How many of its intervals a key may miss, in halves, and the bounds of that time: a link that delivers
/// repetitions in bursts measures too short an interval.
const MISSED_HALVES: u32 = 5;
const SHORTEST_WINDOW: Duration = Duration::from_millis(90);
const LONGEST_WINDOW: Duration = Duration::from_millis(300);
/// The interval while none has been measured.
const USUAL_INTERVAL: Duration = Duration::from_millis(60);

/// The delay and the interval of a keyboard, as far as they have been learned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rhythm {
    pub(super) delay: Option<Duration>,
    /// The longest of the last ones, slowly forgotten.
    pub(super) interval: Option<Duration>,
}

impl Rhythm {
    /// This, and what `prior` knows where it knows nothing.
    pub(super) fn or(self, prior: Self) -> Self {
        Self { delay: self.delay.or(prior.delay), interval: self.interval.or(prior.interval) }
    }

    /// Whether a key that repeats for the first time may do so after `gap`.
    pub(super) fn may_begin_after(self, gap: Duration) -> bool {
        let earliest = self.delay.map_or(SHORTEST_DELAY, |delay| delay * 3 / 4);
        (earliest.max(SHORTEST_DELAY)..=LONGEST_DELAY).contains(&gap)
    }

    /// Whether `count` bytes that took `span` since the one before them are too many for taps.
    pub(super) fn is_repetition(self, count: u32, span: Duration) -> bool {
        let mean = SHORTEST_TAP + PATIENCE * (count.saturating_sub(1)).min(MOST_PATIENCE);
        let known = self.interval.map_or(Duration::ZERO, |interval| interval * 5 / 4);
        span <= mean.max(known.min(SHORTEST_TAP * 3 / 2)) * count
    }

    /// Takes note that the first repetition came after `delay`.
    pub(super) fn learn_delay(&mut self, delay: Duration) {
        if (SHORTEST_DELAY..=LONGEST_DELAY).contains(&delay) {
            // A link may delay a byte, but can't bring it before its time: what is shorter is believed at once.
            let known = self.delay.unwrap_or(delay);
            self.delay = Some(delay.min(known + delay.saturating_sub(known) / 4));
        }
    }

    /// Takes note that a repetition came after `interval`.
    pub(super) fn learn_interval(&mut self, interval: Duration) {
        let longest = self.interval.map_or(Duration::ZERO, |longest| longest * 7 / 8);
        self.interval = Some(interval.max(longest));
    }

    /// For how long a key that was pressed may be down without having repeated.
    pub(super) fn first_window(self) -> Duration {
        self.delay.map_or(USUAL_DELAY, |delay| delay * 5 / 4 + SHORTEST_TAP)
    }

    /// How long a key that is down surely has not repeated.
    pub(super) fn silence(self) -> Duration {
        self.delay.unwrap_or(USUAL_SILENCE)
    }

    /// For how long a key that repeats may be silent.
    pub(super) fn window(self) -> Duration {
        let interval = self.interval.unwrap_or(USUAL_INTERVAL);
        (interval * MISSED_HALVES / 2).clamp(SHORTEST_WINDOW, LONGEST_WINDOW)
    }
}
