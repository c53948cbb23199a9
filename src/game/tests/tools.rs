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
