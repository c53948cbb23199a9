//! Taps and running jumps on each keyboard.

use super::*;

/// The duration of a tap, in milliseconds.
const TAP: u64 = 80;

/// The angle in degrees and the distance in cells by which `count` taps move the player.
fn taps(rate: Option<Rate>, key: Key, count: u64) -> (f64, f64) {
    let mut rig = Rig::new(floor(), rate);
    let (start, degrees) = (rig.position(), rig.degrees());
    for _ in 0..count {
        rig.tap(key, TAP);
        rig.wait(TAP);
    }
    rig.wait(2500);
    (rig.degrees() - degrees, rig.position().distance(start))
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

#[test]
fn taps_are_exact_and_every_running_jump_succeeds() {
    for rate in keyboards() {
        assert_eq!(jumps(rate), 6, "{rate:?}");
        let ((one, _), (two, _)) = (taps(rate, Key::Right, 1), taps(rate, Key::Right, 2));
        assert!((one - 5.0).abs() < 1e-3 && (two - 10.0).abs() < 1e-3, "{rate:?}: {one} {two}");
        let ((_, one), (_, two)) = (taps(rate, W, 1), taps(rate, W, 2));
        assert!((one - 0.25).abs() < 1e-3 && (two - 0.5).abs() < 1e-3, "{rate:?}: {one} {two}");
    }
}
