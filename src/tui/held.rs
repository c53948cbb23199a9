//! The keys that are held, in terminals with and without key releases.
//!
//! Some terminals report when a key is released. Others send a byte when a key is pressed, send it
//! again while the key is held, and stop for good when another key is pressed. [`HeldKeys`] gives
//! both the same behaviour: a press is a tap of a number of steps, and a key that stays down is
//! held after its tap.
//!
//! Without releases:
//!
//! - A press is a tap. Taps are queued, so that two of them have exactly twice the effect of one.
//! - A second byte counts as another tap. It may be the first repetition: if the next byte follows
//!   sooner than people tap, the key is held. The repeat delay and interval are learned from that.
//! - A held key is released when no repetition comes for a few of its intervals.
//! - A held key whose repetition is ended by another key stays held while the other key may be
//!   held, and for [`LINGER`] after that. It is released earlier if it is pressed again, if an
//!   opposing key is pressed, or by [`HeldKeys::release_lingering`].
//! - Two keys pressed within [`CHORD`] of each other are both held once one of them repeats. Any other
//!   key that has not repeated stays a tap.
//!
//! Taking a byte at the learned delay for a repetition at once was refused: it gains one interval,
//! and people who tap at that rate keep walking. Counting a tap as held until the first repetition
//! could have come was refused, too: one tap then walks 1.75 cells.
//!
//! The time is an argument, measured from a fixed moment, so that tests need not wait.

mod key;
#[cfg(test)]
pub(crate) mod keyboard;
mod repeat_timing;
#[cfg(test)]
mod tests;

use std::time::Duration;

use key::{HeldKey, State};
use repeat_timing::RepeatTiming;

/// How long a key stays held after the newer key that ended its repetition is released.
pub const LINGER: Duration = Duration::from_millis(300);
/// Two keys pressed within this time are meant to be held together. People who tap one key and then
/// hold another take longer.
pub const CHORD: Duration = Duration::from_millis(50);

/// The most keys that are stored: more than there are fingers.
const MOST_KEYS: usize = 16;

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
    /// The timing of any key, for keys that have not repeated yet.
    timing: RepeatTiming,
    /// Keys whose repetition a newer key has ended are held until then.
    lingers_until: Duration,
}

/// How a key is held.
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
            keys: Vec::with_capacity(MOST_KEYS),
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

    /// Whether releases are reported.
    pub fn reports_releases(&self) -> bool {
        self.reports_releases
    }

    /// Handles a press or a repetition of `key` at time `now`. A press is a tap of `steps` steps,
    /// or no tap if `steps` is 0. If releases are not reported, the keys for which `opposes` is
    /// true are released.
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
        if let Some(expiry) = held.expiry(self.timing) {
            self.lingers_until = expiry + LINGER;
        }
        self.keys.push(held);
        press
    }

    /// Handles a repetition of `key` from a terminal that reports releases.
    pub fn repeat(&mut self, key: K) {
        let mut held = self.take(key);
        if held.state == State::Up {
            held.state = State::Down;
        }
        self.keys.push(held);
    }

    /// Handles the release of `key`. Its tap continues to its end.
    pub fn release(&mut self, key: K) {
        if let Some(held) = self.keys.iter_mut().find(|held| held.key == key) {
            held.state = State::Up;
        }
    }

    /// Releases all keys, for example when the window loses the focus. A key that continues to
    /// repeat is up until it is pressed again.
    pub fn release_all(&mut self) {
        self.release_each(|_| true);
    }

    /// Releases in this way each key for which `is_meant` is true, and ends its taps.
    pub fn release_each(&mut self, is_meant: impl Fn(K) -> bool) {
        self.keys.iter_mut().filter(|held| is_meant(held.key)).for_each(HeldKey::suppress);
    }

    /// Releases the keys whose repetition has not come by `now`.
    pub fn advance(&mut self, now: Duration) {
        for held in &mut self.keys {
            let expiry = match held.state {
                State::Lingers => Some(self.lingers_until),
                _ => held.expiry(self.timing),
            };
            if expiry.is_some_and(|expiry| expiry <= now) {
                held.mark_as_up();
            }
        }
    }

    /// Advances taps by one step of the game.
    pub fn step(&mut self) {
        self.keys.iter_mut().for_each(HeldKey::step);
    }

    /// Holds the keys whose repetition a newer key has ended until [`LINGER`] after `now`. Call it
    /// in each step in which the player is in the air, so that they keep their direction until they
    /// land.
    pub fn keep(&mut self, now: Duration) {
        self.lingers_until = self.lingers_until.max(now + LINGER);
    }

    /// Holds the last key before the newest one for which `is_meant` is true, if it could not have
    /// repeated yet, and the keys pressed together with it. A player who presses a direction and then
    /// jumps wants to jump in that direction. Does nothing if one of those keys is held already.
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

    /// Releases each key for which `is_meant` is true and which is held only because a newer key ended
    /// its repetition. Call it when another key is pressed, for keys that should not outlast it:
    /// somebody who turns and then walks wants to walk straight on.
    pub fn release_lingering(&mut self, is_meant: impl Fn(K) -> bool) {
        let lingering = self.keys.iter_mut().filter(|held| held.state == State::Lingers);
        lingering.filter(|held| is_meant(held.key)).for_each(HeldKey::mark_as_up);
    }

    /// When the next key expires if no event of it comes until then.
    pub fn next_expiry(&self) -> Option<Duration> {
        let expiries = self.keys.iter().filter_map(|held| match held.state {
            State::Lingers => Some(self.lingers_until),
            _ => held.expiry(self.timing),
        });
        expiries.min()
    }

    /// Whether any key is in the steps of its tap, so that its state may change with the next step.
    pub fn has_taps(&self) -> bool {
        self.keys.iter().any(HeldKey::has_taps)
    }

    /// Whether a key that was pressed at or before `time` may have been down ever since.
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

    /// Removes the state of `key` from the list, or creates it. If the list is full, the oldest key
    /// makes room.
    fn take(&mut self, key: K) -> HeldKey<K> {
        if let Some(index) = self.keys.iter().position(|held| held.key == key) {
            return self.keys.remove(index);
        }
        if self.keys.len() == MOST_KEYS {
            let idle = self.keys.iter().position(|held| held.hold() == Hold::Up);
            self.keys.remove(idle.unwrap_or(0));
        }
        HeldKey::new(key)
    }
}
