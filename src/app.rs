//! The game as a program: screens, settings, keys to intents, and the loop.
//!
//! The state has neither a terminal nor a clock. Keys and times are arguments, so that a [`Replay`]
//! can play it off screen. [`play`] is the main loop, which has both.

mod bindings;
mod clock;
mod controls;
mod detection;
mod goal;
mod help;
mod keys;
mod levels;
mod map_panel;
mod mouse;
mod panels;
mod played;
mod recording;
mod reload;
mod replay;
mod run;
mod settings;
mod stats;
mod status;
mod steps;

use std::time::Duration;

pub use bindings::Bindings;
use goal::Goal;
use help::HelpScroll;
use levels::LevelNumber;
pub use levels::Levels;
use map_panel::MapPanel;
use ratatui::layout::Rect;
pub use recording::Recording;
pub use replay::Replay;
pub use run::play;
pub use settings::{Configuration, MapDisplay, Settings};

use crate::canvas::Canvas;
use crate::color::palette::ColorDepth;
use crate::game::STEP;
use crate::render::Filter;
use crate::tui::{CellAspect, GlyphMode, View};
use crate::world::FieldOfView;
use clock::Clock;
use controls::Controls;
use detection::Detection;
use keys::Pending;
use mouse::Pointer;
use played::{Played, Viewpoint, Views};
use recording::ScriptRecorder;
use reload::Reload;
use stats::Stats;
use status::{StatusLine, StatusValues};

/// The panel on the picture. The effect of keys depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Screen {
    Playing,
    Paused,
    Help,
    /// The question whether to leave.
    Leaving,
    LevelDone,
    End,
}

/// The part of the game's state that a picture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    viewpoint: Viewpoint,
    revision: u64,
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
struct DrawOptions {
    glyphs: GlyphMode,
    depth: ColorDepth,
    cell_aspect: CellAspect,
    filter: Filter,
    field_of_view: FieldOfView,
}

struct App {
    later_levels: Box<dyn Iterator<Item = Played>>,
    game: Played,
    level: LevelNumber,
    goal: Goal,
    /// The seconds that the earlier levels took.
    earlier: f64,
    screen: Screen,
    settings: Settings,
    depth: ColorDepth,
    cell_aspect: CellAspect,
    field_of_view: FieldOfView,
    controls: Controls,
    pointer: Pointer,
    map: MapPanel,
    help: HelpScroll,
    /// The screen to return to if the player does not leave.
    returns_to: Screen,
    /// The time of the last event, and the time since which the screen is shown.
    now: Duration,
    shown_since: Duration,
    pending: Option<Pending>,
    has_left: bool,
    clock: Clock,
    views: Views,
    /// The state that the screen shows; `None` if it must be redrawn.
    shown: Option<Shown>,
    /// The game time of the next change in the picture that the player does not cause.
    animates_at: Option<f64>,
    shows_stats: bool,
    stats: Option<Stats>,
    status: StatusLine,
    /// The known properties of the terminal.
    detection: Detection,
    /// Records the player's intents.
    script: Option<ScriptRecorder>,
    /// The source of changes of the level.
    reload: Option<Reload>,
}

impl App {
    fn new(levels: Levels, settings: Settings) -> Self {
        let Levels { first, rest, number, changes } = levels;
        Self {
            later_levels: rest,
            level: number,
            goal: Goal::of(&first, settings.minimap),
            map: MapPanel::new(settings.minimap),
            help: HelpScroll::default(),
            game: first,
            earlier: 0.0,
            screen: Screen::Playing,
            field_of_view: settings.field_of_view,
            depth: settings.depth.unwrap_or_default(),
            cell_aspect: settings.cell_aspect.unwrap_or_default(),
            views: Views::new(View::with_caster(settings.caster.clone())),
            shows_stats: settings.shows_stats,
            pointer: Pointer::new(settings.mouse),
            settings,
            controls: Controls::default(),
            returns_to: Screen::Playing,
            now: Duration::ZERO,
            shown_since: Duration::ZERO,
            pending: None,
            has_left: false,
            clock: Clock::default(),
            shown: None,
            animates_at: None,
            stats: None,
            status: StatusLine::default(),
            detection: Detection::default(),
            script: None,
            reload: changes.map(Reload::from),
        }
    }

    /// The state that a picture would show now.
    fn visible(&self) -> Shown {
        Shown { viewpoint: self.game.viewpoint(self.field_of_view), revision: self.game.revision() }
    }

    /// Whether the screen is out of date.
    fn is_stale(&self) -> bool {
        self.shown != Some(self.visible()) || self.steps_to_animation() == Some(0)
    }

    /// The number of steps until that change; `None` for never.
    fn steps_to_animation(&self) -> Option<u64> {
        let steps = (self.animates_at? - self.game.elapsed()) / STEP;
        Some(steps.round().max(0.0) as u64)
    }

    /// Records that the screen is up to date.
    fn drawn(&mut self) {
        self.shown = Some(self.visible());
        let soonest = self.game.elapsed() + STEP;
        self.animates_at = self.views.next_change().map(|change| change.max(soonest));
    }

    /// The time at which the game changes without an event; `None` for never.
    fn next_change(&self) -> Option<Duration> {
        if self.screen != Screen::Playing {
            return self.pending.map(|pending| pending.until);
        }
        if self.controls.held.has_taps() {
            return Some(self.clock.step_after(0));
        }
        let quiet = Some(self.game.quiet_steps(self.wanted())).filter(|&quiet| quiet < u64::MAX);
        let before_animation = self.steps_to_animation().map(|steps| steps.saturating_sub(1));
        let steps = quiet.into_iter().chain(before_animation).min()?;
        Some(self.clock.step_after(steps))
    }

    fn show(&mut self, screen: Screen) {
        self.screen = screen;
        self.shown_since = self.now;
        self.pending = None;
        self.shown = None;
    }

    fn next_level(&mut self) {
        let Some(level) = self.later_levels.next() else { return self.show(Screen::End) };
        self.earlier += self.game.elapsed();
        self.game = level;
        self.level = self.level.next();
        self.goal = Goal::of(&self.game, self.settings.minimap);
        self.map.begin_level();
        self.release_keys();
        self.show(Screen::Playing);
    }

    /// Handles a new size or new properties of the terminal.
    fn terminal_changed(&mut self, aspect: Option<CellAspect>, depth: ColorDepth) {
        self.cell_aspect = self.settings.cell_aspect.or(aspect).unwrap_or_default();
        self.depth = self.settings.depth.unwrap_or(depth);
        self.shown = None;
    }

    /// Continues after a suspension, whose time does not count.
    fn resumed(&mut self, now: Duration) {
        self.clock.skip_to(now);
        self.release_keys();
        self.pointer.forget();
        self.shown = None;
    }

    fn draw(&mut self, canvas: &mut impl Canvas) {
        let area = canvas.bounds();
        if panels::is_too_small(area) {
            return panels::too_small(canvas);
        }
        let [picture, status] = panels::picture_and_status(area);
        self.draw_picture(canvas, picture);
        self.status.update(&StatusValues {
            game: &self.game,
            goal: &self.goal,
            level: self.level,
            share_seen: self.game.grid().and_then(|game| self.map.share_seen(game)),
            toggles: self.controls.toggles,
            mouse: self.pointer.is_on(),
            stats: self.stats.as_ref().filter(|_| self.shows_stats),
            bindings: &self.settings.bindings,
        });
        canvas.draw_widget(&self.status, status);
        let bindings = &self.settings.bindings;
        let progress = panels::Progress { game: &self.game, level: self.level };
        match self.screen {
            Screen::Playing => {}
            Screen::Paused => panels::paused(canvas, picture, &progress, &self.goal, bindings),
            Screen::Help => self.help.draw(canvas, picture, bindings, self.detection.lines()),
            Screen::LevelDone => panels::level_done(canvas, picture, &progress),
            Screen::Leaving => panels::leaving(canvas, picture, bindings),
            Screen::End => panels::end(canvas, picture, self.earlier + self.game.elapsed()),
        }
        self.draw_fault(canvas, picture);
    }

    fn draw_picture(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let options = DrawOptions {
            glyphs: self.settings.glyphs,
            depth: self.depth,
            cell_aspect: self.cell_aspect,
            filter: self.settings.filter,
            field_of_view: self.field_of_view,
        };
        self.game.draw(&options, canvas, area, &mut self.views);
        let Some(game) = self.game.grid() else { return };
        let camera = &game.camera(self.field_of_view);
        self.map.explore(game, camera, area.width);
        if !self.map.is_shown {
            return;
        }
        let map = self.map.minimap(game, camera, &self.views.grid);
        let map = map.glyphs(self.settings.glyphs).color_depth(self.depth);
        if let Some(panel) = panels::minimap(area, &map) {
            let inside = panels::framed(canvas, panel, "map");
            map.paint(inside, canvas);
            let extent = map.extent_within(inside.as_size());
            self.map.shown(extent, game, camera);
        }
    }
}

#[cfg(test)]
mod tests;
mod wrap;
