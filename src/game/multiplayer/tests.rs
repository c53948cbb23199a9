//! Properties of multiplayer games.

mod among;
mod properties;

use glam::DVec2;

use super::*;
use crate::game::Outcome;
use crate::game::player::RADIUS;
use crate::game::{ShownPlayers, StrikeEffect};
use crate::map;
use crate::world::{Cell, Difficulty, World};

const RULES: Rules = Rules { difficulty: Difficulty::Normal, seed: 7 };

fn world(text: &str) -> World {
    map::parse_str(text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The world that `rows` draw. The player starts at `@` and looks east.
fn level(rows: &[&str], tiles: &str, things: &str) -> World {
    world(&format!(
        "grid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = \"brick\" }}\n{tiles}\n[things]\n'@' = {{ start = 0 }}\n{things}\n",
        rows.join("\n")
    ))
}

/// A multiplayer game with `count` players in it.
fn with_players(world: World, rules: MultiplayerRules, count: usize) -> (Game, Vec<PlayerId>) {
    let mut game = Game::for_players(world, RULES, rules);
    let ids = (0..count).map(|index| game.join(PlayerColor::ALL[index % 8]).unwrap()).collect();
    (game, ids)
}

fn intents(list: &[Intent]) -> Intents {
    list.iter().copied().collect()
}

/// Plays `steps` steps with the intents in `wanted`.
fn play(game: &mut Game, steps: usize, wanted: &[(PlayerId, &[Intent])]) {
    for _ in 0..steps {
        let seen = game.steps();
        let inputs =
            wanted.iter().map(|&(player, list)| Input { player, intents: intents(list), seen });
        game.step_all(&inputs.collect::<Vec<_>>());
    }
}

fn position(game: &Game, player: PlayerId) -> DVec2 {
    game.seen_by(player).unwrap().camera(crate::world::FieldOfView::default()).position()
}

/// Asserts that everything but figures and sprites is equal in a single-player game and in `other`.
/// The single player corresponds to the player in the first slot of `other`.
fn assert_plays_alike(one: &Game, other: &Game) {
    let member = other.members.as_ref().unwrap().member(0).unwrap();
    assert_eq!(one.player, member.player);
    assert_eq!(one.doors, other.doors);
    assert_eq!(one.mechanisms, other.mechanisms);
    assert_eq!(one.spikes, other.spikes);
    assert_eq!(one.missiles, other.missiles);
    assert_eq!(one.smoke, other.smoke);
    assert_eq!(one.guards, other.guards);
    assert_eq!(one.world.things(), other.world.things());
    assert_eq!(
        (one.steps, one.outcome()),
        (other.steps, other.seen_by(PlayerId::FIRST).unwrap().outcome())
    );
}
