//! Results: the records of a run, and the panels at the end of a level, after a death, and at the
//! end of the last level.

use crate::app::App;
use crate::app::page::Menu;
use crate::app::recording::{self, RunLog, Steps};
use crate::app::screen::MenuChoice;
use crate::app::status::{tenths, whole_seconds};
use crate::app::store::{Improved, Run};
use crate::game::{Game, Header, LevelName, Outcome, STEP, Script, Share, Tally};
use crate::map::builtin;

impl App {
    /// Records the result of the level that the player has just won, and returns its improvement.
    pub(crate) fn record_result(&mut self) -> Option<Improved> {
        if self.is_descent() {
            self.record_floor();
        } else {
            self.remove_save_of_level();
        }
        let game = self.game.grid()?;
        let Some(level) = self.levels.stage.name() else { return Some(Improved::default()) };
        let (level, tally) = (level.to_owned(), self.tally(game));
        let run =
            Run { tally, rank: tally.rank(game.world().par()), script: self.run_script(game) };
        Some(self.store.record(&level, self.difficulty, run))
    }

    /// The script of the run up to now, with a header that names the level. A descent counts as one
    /// run from its first floor on.
    pub(crate) fn run_script(&self, game: &Game) -> String {
        let level = if self.is_descent() {
            Some(LevelName::of_floor(1))
        } else {
            self.levels.stage.name().and_then(LevelName::new)
        };
        let header = Header {
            level,
            difficulty: Some(self.difficulty),
            seed: Some(game.rules().seed),
            taken_back: self.log.taken_back,
        };
        format!("{header}\n{}", self.log.script())
    }

    /// The player's results up to now.
    fn tally(&self, game: &Game) -> Tally {
        Tally { taken_back: self.log.taken_back, ..game.tally() }
    }

    /// A line about the current game: the level, the time, and the main counts.
    pub(crate) fn summary(&self) -> Option<String> {
        if self.demo.is_some() || self.log.is_empty() {
            return self.left.clone();
        }
        let seconds = whole_seconds(self.game.elapsed());
        let title = self.game.title();
        let Some(game) = self.game.grid().filter(|game| game.is_mission()) else {
            return Some(format!("{title}: {seconds}"));
        };
        let Tally { treasure, alarms, taken_back, .. } = self.tally(game);
        let alarms = match alarms {
            1 => "1 alarm".to_owned(),
            alarms => format!("{alarms} alarms"),
        };
        let gold = match treasure.total {
            0 => String::new(),
            total => format!(", {} of {total} gold", treasure.found),
        };
        let taken_back =
            if taken_back > 0 { format!(", {taken_back} taken back") } else { String::new() };
        let unranked = if self.is_unranked { ", unranked" } else { "" };
        let difficulty = self.difficulty.name();
        Some(format!("{title} on {difficulty}{unranked}: {seconds}, {alarms}{gold}{taken_back}"))
    }

    /// Ends the current game, stores a line about it, and saves it so that the player can continue
    /// later. If it cannot be saved, returns a sentence that says so, and adds that sentence to the
    /// line.
    pub(crate) fn leave_game(&mut self) -> Option<String> {
        self.left = self.summary();
        let saved = self.save_game();
        self.log = RunLog::default();
        let sentence = format!("The game is not saved: {}.", saved.err()?);
        self.left.iter_mut().for_each(|left| *left = format!("{left}\n{sentence}"));
        Some(sentence)
    }

    /// The best run of the level, for the ghost.
    pub(crate) fn best_run(&self) -> Option<Steps> {
        let text = self.store.script(self.levels.stage.name()?, self.difficulty)?;
        Script::parse(&text, "the best run").ok().map(|script| recording::steps(&script))
    }

    /// The index of the first built-in level that is not yet won at the preferred difficulty;
    /// `None` if the player has won none or all of them.
    pub(crate) fn first_not_won(&self) -> Option<usize> {
        let difficulty = self.store.preferences().difficulty;
        let won: Vec<&str> = self.store.won(difficulty).collect();
        let index = builtin::LEVELS.iter().position(|level| !won.contains(&level.name))?;
        (!won.is_empty()).then_some(index)
    }
}

/// The level name to show to the player: a map's key without the hash of its text.
pub(crate) fn shown_name(key: &str) -> &str {
    match key.rsplit_once('-').filter(|_| builtin_named(key).is_none()) {
        Some((name, _)) => name,
        None => key,
    }
}

pub(crate) fn builtin_named(name: &str) -> Option<usize> {
    builtin::LEVELS.iter().position(|level| level.name == name)
}

impl App {
    /// The menu with the result of the level and the ways to continue.
    pub(crate) fn level_done_menu(&self) -> Menu<MenuChoice> {
        let is_fastest = self.improved.is_some_and(|improved| improved.time);
        let fastest = if is_fastest { " (your fastest)" } else { "" };
        let game = self.game.grid();
        let result = self.improved.zip(game.map(|game| (self.tally(game), game.world().par())));
        let result = result.map(|(improved, (tally, par))| result_lines(improved, tally, par));
        let menu = Menu::new("you found the way out")
            .lines(self.level_lines())
            .line(format!("in {}{fastest}", tenths(self.game.elapsed())))
            .lines(result.into_iter().flatten())
            .entries((!self.levels.is_trial).then_some(("Go on", "", MenuChoice::NextLevel)))
            .entries((!self.is_descent()).then_some(("Play it again", "", MenuChoice::Restart)));
        self.with_leaving(menu)
    }

    /// The menu with the cause of death and the ways to continue. The first entry retries
    /// immediately.
    pub(crate) fn death_menu(&self) -> Menu<MenuChoice> {
        let cause = match self.game.grid().map(Game::outcome) {
            Some(Outcome::Dead { cause }) => format!("killed by {cause}"),
            _ => String::new(),
        };
        let noticed = self.look_back.as_ref().map(|it| it.sentence.as_str());
        let menu = Menu::new("you are dead").line(cause).lines(noticed);
        if self.is_descent() {
            return self.with_leaving(menu.lines(self.descent_lines()));
        }
        let deaths = self.game.grid().map_or(0, |game| game.tally().deaths);
        let menu = menu
            .lines((deaths > 1).then(|| format!("for the {} time", ordinal(deaths))))
            .entry("Try again", MenuChoice::Retry)
            .entries(self.take_back_entry())
            .entry("Restart the level", MenuChoice::Restart);
        self.with_leaving(menu)
    }

    pub(crate) fn end_menu(&self) -> Menu<MenuChoice> {
        let seconds = self.earlier + self.game.elapsed();
        let menu = Menu::new("the end").line("all levels").line(format!("in {}", tenths(seconds)));
        self.with_leaving(menu)
    }

    /// The level's title, followed by its number if there are several levels.
    pub(crate) fn level_lines(&self) -> impl Iterator<Item = String> {
        let number = self.levels.number;
        let number = number.is_one_of_several().then(|| number.to_string());
        [self.game.title().to_owned()].into_iter().chain(number)
    }
}

/// Formats `number` as an ordinal: 1st, 2nd, 3rd, 4th.
fn ordinal(number: u32) -> String {
    let ending = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// The lines of the result. The rank comes first, because a small window shows only the first line.
fn result_lines(
    improved: Improved,
    tally: Tally,
    par: Option<u32>,
) -> impl Iterator<Item = String> {
    let best = if improved.rank { " (your best)" } else { "" };
    let taken_back = match tally.taken_back {
        0 => String::new(),
        count => format!(" with {count} taken back"),
    };
    let lines = [format!("rank: {}{taken_back}{best}", tally.rank(par)), counts(&tally)];
    lines.into_iter().chain(par.map(|par| {
        let seconds = tally.steps as f64 * STEP;
        let compared = if seconds <= f64::from(par) { "within" } else { "over" };
        format!("{compared} the par time of {}", whole_seconds(par.into()))
    }))
}

/// The counts of finds and events. Zeros are left out unless they mean something.
fn counts(tally: &Tally) -> String {
    let shares = [("gold", tally.treasure), ("secrets", tally.secrets)];
    let shares = shares.into_iter().filter(|(_, share)| share.total > 0);
    let shares = shares.map(|(what, Share { found, total })| format!("{what}: {found} of {total}"));
    let counts = [("alarms", tally.alarms), ("stunned", tally.stunned), ("deaths", tally.deaths)];
    let counts = counts.into_iter().filter(|&(what, count)| count > 0 || what == "alarms");
    let counts = counts.map(|(what, count)| format!("{what}: {count}"));
    shares.chain(counts).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinals_have_english_endings() {
        let numbers = [1, 2, 3, 4, 11, 12, 13, 21, 102, 111, 113];
        let shown = numbers.map(ordinal).join(" ");
        assert_eq!(shown, "1st 2nd 3rd 4th 11th 12th 13th 21st 102nd 111th 113th");
    }
}
