//! A recorded run: a script, its levels, the states along the way, and the marks of its events.
//!
//! The run is read ahead once, by playing it. While reading, every few seconds of it the state is
//! kept. Any step that was read is then reached from the last state before it. A state is the bytes
//! of a [stored](Game::stored) game, or a copy of a flight or of a game in a generated level, which
//! cannot be stored.
//!
//! If there are too many states, every second one is dropped and the distance doubles. A state takes
//! 3 to 11 kB in the built-in levels and 80 kB in a generated one, so [`MAX_STATES`] of them take at
//! most 6 MB or 40 MB. An hour of play has 360 states of 3 to 4.3 MB in all. A debug build reads it
//! in 2.2 s, and the slowest of 500 jumps in it takes 18 ms. In a day of play, the states are 320
//! seconds apart.
//!
//! Two marks of the same kind are at least a second apart, so a day has at most 345,600 of them, in
//! 6 MB. The stretches of a day take at most 125 MB, if no two steps of the script are alike.
//!
//! Rejected: copies of all games. They take 184 kB each in the largest built-in level.

use crate::app::levels::{LevelNumber, Levels, Stage};
use crate::app::played::Played;
use crate::game::{Game, Intents, STEPS_PER_SECOND, Script, Tally};
use crate::world::Difficulty;

/// The maximum number of states that are kept.
pub(crate) const MAX_STATES: usize = 512;
/// The first distance between two states, in steps.
const FIRST_INTERVAL: u64 = 10 * STEPS_PER_SECOND as u64;
/// The minimum distance between two marks of the same kind, in steps.
const MIN_DISTANCE: u64 = STEPS_PER_SECOND as u64;

/// A run that is read ahead while it is shown.
pub(crate) struct RecordedRun {
    /// The intents of the script, each with the number of steps up to their end.
    stretches: Vec<(u64, Intents)>,
    difficulty: Difficulty,
    /// The levels that were reached.
    levels: Vec<RecordedLevel>,
    /// The levels after them.
    rest: Box<dyn Iterator<Item = Stage>>,
    first_number: LevelNumber,
    /// The state up to which the run was read.
    reader: Cursor,
    game: Played,
    /// `true` if the end was read.
    is_read: bool,
    /// The states on the way, without the starts of levels.
    states: Vec<(Cursor, State)>,
    /// The distance between two states, in steps.
    interval: u64,
    marks: Vec<Mark>,
    /// The events of the current level up to the reader.
    counts: Counts,
}

/// A level of the run.
struct RecordedLevel {
    stage: Stage,
    /// The number of steps before its first one.
    before: u64,
}

/// A place in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Cursor {
    /// The number of steps before it, counted over all levels.
    pub(crate) step: u64,
    /// The index of its level.
    pub(crate) level: usize,
}

/// A state of the game.
enum State {
    Stored(Vec<u8>),
    Copy(Box<Played>),
}

/// An event in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mark {
    /// The number of steps up to and including the event.
    pub(crate) step: u64,
    pub(crate) kind: MarkKind,
}

/// A kind of event, the least important first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum MarkKind {
    /// The player found treasure, a secret or a key.
    Find,
    /// A guard began to follow the player.
    Alarm,
    /// The player reached the exit.
    LevelEnd,
    /// The player died.
    Death,
}

/// The numbers of events in a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
struct Counts {
    finds: usize,
    alarms: u32,
    deaths: u32,
}

impl Counts {
    fn of(played: &Played) -> Self {
        let Some(game) = played.grid() else { return Self::default() };
        let Tally { treasure, secrets, alarms, deaths, .. } = game.tally();
        let finds = (treasure.found + secrets.found) as usize + game.keys().count();
        Self { finds, alarms, deaths }
    }
}

impl RecordedRun {
    /// The run of `script` in `levels`, and its state at the start. `None` if the first level cannot
    /// begin.
    pub(crate) fn new(
        levels: Levels,
        script: &Script,
        difficulty: Difficulty,
    ) -> Option<(Self, Played)> {
        let (stage, rest, first_number) = levels.into_parts();
        let start = stage.begin(difficulty)?;
        let mut end = 0;
        let stretches = script.sections().iter().flat_map(|section| &section.stretches);
        let stretches = stretches.map(|stretch| {
            end += u64::from(stretch.steps);
            (end, stretch.intents)
        });
        let run = Self {
            stretches: stretches.collect(),
            difficulty,
            levels: vec![RecordedLevel { stage, before: 0 }],
            rest,
            first_number,
            reader: Cursor::default(),
            counts: Counts::of(&start),
            game: start.clone(),
            is_read: false,
            states: Vec::new(),
            interval: FIRST_INTERVAL,
            marks: Vec::new(),
        };
        Some((run, start))
    }

    /// The number of steps: of the script or, once it was read, up to the end of its last level.
    pub(crate) fn steps(&self) -> u64 {
        let of_script = self.stretches.last().map_or(0, |&(end, _)| end);
        if self.is_read { self.reader.step } else { of_script }
    }

    /// The number of steps that were read.
    pub(crate) fn steps_read(&self) -> u64 {
        self.reader.step
    }

    /// Whether the run was read to its end.
    pub(crate) fn is_read(&self) -> bool {
        self.is_read
    }

    /// The marks of the part that was read, in order.
    pub(crate) fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// The number of the level with this index.
    pub(crate) fn number(&self, level: usize) -> LevelNumber {
        self.first_number.after(level)
    }

    /// The levels from the one with this index on.
    pub(crate) fn into_levels(self, level: usize) -> Levels {
        let number = self.number(level);
        let later = self.levels.into_iter().skip(level).map(|level| level.stage);
        Levels::of_stages(later.chain(self.rest), number)
    }

    /// Reads one more step. Returns `false` at the end.
    pub(crate) fn read(&mut self) -> bool {
        let Some(intents) = self.intents(self.reader.step) else {
            self.is_read = true;
            return false;
        };
        if self.game.is_finished() {
            let next = self.rest.next();
            let Some((game, stage)) = next.and_then(|it| Some((it.begin(self.difficulty)?, it)))
            else {
                self.is_read = true;
                return false;
            };
            self.levels.push(RecordedLevel { stage, before: self.reader.step });
            self.reader.level += 1;
            self.counts = Counts::of(&game);
            self.game = game;
        }
        self.game.step(intents);
        self.reader.step += 1;
        self.mark_events();
        if self.reader.step.is_multiple_of(self.interval) {
            self.keep_state();
        }
        true
    }

    fn mark_events(&mut self) {
        let (before, now) = (self.counts, Counts::of(&self.game));
        self.counts = now;
        let events = [
            (now.finds > before.finds, MarkKind::Find),
            (now.alarms > before.alarms, MarkKind::Alarm),
            (now.deaths > before.deaths, MarkKind::Death),
            (self.game.is_finished(), MarkKind::LevelEnd),
        ];
        let step = self.reader.step;
        for (_, kind) in events.into_iter().filter(|event| event.0) {
            let is_near = |mark: &Mark| mark.kind == kind && step < mark.step + MIN_DISTANCE;
            let mut recent = self.marks.iter().rev().take(MarkKind::ALL.len());
            if !recent.any(is_near) {
                self.marks.push(Mark { step, kind });
            }
        }
    }

    fn keep_state(&mut self) {
        if self.states.len() == MAX_STATES {
            self.interval *= 2;
            let interval = self.interval;
            self.states.retain(|(cursor, _)| cursor.step.is_multiple_of(interval));
            if !self.reader.step.is_multiple_of(interval) {
                return;
            }
        }
        let stored = self.game.grid().and_then(Game::stored);
        let state = match stored {
            Some(bytes) => State::Stored(bytes),
            None => State::Copy(Box::new(self.game.clone())),
        };
        self.states.push((self.reader, state));
    }

    /// The intents of the step after `step` others; `None` at the end of the script.
    fn intents(&self, step: u64) -> Option<Intents> {
        let index = self.stretches.partition_point(|&(end, _)| end <= step);
        self.stretches.get(index).map(|&(_, intents)| intents)
    }

    /// Advances `game`, which is at `cursor`, by a step, if that step was read.
    pub(crate) fn step(&self, cursor: &mut Cursor, game: &mut Played) {
        if cursor.step >= self.reader.step {
            return;
        }
        let Some(intents) = self.intents(cursor.step) else { return };
        if game.is_finished()
            && let Some(next) = self.start(cursor.level + 1)
        {
            cursor.level += 1;
            *game = next;
        }
        game.step(intents);
        cursor.step += 1;
    }

    /// The level with this index at its start.
    fn start(&self, level: usize) -> Option<Played> {
        self.levels.get(level)?.stage.begin(self.difficulty)
    }

    /// Moves `game` from `cursor` to the state after `step` steps, or after all that were read.
    pub(crate) fn seek(&self, step: u64, cursor: &mut Cursor, game: &mut Played) {
        let step = step.min(self.reader.step);
        let is_ahead = cursor.step <= step;
        if let Some((nearest, start)) = self.state_before(step)
            && !(is_ahead && nearest.step <= cursor.step)
        {
            (*cursor, *game) = (nearest, start);
        }
        while cursor.step < step {
            let before = cursor.step;
            self.step(cursor, game);
            if cursor.step == before {
                break;
            }
        }
    }

    /// The last known state from which the state after `step` steps can be played.
    fn state_before(&self, step: u64) -> Option<(Cursor, Played)> {
        // A level that begins at a step is entered only by the step after it.
        let entered = self.levels.partition_point(|level| level.before < step);
        let level = entered.saturating_sub(1);
        let start = Cursor { step: self.levels.get(level)?.before, level };
        let kept = self.states.partition_point(|(cursor, _)| cursor.step <= step);
        let kept = self.states[..kept].last().filter(|(cursor, _)| cursor.step > start.step);
        let restored = kept.and_then(|(cursor, state)| {
            let game = match state {
                State::Copy(game) => Played::clone(game),
                State::Stored(bytes) => match self.start(cursor.level)? {
                    Played::Grid(game) => Played::Grid(Box::new(game.restored(bytes).ok()?)),
                    Played::Space(_) => return None,
                },
            };
            Some((*cursor, game))
        });
        restored.or_else(|| Some((start, self.start(level)?)))
    }
}

impl MarkKind {
    /// All kinds, the least important first.
    pub(crate) const ALL: [Self; 4] = [Self::Find, Self::Alarm, Self::LevelEnd, Self::Death];

    /// The kind in a sentence, and its character on the time line.
    pub(crate) const fn name(self) -> (&'static str, char) {
        match self {
            Self::Find => ("find", '*'),
            Self::Alarm => ("alarm", '!'),
            Self::LevelEnd => ("end of the level", '|'),
            Self::Death => ("death", 'x'),
        }
    }
}

#[cfg(test)]
mod tests;
