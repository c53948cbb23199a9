//! The history of a game: states at some of its past steps, from which the steps after them are
//! played again.
//!
//! Rejected: copies of the game. They are found as fast, but a copy contains the whole grid.

use crate::app::states::States;
use crate::game::{Game, Intents};

/// States of a game. Steps are counted as in the script of the run.
#[derive(Debug)]
pub(crate) struct History {
    start: Game,
    /// The number of steps of the run before the game started.
    pub(crate) begun: u64,
    /// The number of steps now.
    pub(crate) steps: u64,
    /// Stored games.
    states: States<Vec<u8>>,
}

impl History {
    /// The history of a game at its start, after `begun` steps of a run.
    pub(crate) fn new(start: Game, begun: u64) -> Self {
        Self { start, begun, steps: begun, states: States::default() }
    }

    /// Records that `game` is the state after `steps` steps of the run.
    pub(crate) fn record(&mut self, steps: u64, game: &Game) {
        self.steps = steps;
        self.states.keep(self.begun, steps, || game.stored());
    }

    /// The state after `steps` steps, which must be in the past. `since` returns the intents of each
    /// step of the run from a step on.
    pub(crate) fn at<I: Iterator<Item = Intents>>(
        &self,
        steps: u64,
        since: impl FnOnce(u64) -> I,
    ) -> Game {
        let mut restored = self
            .states
            .before(steps)
            .filter_map(|(step, bytes)| Some((step, self.start.clone().restored(bytes).ok()?)));
        let (first, mut game) = restored.next().unwrap_or((self.begun, self.start.clone()));
        let count = steps.saturating_sub(first) as usize;
        since(first).take(count).for_each(|intents| game.step(intents));
        game
    }

    /// Forgets all states after `steps` steps.
    pub(crate) fn forget_after(&mut self, steps: u64) {
        self.steps = steps;
        self.states.forget_after(steps);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::recording::RunLog;
    use crate::game::Script;
    use crate::map::builtin;

    #[test]
    fn each_past_state_of_a_run_is_found_again() {
        for level in builtin::LEVELS.iter().take(3) {
            let file = format!("maps/scripts/{}.hard.script", level.name);
            let text = std::fs::read_to_string(file).expect("each level has a script");
            let script = Script::parse(&text, "it").expect("the script is valid");
            let world = level.world().expect("the level is valid");
            let mut game = Game::with_rules(world, script.header().rules());
            let mut history = History::new(game.clone(), 0);
            let (mut log, mut checksums) = (RunLog::default(), vec![game.checksum()]);
            for (_, intents) in script.iter() {
                game.step(intents);
                log.record(intents, 1);
                history.record(log.steps, &game);
                checksums.push(game.checksum());
            }
            for (steps, &checksum) in checksums.iter().enumerate().step_by(97) {
                let found = history.at(steps as u64, |first| log.since(first));
                assert_eq!(found.checksum(), checksum, "{} at {steps}", level.name);
            }
        }
    }
}
