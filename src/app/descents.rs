//! Descents: endless ones, and the one of the day.
//!
//! A descent ends when the player dies: there is no way back to a floor, so that how far somebody
//! came means the same for all. The first try of a daily run counts, and is asked about before it begins;
//! tries after its end are practice. A descent that is left is saved, and goes on from there as the same
//! try: its saved game is removed then, so that a death cannot be undone.

use super::levels::Course;
use super::menu::Menu;
use super::played::Goal;
use super::screen::Choice;
use super::time::whole_seconds;
use super::{App, Levels, Screen};
use crate::app::store::{Descent, Reached, Save};
use crate::game::{LevelName, Rules, STEP};
use crate::world::Difficulty;

/// The sentence about a daily run that does not count.
const PRACTICE: &str = "Practice: the first try of the day counts";

impl App {
    /// The question before the daily run: the try that counts begins or goes on, or is over.
    pub(crate) fn daily_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("daily run");
        let Some(date) = self.offers.as_ref().and_then(|offers| offers.today) else { return menu };
        let menu = menu.line(format!("The descent of {}, the same for all.", date_of(date.into())));
        let rules = Rules { difficulty: Difficulty::default(), seed: date.into() };
        let id = save_of_descent(Descent::Daily, rules).id();
        let menu = match self.store.daily(date) {
            None if !self.store.has_room_for(id) => self.with_removal(menu),
            None => menu
                .line("One try counts, and it ends with your death.")
                .line("If you leave, it is saved, and you can go on.")
                .entry("Begin the try that counts", Choice::Daily),
            Some(_) if self.store.has_saved(id) => menu
                .line("The try that counts is where you left it.")
                .entry("Continue the try that counts", Choice::Continue(id)),
            Some(tried) => menu
                .line(format!("The try that counts reached {}.", described(tried)))
                .entry("Practise", Choice::Daily),
        };
        menu.entry("Return to the title", Choice::Back)
    }

    /// Begins the descent of the day, at the same difficulty for everybody.
    pub(crate) fn begin_daily(&mut self) {
        let Some(date) = self.offers.as_ref().and_then(|offers| offers.today) else { return };
        let counts = self.store.begin_daily(date);
        self.difficulty = Difficulty::default();
        self.set_up(Levels::descent(date.into(), Course::Daily { date, counts }));
        self.ask_about_saved();
    }

    /// Begins a descent that nobody has seen.
    pub(crate) fn begin_endless(&mut self) {
        let Some(offers) = self.offers.as_mut() else { return };
        let seed = offers.seed;
        offers.seed = seed.wrapping_add(1);
        let usual = self.store.preferences().difficulty;
        self.difficulty = self.settings.difficulty.unwrap_or(usual);
        self.begin(Levels::descent(seed, Course::Endless));
    }

    /// Says at the start of a daily run whether the try counts.
    pub(crate) fn tell_whether_it_counts(&mut self) {
        let (text, short) = match self.course {
            Course::Daily { counts: true, .. } => ("Daily run: this try counts", "This try counts"),
            Course::Daily { counts: false, .. } => (PRACTICE, "Practice"),
            Course::Levels | Course::Endless => return,
        };
        self.goal = Goal::new(text, short);
    }

    /// The kind of the descent; `None` for levels.
    pub(crate) fn descent(&self) -> Option<Descent> {
        match self.course {
            Course::Levels => None,
            Course::Endless => Some(Descent::Endless),
            Course::Daily { counts: true, .. } => Some(Descent::Daily),
            Course::Daily { counts: false, .. } => Some(Descent::Practice),
        }
    }

    /// The descent of that kind and seed, from its first floor on. The seed of a daily run is its date.
    pub(crate) fn descent_of(kind: Descent, seed: u64) -> Option<Levels> {
        let course = match kind {
            Descent::Endless => Course::Endless,
            Descent::Daily | Descent::Practice => {
                Course::Daily { date: seed.try_into().ok()?, counts: kind == Descent::Daily }
            }
        };
        Some(Levels::descent(seed, course))
    }

    /// Counts the floor whose exit the player has just reached.
    pub(crate) fn count_floor(&mut self) {
        if let Some(game) = self.game.grid() {
            self.reached = self.reached.and(&game.tally());
        }
    }

    /// Whether the level belongs to a descent.
    pub(crate) fn is_descent(&self) -> bool {
        self.course != Course::Levels
    }

    /// Records a floor that was won.
    pub(crate) fn record_floor(&mut self) {
        let Some(game) = self.game.grid() else { return };
        let script = self.run_script(game);
        self.count_floor();
        match self.course {
            Course::Daily { date, counts: true } => {
                self.store.record_daily(date, self.reached, script);
            }
            Course::Endless => _ = self.store.record_descent(self.reached, script),
            Course::Levels | Course::Daily { counts: false, .. } => {}
        }
    }

    /// The lines about how far the descent came.
    pub(crate) fn descent_lines(&self) -> Vec<String> {
        let mut lines = vec![described(self.reached)];
        if let Course::Daily { counts: false, .. } = self.course {
            lines.push(PRACTICE.to_owned());
        }
        lines
    }

    /// Adds the descents to the title's menu.
    pub(crate) fn with_descents(&self, menu: Menu<Choice>) -> Menu<Choice> {
        let Some(offers) = &self.offers else { return menu };
        let menu = match offers.today {
            Some(date) => {
                let tried = self.store.daily(date);
                let tried = tried.map_or_else(String::new, short);
                menu.entry_with("Daily run", tried, Choice::Open(Screen::Daily))
            }
            None => menu,
        };
        let best = self.store.best_descent().map_or_else(String::new, short);
        menu.entry_with("Endless", best, Choice::Endless)
    }
}

/// The descent of that kind with these rules, as it is saved, without steps and checksum.
pub(crate) fn save_of_descent(kind: Descent, rules: Rules) -> Save {
    Save {
        level: LevelName::of_floor(1).as_str().to_owned(),
        file: None,
        rules,
        descent: Some(kind),
        steps: None,
        checksum: None,
    }
}

/// The seed of a daily run as a date: 20261122 is 2026-11-22.
pub(crate) fn date_of(seed: u64) -> String {
    format!("{}-{:02}-{:02}", seed / 10_000, seed / 100 % 100, seed % 100)
}

/// The floors that were reached, for the title.
fn short(reached: Reached) -> String {
    match reached.floors {
        1 => "1 floor".to_owned(),
        floors => format!("{floors} floors"),
    }
}

fn described(reached: Reached) -> String {
    if reached.floors == 0 {
        return short(reached);
    }
    let seconds = whole_seconds(reached.steps as f64 * STEP);
    format!("{}, {} gold in {seconds}", short(reached), reached.treasure)
}
