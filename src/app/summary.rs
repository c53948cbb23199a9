//! The end of a level, the death of the player, and the end of the last level.

use super::menu::Menu;
use super::menus::Choice;
use super::panels::{time, whole_seconds};
use super::results::LevelResult;
use super::{App, STEP};
use crate::game::{Game, Outcome, Share, Tally};

impl App {
    /// What the player has done in the level, its rank, and how to go on.
    pub(crate) fn level_done_menu(&self) -> Menu<Choice> {
        let menu =
            self.level_lines().into_iter().fold(Menu::new("you found the way out"), Menu::line);
        let is_fastest = self.result.is_some_and(|result| result.improved.time);
        let fastest = if is_fastest { " (your fastest)" } else { "" };
        let menu = menu.line(format!("in {}{fastest}", time(self.game.elapsed())));
        let menu = match &self.result {
            Some(result) => result_lines(result).into_iter().fold(menu, Menu::line),
            None => menu,
        };
        let menu = menu.entry("Go on", Choice::NextLevel);
        let menu =
            if self.is_descent() { menu } else { menu.entry("Play it again", Choice::Restart) };
        self.with_leaving(menu)
    }

    /// What happened to the player, and how to go on. The first choice goes on at once.
    pub(crate) fn death_menu(&self) -> Menu<Choice> {
        let cause = match self.game.grid().map(Game::outcome) {
            Some(Outcome::Dead { cause }) => format!("killed by {cause}"),
            _ => String::new(),
        };
        if self.is_descent() {
            let menu = Menu::new("you are dead").line(cause);
            let menu = self.descent_lines().into_iter().fold(menu, Menu::line);
            return self.with_leaving(menu);
        }
        let deaths = self.game.grid().map_or(0, |game| game.tally().deaths);
        let menu = Menu::new("you are dead").line(cause);
        let menu =
            if deaths > 1 { menu.line(format!("for the {} time", ordinal(deaths))) } else { menu };
        let menu =
            menu.entry("Try again", Choice::Retry).entry("Restart the level", Choice::Restart);
        self.with_leaving(menu)
    }

    pub(crate) fn end_menu(&self) -> Menu<Choice> {
        let seconds = self.earlier + self.game.elapsed();
        let menu = Menu::new("the end").line("all levels").line(format!("in {}", time(seconds)));
        self.with_leaving(menu)
    }

    /// The level's title and, if there are several levels, its number.
    pub(crate) fn level_lines(&self) -> Vec<String> {
        let mut lines = vec![self.game.title().to_owned()];
        if self.level.is_one_of_several() {
            lines.push(self.level.to_string());
        }
        lines
    }
}

/// `number` as an ordinal: 1st, 2nd, 3rd, 4th.
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

/// The rank first, as it is what a small window has room for.
fn result_lines(result: &LevelResult) -> Vec<String> {
    let LevelResult { tally, par, rank, improved } = *result;
    let best = if improved.rank { " (your best)" } else { "" };
    let mut lines = vec![format!("rank: {rank}{best}"), counts(&tally)];
    if let Some(par) = par {
        let seconds = tally.steps as f64 * STEP;
        let compared = if seconds <= f64::from(par) { "within" } else { "over" };
        lines.push(format!("{compared} the par time of {}", whole_seconds(par.into())));
    }
    lines
}

/// What was found and what happened, where there was something to find or something happened.
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
    fn ordinals_have_the_endings_of_english() {
        let numbers = [1, 2, 3, 4, 11, 12, 13, 21, 102, 111, 113];
        let shown = numbers.map(ordinal).join(" ");
        assert_eq!(shown, "1st 2nd 3rd 4th 11th 12th 13th 21st 102nd 111th 113th");
    }
}
