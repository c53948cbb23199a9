//! One key: its taps, its repetition, and what its bytes mean.

use std::time::Duration;

use super::rhythm::Rhythm;
use super::{CHORD, Hold, Press};

/// How many taps wait for one another, at most: a link that was stuck delivers a whole repetition at once.
const MOST_WAITING: u32 = 4;
/// How far bytes are apart, at most, that may be a repetition.
const LONGEST_INTERVAL: Duration = Duration::from_millis(150);
/// A repetition that was cut off by a slow link goes on after no more than this.
const LONGEST_STALL: Duration = Duration::from_secs(1);
/// Nobody taps so many times in a row as fast as a keyboard repeats, for so long.
const SURE_COUNT: u32 = 4;
const SURE_SPAN: Duration = Duration::from_millis(200);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    Up,
    /// Releases are reported, and this key's was not.
    Down,
    /// It was pressed, and may be down.
    Pressed,
    /// It repeats.
    Repeats,
    /// It repeated until another key was pressed.
    CutOff,
    /// It was let go of, but what comes of it may still be its repetition.
    Dropped,
}

/// What is known of a key.
#[derive(Clone, Debug)]
pub(super) struct HeldKey<K> {
    pub(super) key: K,
    pub(super) state: State,
    pub(super) rhythm: Rhythm,
    /// When its last byte came, if any has.
    heard: Option<Duration>,
    /// When it was last pressed, as far as that is known.
    pressed: Duration,
    tap: Tap,
    run: Run,
    /// Whether it repeated when it was last let go of.
    repeated: bool,
}

/// The steps that are left of a tap, and those that wait for them.
#[derive(Clone, Copy, Debug, Default)]
struct Tap {
    steps: u32,
    left: u32,
    waiting: u32,
    /// Whether the key counts as up for a step, so that two taps are told from one.
    rests: bool,
}

/// Bytes of a key that follow each other as fast as a repetition.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    start: Duration,
    /// How many there were after the first.
    count: u32,
    /// How long before it the one before came.
    after: Option<Duration>,
    /// Whether the first one may have been a repetition.
    is_suspect: bool,
}

impl<K: Copy + Eq> HeldKey<K> {
    pub(super) fn new(key: K) -> Self {
        Self {
            key,
            state: State::Up,
            rhythm: Rhythm::default(),
            heard: None,
            pressed: Duration::ZERO,
            tap: Tap::default(),
            run: Run::default(),
            repeated: false,
        }
    }

    pub(super) fn hold(&self) -> Hold {
        match self.state {
            _ if self.tap.rests => Hold::Up,
            State::Repeats | State::CutOff => Hold::Held,
            _ if self.tap.left > 0 => Hold::Tap,
            State::Up | State::Dropped => Hold::Up,
            State::Pressed => Hold::Unknown,
            State::Down => Hold::Held,
        }
    }

    pub(super) fn is_held(&self) -> bool {
        matches!(self.state, State::Down | State::Repeats | State::CutOff)
    }

    pub(super) fn has_taps(&self) -> bool {
        self.tap.left > 0 || self.tap.rests
    }

    pub(super) fn step(&mut self) {
        self.tap.step();
    }

    /// It was pressed, or still is, where releases are reported.
    pub(super) fn press_until_release(&mut self, steps: u32) -> Press {
        let was_held = self.hold() == Hold::Held;
        self.tap.add(steps, was_held);
        self.state = State::Down;
        Press::Fresh
    }

    /// A byte of it came, where releases are not reported; `is_newest` if it did last time, too.
    pub(super) fn byte(
        &mut self,
        steps: u32,
        now: Duration,
        is_newest: bool,
        prior: Rhythm,
    ) -> Press {
        let gap = self.heard.filter(|_| is_newest).map(|heard| now.saturating_sub(heard));
        self.heard = Some(now);
        let known = self.rhythm.or(prior);
        match (self.state, gap) {
            (State::Repeats, Some(gap)) => {
                self.rhythm.learn_interval(gap);
                return Press::Repeat;
            }
            (State::Dropped, Some(gap)) if gap <= known.window().max(LONGEST_INTERVAL) => {
                return Press::Repeat;
            }
            _ => {}
        }
        if self.run.goes_on(now, gap, known) {
            self.begin_repetition(now, prior);
            return Press::Repeat;
        }
        let may_resume = self.repeated && gap.is_some_and(|gap| gap <= LONGEST_STALL);
        let is_suspect = may_resume || gap.is_some_and(|gap| known.may_begin_after(gap));
        if self.run.count == 0 {
            self.run.is_suspect = is_suspect;
        }
        let is_unclear = self.run.count == 0 && is_suspect;
        if !is_unclear {
            self.repeated = false;
            self.pressed = now;
        }
        let was_held = self.is_held();
        self.state = State::Pressed;
        self.tap.add(steps, was_held);
        if is_unclear { Press::Unclear } else { Press::Fresh }
    }

    fn begin_repetition(&mut self, now: Duration, prior: Rhythm) {
        let before = self.rhythm.or(prior);
        self.rhythm = before;
        if let Some(delay) = self.run.after.filter(|_| !self.repeated) {
            self.rhythm.learn_delay(delay);
        }
        let span = now.saturating_sub(self.run.start);
        self.rhythm.learn_interval(span / self.run.count.max(1));
        self.state = State::Repeats;
        self.repeated = true;
        self.tap = Tap::default();
    }

    /// Another key was pressed, which ends the repetition of this one.
    pub(super) fn cut_off(&mut self) {
        if self.state == State::Repeats {
            self.state = State::CutOff;
        }
    }

    /// `newer` repeats: was this one pressed together with it?
    pub(super) fn join(&mut self, newer: &Self) {
        if self.was_pressed_within(CHORD, newer) {
            self.hold_on();
        }
    }

    /// `newer` was pressed: could this one have repeated before?
    pub(super) fn join_before_repetition(&mut self, newer: &Self, prior: Rhythm) {
        if self.was_pressed_within(self.rhythm.or(prior).silence(), newer) {
            self.hold_on();
        }
    }

    /// Whether this one was pressed, once, no longer than `most` before `newer`.
    fn was_pressed_within(&self, most: Duration, newer: &Self) -> bool {
        let apart = newer.pressed.checked_sub(self.pressed);
        let is_single = self.heard == Some(self.pressed) && !self.is_held();
        is_single && apart.is_some_and(|apart| apart <= most)
    }

    fn hold_on(&mut self) {
        self.state = State::CutOff;
        self.tap = Tap::default();
    }

    /// It is up. Its tap goes on to its end, and so two that oppose each other lead back.
    pub(super) fn let_go(&mut self) {
        if !matches!(self.state, State::Dropped | State::Up) {
            self.repeated = self.state == State::Repeats;
            self.state = State::Up;
        }
    }

    /// It is up, whatever the keyboard says.
    pub(super) fn drop(&mut self) {
        let may_repeat = matches!(self.state, State::Down | State::Repeats | State::Dropped);
        self.state = if may_repeat { State::Dropped } else { State::Up };
        self.heard = self.heard.filter(|_| may_repeat);
        self.tap = Tap::default();
    }

    /// When it is let go of, if nothing is heard of it until then, and no newer key has cut it off.
    pub(super) fn expiry(&self, prior: Rhythm) -> Option<Duration> {
        let rhythm = self.rhythm.or(prior);
        match self.state {
            State::Pressed => Some(self.heard? + rhythm.first_window()),
            State::Repeats => Some(self.heard? + rhythm.window()),
            State::Up | State::Down | State::CutOff | State::Dropped => None,
        }
    }
}

impl Run {
    /// A byte came `gap` after the last one: whether that makes a repetition of the run.
    fn goes_on(&mut self, now: Duration, gap: Option<Duration>, rhythm: Rhythm) -> bool {
        if gap.is_none_or(|gap| gap > LONGEST_INTERVAL) {
            *self = Self { start: now, count: 0, after: gap, is_suspect: false };
            return false;
        }
        self.count += 1;
        let span = now.saturating_sub(self.start);
        rhythm.is_repetition(self.count, span)
            && (self.is_suspect || self.count >= SURE_COUNT && span >= SURE_SPAN)
    }
}

impl Tap {
    fn add(&mut self, steps: u32, was_held: bool) {
        if steps == 0 {
            return;
        }
        if self.left > 0 || self.rests {
            self.waiting = (self.waiting + 1).min(MOST_WAITING);
        } else {
            (self.left, self.rests) = if was_held { (0, true) } else { (steps, false) };
        }
        self.steps = steps;
    }

    fn step(&mut self) {
        if self.rests {
            (self.left, self.rests) = (self.steps, false);
        } else if self.left > 0 {
            self.left -= 1;
            if self.left == 0 && self.waiting > 0 {
                self.waiting -= 1;
                self.rests = true;
            }
        }
    }
}
