use proptest::prelude::*;

use super::*;

/// Delays in milliseconds, and repetitions per second.
const KEYBOARDS: [(u64, u32); 16] = [
    (250, 15),
    (250, 25),
    (250, 30),
    (250, 40),
    (400, 15),
    (400, 25),
    (400, 30),
    (400, 40),
    (500, 15),
    (500, 25),
    (500, 30),
    (500, 40),
    (660, 15),
    (660, 25),
    (660, 30),
    (660, 40),
];
const STEPS: u32 = 5;

fn at(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn opposes(one: char, other: char) -> bool {
    matches!((one, other), ('w', 's') | ('s', 'w'))
}

fn press(held: &mut HeldKeys<char>, key: char, milliseconds: u64) -> Press {
    held.press(key, STEPS, at(milliseconds), |other| opposes(key, other))
}

#[test]
fn with_releases_a_key_is_held_from_the_end_of_its_tap_to_its_release() {
    let mut held = HeldKeys::default();
    held.set_reports_releases(true);
    press(&mut held, 'w', 0);
    assert_eq!(held.hold('w'), Hold::Tap);
    (0..STEPS).for_each(|_| held.step());
    held.advance(at(1_000_000));
    assert_eq!((held.hold('w'), held.next_expiry()), (Hold::Held, None));
    held.release('w');
    assert_eq!(held.hold('w'), Hold::Up);
}

#[test]
fn a_released_tap_runs_to_its_end() {
    let mut held = HeldKeys::default();
    held.set_reports_releases(true);
    press(&mut held, 'w', 0);
    held.release('w');
    let steps = (0..20).filter(|_| {
        let taps = held.hold('w') == Hold::Tap;
        held.step();
        taps
    });
    assert_eq!(steps.count() as u32, STEPS);
}

#[test]
fn taps_are_counted_at_any_speed() {
    for gap in [0, 1, 30, 60, 90, 130, 170, 230, 300, 450, 700] {
        for taps in 1..=4 {
            let mut typist = Typist::new((250, 30));
            for _ in 0..taps {
                typist.press('w');
                typist.release('w');
                assert_eq!(typist.wait(gap, ['w']), [0], "{taps} taps every {gap} ms");
            }
            typist.wait(2000, []);
            assert_eq!(typist.tapped, taps * STEPS, "{taps} taps every {gap} ms");
        }
    }
}

#[test]
fn a_key_is_held_from_its_second_repetition_without_a_gap() {
    for keyboard in KEYBOARDS {
        let mut typist = Typist::new(keyboard);
        for _ in 0..3 {
            typist.press('w');
            let interval = 1000 / u64::from(keyboard.1);
            let begins = keyboard.0 + interval + 1;
            typist.wait(begins, []);
            assert_eq!(typist.wait(2000, ['w']), [2000], "{keyboard:?}");
            typist.release('w');
            let [coasts] = typist.wait(1500, ['w']);
            assert!(coasts <= (interval * 5 / 2 + 1).max(91), "{keyboard:?}: {coasts}");
        }
    }
}

#[test]
fn a_newer_key_does_not_end_an_older_one() {
    for keyboard in KEYBOARDS {
        let mut typist = Typist::new(keyboard);
        typist.press('w');
        typist.wait(1000, []);
        typist.press('d');
        typist.wait(800, []);
        assert_eq!(typist.wait(2000, ['w', 'd']), [2000, 2000], "{keyboard:?}");
        typist.release('d');
        typist.release('w');
        let [walks, turns] = typist.wait(2000, ['w', 'd']);
        assert!(turns < walks && walks <= turns + 301, "{keyboard:?}: {walks} {turns}");
        // A tap of the newer key does not end the older one, either.
        typist.press('w');
        typist.wait(1000, []);
        typist.press('d');
        typist.release('d');
        assert_eq!(typist.wait(600, ['w', 'd']), [600, 0], "{keyboard:?}");
        let [walks] = typist.wait(2000, ['w']);
        assert!((1..=760).contains(&walks), "{keyboard:?}: {walks}");
    }
}

#[test]
fn pressing_again_releases_a_key_that_a_newer_one_interrupted() {
    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(1000, []);
    typist.press('d');
    typist.release('d');
    typist.wait(100, []);
    typist.tapped = 0;
    typist.press('w');
    typist.release('w');
    assert_eq!(typist.wait(2000, ['w']), [0]);
    assert_eq!(typist.tapped, STEPS);
}

#[test]
fn an_opposing_key_ends_a_hold_at_once_but_not_a_tap() {
    for is_interrupted in [false, true] {
        let mut typist = Typist::new((400, 30));
        typist.press('w');
        typist.wait(800, []);
        if is_interrupted {
            typist.press('d');
            typist.wait(50, []);
        }
        assert_eq!(typist.held.hold('w'), Hold::Held);
        typist.press('s');
        assert_eq!(typist.held.hold('w'), Hold::Up);
    }
    let mut typist = Typist::new((400, 30));
    typist.press('w');
    typist.press('s');
    typist.release('s');
    typist.wait(1000, []);
    assert_eq!(typist.tapped, 2 * STEPS);
}

#[test]
fn two_keys_pressed_together_are_held_together_once_one_repeats() {
    for keyboard in KEYBOARDS {
        for (apart, joins) in [(0, true), (40, true), (60, false), (140, false), (240, false)] {
            let mut typist = Typist::new(keyboard);
            typist.press('w');
            typist.wait(apart, []);
            typist.press('d');
            typist.wait(800, []);
            let [walks, turns] = typist.wait(500, ['w', 'd']);
            assert_eq!((walks == 500, turns), (joins, 500), "{keyboard:?}, {apart} ms apart");
        }
    }
}

#[test]
fn a_jump_holds_keys_that_could_not_have_repeated_yet() {
    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(300, []);
    typist.press(' ');
    typist.release(' ');
    typist.held.join_newest(|_| true);
    assert_eq!(typist.held.hold('w'), Hold::Held);
    // In the air, the player keeps holding the key.
    for _ in 0..40 {
        typist.held.keep(at(typist.now));
        assert_eq!(typist.wait(50, ['w']), [50]);
    }
    assert!((1..=301).contains(&typist.wait(2000, ['w'])[0]));

    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(550, []);
    let mut tapped = Typist::new((500, 30));
    tapped.press('w');
    tapped.release('w');
    tapped.wait(600, []);
    tapped.press(' ');
    tapped.held.join_newest(|_| true);
    assert_eq!(tapped.held.hold('w'), Hold::Unknown);
}

#[test]
fn a_jump_holds_only_the_key_that_gives_its_direction() {
    let typed = |keys: &[(char, u64)]| {
        let mut typist = Typist::new((500, 30));
        for &(key, wait) in keys {
            typist.press(key);
            typist.wait(wait, []);
        }
        typist.press(' ');
        typist.held.join_newest(|key| key != 'e');
        ['a', 'w', 'e'].map(|key| typist.held.hold(key) == Hold::Held)
    };
    assert_eq!(typed(&[('a', 150), ('w', 200)]), [false, true, false]);
    assert_eq!(typed(&[('a', 30), ('w', 200)]), [true, true, false]);
    assert_eq!(typed(&[('w', 100), ('e', 100)]), [false, true, false]);
    // The first key repeats already.
    assert_eq!(typed(&[('w', 900), ('a', 200)]), [false, true, false]);
}

#[test]
fn a_key_that_should_not_outlast_a_newer_one_is_released() {
    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(900, []);
    typist.press('d');
    typist.held.release_lingering(|key| key == 'd');
    assert_eq!(typist.held.hold('w'), Hold::Held);
    typist.held.release_lingering(|key| key == 'w');
    assert_eq!(typist.wait(2000, ['w']), [0]);
}

#[test]
fn a_key_is_down_from_its_press_to_its_release() {
    for reports_releases in [false, true] {
        let mut held = HeldKeys::default();
        held.set_reports_releases(reports_releases);
        press(&mut held, 'w', 500);
        assert!(held.is_any_down_since(at(500)));
        assert!(!held.is_any_down_since(at(499)), "it was pressed later");
        held.release('w');
        held.advance(at(1300));
        assert!(!held.is_any_down_since(at(500)));
    }
}

/// Each byte is up to 60 ms late, so that some come in pairs.
#[test]
fn jitter_releases_no_key_and_adds_no_tap() {
    for (delay, per_second) in KEYBOARDS {
        let interval = 1000 / u64::from(per_second);
        let mut held = HeldKeys::default();
        press(&mut held, 'w', 0);
        let mut arrival = 0;
        for index in 0..60 {
            let due = delay + index * interval + [0, 60, 10, 45, 5][index as usize % 5];
            arrival = due.max(arrival);
            held.advance(at(arrival));
            if index > 3 {
                assert_eq!(held.hold('w'), Hold::Held, "{delay} ms, {per_second} Hz, {index}");
            }
            press(&mut held, 'w', arrival);
            (0..interval / 16).for_each(|_| held.step());
        }
        assert!(!held.has_taps());
    }
}

#[test]
fn a_burst_after_a_stall_counts_as_repetition_not_taps() {
    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(1500, []);
    typist.release('w');
    typist.wait(450, []);
    typist.tapped = 0;
    for _ in 0..14 {
        press(&mut typist.held, 'w', typist.now);
    }
    assert_eq!(typist.held.hold('w'), Hold::Held);
    typist.wait(1000, []);
    assert_eq!(typist.tapped, 0);
}

#[test]
fn a_repetition_without_a_delay_is_recognized() {
    let mut held = HeldKeys::default();
    let presses = (0..20).map(|index| press(&mut held, 'w', index * 33)).collect::<Vec<_>>();
    assert_eq!(presses[19], Press::Repeat);
    assert_eq!(held.hold('w'), Hold::Held);
}

#[test]
fn a_released_key_stays_up_until_it_is_pressed_again() {
    let mut typist = Typist::new((500, 30));
    typist.press('w');
    typist.wait(1000, []);
    typist.held.release_all();
    assert_eq!(typist.wait(1000, ['w']), [0]);
    typist.release('w');
    typist.wait(400, []);
    typist.press('w');
    assert_eq!(typist.held.hold('w'), Hold::Tap);
}

#[test]
fn a_press_is_unclear_if_it_may_be_a_repetition() {
    let mut held = HeldKeys::default();
    let bytes = [
        (0, Press::Fresh),
        (150, Press::Fresh),
        (600, Press::Unclear),
        (1000, Press::Unclear),
        (1030, Press::Repeat),
        (1060, Press::Repeat),
        (4000, Press::Fresh),
    ];
    for (milliseconds, press_is) in bytes {
        assert_eq!(press(&mut held, ' ', milliseconds), press_is, "at {milliseconds} ms");
    }
}

fn names(keys: &[(Intent, Hold)]) -> Vec<&'static str> {
    wanted(keys.iter().copied()).iter().map(Intent::name).collect()
}

#[test]
fn a_tap_turns_slowly_and_does_not_run() {
    use Hold::{Held, Tap, Unknown};
    use Intent::{Duck, FineLeft, Forward, Run, TurnLeft};
    assert_eq!(names(&[(TurnLeft, Tap)]), ["turn-left", "aim"]);
    assert_eq!(names(&[(TurnLeft, Held)]), ["turn-left"]);
    assert_eq!(names(&[(TurnLeft, Unknown), (Forward, Unknown)]), [""; 0]);
    assert_eq!(names(&[(Forward, Tap), (Run, Held)]), ["forward"]);
    assert_eq!(names(&[(Forward, Held), (Run, Held)]), ["forward", "run"]);
    assert_eq!(names(&[(Duck, Unknown), (FineLeft, Held)]), ["duck"]);
}

proptest! {
    /// For any bytes, nothing panics, all keys come up, and memory is bounded.
    #[test]
    fn after_any_bytes_all_keys_come_up(bytes in prop::collection::vec((0..900_u64, prop::char::range('a', 'z')), 0..80)) {
        let mut held = HeldKeys::default();
        let mut now = 0;
        for (gap, key) in bytes {
            now += gap;
            press(&mut held, key, now);
            held.step();
            prop_assert!(held.keys.len() <= MAX_KEYS);
        }
        (0..200).for_each(|_| held.step());
        held.advance(at(now + 3000));
        prop_assert_eq!(held.iter().count(), 0);
        prop_assert_eq!((held.next_expiry(), held.has_taps()), (None, false));
    }
}

/// A simulated keyboard at a terminal that does not report releases: the bytes that it sends. One key repeats at a
/// time: the key that was pressed last, until it is released.
#[derive(Clone, Debug)]
pub(crate) struct Keyboard<K> {
    delay: Duration,
    interval: Duration,
    repeats: Option<(K, Duration)>,
}

impl<K: Copy + Eq> Keyboard<K> {
    /// A keyboard that repeats after `delay`, `per_second` times per second.
    pub(crate) fn new(delay: Duration, per_second: u32) -> Self {
        Self { delay, interval: Duration::from_secs(1) / per_second, repeats: None }
    }

    /// Presses a key at `now`, and returns its byte.
    pub(crate) fn press(&mut self, key: K, now: Duration) -> K {
        self.repeats = Some((key, now + self.delay));
        key
    }

    /// Releases a key.
    pub(crate) fn release(&mut self, key: K) {
        self.repeats = self.repeats.filter(|&(other, _)| other != key);
    }

    /// The next byte due at or before `now`, and its time.
    pub(crate) fn next_byte(&mut self, now: Duration) -> Option<(K, Duration)> {
        let (key, due) = self.repeats.filter(|&(_, due)| due <= now)?;
        self.repeats = Some((key, due + self.interval));
        Some((key, due))
    }
}

/// A player at a keyboard that repeats. A step passes every 16 ms.
struct Typist {
    held: HeldKeys<char>,
    keyboard: Keyboard<char>,
    now: u64,
    /// The steps in which a key was tapped.
    tapped: u32,
}

impl Typist {
    fn new((delay, per_second): (u64, u32)) -> Self {
        Self {
            held: HeldKeys::default(),
            keyboard: Keyboard::new(at(delay), per_second),
            now: 0,
            tapped: 0,
        }
    }

    fn press(&mut self, key: char) {
        let key = self.keyboard.press(key, at(self.now));
        press(&mut self.held, key, self.now);
    }

    fn release(&mut self, key: char) {
        self.keyboard.release(key);
    }

    /// Lets time pass, and returns the number of milliseconds for which each of `keys` was `Held`.
    fn wait<const N: usize>(&mut self, milliseconds: u64, keys: [char; N]) -> [u64; N] {
        let mut held_for = [0; N];
        for _ in 0..milliseconds {
            self.now += 1;
            while let Some((key, due)) = self.keyboard.next_byte(at(self.now)) {
                self.held.press(key, STEPS, due, |other| opposes(key, other));
            }
            self.held.advance(at(self.now));
            for (count, key) in held_for.iter_mut().zip(keys) {
                *count += u64::from(self.held.hold(key) == Hold::Held);
            }
            if self.now.is_multiple_of(16) {
                self.tapped +=
                    self.held.iter().filter(|&(_, hold)| hold == Hold::Tap).count() as u32;
                self.held.step();
            }
        }
        held_for
    }
}
