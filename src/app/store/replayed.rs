//! Scripts, played again to learn what they reach.

use super::Reached;
use crate::game::{Game, Outcome, Rules, Script};
use crate::generate::floors_below;
use crate::world::World;

/// The end of a descent.
pub struct DescentRun {
    /// The game on the last floor.
    pub game: Game,
    /// How far it came.
    pub reached: Reached,
}

/// The game at the end of `script`, or at its first exit.
pub fn replayed(world: World, rules: Rules, script: &Script) -> Game {
    let mut game = Game::with_rules(world, rules);
    for (_section, intents) in script.iter() {
        if game.is_finished() {
            break;
        }
        game.step(intents);
    }
    game
}

impl DescentRun {
    /// The descent of `script` from `floor` on, whose world is `first`. As in a game, a descent ends
    /// with the first death, and what is found counts once the exit is reached.
    pub fn replayed(floor: u32, first: World, rules: Rules, script: &Script) -> Self {
        let mut game = Game::with_rules(first, rules);
        let mut later = floors_below(rules.seed, floor);
        let mut reached = Reached::default();
        for (_section, intents) in script.iter() {
            if game.outcome() != Outcome::Playing {
                let Some(world) = later.next().filter(|_| game.is_finished()) else { break };
                game = Game::with_rules(world, rules);
            }
            game.step(intents);
            if game.is_finished() {
                reached = reached.and(&game.tally());
            }
        }
        Self { game, reached }
    }
}
