//! The record of a script: its intents, in one level after another.

use super::recorded::{Cursor, MarkKind, Record};
use crate::app::levels::{LevelNumber, Levels, Stage};
use crate::app::played::Played;
use crate::game::{Game, Intents, Script, Tally};
use crate::world::Difficulty;

/// A script and its levels. The stretches of a day take at most 125 MB, if no two steps are alike.
pub(crate) struct ScriptRecord {
    /// The intents of the script, each with the number of steps up to their end.
    stretches: Vec<(u64, Intents)>,
    difficulty: Difficulty,
    /// The levels that were begun.
    levels: Vec<Stage>,
    /// The levels after them.
    rest: Box<dyn Iterator<Item = Stage>>,
    first_number: LevelNumber,
}

/// A game in little memory.
pub(crate) enum State {
    /// The bytes of a [stored](Game::stored) game.
    Stored(Vec<u8>),
    /// A flight, or a game in a generated level, which cannot be stored.
    Copy(Box<Played>),
}

impl ScriptRecord {
    pub(crate) fn new(levels: Levels, script: &Script, difficulty: Difficulty) -> Self {
        let (stage, rest, first_number) = levels.into_parts();
        let mut end = 0;
        let stretches = script.sections().iter().flat_map(|section| &section.stretches);
        let stretches = stretches.map(|stretch| {
            end += u64::from(stretch.steps);
            (end, stretch.intents)
        });
        let stretches = stretches.collect();
        Self { stretches, difficulty, levels: vec![stage], rest, first_number }
    }

    /// The number of the level with this index.
    pub(crate) fn number(&self, level: usize) -> LevelNumber {
        self.first_number.after(level)
    }

    /// The levels from the one with this index on.
    pub(crate) fn into_levels(self, level: usize) -> Levels {
        let number = self.number(level);
        Levels::of_stages(self.levels.into_iter().skip(level).chain(self.rest), number)
    }
}

impl Record for ScriptRecord {
    type Game = Played;
    type Stored = State;

    fn steps(&self) -> u64 {
        self.stretches.last().map_or(0, |&(end, _)| end)
    }

    fn begin(&mut self, level: usize) -> Option<Played> {
        if level >= self.levels.len() {
            self.levels.extend(self.rest.next());
        }
        self.levels.get(level)?.begin(self.difficulty)
    }

    fn goes_on(&self, cursor: Cursor, _: &Played) -> bool {
        cursor.step < self.steps()
    }

    fn is_over(&self, _: usize, game: &Played) -> bool {
        game.is_finished()
    }

    fn advance(&self, cursor: Cursor, game: &mut Played) {
        let index = self.stretches.partition_point(|&(end, _)| end <= cursor.step);
        if let Some((_, intents)) = self.stretches.get(index) {
            game.step(*intents);
        }
    }

    fn store(&self, game: &Played) -> State {
        match game.grid().and_then(Game::stored) {
            Some(bytes) => State::Stored(bytes),
            None => State::Copy(Box::new(game.clone())),
        }
    }

    fn restore(&mut self, level: usize, stored: &State) -> Option<Played> {
        match stored {
            State::Copy(game) => Some(Played::clone(game)),
            State::Stored(bytes) => match self.begin(level)? {
                Played::Grid(game) => Some(Played::Grid(Box::new(game.restored(bytes).ok()?))),
                Played::Space(_) => None,
            },
        }
    }

    fn events(&self, played: &Played) -> [u32; MarkKind::ALL.len()] {
        let end = u32::from(played.is_finished());
        let Some(game) = played.grid() else { return [0, 0, 0, end, 0] };
        let Tally { treasure, secrets, alarms, deaths, .. } = game.tally();
        let finds = treasure.found + secrets.found + game.keys().count() as u32;
        [finds, alarms, 0, end, deaths]
    }
}
