//! The keys that are held, in terminals with and without key releases, and the intents that they mean.
//!
//! Some terminals report when a key is released. Others send a byte when a key is pressed, send it again while the key
//! is held, and stop for good when another key is pressed. [`HeldKeys`] behaves the same in both: a press is a tap of
//! a number of steps, and a key that stays down is held after its tap.
//!
//! Without releases:
//!
//! - A press is a tap. Taps are queued, so that two of them have exactly twice the effect of one.
//! - A second byte counts as another tap, but may be the first repetition. If the next byte follows sooner than people
//!   tap, the key is held. The repeat delay and interval are learned from that.
//! - A held key is released when no repetition comes for a few of its intervals.
//! - If another key ends the repetition of a held key, the held key stays held while the other key may be held, and
//!   for [`LINGER`] after that. It is released earlier if it is pressed again, if an opposing key is pressed, or by
//!   [`HeldKeys::release_lingering`].
//! - Two keys pressed within [`CHORD`] of each other are both held once one of them repeats. Any other key that has
//!   not repeated stays a tap.
//!
//! The time is an argument, measured from a fixed moment, so that tests need not wait.
//!
//! Rejected: taking a byte at the learned delay for a repetition at once. It gains one interval, but people who tap at
//! that rate keep walking. Rejected: counting a tap as held until the first repetition could have come. One tap then
//! walks 1.75 cells.

use std::time::Duration;

use crate::game::{Intent, Intents};

/// The time for which a key stays held after the newer key that ended its repetition is released.
pub const LINGER: Duration = Duration::from_millis(300);
/// Two keys pressed within this time are meant to be held together. People who tap one key and then
/// hold another take longer.
pub const CHORD: Duration = Duration::from_millis(50);

/// The maximum number of stored keys, which is more than there are fingers.
const MAX_KEYS: usize = 16;

/// The keys that are held. `K` is any type that identifies keys.
///
/// ```
/// use std::time::Duration;
/// use cellcaster::tui::{HeldKeys, Hold};
///
/// let at = Duration::from_millis;
/// let mut held = HeldKeys::default();
/// held.press('w', 2, at(0), |_| false);
/// assert_eq!(held.hold('w'), Hold::Tap);
/// held.step();
/// held.step();
/// assert_eq!(held.hold('w'), Hold::Unknown);
/// // The keyboard begins to repeat the key.
/// held.press('w', 2, at(500), |_| false);
/// held.press('w', 2, at(530), |_| false);
/// assert_eq!(held.hold('w'), Hold::Held);
/// held.advance(at(800));
/// assert_eq!(held.hold('w'), Hold::Up);
/// ```
#[derive(Clone, Debug)]
pub struct HeldKeys<K> {
    reports_releases: bool,
    /// The last element is the key whose event came last.
    keys: Vec<HeldKey<K>>,
    /// The timing of the last key that repeated, for keys that have not repeated yet.
    timing: RepeatTiming,
    /// The time until which keys are held if a newer key has ended their repetition.
    lingers_until: Duration,
}

/// The state of a key: up, tapped or held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// The key is up.
    Up,
    /// The key was pressed, and the steps of its tap are not over.
    Tap,
    /// The key was pressed, and its tap is over. The terminal does not report whether it is still
    /// down.
    Unknown,
    /// The key is down for longer than a tap.
    Held,
}

/// The meaning of a byte that a key sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    /// The key was up, and was pressed.
    Fresh,
    /// The key was pressed again, or begins to repeat.
    Unclear,
    /// The key is down, and repeats.
    Repeat,
}

impl<K> Default for HeldKeys<K> {
    /// No key is held, and releases are not reported.
    fn default() -> Self {
        Self {
            reports_releases: false,
            keys: Vec::new(),
            timing: RepeatTiming::default(),
            lingers_until: Duration::ZERO,
        }
    }
}

impl<K: Copy + Eq> HeldKeys<K> {
    /// Sets whether releases are reported. If that changes, all keys count as up.
    pub fn set_reports_releases(&mut self, reports_releases: bool) {
        if self.reports_releases != reports_releases {
            self.reports_releases = reports_releases;
            self.keys.clear();
        }
    }

    /// Returns true if releases are reported.
    pub fn reports_releases(&self) -> bool {
        self.reports_releases
    }

    /// Handles a press or a repetition of `key` at time `now`. A press is a tap of `steps` steps, or no tap if `steps`
    /// is 0. If releases are not reported, releases the keys for which `opposes` returns `true`.
    pub fn press(
        &mut self,
        key: K,
        steps: u32,
        now: Duration,
        opposes: impl Fn(K) -> bool,
    ) -> Press {
        self.advance(now);
        let is_newest = self.keys.last().is_some_and(|newest| newest.key == key);
        let mut held = self.take(key);
        if self.reports_releases {
            let press = held.press_until_release(steps, now);
            self.keys.push(held);
            return press;
        }
        let press = held.byte(steps, now, is_newest, self.timing);
        for other in &mut self.keys {
            if opposes(other.key) {
                other.mark_as_up();
            } else if press == Press::Repeat && held.is_held() {
                other.join(&held);
            } else if press == Press::Fresh {
                other.end_repetition();
            }
        }
        if held.is_held() {
            self.timing = held.timing;
        }
        // A pressed or repeating key does not linger.
        if let Some(expiry) = held.expiry(self.timing, Duration::ZERO) {
            self.lingers_until = expiry + LINGER;
        }
        self.keys.push(held);
        press
    }

    /// Handles a repetition of `key` from a terminal that reports releases.
    pub fn repeat(&mut self, key: K) {
        let mut held = self.take(key);
        if held.state == KeyState::Up {
            held.state = KeyState::Down;
        }
        self.keys.push(held);
    }

    /// Handles the release of `key`. Its tap continues to its end.
    pub fn release(&mut self, key: K) {
        if let Some(held) = self.keys.iter_mut().find(|held| held.key == key) {
            held.state = KeyState::Up;
        }
    }

    /// Releases all keys, for example when the window loses the focus. A key that continues to
    /// repeat is up until it is pressed again.
    pub fn release_all(&mut self) {
        self.release_each(|_| true);
    }

    /// Releases each key for which `is_meant` returns `true`, as [`HeldKeys::release_all`] does, and ends its taps.
    pub fn release_each(&mut self, is_meant: impl Fn(K) -> bool) {
        self.keys.iter_mut().filter(|held| is_meant(held.key)).for_each(HeldKey::suppress);
    }

    /// Releases the keys whose next repetition has not come by `now`.
    pub fn advance(&mut self, now: Duration) {
        let (timing, lingers_until) = (self.timing, self.lingers_until);
        let keys = self.keys.iter_mut();
        keys.filter(|held| held.expiry(timing, lingers_until).is_some_and(|expiry| expiry <= now))
            .for_each(HeldKey::mark_as_up);
    }

    /// Advances taps by one step of the game.
    pub fn step(&mut self) {
        self.keys.iter_mut().for_each(|held| held.tap.step());
    }

    /// Keeps holding the keys whose repetition a newer key has ended, until [`LINGER`] after `now`. Call it in each
    /// step in which the player is in the air, so that the player keeps the direction until landing.
    pub fn keep(&mut self, now: Duration) {
        self.lingers_until = self.lingers_until.max(now + LINGER);
    }

    /// Finds the last key before the newest one for which `is_meant` returns `true`. If that key could not have
    /// repeated yet, holds it and the keys pressed together with it. A player who presses a direction and then jumps
    /// wants to jump in that direction. Does nothing if one of the keys for which `is_meant` returns `true` is held
    /// already.
    pub fn join_newest(&mut self, is_meant: impl Fn(K) -> bool) {
        let Some((newest, others)) = self.keys.split_last_mut() else { return };
        let meant: Vec<_> = others.iter_mut().filter(|held| is_meant(held.key)).collect();
        let Some(last) = meant.last().map(|last| (*last).clone()) else { return };
        let is_any_held = meant.iter().any(|held| held.is_held());
        if !is_any_held && last.may_be_down_at(newest, self.timing) {
            for held in meant {
                held.join(&last);
            }
        }
    }

    /// Releases each key for which `is_meant` returns `true`, if it is held only because a newer key ended its
    /// repetition. Call it when another key is pressed, for keys that should not outlast it: a player who turns and
    /// then walks wants to walk straight on.
    pub fn release_lingering(&mut self, is_meant: impl Fn(K) -> bool) {
        let lingering = self.keys.iter_mut().filter(|held| held.state == KeyState::Lingers);
        lingering.filter(|held| is_meant(held.key)).for_each(HeldKey::mark_as_up);
    }

    /// The time at which the next key expires if no event of that key comes before.
    pub fn next_expiry(&self) -> Option<Duration> {
        self.keys.iter().filter_map(|held| held.expiry(self.timing, self.lingers_until)).min()
    }

    /// Returns true if any key is in the steps of its tap, so that its state may change with the next step.
    pub fn has_taps(&self) -> bool {
        self.keys.iter().any(HeldKey::has_taps)
    }

    /// Returns true if a key that was pressed at or before `time` may have been down ever since.
    pub fn is_any_down_since(&self, time: Duration) -> bool {
        self.keys.iter().any(|held| held.is_down_since(time))
    }

    /// The state of `key`.
    pub fn hold(&self, key: K) -> Hold {
        self.keys.iter().find(|held| held.key == key).map_or(Hold::Up, HeldKey::hold)
    }

    /// The keys that are not up, with their states.
    pub fn iter(&self) -> impl Iterator<Item = (K, Hold)> {
        let holds = self.keys.iter().map(|held| (held.key, held.hold()));
        holds.filter(|&(_, hold)| hold != Hold::Up)
    }

    /// Removes the state of `key` from the list, or creates it. If the list is full, removes a key that is up, or the
    /// oldest key.
    fn take(&mut self, key: K) -> HeldKey<K> {
        if let Some(index) = self.keys.iter().position(|held| held.key == key) {
            return self.keys.remove(index);
        }
        if self.keys.len() == MAX_KEYS {
            let idle = self.keys.iter().position(|held| held.hold() == Hold::Up);
            self.keys.remove(idle.unwrap_or(0));
        }
        HeldKey::new(key)
    }
}

/// The maximum number of queued taps. A link that stalled delivers many bytes at once.
const MAX_QUEUED: u32 = 4;
/// The longest time between two bytes of a repetition.
const MAX_INTERVAL: Duration = Duration::from_millis(150);
/// The longest time by which a slow link interrupts a repetition.
const MAX_STALL: Duration = Duration::from_secs(1);
/// People do not tap this often, for this long, as fast as a keyboard repeats.
const SURE_COUNT: u32 = 4;
const SURE_SPAN: Duration = Duration::from_millis(200);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum KeyState {
    Up,
    /// The key is down, and releases are reported.
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
struct HeldKey<K> {
    key: K,
    state: KeyState,
    timing: RepeatTiming,
    /// The time of the key's last byte, if any.
    last_byte: Option<Duration>,
    /// The time at which the key was last pressed, as far as that is certain.
    pressed: Duration,
    tap: Tap,
    series: Series,
    /// `true` if the key repeated when it was last marked as up.
    repeated: bool,
}

/// The remaining steps of a tap, and the queued taps.
#[derive(Clone, Copy, Debug, Default)]
struct Tap {
    steps: u32,
    left: u32,
    queued: u32,
    /// `true` if the key counts as up for one step, to separate two taps.
    pauses: bool,
}

/// A series of bytes that are as close together as in a repetition.
#[derive(Clone, Copy, Debug, Default)]
struct Series {
    start: Duration,
    /// The number of bytes after the first.
    count: u32,
    /// The time between the first byte and the one before it.
    after: Option<Duration>,
    /// `true` if the first byte may have been a repetition.
    is_suspect: bool,
}

impl<K: Copy + Eq> HeldKey<K> {
    fn new(key: K) -> Self {
        Self {
            key,
            state: KeyState::Up,
            timing: RepeatTiming::default(),
            last_byte: None,
            pressed: Duration::ZERO,
            tap: Tap::default(),
            series: Series::default(),
            repeated: false,
        }
    }

    fn hold(&self) -> Hold {
        match self.state {
            _ if self.tap.pauses => Hold::Up,
            KeyState::Repeats | KeyState::Lingers => Hold::Held,
            _ if self.tap.left > 0 => Hold::Tap,
            KeyState::Up | KeyState::Suppressed => Hold::Up,
            KeyState::Pressed => Hold::Unknown,
            KeyState::Down => Hold::Held,
        }
    }

    fn is_held(&self) -> bool {
        matches!(self.state, KeyState::Down | KeyState::Repeats | KeyState::Lingers)
    }

    fn has_taps(&self) -> bool {
        self.tap.left > 0 || self.tap.pauses
    }

    /// Handles a press if releases are reported.
    fn press_until_release(&mut self, steps: u32, now: Duration) -> Press {
        let was_held = self.hold() == Hold::Held;
        self.tap.add(steps, was_held);
        self.state = KeyState::Down;
        self.pressed = now;
        Press::Fresh
    }

    /// Handles a byte of the key if releases are not reported. `is_newest` is `true` if the last byte was of the same
    /// key.
    fn byte(&mut self, steps: u32, now: Duration, is_newest: bool, prior: RepeatTiming) -> Press {
        let gap =
            self.last_byte.filter(|_| is_newest).map(|last_byte| now.saturating_sub(last_byte));
        self.last_byte = Some(now);
        let known = self.timing.or(prior);
        match (self.state, gap) {
            (KeyState::Repeats, Some(gap)) => {
                self.timing.learn_interval(gap);
                return Press::Repeat;
            }
            (KeyState::Suppressed, Some(gap)) if gap <= known.timeout().max(MAX_INTERVAL) => {
                return Press::Repeat;
            }
            _ => {}
        }
        if self.series.continues(now, gap, known) {
            self.begin_repetition(now, prior);
            return Press::Repeat;
        }
        let may_resume = self.repeated && gap.is_some_and(|gap| gap <= MAX_STALL);
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
        self.state = KeyState::Pressed;
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
        self.state = KeyState::Repeats;
        self.repeated = true;
        self.tap = Tap::default();
    }

    /// Handles the press of another key, which ends the repetition of this one.
    fn end_repetition(&mut self) {
        if self.state == KeyState::Repeats {
            self.state = KeyState::Lingers;
        }
    }

    /// Holds this key if it was pressed together with `newer`, which is held.
    fn join(&mut self, newer: &Self) {
        if self.was_pressed_within(CHORD, newer) {
            self.state = KeyState::Lingers;
            self.tap = Tap::default();
        }
    }

    /// Returns true if this key may have been down without a repetition when `newer` was pressed.
    fn may_be_down_at(&self, newer: &Self, prior: RepeatTiming) -> bool {
        self.was_pressed_within(self.timing.or(prior).delay_or_default(), newer)
    }

    /// Returns true if this key was pressed at or before `time` and may have been down ever since.
    fn is_down_since(&self, time: Duration) -> bool {
        let may_be_down = !matches!(self.state, KeyState::Up | KeyState::Suppressed);
        may_be_down && self.pressed <= time
    }

    /// Returns true if this key was pressed once, at most `most` before `newer`.
    fn was_pressed_within(&self, most: Duration, newer: &Self) -> bool {
        let apart = newer.pressed.checked_sub(self.pressed);
        let is_single = self.last_byte == Some(self.pressed) && !self.is_held();
        is_single && apart.is_some_and(|apart| apart <= most)
    }

    /// Marks the key as up. Its tap continues to its end, so that two opposing taps lead back to
    /// the start.
    fn mark_as_up(&mut self) {
        if !matches!(self.state, KeyState::Suppressed | KeyState::Up) {
            self.repeated = self.state == KeyState::Repeats;
            self.state = KeyState::Up;
        }
    }

    /// Marks the key as up and ignores its repetitions.
    fn suppress(&mut self) {
        let may_repeat =
            matches!(self.state, KeyState::Down | KeyState::Repeats | KeyState::Suppressed);
        self.state = if may_repeat { KeyState::Suppressed } else { KeyState::Up };
        self.last_byte = self.last_byte.filter(|_| may_repeat);
        self.tap = Tap::default();
    }

    /// The time at which the key expires if no byte of it comes before. `None` if it does not expire by itself.
    fn expiry(&self, prior: RepeatTiming, lingers_until: Duration) -> Option<Duration> {
        let timing = self.timing.or(prior);
        match self.state {
            KeyState::Pressed => Some(self.last_byte? + timing.first_timeout()),
            KeyState::Repeats => Some(self.last_byte? + timing.timeout()),
            KeyState::Lingers => Some(lingers_until),
            KeyState::Up | KeyState::Down | KeyState::Suppressed => None,
        }
    }
}

impl Series {
    /// Handles a byte that came `gap` after the last one. Returns true if the series is a repetition.
    fn continues(&mut self, now: Duration, gap: Option<Duration>, timing: RepeatTiming) -> bool {
        if gap.is_none_or(|gap| gap > MAX_INTERVAL) {
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
            self.queued = (self.queued + 1).min(MAX_QUEUED);
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

/// The shortest and the longest delay of any keyboard.
const MIN_DELAY: Duration = Duration::from_millis(200);
const MAX_DELAY: Duration = Duration::from_secs(1);
/// The first timeout while no delay is known: the longest default delay of a system, X11's 660 ms, plus an interval.
const DEFAULT_FIRST_TIMEOUT: Duration = Duration::from_millis(750);
/// The default delay of most systems.
const DEFAULT_DELAY: Duration = Duration::from_millis(500);
/// People do not tap a key faster than once in this time. In a series of taps, the mean time is longer by a slack for
/// each further tap, up to a limit.
const MIN_TAP: Duration = Duration::from_millis(80);
const TAP_SLACK: Duration = Duration::from_millis(10);
const MAX_SLACKS: u32 = 2;
/// The number of half intervals without a byte after which a key has stopped repeating, and the bounds of that time. A
/// link that delivers bytes in bursts makes the interval look too short.
const MISSED_HALVES: u32 = 5;
const MIN_TIMEOUT: Duration = Duration::from_millis(90);
const MAX_TIMEOUT: Duration = Duration::from_millis(300);
/// The assumed interval until one has been measured.
const DEFAULT_INTERVAL: Duration = Duration::from_millis(60);

/// The delay and the interval of a keyboard, as far as they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct RepeatTiming {
    delay: Option<Duration>,
    /// The longest recent interval. It decays slowly.
    interval: Option<Duration>,
}

impl RepeatTiming {
    /// This timing, completed from `prior`.
    fn or(self, prior: Self) -> Self {
        Self { delay: self.delay.or(prior.delay), interval: self.interval.or(prior.interval) }
    }

    /// Returns true if the first repetition of a key may come after `gap`.
    fn may_begin_after(self, gap: Duration) -> bool {
        let earliest = self.delay.map_or(MIN_DELAY, |delay| delay * 3 / 4);
        (earliest.max(MIN_DELAY)..=MAX_DELAY).contains(&gap)
    }

    /// Returns true if `count` bytes in the time `span` are too many for taps.
    fn is_repetition(self, count: u32, span: Duration) -> bool {
        let mean = MIN_TAP + TAP_SLACK * (count.saturating_sub(1)).min(MAX_SLACKS);
        let known = self.interval.map_or(Duration::ZERO, |interval| interval * 5 / 4);
        span <= mean.max(known.min(MIN_TAP * 3 / 2)) * count
    }

    /// Learns from a first repetition that came after `delay`.
    fn learn_delay(&mut self, delay: Duration) {
        if (MIN_DELAY..=MAX_DELAY).contains(&delay) {
            // A link can delay a byte, but not advance it, so shorter delays are adopted at once.
            let known = self.delay.unwrap_or(delay);
            self.delay = Some(delay.min(known + delay.saturating_sub(known) / 4));
        }
    }

    /// Learns from a repetition that came after `interval`.
    fn learn_interval(&mut self, interval: Duration) {
        let longest = self.interval.map_or(Duration::ZERO, |longest| longest * 7 / 8);
        self.interval = Some(interval.max(longest));
    }

    /// The time for which a pressed key may be down before its first repetition.
    fn first_timeout(self) -> Duration {
        self.delay.map_or(DEFAULT_FIRST_TIMEOUT, |delay| delay * 5 / 4 + MIN_TAP)
    }

    /// The delay, or the default of most systems if it is unknown.
    fn delay_or_default(self) -> Duration {
        self.delay.unwrap_or(DEFAULT_DELAY)
    }

    /// The time for which a repeating key may send nothing.
    fn timeout(self) -> Duration {
        let interval = self.interval.unwrap_or(DEFAULT_INTERVAL);
        (interval * MISSED_HALVES / 2).clamp(MIN_TIMEOUT, MAX_TIMEOUT)
    }
}

/// The number of steps of a tap of a key that is bound to `intent`, as an argument of [`HeldKeys::press`].
pub fn tap_steps(intent: Intent) -> u32 {
    match intent {
        once if once.acts_once() => 1,
        turn if turn.turns() => 10,
        Intent::Open | Intent::LookAhead => 1,
        Intent::Run | Intent::Aim => 0,
        _ => 5,
    }
}

/// The intents of a step, given the intents that are bound to keys and the state of each key.
///
/// A tap has a small, exact effect, because motion that starts and stops smoothly covers the same distance as motion
/// that does not: 5 steps of walking are a quarter of a cell, and 10 steps of turning slowly are 5 degrees. Taps turn
/// slowly and never run. A key to duck that may be down counts as held.
pub fn wanted(keys: impl Iterator<Item = (Intent, Hold)>) -> Intents {
    let mut wanted = Intents::new();
    let mut held = Intents::new();
    for (intent, hold) in keys {
        let is_wanted = match intent {
            Intent::Duck => hold != Hold::Up,
            once if once.acts_once() => hold == Hold::Tap,
            _ => matches!(hold, Hold::Tap | Hold::Held),
        };
        if is_wanted {
            wanted.insert(intent);
        }
        if hold == Hold::Held {
            held.insert(intent);
        }
    }
    let taps =
        |is_meant: fn(Intent) -> bool| wanted.iter().any(is_meant) && !held.iter().any(is_meant);
    let (turns_by_taps, walks_by_taps) = (taps(Intent::turns), taps(Intent::walks));
    if turns_by_taps {
        wanted.insert(Intent::Aim);
    }
    if walks_by_taps {
        wanted.remove(Intent::Run);
    }
    wanted
}

#[cfg(test)]
pub(crate) mod tests;
