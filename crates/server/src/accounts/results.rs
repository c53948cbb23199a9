//! Results: their boards, and the runs that count. The host replays the scripts of runs.

use std::sync::Arc;

use cellcaster::app::parts::of_steps;
use cellcaster::app::store::{Best, Improved, name_in_map_key, replayed};
use cellcaster::fault::Faults;
use cellcaster::game::{Outcome, Rank, STEPS_PER_SECOND, Script, Tally};
use cellcaster::map::builtin;
use cellcaster::world::{Difficulty, World};
use thiserror::Error;
use unicode_width::UnicodeWidthStr;

use super::{AccountId, Day, Name, UnixTime};

/// The longest script that is verified, in steps: half an hour.
pub const MAX_SCRIPT_STEPS: u64 = 60 * 30 * STEPS_PER_SECOND as u64;
/// The longest script that is verified, in bytes. A player who moves the mouse in each step of half an hour writes
/// less.
pub const MAX_SCRIPT_BYTES: usize = 8 << 20;

/// A board: a built-in level or a map of the host, at one difficulty, or a daily level, at normal difficulty.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelBoard {
    level: Arc<str>,
    difficulty: Difficulty,
}

/// An entry of a level's board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelScore {
    /// The account.
    pub account: AccountId,
    /// Its name.
    pub name: Name,
    /// The tally of its fastest run.
    pub tally: Tally,
    /// The highest rank of all its runs.
    pub rank: Rank,
    /// When the fastest run was verified.
    pub verified_at: UnixTime,
}

/// Boards, each with its entries.
pub(crate) type ScoredBoards = Vec<(LevelBoard, Vec<LevelScore>)>;

/// A run that [`verify`] has replayed: a built-in level, a map of the host or a daily level that was won.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifiedRun {
    pub(crate) board: LevelBoard,
    pub(crate) tally: Tally,
    pub(crate) rank: Rank,
    pub(crate) script: String,
}

/// The reason why a script is not a run that counts.
#[derive(Debug, Error)]
pub enum Unverified {
    /// It is longer than [`MAX_SCRIPT_STEPS`] or [`MAX_SCRIPT_BYTES`].
    #[error("The run took longer than half an hour.")]
    TooLong,
    /// It is not a script.
    #[error("{0}")]
    Faulty(Faults),
    /// It names no level with a board.
    #[error("The level has no board.")]
    OtherLevel,
    /// It is a run in the daily level of another day.
    #[error("A result in the daily level counts only on its day.")]
    OtherDay,
    /// Its seed is not 0. All runs of a level have the same seed, so that they compare.
    #[error("The run has a different seed from all other runs of the level.")]
    OtherSeed,
    /// The player dies.
    #[error("The run ends with the player's death.")]
    Dead,
    /// No exit is reached.
    #[error("The run does not reach an exit.")]
    NotWon,
}

/// Replays a script in the level that its header names: a built-in level, one of the host's maps, or a daily level.
/// `world` returns the world of a map by its [key](cellcaster::app::store::map_key), or of a daily level by its
/// [name](Day::level), so no file is read. The work is at most [`MAX_SCRIPT_STEPS`] steps.
///
/// ```
/// use cellcaster_server::accounts::{Unverified, verify};
///
/// let verified = verify("level cellar\n2 s forward\n", |_| None);
/// assert!(matches!(verified, Err(Unverified::NotWon)));
/// ```
///
/// # Errors
/// The reason why the run does not count.
pub fn verify(
    script: &str,
    world: impl FnOnce(&str) -> Option<World>,
) -> Result<VerifiedRun, Unverified> {
    if script.len() > MAX_SCRIPT_BYTES {
        return Err(Unverified::TooLong);
    }
    let script = Script::parse(script, "the script").map_err(Unverified::Faulty)?;
    if script.steps() > MAX_SCRIPT_STEPS {
        return Err(Unverified::TooLong);
    }
    let rules = script.header().rules();
    let level = script.header().level.as_ref().ok_or(Unverified::OtherLevel)?;
    let board = LevelBoard::new(level.as_str(), rules.difficulty).ok_or(Unverified::OtherLevel)?;
    if rules.seed != 0 {
        return Err(Unverified::OtherSeed);
    }
    let world = match builtin::LEVELS.iter().find(|level| level.name == board.level()) {
        Some(level) => level.world().ok(),
        None => world(board.level()),
    };
    let game = replayed(world.ok_or(Unverified::OtherLevel)?, rules, &script);
    if !game.is_finished() {
        let is_dead = matches!(game.outcome(), Outcome::Dead { .. });
        return Err(if is_dead { Unverified::Dead } else { Unverified::NotWon });
    }
    let tally = game.tally();
    let rank = tally.rank(game.world().par());
    Ok(VerifiedRun { board, tally, rank, script: script.to_string() })
}

/// Like [`verify`], for a run that ended at `time`. A run in a daily level counts only on its day.
pub(crate) fn verify_at(
    script: &str,
    time: UnixTime,
    world: impl FnOnce(&str) -> Option<World>,
) -> Result<VerifiedRun, Unverified> {
    let run = verify(script, world)?;
    let counts = Day::of_level(run.board.level()).is_none_or(|day| day.counts_at(time));
    counts.then_some(run).ok_or(Unverified::OtherDay)
}

impl LevelBoard {
    /// The board of `level`: the name of a built-in level, the [key](cellcaster::app::store::map_key) of a map, or the
    /// [name](Day::level) of a daily level. `None` if it is none of them, or if it is a daily level and the
    /// difficulty is not normal.
    pub fn new(level: &str, difficulty: Difficulty) -> Option<Self> {
        let is_daily = Day::of_level(level).is_some() && difficulty == Difficulty::Normal;
        let is_level = place(level).is_some() || name_in_map_key(level).is_some() || is_daily;
        is_level.then(|| Self { level: level.into(), difficulty })
    }

    /// The name of the level, or the key of the map.
    pub fn level(&self) -> &str {
        &self.level
    }

    /// The name of the level, or the name of the map without the hash of its text.
    pub fn name(&self) -> &str {
        name_in_map_key(&self.level).unwrap_or(&self.level)
    }

    /// The difficulty.
    pub fn difficulty(&self) -> Difficulty {
        self.difficulty
    }

    /// The sort key of a list of boards: built-in levels in their order, then daily levels and maps by name; easy
    /// before hard.
    pub(crate) fn order(&self) -> (usize, Arc<str>, Option<usize>) {
        let level = place(&self.level).unwrap_or(usize::MAX);
        let difficulty = Difficulty::ALL.iter().position(|it| *it == self.difficulty);
        (level, Arc::clone(&self.level), difficulty)
    }
}

impl LevelScore {
    /// A line of a table: the place, the name, the time and the rank.
    pub(crate) fn line(&self, place: usize) -> String {
        let (name, time, rank) = (self.name.as_str(), of_steps(self.tally.steps), self.rank.name());
        // A name can take more columns than it has characters.
        let blanks = Name::MAX_COLUMNS.saturating_sub(name.width());
        format!("{place:>4}  {name}{:blanks$}  {time:<8}  {rank}\n", "")
    }
}

/// The position of a built-in level among all built-in levels.
fn place(level: &str) -> Option<usize> {
    builtin::LEVELS.iter().position(|known| known.name == level)
}

impl VerifiedRun {
    /// The board that it belongs to.
    pub fn board(&self) -> &LevelBoard {
        &self.board
    }

    /// The tally of the run.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// The rank of the run.
    pub fn rank(&self) -> Rank {
        self.rank
    }

    /// The script of the run.
    pub fn script(&self) -> &str {
        &self.script
    }
}

/// Merges a known result with a run. Also returns the improvements by the run.
pub(crate) fn with_run(known: Option<Best>, run: &VerifiedRun) -> (Best, Improved) {
    let of_run = Best { tally: run.tally(), rank: run.rank() };
    let Some(known) = known else { return (of_run, Improved { time: true, rank: true }) };
    let time = of_run.tally.steps < known.tally.steps;
    (known.and(of_run), Improved { time, rank: of_run.rank > known.rank })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WON: &str = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../maps/scripts/cellar.normal.script"
    ));

    /// The beginning of 2026-11-28.
    const MIDNIGHT: u64 = 1_795_824_000;

    #[test]
    fn a_winning_script_is_a_run() {
        let run = verify(WON, |_| None).unwrap();
        assert_eq!((run.board().level(), run.board().difficulty()), ("cellar", Difficulty::Normal));
        assert!(run.tally().steps > 0 && run.tally().steps <= MAX_SCRIPT_STEPS);
        // The stored script is a run, too, and the same one.
        assert_eq!(verify(run.script(), |_| None).unwrap(), run);
    }

    #[test]
    fn a_run_in_a_daily_level_counts_on_its_day_at_normal_difficulty() {
        let corridor = "grid = '''\n#####\n#@.>#\n#####\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                        [things]\n\"@\" = { start = 0 }\n\">\" = { exit = true }\n";
        let world = |level: &str| {
            assert_eq!(level, "daily-2026-11-28");
            cellcaster::map::parse(corridor, level, &cellcaster::map::NoFiles).ok()
        };
        let script = "level daily-2026-11-28\ndifficulty normal\nseed 0\n4 s forward\n";
        let at = |time| verify_at(script, UnixTime::new(time), world);
        assert_eq!(at(MIDNIGHT).unwrap().board().name(), "daily-2026-11-28");
        assert!(at(MIDNIGHT + 24 * 3600 + 3599).is_ok());
        for time in [MIDNIGHT - 3601, MIDNIGHT + 25 * 3600] {
            let sentence = at(time).unwrap_err().to_string();
            assert_eq!(sentence, "A result in the daily level counts only on its day.");
        }
        let hard = script.replace("normal", "hard");
        assert!(matches!(verify(&hard, world), Err(Unverified::OtherLevel)));
    }

    #[test]
    fn input_after_the_exit_does_not_count() {
        let (run, longer) = (
            verify(WON, |_| None).unwrap(),
            verify(&format!("{WON}9 s back\n"), |_| None).unwrap(),
        );
        assert_eq!((run.tally(), run.rank()), (longer.tally(), longer.rank()));
    }

    #[test]
    fn other_scripts_are_refused_with_a_sentence() {
        let shorter = WON.lines().take(6).collect::<Vec<_>>().join("\n");
        let steps = |count: u64| format!("level cellar\n{count} steps stand\n").repeat(1);
        let long = steps(MAX_SCRIPT_STEPS) + "1 step stand\n";
        for (script, expected) in [
            (shorter.as_str(), "does not reach an exit"),
            ("2 s forward\n", "has no board"),
            ("level tests/maps/way_out.toml\n2 s forward\n", "has no board"),
            ("level /dev/zero\n2 s forward\n", "has no board"),
            ("level floor 2\n2 s forward\n", "has no board"),
            ("level floor 1\n2 s forward\n", "has no board"),
            (&WON.replace("seed 0", "seed 1"), "a different seed"),
            (&long, "longer than half an hour"),
            (&"#".repeat(MAX_SCRIPT_BYTES + 1), "longer than half an hour"),
            ("level cellar\n2 s fly\n", "unknown intent"),
            ("", "no line with a duration"),
        ] {
            let sentence = verify(script, |_| None).unwrap_err().to_string();
            assert!(sentence.contains(expected), "{sentence}");
        }
    }
}
