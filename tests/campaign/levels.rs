//! Properties of every level of the campaign.

use cellcaster::game::{Game, Intent, Intents, Rules, STEPS_PER_SECOND};
use cellcaster::map;
use cellcaster::map::builtin::{self, BuiltinLevel};
use cellcaster::world::{Difficulty, Driver, ThingKind, World};

use crate::route::{self, Errand};

/// The world of a level, read from its file, so that a change of a map does not require compiling
/// the tests again.
pub(crate) fn world(level: &BuiltinLevel) -> World {
    map::parse_str(&text(level)).unwrap_or_else(|faults| panic!("{}: {faults}", level.name))
}

fn text(level: &BuiltinLevel) -> String {
    let path = format!("{}/maps/{}.toml", env!("CARGO_MANIFEST_DIR"), level.name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The route through a level.
pub(crate) fn route(level: &BuiltinLevel) -> Vec<Errand> {
    let path = format!("{}/tests/campaign/routes/{}.route", env!("CARGO_MANIFEST_DIR"), level.name);
    let route = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    route::parse(&route, &text(level))
}

#[test]
fn every_level_has_a_title_a_par_time_secrets_treasure_guards_and_notes() {
    assert!(builtin::LEVELS.len() >= 10);
    for level in builtin::LEVELS {
        let world = world(level);
        let name = level.name;
        assert!(!world.title().is_empty() && world.par().is_some(), "{name}");
        let secrets = world.moving_tiles().iter().filter(|tile| tile.driver == Driver::Hand);
        assert!(secrets.count() > 0, "{name} has no secret");
        let has = |kind: fn(ThingKind) -> bool| world.things().iter().any(|thing| kind(thing.kind));
        assert!(has(|kind| matches!(kind, ThingKind::Note(_))), "{name} has no note");
        assert!(has(|kind| matches!(kind, ThingKind::Treasure(_))), "{name} has no treasure");
        assert!(has(|kind| kind == ThingKind::Exit), "{name} has no exit");
        let on_easy = world.guards().iter().filter(|guard| guard.from == Difficulty::Easy);
        assert!(on_easy.count() > 0, "{name} has no guard");
        let treasure: u32 = world
            .things()
            .iter()
            .map(|thing| if let ThingKind::Treasure(worth) = thing.kind { worth.into() } else { 0 })
            .sum();
        assert!(treasure > world.treasure_needed(), "{name} has nothing to find beside its goal");
    }
}

#[test]
fn titles_differ() {
    let titles: Vec<String> =
        builtin::LEVELS.iter().map(|level| world(level).title().to_owned()).collect();
    for (index, title) in titles.iter().enumerate() {
        assert!(!titles[..index].contains(title), "{title} twice");
    }
}

#[test]
fn nobody_is_hurt_at_the_start_before_they_act() {
    const TWO_MINUTES: u32 = 120 * STEPS_PER_SECOND;
    let look = [Intent::TurnRight, Intent::Duck].into_iter().collect();
    for level in builtin::LEVELS {
        for difficulty in Difficulty::ALL {
            let rules = Rules { difficulty, seed: 0 };
            let mut game = Game::with_rules(world(level), rules);
            let unhurt = game.health();
            for step in 0..TWO_MINUTES {
                game.step(if step % 600 < 60 { look } else { Intents::new() });
            }
            assert_eq!(game.health(), unhurt, "{} on {}", level.name, difficulty.name());
        }
    }
}
