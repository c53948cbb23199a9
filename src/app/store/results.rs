//! Results: of a run, of the best runs, and of a script that is played again.

use crate::game::{Game, Outcome, Rank, Rules, Script, Tally};
use crate::generate::floors_below;
use crate::world::World;

/// A run that reached the exit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Its tally.
    pub tally: Tally,
    /// Its rank.
    pub rank: Rank,
    /// Its script, with a header that names the level.
    pub script: String,
}

/// The best results in a level at one difficulty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Best {
    /// The tally of the fastest run.
    pub tally: Tally,
    /// The highest rank of all runs.
    pub rank: Rank,
}

/// The improvement by a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Improved {
    /// Whether it is the fastest run.
    pub time: bool,
    /// Whether it has a higher rank than all others.
    pub rank: bool,
}

impl Improved {
    /// Whether it improved anything.
    pub fn any(self) -> bool {
        self.time || self.rank
    }
}

/// How far a descent came. More floors are better, then more treasure, then fewer steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Reached {
    /// The floors whose exit was reached.
    pub floors: u32,
    /// The treasure of these floors.
    pub treasure: u32,
    /// The steps that these floors took.
    pub steps: u64,
}

impl Reached {
    /// One floor further, with the tally of that floor.
    #[must_use]
    pub fn and(self, tally: &Tally) -> Self {
        Self {
            floors: self.floors + 1,
            treasure: self.treasure.saturating_add(tally.treasure.found),
            steps: self.steps + tally.steps,
        }
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_value = (self.floors, self.treasure).cmp(&(other.floors, other.treasure));
        by_value.then(other.steps.cmp(&self.steps))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Best {
    /// The results of one run.
    pub(crate) fn of(run: &Run) -> Self {
        Self { tally: run.tally, rank: run.rank }
    }

    /// The best of both. Of equally fast runs it is the first.
    pub fn and(self, other: Self) -> Self {
        let fastest = if other.tally.steps < self.tally.steps { other } else { self };
        Self { tally: fastest.tally, rank: self.rank.max(other.rank) }
    }
}

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
