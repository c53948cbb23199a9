//! Scripts of descents: `replay --verify` reports their progress.
#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;

use cellcaster::app::store::Reached;
use cellcaster::game::{Game, Header, LevelName, Outcome, Rules};
use cellcaster::generate::descent;
use cellcaster::world::{Cell, Difficulty, ThingKind};

use crate::pilot::{Pace, Pilot};
use crate::support::cellcaster;
use crate::ways::Ways;

/// The longest time on a floor, in steps.
const MAX_STEPS: u64 = 60 * 90;

/// The goal of the player: the nearest treasure while some is needed, and then the exit.
fn goal(pilot: &Pilot) -> Option<Cell> {
    let world = pilot.game.world();
    let needs_more = pilot.game.treasure().found < world.treasure_needed();
    let is_wanted = |kind| match kind {
        ThingKind::Treasure(_) => needs_more,
        kind => kind == ThingKind::Exit && !needs_more,
    };
    let cells = world.things().iter().filter(|thing| is_wanted(thing.kind)).map(|thing| thing.cell);
    cells.min_by_key(|&cell| {
        (Ways::new(&pilot.game, cell, |_| 0).cost(pilot.cell()), cell.row, cell.column)
    })
}

/// Runs through a floor carelessly.
fn run(seed: u64, floor: u32, difficulty: Difficulty) -> Pilot {
    let mut pilot =
        Pilot::new(Game::with_rules(descent(seed, floor).unwrap(), Rules { difficulty, seed }));
    while pilot.steps() < MAX_STEPS && pilot.game.outcome() == Outcome::Playing {
        let Some(goal) = goal(&pilot) else { break };
        let ways = Ways::new(&pilot.game, goal, |_| 0);
        pilot.go(&ways, Pace::Run, 60);
    }
    pilot
}

/// A descent to the first floor whose exit the player does not reach. Returns its script and its
/// progress.
fn descend(seed: u64, difficulty: Difficulty, most: u32) -> (String, Reached) {
    let level = Some(LevelName::of_floor(1));
    let mut script = format!("{}\n", Header::of(level, Rules { difficulty, seed }));
    let mut reached = Reached::default();
    for floor in 1..=most {
        let pilot = run(seed, floor, difficulty);
        script += &pilot.script();
        if !pilot.game.is_finished() {
            break;
        }
        reached = reached.and(&pilot.game.tally());
    }
    (script, reached)
}

#[test]
fn a_descent_is_verified_floor_by_floor() {
    let descents = (1..40).map(|seed| descend(seed, Difficulty::Easy, 3));
    let (script, reached) = { descents }.find(|(_, reached)| reached.floors >= 2).unwrap();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("descent.script");
    let verify = |script: &str| {
        fs::write(&path, script).unwrap();
        let words = ["replay", path.to_str().unwrap(), "--verify"];
        let output = cellcaster(&words).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let (status, report) = verify(&script);
    assert_eq!(status, Some(0), "{report}");
    for line in [
        "level      floor 1\n".to_owned(),
        format!("floors     {}\n", reached.floors),
        format!("({} steps)\n", reached.steps),
        format!("treasure   {}\n", reached.treasure),
    ] {
        assert!(report.contains(&line), "{report}{line}");
    }
    let other_seed = script.replacen("seed       ", "seed       9", 1);
    assert_ne!(verify(&other_seed).1, report);
}
