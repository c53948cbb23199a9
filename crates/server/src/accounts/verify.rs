//! Runs that count: the host plays their scripts again.

use std::fmt;

use super::{Day, LevelBoard};
use cellcaster::app::store::{DescentRun, Reached, replayed};
use cellcaster::fault::Faults;
use cellcaster::game::{Game, Outcome, Rank, Rules, STEPS_PER_SECOND, Script, Tally};
use cellcaster::generate::descent;
use cellcaster::map::builtin;
use cellcaster::world::{Difficulty, World};

/// The longest script that is verified, in steps: half an hour.
pub const MOST_SCRIPT_STEPS: u64 = 60 * 30 * STEPS_PER_SECOND as u64;
/// The longest script that is verified, in bytes. A player who moves the mouse in each step of half an
/// hour writes less.
pub const MOST_SCRIPT_BYTES: usize = 8 << 20;

/// A run that [`verify`] has replayed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VerifiedRun {
    /// A level that was won.
    Level(VerifiedLevel),
    /// A descent that reached an exit.
    Descent(VerifiedDescent),
}

/// A built-in level or a map of the host that was won.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedLevel {
    board: LevelBoard,
    tally: Tally,
    rank: Rank,
    script: String,
}

/// A descent from the first floor on that reached an exit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedDescent {
    rules: Rules,
    reached: Reached,
    script: String,
}

/// Why a script is no run that counts.
#[derive(Debug)]
pub enum Unverified {
    /// It is longer than [`MOST_SCRIPT_STEPS`] or [`MOST_SCRIPT_BYTES`].
    TooLong,
    /// It is no script.
    Faulty(Faults),
    /// It names no level that is known, and not the first floor of a descent.
    OtherLevel,
    /// A level is played with the seed 0, so that all runs of it compare.
    OtherSeed,
    /// The player dies.
    Dead,
    /// No exit is reached.
    NotWon,
}

/// Plays a script again in the level that its header names.
///
/// Only built-in levels and descents are played, so that no file is read. The work is that of
/// [`MOST_SCRIPT_STEPS`] steps at most.
///
/// ```
/// use cellcaster_server::accounts::{Unverified, verify};
///
/// assert!(matches!(verify("level cellar\n2 s forward\n"), Err(Unverified::NotWon)));
/// ```
///
/// # Errors
/// Why the run does not count.
pub fn verify(script: &str) -> Result<VerifiedRun, Unverified> {
    verify_with(script, |_| None)
}

/// As [`verify`], where `map` has the worlds of the host's maps by their [keys](cellcaster::app::store::map_key).
///
/// # Errors
/// Why the run does not count.
pub fn verify_with(
    script: &str,
    map: impl FnOnce(&str) -> Option<World>,
) -> Result<VerifiedRun, Unverified> {
    if script.len() > MOST_SCRIPT_BYTES {
        return Err(Unverified::TooLong);
    }
    let script = Script::parse(script, "the script").map_err(Unverified::Faulty)?;
    if script.steps() > MOST_SCRIPT_STEPS {
        return Err(Unverified::TooLong);
    }
    let rules = script.header().rules();
    let level = script.header().level.as_ref().ok_or(Unverified::OtherLevel)?;
    match level.floor() {
        Some(1) => verify_descent(rules, &script).map(VerifiedRun::Descent),
        Some(_) => Err(Unverified::OtherLevel),
        None => verify_level(level.as_str(), map, rules, &script).map(VerifiedRun::Level),
    }
}

fn verify_level(
    name: &str,
    map: impl FnOnce(&str) -> Option<World>,
    rules: Rules,
    script: &Script,
) -> Result<VerifiedLevel, Unverified> {
    let board = LevelBoard::new(name, rules.difficulty).ok_or(Unverified::OtherLevel)?;
    if rules.seed != 0 {
        return Err(Unverified::OtherSeed);
    }
    let world = match builtin::LEVELS.iter().find(|level| level.name == name) {
        Some(level) => level.world().ok(),
        None => map(name),
    };
    let world = world.ok_or(Unverified::OtherLevel)?;
    let game = replayed(world, rules, script);
    if !game.is_finished() {
        return Err(not_won(&game));
    }
    let tally = game.tally();
    let rank = tally.rank(game.world().par());
    Ok(VerifiedLevel { board, tally, rank, script: script.to_string() })
}

fn verify_descent(rules: Rules, script: &Script) -> Result<VerifiedDescent, Unverified> {
    let first = descent(rules.seed, 1).map_err(|_| Unverified::OtherLevel)?;
    let DescentRun { game, reached } = DescentRun::replayed(1, first, rules, script);
    if reached.floors == 0 {
        return Err(not_won(&game));
    }
    Ok(VerifiedDescent { rules, reached, script: script.to_string() })
}

fn not_won(game: &Game) -> Unverified {
    match game.outcome() {
        Outcome::Dead { .. } => Unverified::Dead,
        Outcome::Playing | Outcome::Won => Unverified::NotWon,
    }
}

impl VerifiedLevel {
    /// The board that it belongs to.
    pub fn board(&self) -> &LevelBoard {
        &self.board
    }

    /// What happened in it.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Its rank.
    pub fn rank(&self) -> Rank {
        self.rank
    }

    /// Its script.
    pub fn script(&self) -> &str {
        &self.script
    }
}

impl VerifiedDescent {
    /// The day whose daily run it is, if it is one: with the seed of a day, at the usual difficulty.
    pub fn day(&self) -> Option<Day> {
        let number = u32::try_from(self.rules.seed).ok()?;
        Day::from_number(number).filter(|_| self.rules.difficulty == Difficulty::default())
    }

    /// The seed of the descent.
    pub fn seed(&self) -> u64 {
        self.rules.seed
    }

    /// The difficulty.
    pub fn difficulty(&self) -> Difficulty {
        self.rules.difficulty
    }

    /// How far it came.
    pub fn reached(&self) -> Reached {
        self.reached
    }

    /// Its script.
    pub fn script(&self) -> &str {
        &self.script
    }
}

impl fmt::Display for Unverified {
    /// Writes a sentence; for a text that is no script, a report.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong => f.write_str("The run took longer than half an hour."),
            Self::Faulty(faults) => faults.fmt(f),
            Self::OtherLevel => f.write_str("The level has no board."),
            Self::OtherSeed => {
                f.write_str("The level was played with another seed than all others.")
            }
            Self::Dead => f.write_str("The run ends with the player's death."),
            Self::NotWon => f.write_str("The run reaches no exit."),
        }
    }
}

impl std::error::Error for Unverified {}

#[cfg(any(test, fuzzing))]
impl VerifiedLevel {
    /// A run that nobody has verified.
    #[doc(hidden)]
    pub fn made_up(board: LevelBoard, tally: Tally, rank: Rank, script: &str) -> Self {
        Self { board, tally, rank, script: script.to_owned() }
    }
}

#[cfg(any(test, fuzzing))]
impl VerifiedDescent {
    /// A descent that nobody has verified.
    #[doc(hidden)]
    pub fn made_up(rules: Rules, reached: Reached, script: &str) -> Self {
        Self { rules, reached, script: script.to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WON: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../maps/scripts/cellar.normal.script"
    ));

    #[test]
    fn a_script_that_wins_is_a_run() {
        let VerifiedRun::Level(run) = verify(WON).unwrap() else { panic!("not a level") };
        assert_eq!((run.board().level(), run.board().difficulty()), ("cellar", Difficulty::Normal));
        assert!(run.tally().steps > 0 && run.tally().steps <= MOST_SCRIPT_STEPS);
        // What is kept is a run, too, and the same one.
        assert_eq!(verify(run.script()).unwrap(), VerifiedRun::Level(run));
    }

    #[test]
    fn what_comes_after_the_exit_does_not_count() {
        let (run, longer) = (verify(WON).unwrap(), verify(&format!("{WON}9 s back\n")).unwrap());
        let (VerifiedRun::Level(run), VerifiedRun::Level(longer)) = (run, longer) else {
            panic!("not a level")
        };
        assert_eq!((run.tally(), run.rank()), (longer.tally(), longer.rank()));
    }

    #[test]
    fn other_scripts_are_refused_in_a_sentence() {
        let shorter = WON.lines().take(6).collect::<Vec<_>>().join("\n");
        let steps = |count: u64| format!("level cellar\n{count} steps stand\n").repeat(1);
        let long = steps(MOST_SCRIPT_STEPS) + "1 step stand\n";
        for (script, expected) in [
            (shorter.as_str(), "reaches no exit"),
            ("2 s forward\n", "has no board"),
            ("level tests/maps/way_out.toml\n2 s forward\n", "has no board"),
            ("level /dev/zero\n2 s forward\n", "has no board"),
            ("level floor 2\n2 s forward\n", "has no board"),
            ("level floor 1\n2 s forward\n", "reaches no exit"),
            (&WON.replace("seed 0", "seed 1"), "another seed"),
            (&long, "longer than half an hour"),
            (&"#".repeat(MOST_SCRIPT_BYTES + 1), "longer than half an hour"),
            ("level cellar\n2 s fly\n", "nobody can want"),
            ("", "no stretch of time"),
        ] {
            let sentence = verify(script).unwrap_err().to_string();
            assert!(sentence.contains(expected), "{sentence}");
        }
    }

    #[test]
    fn a_daily_run_has_the_seed_of_a_day_and_the_usual_difficulty() {
        let day = |seed, difficulty| {
            VerifiedDescent::made_up(Rules { difficulty, seed }, Reached::default(), "").day()
        };
        assert_eq!(day(20_261_122, Difficulty::Normal), Day::parse("2026-11-22"));
        assert_eq!(day(20_261_122, Difficulty::Easy), None);
        assert_eq!(day(20_261_322, Difficulty::Normal), None);
        assert_eq!(day(u64::MAX, Difficulty::Normal), None);
    }
}
