//! Which keys are held: the one place that knows how little terminals tell of it.
//!
//! A terminal that reports releases tells all there is. Others send a key again and again while it
//! is held, and only the one pressed last. There, a key counts as held until its repetition fails to
//! come: the first time for longer than any keyboard waits before it repeats, from then on for a few
//! of the intervals that this keyboard was measured to repeat in. Timers shorter than the wait before
//! the first repetition were refused: walking stutters with them. A key that was merely tapped
//! counts as held for as long as that wait; [`HeldKeys::is_certain`] tells it from one that is held.
//!
//! Time is handed in, as the time since some fixed moment, so that tests need not wait.

use std::time::Duration;

use crate::terminal::{Key, KeyEvent, Phase};

/// Longer than keyboards wait before the first repetition, which is 250 to 500 ms.
const FIRST_WINDOW: Duration = Duration::from_millis(600);
/// After the first repetition, while no interval has been measured.
const SECOND_WINDOW: Duration = Duration::from_millis(200);
/// How many measured intervals a key may miss.
const INTERVALS: u32 = 3;
/// Bounds for that window: a link that delivers repetitions in bursts measures too short a one.
const SHORTEST_WINDOW: Duration = Duration::from_millis(90);
const LONGEST_WINDOW: Duration = Duration::from_millis(300);

/// The keys that are held.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldKeys {
    reports_releases: bool,
    keys: Vec<HeldKey>,
}

#[derive(Clone, Debug)]
struct HeldKey {
    key: Key,
    /// Whether Shift was down when the key was last heard of.
    shift: bool,
    heard: Duration,
    repetition: Repetition,
    /// When it stops counting as held; never, where releases are reported.
    expires: Option<Duration>,
}

#[derive(Clone, Copy, Debug)]
enum Repetition {
    NotYet,
    Once,
    /// The longest of the last intervals, slowly forgotten.
    Every(Duration),
}

impl HeldKeys {
    /// From now on releases are reported, or are not. Where that is news, every key counts as up.
    pub(super) fn set_reports_releases(&mut self, reports_releases: bool) {
        if self.reports_releases != reports_releases {
            self.reports_releases = reports_releases;
            self.keys.clear();
        }
    }

    /// Takes note of an event at time `now`. Keys that `opposes` names are let go of where nobody
    /// would say that they were.
    pub(super) fn note(&mut self, event: KeyEvent, now: Duration, opposes: impl Fn(Key) -> bool) {
        match event.phase {
            Phase::Release => self.keys.retain(|held| held.key != event.key),
            Phase::Press | Phase::Repeat => {
                if !self.reports_releases {
                    self.keys.retain(|held| held.key == event.key || !opposes(held.key));
                }
                self.press(event, now);
            }
        }
    }

    fn press(&mut self, event: KeyEvent, now: Duration) {
        self.expire(now);
        let known = self.keys.iter().position(|held| held.key == event.key);
        let repetition = known.map_or(Repetition::NotYet, |index| {
            let held = self.keys.swap_remove(index);
            held.repetition.after(now.saturating_sub(held.heard))
        });
        let expires = (!self.reports_releases).then(|| now + repetition.window());
        let shift = event.modifiers.shift;
        self.keys.push(HeldKey { key: event.key, shift, heard: now, repetition, expires });
    }

    /// Lets go of the keys whose repetition has failed to come by `now`.
    pub(super) fn expire(&mut self, now: Duration) {
        self.keys.retain(|held| held.expires.is_none_or(|expires| now < expires));
    }

    /// Lets go of all keys.
    pub(super) fn clear(&mut self) {
        self.keys.clear();
    }

    /// When the next key will be let go of, if nothing is heard of it until then.
    pub(super) fn next_expiry(&self) -> Option<Duration> {
        self.keys.iter().filter_map(|held| held.expires).min()
    }

    /// Whether `key` is known to be held, by its repetition or because releases are reported.
    pub(super) fn is_certain(&self, key: Key) -> bool {
        let repeats = |held: &HeldKey| !matches!(held.repetition, Repetition::NotYet);
        self.reports_releases || self.keys.iter().any(|held| held.key == key && repeats(held))
    }

    /// The keys that are held, Shift among them where only its effect on another key shows.
    pub(super) fn iter(&self) -> impl Iterator<Item = Key> {
        let shifted = !self.reports_releases && self.keys.iter().any(|held| held.shift);
        self.keys.iter().map(|held| held.key).chain(shifted.then_some(Key::Shift))
    }
}

impl Repetition {
    fn after(self, interval: Duration) -> Self {
        match self {
            // This one was the wait before the first repetition.
            Self::NotYet => Self::Once,
            Self::Once => Self::Every(interval),
            Self::Every(longest) => Self::Every(interval.max(longest * 7 / 8)),
        }
    }

    fn window(self) -> Duration {
        match self {
            Self::NotYet => FIRST_WINDOW,
            Self::Once => SECOND_WINDOW,
            Self::Every(interval) => (interval * INTERVALS).clamp(SHORTEST_WINDOW, LONGEST_WINDOW),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::Modifiers;

    const NONE: fn(Key) -> bool = |_| false;

    fn event(key: char, phase: Phase) -> KeyEvent {
        KeyEvent { key: Key::Char(key), base: None, modifiers: Modifiers::default(), phase }
    }

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    fn held_at(held: &mut HeldKeys, milliseconds: u64) -> Vec<Key> {
        held.expire(at(milliseconds));
        held.iter().collect()
    }

    #[test]
    fn with_releases_a_key_is_held_from_press_to_release() {
        let mut held = HeldKeys::default();
        held.set_reports_releases(true);
        held.note(event('w', Phase::Press), at(0), NONE);
        held.note(event('a', Phase::Press), at(10), NONE);
        assert_eq!(held_at(&mut held, 1_000_000), [Key::Char('w'), Key::Char('a')]);
        assert_eq!(held.next_expiry(), None);
        held.note(event('w', Phase::Release), at(1_000_001), NONE);
        assert_eq!(held_at(&mut held, 1_000_001), [Key::Char('a')]);
    }

    #[test]
    fn a_slow_keyboard_does_not_stutter() {
        let mut held = HeldKeys::default();
        held.note(event('w', Phase::Press), at(0), NONE);
        let mut now = 500;
        while now < 5000 {
            assert_eq!(held_at(&mut held, now), [Key::Char('w')], "{now}");
            held.note(event('w', Phase::Press), at(now), NONE);
            now += 90;
        }
    }

    #[test]
    fn once_the_rhythm_is_known_a_release_shows_within_a_few_beats() {
        let mut held = HeldKeys::default();
        held.note(event('w', Phase::Press), at(0), NONE);
        for now in (300..1000).step_by(33) {
            held.note(event('w', Phase::Press), at(now), NONE);
        }
        let last = (300..1000).step_by(33).last().unwrap();
        assert_eq!(held_at(&mut held, last + 98), [Key::Char('w')]);
        assert_eq!(held_at(&mut held, last + 100), []);
    }

    #[test]
    fn an_opposing_key_cancels_at_once() {
        let mut held = HeldKeys::default();
        held.note(event('w', Phase::Press), at(0), NONE);
        held.note(event('s', Phase::Press), at(50), |key| key == Key::Char('w'));
        assert_eq!(held_at(&mut held, 51), [Key::Char('s')]);
    }

    #[test]
    fn a_tap_is_not_certain_until_it_repeats() {
        let mut held = HeldKeys::default();
        held.note(event('w', Phase::Press), at(0), NONE);
        assert!(!held.is_certain(Key::Char('w')));
        held.note(event('w', Phase::Press), at(400), NONE);
        assert!(held.is_certain(Key::Char('w')));
        held.set_reports_releases(true);
        held.note(event('a', Phase::Press), at(500), NONE);
        assert!(held.is_certain(Key::Char('a')));
    }

    #[test]
    fn shift_shows_by_its_effect() {
        let mut held = HeldKeys::default();
        let modifiers = Modifiers { shift: true, ..Modifiers::default() };
        let shifted = KeyEvent { modifiers, ..event('w', Phase::Press) };
        held.note(shifted, at(0), NONE);
        assert_eq!(held_at(&mut held, 1), [Key::Char('w'), Key::Shift]);
        held.note(event('w', Phase::Press), at(30), NONE);
        assert_eq!(held_at(&mut held, 31), [Key::Char('w')]);
    }
}
