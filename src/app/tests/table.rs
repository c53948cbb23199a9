//! The effect of keys on each keyboard: the table in docs/keys.md.

use std::fmt::Write;

use super::*;

const DELAYS: [u64; 4] = [250, 400, 500, 660];
const RATES: [u32; 4] = [15, 25, 30, 40];
/// The duration of a tap, in milliseconds.
const TAP: u64 = 80;

fn rates() -> impl Iterator<Item = Option<Rate>> {
    let legacy = DELAYS.into_iter().flat_map(|delay| RATES.map(|rate| Some((delay, rate))));
    legacy.chain([None])
}

/// The angle in degrees and the distance in cells by which `plays` moves the player.
fn measured(rate: Option<Rate>, plays: impl Fn(&mut Rig)) -> (f64, f64) {
    let mut rig = Rig::new(floor(), rate);
    let (start, degrees) = (rig.position(), rig.degrees());
    plays(&mut rig);
    rig.wait(2500);
    (rig.degrees() - degrees, rig.position().distance(start))
}

fn taps(rate: Option<Rate>, key: Key, count: u64) -> (f64, f64) {
    measured(rate, |rig| {
        for _ in 0..count {
            rig.tap(key, TAP);
            rig.wait(TAP);
        }
    })
}

fn held(rate: Option<Rate>, key: Key) -> (f64, f64) {
    measured(rate, |rig| rig.tap(key, 1000))
}

/// The angle in degrees and the distance in cells after 2 seconds of walking and turning at the
/// same time.
fn chord(rate: Option<Rate>) -> (f64, f64) {
    let mut rig = Rig::new(floor(), rate);
    rig.press(W);
    rig.wait(1000);
    rig.press(Key::Right);
    let (mut walked, mut turned) = (0.0, 0.0);
    for _ in 0..200 {
        let (position, degrees) = (rig.position(), rig.degrees());
        rig.wait(10);
        walked += rig.position().distance(position);
        turned += (rig.degrees() - degrees).rem_euclid(360.0);
    }
    (turned, walked)
}

/// The number of running jumps, out of six from different positions, that cross a pit of one cell.
fn jumps(rate: Option<Rate>) -> usize {
    let places = [5.1, 5.3, 5.5, 5.7, 5.9, 6.1];
    let clears = places.into_iter().filter(|&place| {
        let mut rig = Rig::new(parse_str(PIT).unwrap(), rate);
        rig.press(W);
        while rig.position().x < place {
            rig.wait(1);
        }
        rig.tap(SPACE, TAP);
        rig.wait(1500);
        rig.position().x > 7.0 && rig.game().feet() == 0.0
    });
    clears.count()
}

fn table() -> String {
    let mut text = String::from(
        "| delay, rate | → tapped | twice | → held 1 s | W tapped | twice | W held 1 s | W and →, 2 s | running jumps |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for rate in rates() {
        let name = rate.map_or("releases reported".to_owned(), |(delay, rate)| {
            format!("{delay} ms, {rate} Hz")
        });
        let turns = [taps(rate, Key::Right, 1), taps(rate, Key::Right, 2), held(rate, Key::Right)];
        let walks = [taps(rate, W, 1), taps(rate, W, 2), held(rate, W)];
        write!(text, "| {name} |").unwrap();
        for (degrees, _) in turns {
            write!(text, " {degrees:.1}° |").unwrap();
        }
        for (_, cells) in walks {
            write!(text, " {cells:.2} |").unwrap();
        }
        let (degrees, cells) = chord(rate);
        writeln!(text, " {cells:.1} and {degrees:.0}° | {} of 6 |", jumps(rate)).unwrap();
    }
    text
}

#[test]
fn key_effects_match_the_table_for_each_keyboard() {
    insta::assert_snapshot!(table());
}

#[test]
fn taps_are_exact_and_every_running_jump_succeeds() {
    for rate in rates() {
        assert_eq!(jumps(rate), 6, "{rate:?}");
        let ((one, _), (two, _)) = (taps(rate, Key::Right, 1), taps(rate, Key::Right, 2));
        assert!((one - 5.0).abs() < 1e-3 && (two - 10.0).abs() < 1e-3, "{rate:?}: {one} {two}");
        let ((_, one), (_, two)) = (taps(rate, W, 1), taps(rate, W, 2));
        assert!((one - 0.25).abs() < 1e-3 && (two - 0.5).abs() < 1e-3, "{rate:?}: {one} {two}");
    }
}
