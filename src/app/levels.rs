//! The levels of a game in order, and the transitions between them: begin, continue with the next
//! one, begin again, die, and return to the title.
//!
//! A level may change during play, because its author edits the map. The game checks for changes a
//! few times a second. Rejected: file events from the operating system. A library for them needs a
//! thread, wakes the loop, and has to follow files that editors replace.
//!
//! A descent is either endless or the daily run. It ends when the player dies. There is no way back
//! to an earlier floor, so the number of floors reached can be compared between players. The first
//! try of a daily run counts, and the game asks before it begins; later tries are practice. When a
//! player leaves a descent, it is saved, and continuing it resumes the same try. The saved game is
//! removed at that moment, so a death cannot be undone.

use std::time::Duration;
use std::{fmt, iter};

use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::app::App;
use crate::app::page::{Menu, panel, wrapped};
use crate::app::played::{Goal, Played, Watch};
use crate::app::recording::{Ghost, RunLog};
use crate::app::screen::{AppScreen, MenuChoice};
use crate::app::status::whole_seconds;
use crate::app::store::{Descent, Reached, Save};
use crate::app::title::OwnLevel;
use crate::fault::Faults;
use crate::game::{Game, Intent, Intents, LevelName, Rules, STEP};
use crate::generate::descent;
use crate::map::{Level, builtin};
use crate::space::Scene;
use crate::tui::canvas::Canvas;
use crate::world::Difficulty;

/// The current level and the levels after it, in order. Each one is created when the player reaches
/// it.
pub struct Levels {
    /// The current level before its start, kept to begin it again.
    pub(crate) stage: Stage,
    rest: Box<dyn Iterator<Item = Stage>>,
    /// The source of changes to the level.
    pub(crate) reload: Option<Reload>,
    pub(crate) number: LevelNumber,
    /// The kind of descent, which ends with the player's death; `None` for levels, which can be
    /// retried until they are won.
    pub(crate) descent: Option<Descent>,
    /// `true` for a test of a map in the editor. Leaving it leads back there, without a question.
    pub(crate) is_trial: bool,
}

/// A level before it begins. It can begin any number of times.
pub(crate) enum Stage {
    Builtin(&'static builtin::BuiltinLevel),
    Level(Level),
    Own(OwnLevel),
    Game(Box<Game>),
    Floor { seed: u64, number: u32 },
}

/// The number of a level, counted from 1, and the total number of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LevelNumber {
    number: usize,
    /// The total; `None` if it is unlimited or unknown.
    of: Option<usize>,
}

impl Levels {
    /// The levels `first` and `rest`.
    pub fn new(first: Level, rest: impl Iterator<Item = Level> + 'static) -> Self {
        let stage = |level| Stage::Level(level);
        Self::staged(stage(first), rest.map(stage))
    }

    /// The games `first` and `rest`, which have already begun.
    pub fn of_games(first: Game, rest: impl Iterator<Item = Game> + 'static) -> Self {
        let stage = |game| Stage::Game(Box::new(game));
        Self::staged(stage(first), rest.map(stage))
    }

    /// A map that belongs to the player.
    pub fn own(level: OwnLevel) -> Self {
        Self::staged(Stage::Own(level), iter::empty())
    }

    /// The built-in levels from index `index` on; `None` if there is no such level.
    pub fn builtin(index: usize) -> Option<Self> {
        let mut stages = builtin::LEVELS.get(index..)?.iter().map(Stage::Builtin);
        let first = stages.next()?;
        Some(Self::staged(first, stages).numbered(index + 1, builtin::LEVELS.len()))
    }

    /// The endless floors of the descent with this seed. The seed of a daily run is its date.
    pub(crate) fn descent(seed: u64, kind: Descent) -> Self {
        Self { descent: Some(kind), ..Self::floors(seed, 1) }
    }

    /// A game that tests a map in the editor.
    #[cfg(feature = "cli")]
    pub(crate) fn trial(game: Game) -> Self {
        Self { is_trial: true, ..Self::of_games(game, iter::empty()) }
    }

    /// One level that may change during the game. The game calls `changes` twenty times a second. If
    /// the level has changed since the last call, `changes` returns the new level or its faults.
    pub fn changing(
        level: Level,
        changes: impl FnMut() -> Option<Result<Level, Faults>> + 'static,
    ) -> Self {
        let reload = Reload { changes: Box::new(changes), next_check: INTERVAL, fault: None };
        Self { reload: Some(reload), ..Self::new(level, iter::empty()) }
    }

    /// Sets the number of the first level, counted from 1, and the total number of levels.
    #[must_use]
    pub fn numbered(self, number: usize, of: usize) -> Self {
        Self { number: LevelNumber { number, of: Some(of) }, ..self }
    }

    /// The floors of the descent with this seed from `first` on, as levels that can be retried.
    pub fn floors(seed: u64, first: u32) -> Self {
        let stage = move |number| Stage::Floor { seed, number };
        Self::staged(stage(first), (first.saturating_add(1)..).map(stage))
    }

    /// The levels in `stages`, numbered from `number`. Without stages, a single empty level.
    pub(crate) fn of_stages(
        mut stages: impl Iterator<Item = Stage> + 'static,
        number: LevelNumber,
    ) -> Self {
        match stages.next() {
            Some(first) => Self { number, ..Self::staged(first, stages) },
            None => Self::default(),
        }
    }

    /// The current level, the levels after it, and its number.
    pub(crate) fn into_parts(self) -> (Stage, Box<dyn Iterator<Item = Stage>>, LevelNumber) {
        (self.stage, self.rest, self.number)
    }

    fn staged(stage: Stage, rest: impl Iterator<Item = Stage> + 'static) -> Self {
        let number = LevelNumber { number: 1, of: None };
        Self { stage, rest: Box::new(rest), number, reload: None, descent: None, is_trial: false }
    }
}

impl Default for Levels {
    /// A single empty level.
    fn default() -> Self {
        Self::staged(Stage::Level(Level::Space(Scene::default())), iter::empty())
    }
}

impl Stage {
    /// The name under which the store keeps results of the level; `None` if it keeps none.
    pub(crate) fn name(&self) -> Option<&str> {
        match self {
            Self::Builtin(level) => Some(level.name),
            Self::Own(own) => Some(&own.key),
            Self::Level(_) | Self::Game(_) | Self::Floor { .. } => None,
        }
    }

    /// The path of the level's map file, if known.
    pub(crate) fn file(&self) -> Option<&str> {
        match self {
            Self::Own(own) => own.file.as_deref(),
            _ => None,
        }
    }

    /// The level at its start; `None` if a built-in level has faults. Tests exclude that case.
    pub(crate) fn begin(&self, difficulty: Difficulty) -> Option<Played> {
        let rules = Rules { difficulty, seed: 0 };
        Some(match self {
            Self::Builtin(level) => Played::with_rules(level.world().ok()?.into(), rules),
            Self::Level(level) | Self::Own(OwnLevel { level, .. }) => {
                Played::with_rules(level.clone(), rules)
            }
            Self::Game(game) => Played::Grid(game.clone()),
            Self::Floor { seed, number } => {
                let floor = descent(*seed, *number).ok()?;
                Played::with_rules(floor.into(), Rules { difficulty, seed: *seed })
            }
        })
    }
}

impl LevelNumber {
    /// The number of the level that comes `count` levels later.
    pub(crate) fn after(self, count: usize) -> Self {
        Self { number: self.number + count, ..self }
    }

    /// Returns true if there are several levels, as far as is known.
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

impl App {
    /// Begins the first of `levels`. If a saved game of it exists, asks first.
    pub(crate) fn begin(&mut self, levels: Levels) {
        // A recorded script covers only the level with which the program began.
        self.script = None;
        self.set_up(levels);
        self.ask_about_saved();
    }

    /// Begins the built-in level with index `index`.
    pub(crate) fn begin_builtin(&mut self, index: usize) {
        if let Some(levels) = Levels::builtin(index) {
            self.begin(levels);
        }
    }

    /// Begins the map with index `index` in the list of own maps.
    pub(crate) fn begin_own_map(&mut self, index: usize) {
        let Some(map) = self.own_maps.get(index) else { return };
        match (map.load)() {
            Ok(level) => {
                self.difficulty = self.store.preferences().difficulty;
                self.begin(Levels::own(level));
            }
            Err(fault) => {
                self.say_in_menu(&fault);
            }
        }
    }

    /// Begins the first of `levels` without asking about a saved game.
    pub(crate) fn set_up(&mut self, levels: Levels) {
        let Some(game) = levels.stage.begin(self.difficulty) else { return };
        self.levels = levels;
        self.earlier = 0.0;
        self.reached = Reached::default();
        self.demo = None;
        self.log = RunLog::default();
        self.begin_level(game);
        self.tell_whether_it_counts();
    }

    /// Begins the next level, or shows the end after the last one.
    pub(crate) fn next_level(&mut self) {
        let stage = self.levels.rest.next();
        let begun = stage.and_then(|stage| Some((stage.begin(self.difficulty)?, stage)));
        let Some((game, stage)) = begun else { return self.show(AppScreen::End) };
        self.earlier += self.game.elapsed();
        self.levels.number.number += 1;
        self.levels.stage = stage;
        if !self.is_descent() {
            self.log = RunLog::default();
        }
        self.begin_level(game);
        self.ask_about_saved();
    }

    /// Begins the level again. This ends the recording of a script, because a level begins only
    /// once in a script.
    pub(crate) fn restart_level(&mut self) {
        self.script = None;
        self.begin_again();
    }

    /// Returns to the start of the level.
    pub(crate) fn begin_again(&mut self) {
        let Some(game) = self.levels.stage.begin(self.difficulty) else { return };
        self.log = RunLog::default();
        self.begin_level(game);
    }

    /// Continues from the last checkpoint after a death.
    pub(crate) fn retry(&mut self) {
        let retry: Intents = [Intent::Retry].into_iter().collect();
        self.game.step(retry);
        self.record(retry, 1);
        self.remember();
        self.watch = Watch::begin(self.game.grid());
        self.release_keys();
        self.show(AppScreen::Playing);
    }

    /// Leaves the game and returns to the title.
    pub(crate) fn return_to_title(&mut self) {
        let not_saved = self.leave_game();
        self.show_title();
        if let Some(sentence) = not_saved {
            self.say_in_menu(&sentence);
        }
    }

    /// Shows the title over a level that plays itself.
    pub(crate) fn show_title(&mut self) {
        self.script = None;
        self.levels.reload = None;
        self.ghost = None;
        self.begin_demo();
        self.release_keys();
        self.show(AppScreen::Title);
    }

    fn begin_level(&mut self, game: Played) {
        let best_run = self.best_run().zip(game.grid());
        self.ghost = best_run.map(|(steps, game)| Ghost::new(game.clone(), steps));
        self.watch = Watch::begin(game.grid());
        self.game = game;
        self.improved = None;
        self.notice = None;
        self.goal = Goal::of(&self.game, self.settings.minimap);
        self.map.begin_level();
        self.begin_history();
        self.release_keys();
        self.show(AppScreen::Playing);
    }
}

/// The time between two checks for changes. With the time to read a map, an author sees a change
/// within a tenth of a second.
const INTERVAL: Duration = Duration::from_millis(50);

/// The source of changes to a level, and the faults that the last change introduced.
pub(crate) struct Reload {
    /// Returns the new level or its faults, if the level has changed.
    changes: Box<dyn FnMut() -> Option<Result<Level, Faults>>>,
    next_check: Duration,
    fault: Option<String>,
}

impl App {
    /// Checks for a change if it is time, and continues in the changed level.
    pub(crate) fn reload(&mut self, now: Duration) {
        let due = self.levels.reload.as_mut().filter(|reload| now >= reload.next_check);
        let Some(reload) = due else { return };
        reload.next_check = now + INTERVAL;
        match (reload.changes)() {
            None => {}
            Some(Ok(level)) => {
                reload.fault = None;
                self.game = self.game.begun_again_in(level.clone());
                self.levels.stage = Stage::Level(level);
                // The run up to now was in another level.
                self.history = None;
                self.goal = Goal::of(&self.game, self.settings.minimap);
                self.map.begin_level();
                if self.shows_result() {
                    self.show(AppScreen::Playing);
                }
                self.shown = None;
            }
            Some(Err(faults)) => {
                reload.fault = Some(faults.summary());
                self.shown = None;
            }
        }
    }

    /// The time of the next check; `None` for never.
    pub(crate) fn next_reload(&self) -> Option<Duration> {
        self.levels.reload.as_ref().map(|reload| reload.next_check)
    }

    /// Draws the level's faults, if any, over the bottom of the picture.
    pub(crate) fn draw_fault(&self, canvas: &mut impl Canvas, picture: Rect) {
        let fault = self.levels.reload.as_ref().and_then(|reload| reload.fault.as_ref());
        let Some(fault) = fault else { return };
        let lines = wrapped(fault, usize::from(picture.width.saturating_sub(4)).max(1));
        let height = (lines.len() as u16).saturating_add(2).min(picture.height);
        let area = Rect { y: picture.bottom() - height, height, ..picture };
        panel(canvas, area, "the map has faults", lines.into_iter().map(Line::from).collect());
    }
}

/// The message for a daily run that does not count.
const PRACTICE: &str = "Practice: only the day's first try counts";

impl App {
    /// The menu before the daily run. It offers to begin or continue the try that counts, or to
    /// practise once that try is over.
    pub(crate) fn daily_menu(&self) -> Menu<MenuChoice> {
        let menu = Menu::new("daily run");
        let Some(date) = self.offers.as_ref().and_then(|offers| offers.today) else { return menu };
        let date_text = date_of(date.into());
        let menu = menu.line(format!("The descent of {date_text}, the same for everyone."));
        let rules = Rules { difficulty: Difficulty::default(), seed: date.into() };
        let id = save_of_descent(Descent::Daily, rules).id();
        let menu = match self.store.daily(date) {
            None if !self.store.has_room_for(id) => self.with_removal(menu),
            None => menu
                .line("Only one try counts, and it ends when you die.")
                .line("If you leave, it is saved for later.")
                .entry("Begin the try that counts", MenuChoice::Daily),
            Some(_) if self.store.has_saved(id) => menu
                .line("The try that counts is where you left it.")
                .entry("Continue the try that counts", MenuChoice::Continue(id)),
            Some(tried) => menu
                .line(format!("The try that counts reached {}.", described(tried)))
                .entry("Practise", MenuChoice::Daily),
        };
        menu.entry("Return to the title", MenuChoice::Back)
    }

    /// Begins the daily descent, at the same difficulty for everybody.
    pub(crate) fn begin_daily(&mut self) {
        let Some(date) = self.offers.as_ref().and_then(|offers| offers.today) else { return };
        let counts = self.store.begin_daily(date);
        let kind = if counts { Descent::Daily } else { Descent::Practice };
        self.difficulty = Difficulty::default();
        self.set_up(Levels::descent(date.into(), kind));
        self.ask_about_saved();
    }

    /// Begins an endless descent with a new seed.
    pub(crate) fn begin_endless(&mut self) {
        let Some(offers) = self.offers.as_mut() else { return };
        let seed = offers.seed;
        offers.seed = seed.wrapping_add(1);
        self.difficulty = self.usual_difficulty();
        self.begin(Levels::descent(seed, Descent::Endless));
    }

    /// Sets a goal that says whether this daily run counts.
    fn tell_whether_it_counts(&mut self) {
        let (text, short) = match self.levels.descent {
            Some(Descent::Daily) => ("Daily run: this try counts", "This try counts"),
            Some(Descent::Practice) => (PRACTICE, "Practice"),
            Some(Descent::Endless) | None => return,
        };
        self.goal = Goal::new(text, short);
    }

    /// Adds the floor whose exit the player has just reached.
    pub(crate) fn count_floor(&mut self) {
        if let Some(game) = self.game.grid() {
            self.reached = self.reached.and(&game.tally());
        }
    }

    /// Returns true if the level belongs to a descent.
    pub(crate) fn is_descent(&self) -> bool {
        self.levels.descent.is_some()
    }

    /// Records a floor that the player has won.
    pub(crate) fn record_floor(&mut self) {
        let Some(game) = self.game.grid() else { return };
        let (date, script) = (u32::try_from(game.rules().seed), self.run_script(game));
        self.count_floor();
        match (self.levels.descent, date) {
            (Some(Descent::Daily), Ok(date)) => self.store.record_daily(date, self.reached, script),
            (Some(Descent::Endless), _) => self.store.record_descent(self.reached, script),
            _ => {}
        }
    }

    /// The lines about how far the descent came.
    pub(crate) fn descent_lines(&self) -> impl Iterator<Item = String> {
        let is_practice = self.levels.descent == Some(Descent::Practice);
        [described(self.reached)].into_iter().chain(is_practice.then(|| PRACTICE.to_owned()))
    }

    /// Adds the two kinds of descent to the title's menu.
    pub(crate) fn with_descents(&self, menu: Menu<MenuChoice>) -> Menu<MenuChoice> {
        let Some(offers) = &self.offers else { return menu };
        let reached = |reached: Option<Reached>| reached.map_or_else(String::new, short);
        let daily = offers.today.map(|date| {
            ("Daily run", reached(self.store.daily(date)), MenuChoice::Open(AppScreen::Daily))
        });
        menu.entries(daily).entry_with(
            "Endless",
            reached(self.store.best_descent()),
            MenuChoice::Endless,
        )
    }
}

/// The entry for a saved descent of this kind with these rules, without steps and checksum.
pub(crate) fn save_of_descent(kind: Descent, rules: Rules) -> Save {
    Save {
        level: LevelName::of_floor(1).as_str().to_owned(),
        file: None,
        rules,
        descent: Some(kind),
        steps: 0,
        checksum: 0,
    }
}

/// Formats the seed of a daily run as a date: 20261122 becomes 2026-11-22.
pub(crate) fn date_of(seed: u64) -> String {
    format!("{}-{:02}-{:02}", seed / 10_000, seed / 100 % 100, seed % 100)
}

/// The number of floors reached, for the title.
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
