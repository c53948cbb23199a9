//! The game as a program: pages, settings, the mapping from keys to intents, and the main loop.
//!
//! The state contains neither a terminal nor a clock. Keys and times are arguments, so a [`Replay`]
//! can run the game off screen. [`play`] is the main loop, and owns both.

mod controls;
mod detection;
mod draw;
#[cfg(feature = "cli")]
pub mod edit;
mod history;
mod levels;
mod look_back;
mod page;
mod picture;
mod playback;
mod played;
mod rebinding;
mod recording;
mod results;
mod run;
mod saved;
mod screen;
pub(crate) mod setting;
mod settings;
mod states;
pub(crate) mod status;
pub mod store;
mod taking_back;
mod text;
mod title;

/// The parts of the program that a server's sessions also use.
pub mod parts {
    pub use crate::app::controls::{Action, Clock, Controls, KeyContext, Pointer, Preset};
    pub use crate::app::detection::Detection;
    pub use crate::app::page::{
        Effect, Menu, Page, PageKind, Pages, framed, is_answerable, is_too_small, leaving, message,
        panel, picture_and_status, too_small, wrapped,
    };
    pub use crate::app::picture::{DrawOptions, MapPanel, Overlay, TerminalLook, widened};
    pub use crate::app::playback::player::{PLAYER_HELP, Perspective, Player, PlayerKey};
    pub use crate::app::playback::recorded::{Cursor, MarkKind, Reader, Record};
    pub use crate::app::played::Watch;
    pub use crate::app::setting::{Choice, Field, FieldAt, Setting, Value, reject_range};
    pub use crate::app::settings::{Choices, settings_menu};
    pub use crate::app::status::{
        HealthSigns, Meter, Part, Stats, StatusLine, hint, of_steps, tenths, whole_seconds,
    };
    pub use crate::app::title::draw_banner;
}

use std::time::Duration;

pub use controls::Bindings;
use controls::{Clock, Controls, Pointer};
use detection::Detection;
use history::History;
pub use levels::Levels;
use look_back::LookBack;
use page::Pages;
use picture::{MapPanel, Suspicion, TerminalLook};
pub use playback::MAX_PLAYBACK_STEPS;
use playback::Playback;
use played::{Goal, Played, Viewpoint, Views, Watch};
pub use recording::Recording;
use recording::{Ghost, RunLog, ScriptRecorder, Steps};
pub use run::{ClosingLines, InitialState, Replay, play};
use screen::{AppScreen, MenuChoice};
pub use setting::MapDisplay;
pub use settings::{Configuration, Origin, SettingOrigins, Settings};
use status::{Stats, StatusLine};
use store::{Improved, Reached, Store};
pub use text::play_as_text;
use title::TmuxOrder;
pub use title::{FindMaps, LoadMap, Offers, OwnLevel, OwnMap};

use crate::color::palette::ColorDepth;
use crate::tui::View;
use crate::world::{Difficulty, Figure};

/// The part of the game's state that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct PictureState {
    viewpoint: Viewpoint,
    revision: u64,
    /// The figures in view.
    figures: Vec<Figure>,
    /// The suspicion of each guard.
    suspicions: Vec<Option<Suspicion>>,
    /// The index of the moment in the look back.
    moment: Option<usize>,
}

#[derive(Default)]
struct App {
    /// The current level and the levels after it.
    levels: Levels,
    game: Played,
    /// How far the descent has come.
    reached: Reached,
    difficulty: Difficulty,
    goal: Goal,
    /// The effect of the last key, unless something else on the screen shows it.
    notice: Option<Goal>,
    /// The run since the start of the level.
    log: RunLog,
    /// Past states of the level; `None` if they are of no use.
    history: Option<History>,
    /// The last seconds before the player's death, if a guard noticed them.
    look_back: Option<LookBack>,
    /// A replay of the best run of the level.
    ghost: Option<Ghost>,
    /// The improvement from the last level won, once that result is recorded.
    improved: Option<Improved>,
    /// A line about the game that the player left.
    left: Option<String>,
    store: Store,
    watch: Watch,
    /// The time that the earlier levels took, in seconds.
    earlier: f64,
    pages: Pages<AppScreen, MenuChoice>,
    /// The entries that the title offers; `None` if there is no title to return to.
    offers: Option<Offers>,
    own_maps: Vec<OwnMap>,
    /// The rest of the script that plays the level behind the title; `None` during a game.
    demo: Option<Steps>,
    /// The recorded run that is shown; `None` during a game.
    playback: Option<Playback>,
    /// `true` after the player went on from the middle of a recorded run.
    is_unranked: bool,
    settings: Settings,
    /// The bindings without the player's own keys.
    usual_keys: Bindings,
    terminal: TerminalLook,
    controls: Controls,
    pointer: Pointer,
    map: MapPanel,
    /// The time of the last event.
    now: Duration,
    /// The machine's clock, used to notice steps that take too long; `None` to let steps take as
    /// long as they need.
    machine_time: Option<fn() -> Duration>,
    has_left: bool,
    clock: Clock,
    views: Views,
    /// The state that the screen shows; `None` if it must be redrawn.
    shown: Option<PictureState>,
    /// `true` after a key interrupted the last picture. The effect of the key is shown first.
    is_interrupted: bool,
    /// The game time of the next change in the picture that the player does not cause.
    animates_at: Option<f64>,
    stats: Option<Stats>,
    status: StatusLine,
    /// The known properties of the terminal.
    detection: Detection,
    tmux_order: TmuxOrder,
    /// Records the player's intents.
    script: Option<ScriptRecorder>,
}

impl App {
    /// A game at the start of the first of `levels`.
    fn new(levels: Levels, settings: Settings) -> Self {
        let difficulty = settings.difficulty.unwrap_or_default();
        let game = levels.stage.begin(difficulty).unwrap_or_default();
        Self {
            difficulty,
            goal: Goal::of(&game, settings.minimap),
            map: MapPanel::new(settings.minimap),
            views: Views::new(View::default()),
            pointer: Pointer::new(settings.mouse),
            usual_keys: settings.bindings.clone(),
            levels,
            game,
            settings,
            ..Self::default()
        }
    }

    /// A game that opens with the levels or the title in `opening`, and with the state in `store`.
    fn opened(opening: InitialState, settings: Settings, store: Store) -> Self {
        let mut app = Self { store, ..Self::new(Levels::default(), settings) };
        app.controls.toggles.runs_by_default = app.store.preferences().runs;
        app.settings.bindings = app.usual_keys.clone().with_own(app.store.keys());
        match opening {
            InitialState::Levels(levels) => {
                app.difficulty = app.usual_difficulty();
                app.begin(*levels);
            }
            InitialState::Playback { levels, script } => {
                app.difficulty = app.usual_difficulty();
                app.begin_playback(*levels, &script);
            }
            InitialState::Title(offers) => app.offer(offers),
            InitialState::Daily(offers) => {
                app.offer(offers);
                app.open(AppScreen::Daily);
            }
            InitialState::Endless(offers) => {
                app.offers = Some(offers);
                app.begin_endless();
            }
        }
        app
    }

    /// Shows the title with these offers.
    fn offer(&mut self, offers: Offers) {
        self.offers = Some(offers);
        self.show_title();
    }

    /// The difficulty of levels that start without a question about it.
    fn usual_difficulty(&self) -> Difficulty {
        self.settings.difficulty.unwrap_or(self.store.preferences().difficulty)
    }

    /// Handles a new size or new properties of the terminal.
    fn terminal_changed(&mut self, terminal: TerminalLook) {
        self.terminal = terminal;
        let is_chosen =
            self.settings.given.glyphs.is_some() || self.store.preferences().glyphs.is_some();
        if !is_chosen && self.settings.glyphs.has_blocks() {
            self.settings.glyphs = terminal.glyphs;
        }
        self.redraw_whole();
    }

    /// The colour depth of the picture.
    fn depth(&self) -> ColorDepth {
        self.settings.depth.unwrap_or(self.terminal.depth)
    }

    /// Continues after a suspension. The time of the suspension does not count.
    fn resumed(&mut self, now: Duration) {
        self.clock.skip_to(now);
        self.release_keys();
        self.pointer.forget();
        self.redraw_whole();
    }

    /// Makes the next frame a complete redraw.
    fn redraw_whole(&mut self) {
        self.shown = None;
        self.is_interrupted = false;
    }
}

#[cfg(test)]
mod tests;
