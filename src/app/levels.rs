//! The levels of a game, in order.

use std::{fmt, iter};

use super::OwnLevel;
use super::played::Played;
use super::reload::Changes;
use crate::fault::Faults;
use crate::game::{Game, Rules};
use crate::generate::descent;
use crate::map::{Level, builtin};
use crate::space::Scene;
use crate::world::Difficulty;

/// The levels of a game, in order. Each but the first is created when it is reached.
pub struct Levels {
    pub(crate) first: Stage,
    pub(crate) rest: Box<dyn Iterator<Item = Stage>>,
    pub(crate) changes: Option<Changes>,
    pub(crate) number: LevelNumber,
    pub(crate) course: Course,
}

/// What levels belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Course {
    /// Levels that are tried again until they are won.
    #[default]
    Levels,
    /// A descent, which ends with the player.
    Endless,
    /// The descent of a day, such as 20261122, and whether the try counts.
    Daily { date: u32, counts: bool },
}

/// A level before it begins. It can begin any number of times.
pub(crate) struct Stage {
    content: Content,
}

enum Content {
    Builtin(&'static builtin::Level),
    Level(Level),
    Own(OwnLevel),
    Game(Box<Game>),
    Floor { seed: u64, number: u32 },
}

/// The number of a level, counted from 1, and the number of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LevelNumber {
    number: usize,
    /// `None` if the number is unlimited or unknown.
    of: Option<usize>,
}

impl Levels {
    /// The levels `first` and `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        let stage = |level| Stage { content: Content::Level(level) };
        Self::staged(stage(first), rest.map(stage))
    }

    /// The games `first` and `rest`, which have already begun.
    pub fn of_games(first: Game, rest: impl Iterator<Item = Game> + 'static) -> Self {
        let stage = |game| Stage { content: Content::Game(Box::new(game)) };
        Self::staged(stage(first), rest.map(stage))
    }

    /// A map of the player's own.
    pub fn own(level: OwnLevel) -> Self {
        Self::staged(Stage { content: Content::Own(level) }, iter::empty())
    }

    /// The built-in levels from the one with that index on; `None` if there is none.
    pub fn builtin(index: usize) -> Option<Self> {
        let mut stages = builtin::LEVELS.get(index..)?.iter().map(Stage::builtin);
        let first = stages.next()?;
        Some(Self::staged(first, stages).numbered(index + 1, builtin::LEVELS.len()))
    }

    /// The floors of the descent with that seed, without an end.
    pub(crate) fn descent(seed: u64, course: Course) -> Self {
        let stage = move |number| Stage { content: Content::Floor { seed, number } };
        Self { course, ..Self::staged(stage(1), (2..).map(stage)) }
    }

    /// One level that may change during the game. `changes` is called a few times a second. If the
    /// level has changed since the last call, it returns the new level or its faults.
    pub fn changing(
        level: Level,
        changes: impl FnMut() -> Option<Result<Level, Faults>> + 'static,
    ) -> Self {
        Self { changes: Some(Box::new(changes)), ..Self::new(level, iter::empty()) }
    }

    /// Sets the number of the first level, counted from 1, and the number of levels.
    #[must_use]
    pub fn numbered(self, number: usize, of: usize) -> Self {
        Self { number: LevelNumber { number, of: Some(of) }, ..self }
    }

    /// No level.
    pub(crate) fn nothing() -> Self {
        Self::staged(Stage::nothing(), iter::empty())
    }

    fn staged(first: Stage, rest: impl Iterator<Item = Stage> + 'static) -> Self {
        Self {
            first,
            rest: Box::new(rest),
            number: LevelNumber { number: 1, of: None },
            changes: None,
            course: Course::default(),
        }
    }
}

impl Stage {
    /// A level in which there is nothing.
    pub(crate) fn nothing() -> Self {
        Self { content: Content::Level(Level::Space(Scene::default())) }
    }

    /// A built-in level.
    pub(crate) fn builtin(level: &'static builtin::Level) -> Self {
        Self { content: Content::Builtin(level) }
    }

    /// The name under which results of the level are kept, if they are.
    pub fn name(&self) -> Option<&str> {
        match &self.content {
            Content::Builtin(level) => Some(level.name),
            Content::Own(own) => Some(&own.key),
            Content::Level(_) | Content::Game(_) | Content::Floor { .. } => None,
        }
    }

    /// The path of the level's map file, if it is known.
    pub(crate) fn file(&self) -> Option<&str> {
        match &self.content {
            Content::Own(own) => own.file.as_deref(),
            _ => None,
        }
    }

    /// The level at its start; `None` if a built-in level has faults, which tests exclude.
    pub(crate) fn begin(&self, difficulty: Difficulty) -> Option<Played> {
        let rules = Rules { difficulty, seed: 0 };
        Some(match &self.content {
            Content::Builtin(level) => Played::with_rules(level.world().ok()?.into(), rules),
            Content::Level(level) | Content::Own(OwnLevel { level, .. }) => {
                Played::with_rules(level.clone(), rules)
            }
            Content::Game(game) => Played::Grid(game.clone()),
            Content::Floor { seed, number } => {
                let floor = descent(*seed, *number).ok()?;
                Played::with_rules(floor.into(), Rules { difficulty, seed: *seed })
            }
        })
    }

    /// Replaces the level by a changed one.
    pub(crate) fn change(&mut self, level: Level) {
        self.content = Content::Level(level);
    }
}

impl LevelNumber {
    /// The number of the next level.
    #[must_use]
    pub(crate) fn next(self) -> Self {
        Self { number: self.number + 1, ..self }
    }

    /// Whether there are several levels, as far as known.
    pub(crate) fn is_one_of_several(self) -> bool {
        self.number > 1 || self.of.is_some_and(|count| count > 1)
    }

    /// Writes the number as `2/5`.
    pub(crate) fn write_short(self, to: &mut impl fmt::Write) -> fmt::Result {
        match self.of {
            Some(count) => write!(to, "{}/{count}", self.number),
            None => write!(to, "{}", self.number),
        }
    }
}

impl fmt::Display for LevelNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "level {}", self.number)?;
        self.of.map_or(Ok(()), |count| write!(f, " of {count}"))
    }
}

impl fmt::Debug for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Levels").finish_non_exhaustive()
    }
}
