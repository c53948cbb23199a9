//! Levers, secret walls and checkpoints of real levels.

use cellcaster::game::{Game, Intent, Outcome, Rules};
use cellcaster::map::builtin;
use cellcaster::world::{Cell, Difficulty, FieldOfView};

use crate::lazy::run;
use crate::levels::world;
use crate::pilot::Pilot;
use crate::route::{Errand, Verb};

const RULES: Rules = Rules { difficulty: Difficulty::Easy, seed: 0 };

/// Starts a level in an easy game.
fn begin(name: &str) -> Pilot {
    let level = builtin::LEVELS.iter().find(|level| level.name == name).unwrap();
    Pilot::new(Game::with_rules(world(level), RULES))
}

fn do_at(pilot: &mut Pilot, verb: Verb, (column, row): (u32, u32)) {
    let cell = Cell { column, row };
    run(pilot, Errand { verb, cell, height: None, is_careful: false });
    assert_eq!(pilot.game.outcome(), Outcome::Playing, "on the way to {cell:?}");
}

#[test]
fn the_lever_of_the_clock_tower_lifts_the_player_to_the_gallery() {
    let mut pilot = begin("clock");
    let eye = |pilot: &Pilot| pilot.game.camera(FieldOfView::default()).eye();
    let before = eye(&pilot);
    do_at(&mut pilot, Verb::Go, (1, 11));
    do_at(&mut pilot, Verb::Open, (1, 12));
    pilot.wait(300);
    assert_eq!(pilot.game.world().floor_at(pilot.cell()), 2.0);
    assert!((eye(&pilot) - before - 2.0).abs() < 1e-9);
}

#[test]
fn a_secret_wall_of_the_clock_tower_sinks_and_gives_the_treasure_behind_it() {
    let mut pilot = begin("clock");
    assert_eq!(pilot.game.secrets().found, 0);
    do_at(&mut pilot, Verb::Open, (13, 16));
    pilot.wait(120);
    assert_eq!(pilot.game.secrets().found, 1);
    do_at(&mut pilot, Verb::Go, (14, 17));
    assert_eq!(pilot.game.treasure().found, 25);
}

#[test]
fn a_player_who_dies_in_the_treasury_goes_on_from_its_checkpoint() {
    let checkpoint = (36, 12);
    let mut pilot = begin("treasury");
    do_at(&mut pilot, Verb::Go, checkpoint);
    assert_eq!(pilot.game.message(), Some("Checkpoint."));
    do_at(&mut pilot, Verb::Go, (18, 18));
    pilot.wait(600);
    assert_eq!(pilot.game.outcome(), Outcome::Dead { cause: "spikes" });
    pilot.press(Intent::Retry);
    assert_eq!(pilot.game.outcome(), Outcome::Playing);
    assert_eq!((pilot.cell().column, pilot.cell().row), checkpoint);
    assert_eq!(pilot.game.tally().deaths, 1);
}
