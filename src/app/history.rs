//! The history of a game: states at some of its past steps, from which the steps after them are
//! played again.
//!
//! The states are stored games, one every [`EVERY`] steps. Once they take more than [`MAX_BYTES`],
//! every second one is removed, and the time between two of them doubles. In the built-in levels, any
//! past state is found again within 6 ms in a debug build.
//!
//! Rejected: copies of the game. They are found as fast, but a copy contains the whole grid.

use crate::game::{Game, Intents, STEPS_PER_SECOND};

/// The least number of steps between two states.
const EVERY: u64 = 5 * STEPS_PER_SECOND as u64;
/// The maximum number of bytes that the states take: half an hour in the largest built-in level.
const MAX_BYTES: usize = 1 << 22;

/// States of a game. Steps are counted as in the script of the run.
#[derive(Debug)]
pub(crate) struct History {
    start: Game,
    /// The number of steps of the run before the game started.
    begun: u64,
    /// The number of steps now.
    steps: u64,
    states: Vec<StoredState>,
    every: u64,
}

#[derive(Debug)]
struct StoredState {
    steps: u64,
    bytes: Vec<u8>,
}

impl History {
    /// The history of a game at its start, after `begun` steps of a run.
    pub(crate) fn new(start: Game, begun: u64) -> Self {
        Self { start, begun, steps: begun, states: Vec::new(), every: EVERY }
    }

    /// The number of steps of the run up to now.
    pub(crate) fn steps(&self) -> u64 {
        self.steps
    }

    /// The number of steps of the run before the game started.
    pub(crate) fn begun(&self) -> u64 {
        self.begun
    }

    /// Records that `game` is the state after `steps` steps of the run.
    pub(crate) fn record(&mut self, steps: u64, game: &Game) {
        self.steps = steps;
        let last = self.states.last().map_or(self.begun, |state| state.steps);
        if steps < last + self.every {
            return;
        }
        let Some(bytes) = game.stored() else { return };
        self.states.push(StoredState { steps, bytes });
        if self.states.iter().map(|state| state.bytes.len()).sum::<usize>() > MAX_BYTES {
            self.every *= 2;
            let mut is_kept = false;
            self.states.retain(|_| {
                is_kept = !is_kept;
                is_kept
            });
        }
    }

    /// The state after `steps` steps, which must be in the past. `since` returns the intents of each
    /// step of the run from a step on.
    pub(crate) fn at<I: Iterator<Item = Intents>>(
        &self,
        steps: u64,
        since: impl FnOnce(u64) -> I,
    ) -> Game {
        let earlier = self.states.iter().rev().filter(|state| state.steps <= steps);
        let mut restored =
            earlier.filter_map(|it| Some((it.steps, self.start.clone().restored(&it.bytes).ok()?)));
        let (first, mut game) = restored.next().unwrap_or((self.begun, self.start.clone()));
        let count = steps.saturating_sub(first) as usize;
        since(first).take(count).for_each(|intents| game.step(intents));
        game
    }

    /// Forgets all states after `steps` steps.
    pub(crate) fn forget_after(&mut self, steps: u64) {
        self.steps = steps;
        self.states.retain(|state| state.steps <= steps);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::recording::RunLog;
    use crate::game::{Intent, Rules, Script};
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
                history.record(log.steps(), &game);
                checksums.push(game.checksum());
            }
            for (steps, &checksum) in checksums.iter().enumerate().step_by(97) {
                let found = history.at(steps as u64, |first| log.since(first));
                assert_eq!(found.checksum(), checksum, "{} at {steps}", level.name);
            }
        }
    }

    #[test]
    fn a_long_history_stays_within_its_bytes() {
        let level = builtin::LEVELS.iter().find(|level| level.name == "citadel");
        let world = level.and_then(|level| level.world().ok()).expect("the level is valid");
        let game = Game::with_rules(world, Rules::default());
        let mut history = History::new(game.clone(), 0);
        let turn = [Intent::TurnLeft].into_iter().collect();
        for steps in 1..400_000 {
            history.record(steps, &game);
        }
        let bytes: usize = history.states.iter().map(|state| state.bytes.len()).sum();
        assert!(bytes <= MAX_BYTES && history.states.len() > 100, "{bytes}");
        let found = history.at(300_000, |_| std::iter::repeat_n(turn, 0));
        assert_eq!(found.checksum(), game.checksum());
    }
}
