//! A careless player, who walks the shortest way from errand to errand, whatever happens.

use cellcaster::game::{Game, Outcome, Rules};
use cellcaster::map::builtin::{self, BuiltinLevel};
use cellcaster::world::{Cell, Difficulty};

use crate::levels::{route, world};
use crate::pilot::{Pace, Pilot};
use crate::route::{Errand, Verb};
use crate::ways::Ways;

/// The time after which the player counts as stuck, in steps.
const MAX_STEPS: u64 = 60 * 60 * 6;

/// Plays a level carelessly.
pub(crate) fn play(level: &BuiltinLevel, rules: Rules) -> Pilot {
    let mut pilot = Pilot::new(Game::with_rules(world(level), rules));
    for errand in route(level).into_iter().filter(|errand| !errand.is_careful) {
        run(&mut pilot, errand);
        if pilot.game.outcome() != Outcome::Playing {
            break;
        }
    }
    pilot
}

/// Does an errand carelessly.
pub(crate) fn run(pilot: &mut Pilot, Errand { verb, cell, height, .. }: Errand) {
    let is_over =
        |pilot: &Pilot| pilot.steps() > MAX_STEPS || pilot.game.outcome() != Outcome::Playing;
    loop {
        let ways = match verb {
            Verb::Go => Ways::new(&pilot.game, cell, |_| 0),
            Verb::Open => Ways::beside(&pilot.game, cell, |_| 0),
            Verb::Hop => {
                pilot.hop(cell, height);
                return;
            }
            Verb::Straight => {
                pilot.straight(cell);
                return;
            }
            Verb::Throw => return,
        };
        if is_over(pilot) || pilot.go(&ways, Pace::Walk, 30) {
            break;
        }
    }
    if verb == Verb::Open && !is_over(pilot) {
        pilot.open(cell);
    }
}

#[test]
fn a_careless_player_loses_every_level() {
    let rules = Rules { difficulty: Difficulty::Normal, seed: 0 };
    let ends = builtin::LEVELS.iter().map(|level| {
        let pilot = play(level, rules);
        (level.name, pilot.game.outcome(), pilot.steps(), pilot.cell())
    });
    let ends: Vec<_> = ends.collect();
    let survived = ends.iter().filter(|(_, outcome, ..)| !matches!(outcome, Outcome::Dead { .. }));
    let survived: Vec<_> = survived.collect();
    assert!(survived.is_empty(), "{survived:#?}");
    let lines = ends.iter().map(|(name, outcome, steps, Cell { column, row })| {
        format!("{name}: {outcome:?} after {steps} steps at {column},{row}\n")
    });
    insta::assert_snapshot!("lazy", lines.collect::<String>());
}
