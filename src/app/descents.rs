//! Descents: endless ones, and the one of the day.
//!
//! A descent ends when the player dies: there is no way back to a floor, so that how far somebody
//! came means the same for all. The daily run counts once; later tries are practice. A descent that is
//! left is saved, and removed when it goes on: it goes on once, and a death cannot be undone.

use super::goal::Goal;
use super::levels::Course;
use super::menu::Menu;
use super::menus::Choice;
use super::panels::whole_seconds;
use super::{App, Levels, STEP};
use crate::store::{Descent, Reached, Slot};
use crate::world::Difficulty;

/// What is said about a daily run that does not count.
const PRACTICE: &str = "Practice: the first try of the day counts";

impl App {
    /// Begins the descent of the day, at the same difficulty for everybody.
    pub(super) fn begin_daily(&mut self) {
        let Some(date) = self.offers.as_ref().and_then(|offers| offers.today) else { return };
        let counts = self.store.begin_daily(date);
        self.difficulty = Difficulty::default();
        self.begin(Levels::descent(date.into(), Course::Daily { date, counts }));
    }

    /// Begins a descent that nobody has seen.
    pub(super) fn begin_endless(&mut self) {
        let Some(offers) = self.offers.as_mut() else { return };
        let seed = offers.seed;
        offers.seed = seed.wrapping_add(1);
        let usual = self.store.preferences().difficulty;
        self.difficulty = self.settings.difficulty.unwrap_or(usual);
        self.begin(Levels::descent(seed, Course::Endless));
    }

    /// Says at the start of a daily run whether the try counts.
    pub(super) fn tell_whether_it_counts(&mut self) {
        let (text, short) = match self.course {
            Course::Daily { counts: true, .. } => ("Daily run: this try counts", "This try counts"),
            Course::Daily { counts: false, .. } => (PRACTICE, "Practice"),
            Course::Levels | Course::Endless => return,
        };
        self.goal = Goal::new(text, short);
    }

    /// The kind of the descent; `None` for levels.
    pub(super) fn descent(&self) -> Option<Descent> {
        match self.course {
            Course::Levels => None,
            Course::Endless => Some(Descent::Endless),
            Course::Daily { counts: true, .. } => Some(Descent::Daily),
            Course::Daily { counts: false, .. } => Some(Descent::Practice),
        }
    }

    /// The descent of that kind and seed, from its first floor on. The seed of a daily run is its date.
    pub(super) fn descent_of(kind: Descent, seed: u64) -> Option<Levels> {
        let course = match kind {
            Descent::Endless => Course::Endless,
            Descent::Daily | Descent::Practice => {
                Course::Daily { date: seed.try_into().ok()?, counts: kind == Descent::Daily }
            }
        };
        Some(Levels::descent(seed, course))
    }

    /// Counts the floor of which the exit has just been reached.
    pub(super) fn count_floor(&mut self) {
        if let Some(game) = self.game.grid() {
            self.reached = self.reached.and(&game.tally());
        }
    }

    /// Whether the level belongs to a descent.
    pub(super) fn is_descent(&self) -> bool {
        self.course != Course::Levels
    }

    /// Records a floor that was won.
    pub(super) fn record_floor(&mut self) {
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
    pub(super) fn descent_lines(&self) -> Vec<String> {
        let mut lines = vec![described(self.reached)];
        if let Course::Daily { counts: false, .. } = self.course {
            lines.push(PRACTICE.to_owned());
        }
        lines
    }

    /// Adds the descents to the title's menu.
    pub(super) fn with_descents(&self, menu: Menu<Choice>) -> Menu<Choice> {
        let Some(offers) = &self.offers else { return menu };
        let menu = match self.store.saved(Slot::Descent).and_then(|saved| saved.descent) {
            Some(kind) => {
                menu.entry_with("Continue descent", name(kind), Choice::Continue(Slot::Descent))
            }
            None => menu,
        };
        let menu = match offers.today {
            Some(date) => {
                let tried = self.store.daily(date);
                let tried = tried.map_or_else(String::new, |tried| short(tried.reached));
                menu.entry_with("Daily run", tried, Choice::Daily)
            }
            None => menu,
        };
        let best = self.store.best_descent().map_or_else(String::new, short);
        menu.entry_with("Endless", best, Choice::Endless)
    }
}

/// The name of a kind of descent, for the title.
fn name(kind: Descent) -> &'static str {
    match kind {
        Descent::Endless => "endless",
        Descent::Daily => "daily run",
        Descent::Practice => "practice",
    }
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
