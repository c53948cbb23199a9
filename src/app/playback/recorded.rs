//! Records that are read ahead: the states along the way, and the marks of events.
//!
//! A record is a function of what it contains, in parts: the levels of a script, or the rounds of a
//! room. It is read ahead once, by playing it. While reading, every few seconds of it the state is
//! [kept](States). Any step that was read is then reached from the last state before it.
//!
//! A game in a generated level and a flight cannot be stored: 512 copies take 40 MB. An hour of play
//! has 360 states of 3 to 4.3 MB in all. A debug build reads it in 2.2 s, and the slowest of 500
//! jumps in it takes 18 ms. In a day of play, the states are 320 seconds apart.
//!
//! Two marks of the same kind are at least a second apart, so a day has at most 432,000 of them, in
//! 7 MB.
//!
//! Rejected: copies of all games. They take 184 kB each in the largest built-in level.

use std::fmt;

use super::MAX_PLAYBACK_STEPS;
use crate::app::states::States;
use crate::game::STEPS_PER_SECOND;

/// The minimum distance between two marks of the same kind, in steps.
const MIN_DISTANCE: u64 = STEPS_PER_SECOND as u64;
/// The steps to play between two looks at the clock, and at most before keys are read.
const STEPS_PER_LOOK: u64 = 64;
const MAX_READ: u64 = 1 << 17;

/// A record that can be played again.
pub trait Record {
    /// A game between two steps.
    type Game;
    /// A game in little memory.
    type Stored;

    /// The number of steps, as far as is known before it is read.
    fn steps(&self) -> u64;

    /// The part with this index at its start; `None` if there is none.
    fn begin(&mut self, part: usize) -> Option<Self::Game>;

    /// Whether a step follows.
    fn goes_on(&self, cursor: Cursor, game: &Self::Game) -> bool;

    /// Whether the next step is in the next part.
    fn is_over(&self, part: usize, game: &Self::Game) -> bool;

    /// Advances `game`, which is at `cursor`, by a step.
    fn advance(&self, cursor: Cursor, game: &mut Self::Game);

    /// The bytes of a game in the part with this index, or a copy.
    fn store(&self, game: &Self::Game) -> Self::Stored;

    /// The game that was stored.
    fn restore(&mut self, part: usize, stored: &Self::Stored) -> Option<Self::Game>;

    /// The number of events of each kind in this part, in the order of [`MarkKind::ALL`].
    fn events(&self, game: &Self::Game) -> [u32; MarkKind::ALL.len()];
}

/// A record that is read ahead while it is shown.
pub struct Reader<R: Record> {
    pub(crate) record: R,
    /// The number of steps before each part that was reached.
    starts: Vec<u64>,
    /// The state up to which the record was read.
    cursor: Cursor,
    game: R::Game,
    /// `true` if the end was read.
    is_read: bool,
    /// The states on the way, each with the index of its part. There are none of starts.
    states: States<(usize, R::Stored)>,
    /// The marks of the part that was read, in order.
    pub(crate) marks: Vec<Mark>,
    events: [u32; MarkKind::ALL.len()],
}

/// A place in a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Cursor {
    /// The number of steps before it, counted over all parts.
    pub step: u64,
    /// The index of its part.
    pub part: usize,
}

/// An event in a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mark {
    /// The number of steps up to and including the event.
    pub(crate) step: u64,
    /// The kind of event.
    pub(crate) kind: MarkKind,
}

/// A kind of event, the least important first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MarkKind {
    /// A player found treasure, a secret or a key.
    Find,
    /// A guard began to follow a player.
    Alarm,
    /// A player was caught by another one.
    Catch,
    /// A player reached the exit, or the round ended.
    End,
    /// A player died.
    Death,
}

impl<R: Record> Reader<R> {
    /// A reader of `record`, and the first state. `None` if the first part cannot begin.
    pub fn new(mut record: R) -> Option<(Self, R::Game)> {
        let start = record.begin(0)?;
        let reader = Self {
            events: record.events(&start),
            game: record.begin(0)?,
            record,
            starts: vec![0],
            cursor: Cursor::default(),
            is_read: false,
            states: States::default(),
            marks: Vec::new(),
        };
        Some((reader, start))
    }

    /// The number of steps: as far as is known or, once the end was read, up to it.
    pub(crate) fn steps(&self) -> u64 {
        if self.is_read { self.cursor.step } else { self.record.steps().max(self.cursor.step) }
    }

    /// The number of steps that were read.
    pub fn steps_read(&self) -> u64 {
        self.cursor.step
    }

    /// Whether the record was read to its end.
    pub fn is_read(&self) -> bool {
        self.is_read
    }

    /// The steps of the marks of a kind, in order.
    pub fn marks_of(&self, kind: MarkKind) -> impl Iterator<Item = u64> {
        self.marks.iter().filter(move |mark| mark.kind == kind).map(|mark| mark.step)
    }

    /// Reads until `is_late`.
    pub fn read(&mut self, is_late: &dyn Fn() -> bool) {
        for count in 1..=MAX_READ {
            if self.is_read || count.is_multiple_of(STEPS_PER_LOOK) && is_late() {
                break;
            }
            self.is_read = self.cursor.step >= MAX_PLAYBACK_STEPS || !self.read_step();
        }
    }

    /// Reads one more step. Returns `false` at the end.
    fn read_step(&mut self) -> bool {
        let Self { record, cursor, game, .. } = self;
        if !record.goes_on(*cursor, game) {
            return false;
        }
        if record.is_over(cursor.part, game) {
            let Some(next) = record.begin(cursor.part + 1) else { return false };
            self.starts.push(cursor.step);
            cursor.part += 1;
            self.events = record.events(&next);
            *game = next;
        }
        record.advance(*cursor, game);
        cursor.step += 1;
        self.mark_events();
        let Self { record, cursor, game, states, .. } = self;
        states.keep(0, cursor.step, || Some((cursor.part, record.store(game))));
        true
    }

    fn mark_events(&mut self) {
        let now = self.record.events(&self.game);
        let before = std::mem::replace(&mut self.events, now);
        let step = self.cursor.step;
        for (kind, (before, now)) in MarkKind::ALL.into_iter().zip(before.into_iter().zip(now)) {
            let is_near = |mark: &Mark| mark.kind == kind && step < mark.step + MIN_DISTANCE;
            let mut recent = self.marks.iter().rev().take(MarkKind::ALL.len());
            if now > before && !recent.any(is_near) {
                self.marks.push(Mark { step, kind });
            }
        }
    }

    /// Advances `game`, which is at `cursor`, by a step, if that step was read.
    pub(crate) fn step(&mut self, cursor: &mut Cursor, game: &mut R::Game) {
        if cursor.step >= self.cursor.step {
            return;
        }
        if self.record.is_over(cursor.part, game)
            && let Some(next) = self.record.begin(cursor.part + 1)
        {
            cursor.part += 1;
            *game = next;
        }
        self.record.advance(*cursor, game);
        cursor.step += 1;
    }

    /// Moves `game` from `cursor` towards the state after `step` steps, or after all that were read,
    /// until `is_late`. Returns whether it is there.
    pub fn seek(
        &mut self,
        step: u64,
        (cursor, game): (&mut Cursor, &mut R::Game),
        is_late: &dyn Fn() -> bool,
    ) -> bool {
        let step = step.min(self.cursor.step);
        let nearest = self.state_before(step);
        if (cursor.step > step || cursor.step < nearest.step)
            && let Some(start) = self.restored(nearest)
        {
            (*cursor, *game) = start;
        }
        let mut count: u64 = 0;
        while cursor.step < step {
            self.step(cursor, game);
            count += 1;
            if count.is_multiple_of(STEPS_PER_LOOK) && is_late() {
                break;
            }
        }
        cursor.step >= step
    }

    /// The last known state from which the state after `step` steps can be played.
    fn state_before(&self, step: u64) -> Cursor {
        // A part that begins at a step is entered only by the step after it.
        let entered = self.starts.partition_point(|&start| start < step);
        let part = entered.saturating_sub(1);
        let start = Cursor { step: self.starts[part], part };
        let kept = self.states.before(step).next();
        let kept = kept.map(|(step, &(part, _))| Cursor { step, part });
        kept.filter(|kept| kept.step > start.step).unwrap_or(start)
    }

    /// A known state, or the start of its part if it cannot be restored.
    fn restored(&mut self, at: Cursor) -> Option<(Cursor, R::Game)> {
        let Self { record, states, starts, .. } = self;
        let start = Cursor { step: starts[at.part], ..at };
        let kept = states.before(at.step).next().filter(|_| at != start);
        let restored = kept.and_then(|(_, (part, stored))| record.restore(*part, stored));
        match restored {
            Some(game) => Some((at, game)),
            None => Some((start, record.begin(at.part)?)),
        }
    }
}

impl<R: Record> fmt::Debug for Reader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reader").field("cursor", &self.cursor).finish_non_exhaustive()
    }
}

impl MarkKind {
    /// All kinds, the least important first.
    pub const ALL: [Self; 5] = [Self::Find, Self::Alarm, Self::Catch, Self::End, Self::Death];

    /// The kind in a sentence, and its character on the time line.
    pub const fn name(self) -> (&'static str, char) {
        match self {
            Self::Find => ("find", '*'),
            Self::Alarm => ("alarm", '!'),
            Self::Catch => ("catch", '+'),
            Self::End => ("end of the level", '|'),
            Self::Death => ("death", 'x'),
        }
    }
}

#[cfg(test)]
mod tests;
