//! Which keys are held: the one place that knows how little terminals tell of it.
//!
//! A terminal that reports releases tells all there is. Others send a byte when a key is pressed, send it
//! again while the key is held, and stop for good when another key is pressed. [`HeldKeys`] makes both
//! the same: a press is a tap of a number of steps, and a key that stays down is held after that.
//!
//! Without releases:
//!
//! - A press is a tap. Taps wait for one another, so two of them are exactly twice one.
//! - A second byte counts as another tap. It may be the first repetition: if the next byte follows
//!   sooner than people tap, the key is held. The delay and the interval are learned from that.
//! - A held key is let go of when its repetition fails to come for a few of its intervals.
//! - A held key whose repetition is cut off by another key stays held as long as the other may be held, and
//!   [`LINGER`] after that; until it is pressed again, or a key that opposes it is pressed.
//! - Two keys pressed within [`CHORD`] of each other are both held once one of them repeats.
//!
//! To take a byte at the learned delay for a repetition at once was refused: it gains one interval, and
//! whoever taps in that rhythm walks on. To count a tap as held until the first repetition could have come
//! was refused, too: one tap then walks 1.75 cells.
//!
//! Time is handed in, as the time since some fixed moment, so that tests need not wait.

mod key;
#[cfg(test)]
pub(crate) mod keyboard;
mod rhythm;
#[cfg(test)]
mod tests;

use std::time::Duration;

use key::{HeldKey, State};
use rhythm::Rhythm;

/// How much longer than the newer key a key is held that the newer one has cut off.
pub const LINGER: Duration = Duration::from_millis(300);
/// How soon after one another two keys are pressed that are meant to be held together.
pub const CHORD: Duration = Duration::from_millis(150);

/// How many keys are remembered: more than there are fingers.
const MOST_KEYS: usize = 16;

/// The keys that are held, of any type that names keys.
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
/// // The keyboard begins to repeat it.
/// held.press('w', 2, at(500), |_| false);
/// held.press('w', 2, at(530), |_| false);
/// assert_eq!(held.hold('w'), Hold::Held);
/// held.advance(at(800));
/// assert_eq!(held.hold('w'), Hold::Up);
/// ```
#[derive(Clone, Debug)]
pub struct HeldKeys<K> {
    reports_releases: bool,
    /// The one that was heard of last is the last.
    keys: Vec<HeldKey<K>>,
    /// Of any key, for those that have not repeated yet.
    rhythm: Rhythm,
    /// Until when keys are held that a newer one has cut off.
    lingers_until: Duration,
}

/// How a key is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// It is up.
    Up,
    /// It was pressed, and the steps of its tap are not over.
    Tap,
    /// It was pressed, its tap is over, and it is up or down: the terminal does not tell.
    Unknown,
    /// It is down, for longer than a tap.
    Held,
}

/// What a byte of a key means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    /// The key was up, and was pressed.
    Fresh,
    /// Either: the key was pressed again, or begins to repeat.
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
            rhythm: Rhythm::default(),
            lingers_until: Duration::ZERO,
        }
    }
}

impl<K: Copy + Eq> HeldKeys<K> {
    /// From now on releases are reported, or are not. Where that is news, every key counts as up.
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

    /// Takes note that `key` was pressed, or repeats, at time `now`: a tap of `steps` steps, or none. Where
    /// releases are not reported, keys that `opposes` names are let go of.
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
            let press = held.press_until_release(steps);
            self.keys.push(held);
            return press;
        }
        let press = held.byte(steps, now, is_newest, self.rhythm);
        for other in &mut self.keys {
            if opposes(other.key) {
                other.let_go();
            } else if press == Press::Repeat && held.is_held() {
                other.join(&held);
            } else if press == Press::Fresh {
                other.cut_off();
            }
        }
        if held.is_held() {
            self.rhythm = held.rhythm;
        }
        if let Some(expiry) = held.expiry(self.rhythm) {
            self.lingers_until = expiry + LINGER;
        }
        self.keys.push(held);
        press
    }

    /// Takes note that `key` is still down, says a terminal that reports releases.
    pub fn repeat(&mut self, key: K) {
        let mut held = self.take(key);
        if held.state == State::Up {
            held.state = State::Down;
        }
        self.keys.push(held);
    }

    /// Takes note that `key` was released. Its tap goes on to its end.
    pub fn release(&mut self, key: K) {
        if let Some(held) = self.keys.iter_mut().find(|held| held.key == key) {
            held.state = State::Up;
        }
    }

    /// Lets go of all keys, as when the window loses the focus. A key that goes on repeating is up until it
    /// is pressed anew.
    pub fn release_all(&mut self) {
        self.keys.iter_mut().for_each(HeldKey::drop);
    }

    /// Lets go of the keys whose repetition has failed to come by `now`.
    pub fn advance(&mut self, now: Duration) {
        for held in &mut self.keys {
            let expiry = match held.state {
                State::CutOff => Some(self.lingers_until),
                _ => held.expiry(self.rhythm),
            };
            if expiry.is_some_and(|expiry| expiry <= now) {
                held.let_go();
            }
        }
    }

    /// Takes note that a step of the game has passed.
    pub fn step(&mut self) {
        self.keys.iter_mut().for_each(HeldKey::step);
    }

    /// Keeps the keys that a newer one has cut off held for [`LINGER`] after `now`: called in each step in
    /// which the player is in the air, it lets them land as they jumped.
    pub fn keep(&mut self, now: Duration) {
        self.lingers_until = self.lingers_until.max(now + LINGER);
    }

    /// Holds the keys that were pressed so shortly before the newest one that they could not have repeated
    /// yet: who jumps right after pressing a key wants to jump that way.
    pub fn join_newest(&mut self) {
        let Some((newest, others)) = self.keys.split_last_mut() else { return };
        for other in others {
            other.join_before_repetition(newest, self.rhythm);
        }
    }

    /// When the next key will be let go of, if nothing is heard of it until then.
    pub fn next_expiry(&self) -> Option<Duration> {
        let expiries = self.keys.iter().filter_map(|held| match held.state {
            State::CutOff => Some(self.lingers_until),
            _ => held.expiry(self.rhythm),
        });
        expiries.min()
    }

    /// Whether any key is in the steps of its tap, so that the next step may find another state.
    pub fn has_taps(&self) -> bool {
        self.keys.iter().any(HeldKey::has_taps)
    }

    /// How `key` is held.
    pub fn hold(&self, key: K) -> Hold {
        self.keys.iter().find(|held| held.key == key).map_or(Hold::Up, HeldKey::hold)
    }

    /// The keys that are not up, and how each is held.
    pub fn iter(&self) -> impl Iterator<Item = (K, Hold)> {
        let holds = self.keys.iter().map(|held| (held.key, held.hold()));
        holds.filter(|&(_, hold)| hold != Hold::Up)
    }

    /// What is known of `key`, taken out of the list; the oldest makes room for one that is new.
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
