//! The timing of a keyboard's repetition: its delay and its interval.

use std::time::Duration;

/// The shortest and the longest delay of any keyboard.
const SHORTEST_DELAY: Duration = Duration::from_millis(200);
const LONGEST_DELAY: Duration = Duration::from_secs(1);
/// The first timeout as long as no delay is known: the longest default delay of a system, X11's 660
/// ms, plus an interval.
const DEFAULT_FIRST_TIMEOUT: Duration = Duration::from_millis(750);
/// The default delay of most systems.
const DEFAULT_DELAY: Duration = Duration::from_millis(500);
/// People do not tap a key faster than once in this time. For further taps in a row, the mean time
/// is longer by a slack for each of them, up to a limit.
const SHORTEST_TAP: Duration = Duration::from_millis(80);
const TAP_SLACK: Duration = Duration::from_millis(10);
const MOST_SLACKS: u32 = 2;
/// The number of half intervals without a byte after which a key has stopped repeating, and the
/// bounds of that time: a link that delivers bytes in bursts makes the interval look too short.
const MISSED_HALVES: u32 = 5;
const SHORTEST_TIMEOUT: Duration = Duration::from_millis(90);
const LONGEST_TIMEOUT: Duration = Duration::from_millis(300);
/// The interval as long as none has been measured.
const DEFAULT_INTERVAL: Duration = Duration::from_millis(60);

/// The delay and the interval of a keyboard, as far as they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RepeatTiming {
    pub(crate) delay: Option<Duration>,
    /// The longest recent interval; it decays slowly.
    pub(crate) interval: Option<Duration>,
}

impl RepeatTiming {
    /// This timing, completed from `prior`.
    pub(crate) fn or(self, prior: Self) -> Self {
        Self { delay: self.delay.or(prior.delay), interval: self.interval.or(prior.interval) }
    }

    /// Whether the first repetition of a key may come after `gap`.
    pub(crate) fn may_begin_after(self, gap: Duration) -> bool {
        let earliest = self.delay.map_or(SHORTEST_DELAY, |delay| delay * 3 / 4);
        (earliest.max(SHORTEST_DELAY)..=LONGEST_DELAY).contains(&gap)
    }

    /// Whether `count` bytes in the time `span` are too many for taps.
    pub(crate) fn is_repetition(self, count: u32, span: Duration) -> bool {
        let mean = SHORTEST_TAP + TAP_SLACK * (count.saturating_sub(1)).min(MOST_SLACKS);
        let known = self.interval.map_or(Duration::ZERO, |interval| interval * 5 / 4);
        span <= mean.max(known.min(SHORTEST_TAP * 3 / 2)) * count
    }

    /// Learns from a first repetition that came after `delay`.
    pub(crate) fn learn_delay(&mut self, delay: Duration) {
        if (SHORTEST_DELAY..=LONGEST_DELAY).contains(&delay) {
            // A link can delay a byte, but not advance it: shorter delays are taken at once.
            let known = self.delay.unwrap_or(delay);
            self.delay = Some(delay.min(known + delay.saturating_sub(known) / 4));
        }
    }

    /// Learns from a repetition that came after `interval`.
    pub(crate) fn learn_interval(&mut self, interval: Duration) {
        let longest = self.interval.map_or(Duration::ZERO, |longest| longest * 7 / 8);
        self.interval = Some(interval.max(longest));
    }

    /// How long a pressed key may be down before its first repetition.
    pub(crate) fn first_timeout(self) -> Duration {
        self.delay.map_or(DEFAULT_FIRST_TIMEOUT, |delay| delay * 5 / 4 + SHORTEST_TAP)
    }

    /// The delay, or that of most systems if it is unknown.
    pub(crate) fn delay_or_default(self) -> Duration {
        self.delay.unwrap_or(DEFAULT_DELAY)
    }

    /// How long a repeating key may send nothing.
    pub(crate) fn timeout(self) -> Duration {
        let interval = self.interval.unwrap_or(DEFAULT_INTERVAL);
        (interval * MISSED_HALVES / 2).clamp(SHORTEST_TIMEOUT, LONGEST_TIMEOUT)
    }
}
