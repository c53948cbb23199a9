//! Results: what is kept of a run when it ends.

use super::App;
use super::levels::Stage;
use super::panels::whole_seconds;
use super::run_log::RunLog;
use super::script_cursor::ScriptCursor;
use crate::app::store::{Improved, Run};
use crate::game::{Game, Header, LevelName, Rank, Script, Tally};
use crate::map::builtin;

/// The result of a level that was won.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelResult {
    pub(crate) tally: Tally,
    pub(crate) par: Option<u32>,
    pub(crate) rank: Rank,
    pub(crate) improved: Improved,
}

impl App {
    /// Records the level that has just been won, and returns its result.
    pub(crate) fn record_result(&mut self) -> Option<LevelResult> {
        if self.is_descent() {
            self.record_floor();
        }
        if !self.is_descent() {
            self.remove_save_of_level();
        }
        let game = self.game.grid()?;
        let (tally, par) = (game.tally(), game.world().par());
        let rank = tally.rank(par);
        let improved = match self.stage.name().map(str::to_owned) {
            Some(level) => {
                let run = Run { tally, rank, script: self.run_script(game) };
                self.store.record(&level, self.difficulty, run)
            }
            None => Improved::default(),
        };
        Some(LevelResult { tally, par, rank, improved })
    }

    /// The script of the run so far, with a header that names the level. A descent is one run from its
    /// first floor on.
    pub(crate) fn run_script(&self, game: &Game) -> String {
        let level = if self.is_descent() {
            Some(LevelName::of_floor(1))
        } else {
            self.stage.name().and_then(LevelName::new)
        };
        let header =
            Header { level, difficulty: Some(self.difficulty), seed: Some(game.rules().seed) };
        format!("{header}\n{}", self.log.script())
    }

    /// One line about the game that is played: the level, the time, and what happened.
    pub(crate) fn summary(&self) -> Option<String> {
        if self.demo.is_some() || self.log.is_empty() {
            return self.left.clone();
        }
        let seconds = whole_seconds(self.game.elapsed());
        let title = self.game.title();
        let Some(game) = self.game.grid().filter(|game| game.is_mission()) else {
            return Some(format!("{title}: {seconds}"));
        };
        let Tally { treasure, alarms, .. } = game.tally();
        let alarms = match alarms {
            1 => "1 alarm".to_owned(),
            alarms => format!("{alarms} alarms"),
        };
        let gold = match treasure.total {
            0 => String::new(),
            total => format!(", {} of {total} gold", treasure.found),
        };
        Some(format!("{title} on {}: {seconds}, {alarms}{gold}", self.difficulty.name()))
    }

    /// Keeps what was done in the game that is left, and saves it to go on with later. Returns a sentence if
    /// it is not saved, which is also in the line about the game.
    pub(crate) fn leave_game(&mut self) -> Option<String> {
        self.left = self.summary();
        let saved = self.save_game();
        self.log = RunLog::default();
        let sentence = format!("The game is not saved: {}.", saved.err()?);
        self.left.iter_mut().for_each(|left| *left = format!("{left}\n{sentence}"));
        Some(sentence)
    }

    /// The best run of the level as a script, to walk along.
    pub(crate) fn best_run(&self, stage: &Stage) -> Option<ScriptCursor> {
        let text = self.store.script(stage.name()?, self.difficulty)?;
        Script::parse(&text, "the best run").ok().map(|script| ScriptCursor::new(&script))
    }

    /// The index of the first built-in level that was not won at the preferred difficulty, if any
    /// was won.
    pub(crate) fn first_not_won(&self) -> Option<usize> {
        let difficulty = self.store.preferences().difficulty;
        let won: Vec<&str> = self.store.won(difficulty).collect();
        let index = builtin::LEVELS.iter().position(|level| !won.contains(&level.name))?;
        (!won.is_empty()).then_some(index)
    }
}

/// The name of a level for the player: without the hash of a map's text.
pub(crate) fn shown_name(key: &str) -> &str {
    match key.rsplit_once('-').filter(|_| builtin_named(key).is_none()) {
        Some((name, _)) => name,
        None => key,
    }
}

pub(crate) fn builtin_named(name: &str) -> Option<usize> {
    builtin::LEVELS.iter().position(|level| level.name == name)
}
