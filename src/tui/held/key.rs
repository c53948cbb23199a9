//! The state of one key: its taps, its repetition, and the meaning of its bytes.

use std::time::Duration;

use super::repeat_timing::RepeatTiming;
use super::{CHORD, Hold, Press};

/// The most taps in the queue: a link that stalled delivers many bytes at once.
const MOST_QUEUED: u32 = 4;
/// The longest time between two bytes of a repetition.
const LONGEST_INTERVAL: Duration = Duration::from_millis(150);
/// The longest time by which a slow link interrupts a repetition.
const LONGEST_STALL: Duration = Duration::from_secs(1);
/// People do not tap this often, for this long, as fast as a keyboard repeats.
const SURE_COUNT: u32 = 4;
const SURE_SPAN: Duration = Duration::from_millis(200);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    Up,
    /// The key is down; releases are reported.
    Down,
    /// The key was pressed, and may be down.
    Pressed,
    /// The key repeats.
    Repeats,
    /// The key repeated until another key was pressed, and still counts as held.
    Lingers,
    /// The key counts as up, and its repetitions are ignored.
    Suppressed,
}

/// The state of a key.
#[derive(Clone, Debug)]
pub(crate) struct HeldKey<K> {
    pub(crate) key: K,
    pub(crate) state: State,
    pub(crate) timing: RepeatTiming,
    /// The time of its last byte, if any.
    last_byte: Option<Duration>,
    /// The time at which it was last pressed, as far as that is certain.
    pressed: Duration,
    tap: Tap,
    series: Series,
    /// Whether it repeated when it was last marked as up.
    repeated: bool,
}

/// The steps left of a tap, and the taps after it.
#[derive(Clone, Copy, Debug, Default)]
struct Tap {
    steps: u32,
    left: u32,
    queued: u32,
    /// Whether the key counts as up for one step, which separates two taps.
    pauses: bool,
}

/// A series of bytes as close together as in a repetition.
#[derive(Clone, Copy, Debug, Default)]
struct Series {
    start: Duration,
    /// The number of bytes after the first.
    count: u32,
    /// The time between the first byte and the one before it.
    after: Option<Duration>,
    /// Whether the first byte may have been a repetition.
    is_suspect: bool,
}

impl<K: Copy + Eq> HeldKey<K> {
    pub(crate) fn new(key: K) -> Self {
        Self {
            key,
            state: State::Up,
            timing: RepeatTiming::default(),
            last_byte: None,
            pressed: Duration::ZERO,
            tap: Tap::default(),
            series: Series::default(),
            repeated: false,
        }
    }

    pub(crate) fn hold(&self) -> Hold {
        match self.state {
            _ if self.tap.pauses => Hold::Up,
            State::Repeats | State::Lingers => Hold::Held,
            _ if self.tap.left > 0 => Hold::Tap,
            State::Up | State::Suppressed => Hold::Up,
            State::Pressed => Hold::Unknown,
            State::Down => Hold::Held,
        }
    }

    pub(crate) fn is_held(&self) -> bool {
        matches!(self.state, State::Down | State::Repeats | State::Lingers)
    }

    pub(crate) fn has_taps(&self) -> bool {
        self.tap.left > 0 || self.tap.pauses
    }

    pub(crate) fn step(&mut self) {
        self.tap.step();
    }

    /// Handles a press where releases are reported.
    pub(crate) fn press_until_release(&mut self, steps: u32, now: Duration) -> Press {
        let was_held = self.hold() == Hold::Held;
        self.tap.add(steps, was_held);
        self.state = State::Down;
        self.pressed = now;
        Press::Fresh
    }

    /// Handles a byte of the key where releases are not reported. `is_newest` says whether the last
    /// byte was of the same key.
    pub(crate) fn byte(
        &mut self,
        steps: u32,
        now: Duration,
        is_newest: bool,
        prior: RepeatTiming,
    ) -> Press {
        let gap =
            self.last_byte.filter(|_| is_newest).map(|last_byte| now.saturating_sub(last_byte));
        self.last_byte = Some(now);
        let known = self.timing.or(prior);
        match (self.state, gap) {
            (State::Repeats, Some(gap)) => {
                self.timing.learn_interval(gap);
                return Press::Repeat;
            }
            (State::Suppressed, Some(gap)) if gap <= known.timeout().max(LONGEST_INTERVAL) => {
                return Press::Repeat;
            }
            _ => {}
        }
        if self.series.continues(now, gap, known) {
            self.begin_repetition(now, prior);
            return Press::Repeat;
        }
        let may_resume = self.repeated && gap.is_some_and(|gap| gap <= LONGEST_STALL);
        let is_suspect = may_resume || gap.is_some_and(|gap| known.may_begin_after(gap));
        if self.series.count == 0 {
            self.series.is_suspect = is_suspect;
        }
        let is_unclear = self.series.count == 0 && is_suspect;
        if !is_unclear {
            self.repeated = false;
            self.pressed = now;
        }
        let was_held = self.is_held();
        self.state = State::Pressed;
        self.tap.add(steps, was_held);
        if is_unclear { Press::Unclear } else { Press::Fresh }
    }

    fn begin_repetition(&mut self, now: Duration, prior: RepeatTiming) {
        let before = self.timing.or(prior);
        self.timing = before;
        if let Some(delay) = self.series.after.filter(|_| !self.repeated) {
            self.timing.learn_delay(delay);
        }
        let span = now.saturating_sub(self.series.start);
        self.timing.learn_interval(span / self.series.count.max(1));
        self.state = State::Repeats;
        self.repeated = true;
        self.tap = Tap::default();
    }

    /// Handles the press of another key, which ends the repetition of this one.
    pub(crate) fn end_repetition(&mut self) {
        if self.state == State::Repeats {
            self.state = State::Lingers;
        }
    }

    /// Holds this key if it was pressed together with `newer`, which is held.
    pub(crate) fn join(&mut self, newer: &Self) {
        if self.was_pressed_within(CHORD, newer) {
            self.state = State::Lingers;
            self.tap = Tap::default();
        }
    }

    /// Whether this key may have been down without a repetition when `newer` was pressed.
    pub(crate) fn may_be_down_at(&self, newer: &Self, prior: RepeatTiming) -> bool {
        self.was_pressed_within(self.timing.or(prior).delay_or_default(), newer)
    }

    /// Whether this key was pressed at or before `time` and may have been down ever since.
    pub(crate) fn is_down_since(&self, time: Duration) -> bool {
        let may_be_down = !matches!(self.state, State::Up | State::Suppressed);
        may_be_down && self.pressed <= time
    }

    /// Whether this key was pressed once, at most `most` before `newer`.
    fn was_pressed_within(&self, most: Duration, newer: &Self) -> bool {
        let apart = newer.pressed.checked_sub(self.pressed);
        let is_single = self.last_byte == Some(self.pressed) && !self.is_held();
        is_single && apart.is_some_and(|apart| apart <= most)
    }

    /// Marks the key as up. Its tap continues to its end, so that two opposing taps lead back to
    /// the start.
    pub(crate) fn mark_as_up(&mut self) {
        if !matches!(self.state, State::Suppressed | State::Up) {
            self.repeated = self.state == State::Repeats;
            self.state = State::Up;
        }
    }

    /// Marks the key as up and ignores its repetitions.
    pub(crate) fn suppress(&mut self) {
        let may_repeat = matches!(self.state, State::Down | State::Repeats | State::Suppressed);
        self.state = if may_repeat { State::Suppressed } else { State::Up };
        self.last_byte = self.last_byte.filter(|_| may_repeat);
        self.tap = Tap::default();
    }

    /// The time at which the key expires if no byte of it comes until then; `None` if it does not
    /// expire by itself.
    pub(crate) fn expiry(&self, prior: RepeatTiming) -> Option<Duration> {
        let timing = self.timing.or(prior);
        match self.state {
            State::Pressed => Some(self.last_byte? + timing.first_timeout()),
            State::Repeats => Some(self.last_byte? + timing.timeout()),
            State::Up | State::Down | State::Lingers | State::Suppressed => None,
        }
    }
}

impl Series {
    /// Handles a byte that came `gap` after the last one. Returns whether the series is a
    /// repetition.
    fn continues(&mut self, now: Duration, gap: Option<Duration>, timing: RepeatTiming) -> bool {
        if gap.is_none_or(|gap| gap > LONGEST_INTERVAL) {
            *self = Self { start: now, count: 0, after: gap, is_suspect: false };
            return false;
        }
        self.count += 1;
        let span = now.saturating_sub(self.start);
        timing.is_repetition(self.count, span)
            && (self.is_suspect || self.count >= SURE_COUNT && span >= SURE_SPAN)
    }
}

impl Tap {
    fn add(&mut self, steps: u32, was_held: bool) {
        if steps == 0 {
            return;
        }
        if self.left > 0 || self.pauses {
            self.queued = (self.queued + 1).min(MOST_QUEUED);
        } else {
            (self.left, self.pauses) = if was_held { (0, true) } else { (steps, false) };
        }
        self.steps = steps;
    }

    fn step(&mut self) {
        if self.pauses {
            (self.left, self.pauses) = (self.steps, false);
        } else if self.left > 0 {
            self.left -= 1;
            if self.left == 0 && self.queued > 0 {
                self.queued -= 1;
                self.pauses = true;
            }
        }
    }
}
