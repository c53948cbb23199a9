//! Tools: what is thrown and shot.

use super::*;
use crate::world::Supply;

#[test]
fn a_pebble_lands_six_cells_ahead_and_a_stretch_throws_one() {
    let mut stage = Stage::new(&["@.............."], "", "");
    stage.play(30, &[Intent::Throw]);
    assert_eq!(stage.game.supplies(Supply::Pebbles), 2);
    assert_eq!(stage.game.quiet_steps(intents(&[Intent::Throw])), 0);
    let mut last = DVec2::ZERO;
    while !stage.game.missiles.is_empty() {
        last = stage.game.missiles.iter().next().unwrap().position;
        stage.play(1, &[]);
    }
    assert!((5.8..6.8).contains(&last.x), "{last}");
    for _ in 0..3 {
        stage.press(Intent::Throw);
    }
    assert_eq!((stage.game.supplies(Supply::Pebbles), stage.message()), (0, "No pebbles left."));
}

#[test]
fn a_strike_says_what_it_did() {
    for (thing, message) in [
        ("", "Nobody is within reach."),
        ("w = { guard = 'warden', heading = 180 }", "Only a blow from behind stuns a warden."),
        ("w = { guard = 'warden', heading = 0 }", "The warden goes down."),
    ] {
        let row = if thing.is_empty() { "@......" } else { "@w....." };
        let mut stage = Stage::new(&[row], "", thing);
        stage.play(3, &[Intent::Forward]);
        stage.press(Intent::Strike);
        assert_eq!(stage.message(), message);
    }
}
