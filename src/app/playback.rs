//! Playback: a recorded run, shown as its player saw it, from above, or from anywhere.
//!
//! A playback is a [`Player`] of a script, and the game at its cursor is the app's. It uses the game's
//! pages, keys and picture.
//!
//! - An hour is read within two seconds.
//! - The map shows the whole level, because whoever watches has not explored it.
//! - Playing on from a place ends the playback. That game is unranked: its levels have no names, so
//!   the store keeps neither results nor saved games of them.
//! - The keys of the playback take precedence over the player's bindings. In the free view, the keys
//!   that walk, turn and look fly instead.

mod free_camera;
pub(crate) mod player;
pub(crate) mod recorded;
mod script;
mod time_line;

use std::time::Duration;

use ratatui::layout::Rect;

use self::player::{PLAYER_HELP, Perspective, Player, PlayerKey};
use self::script::ScriptRecord;
use crate::app::controls::{Action, Bindings, Clock};
use crate::app::page;
use crate::app::picture::{DrawOptions, MapPanel};
use crate::app::played::{Goal, Played, Watch};
use crate::app::screen::{AppScreen, capitalized};
use crate::app::setting::MapDisplay;
use crate::app::{App, Levels};
use crate::game::{Game, Intent, STEPS_PER_SECOND, Script};
use crate::terminal::{Key, MouseButton, MouseEvent, MouseEventKind};
use crate::tui::canvas::Canvas;
use crate::tui::{MapMark, Press};
use crate::world::{FieldOfView, Figure, SpriteId};

/// The maximum length of a run that can be shown, in steps: a day.
pub const MAX_PLAYBACK_STEPS: u64 = 24 * 60 * 60 * STEPS_PER_SECOND as u64;

/// A recorded run and how it is shown. The state at the cursor is the app's game.
pub(crate) type Playback = Player<ScriptRecord>;

impl App {
    /// Shows the run of `script` in `levels` from its start.
    pub(crate) fn begin_playback(&mut self, levels: Levels, script: &Script) {
        let record = ScriptRecord::new(levels, script, self.difficulty);
        let Some((playback, start)) = Player::new(record) else { return };
        self.levels.number = playback.record().number(0);
        self.playback = Some(playback);
        self.game = start;
        self.goal = Goal::default();
        self.map = MapPanel::new(MapDisplay::All);
        self.show(AppScreen::Playing);
    }

    /// Reads ahead until `is_late`, and moves the cursor and the free camera up to `now`.
    pub(crate) fn advance_playback(&mut self, now: Duration, is_late: &dyn Fn() -> bool) {
        let steps = self.clock.steps_until(now).min(Clock::MAX_STEPS);
        let is_shown = self.screen() == AppScreen::Playing;
        for _ in 0..if is_shown { steps } else { 0 } {
            self.fly();
        }
        let Self { playback: Some(playback), game, .. } = self else { return };
        let level = playback.cursor().part;
        let played = playback.advance(if is_shown { steps } else { 0 }, game, is_late);
        let now_in = playback.cursor().part;
        if now_in != level {
            self.levels.number = playback.record().number(now_in);
            self.map.begin_level();
        }
        self.notice.iter_mut().for_each(|notice| notice.moved(played));
    }

    /// Moves the free camera by a step.
    fn fly(&mut self) {
        let intents = self.wanted();
        if let Self { playback: Some(playback), game: Played::Grid(game), .. } = self {
            playback.fly(game.world(), intents);
        }
        self.controls.held.step();
        self.pointer.passed(1);
    }

    /// Whether the keys that walk move the free camera.
    pub(crate) fn flies_freely(&self) -> bool {
        let is_free = |it: &Playback| matches!(it.perspective(), Perspective::Free(_));
        self.playback.as_ref().is_some_and(is_free)
    }

    /// Handles a key during a playback. Returns `false` for a key whose effect is the same as in a
    /// game.
    pub(crate) fn press_in_playback(&mut self, key: Key, press: Press) -> bool {
        let action = self.settings.bindings.action(key);
        let flies = self.flies_freely();
        let Some(playback) = &mut self.playback else { return false };
        if flies && action.is_some_and(flies_by) {
            return true;
        }
        let is_repeat = press == Press::Repeat;
        self.shown = None;
        self.notice = None;
        match playback.press(key, is_repeat) {
            PlayerKey::Done => return true,
            PlayerKey::ToMark(kind) => {
                let name = capitalized(kind.name().0);
                self.notice = Some(Goal::new(&name, &name));
                return true;
            }
            PlayerKey::Other => {}
        }
        match key {
            Key::Char('v') if !is_repeat => self.change_perspective(),
            Key::Enter if !is_repeat => self.play_on(),
            _ => match action {
                Some(Action::TogglePause) if !is_repeat => playback.toggle_pause(),
                Some(action) => return !is_useful(action, flies),
                None => {}
            },
        }
        true
    }

    /// Shows the next view. Bodies have no map.
    fn change_perspective(&mut self) {
        let camera = self.game.grid().map(|game| game.camera(self.settings.field_of_view));
        let (Some(camera), Some(playback)) = (camera, &mut self.playback) else { return };
        playback.change_perspective(camera);
        self.release_keys();
    }

    /// Handles a mouse event: a press on the time line goes to its place.
    pub(crate) fn mouse_in_playback(&mut self, event: MouseEvent) {
        let Some(playback) = &mut self.playback else { return };
        if event.kind != MouseEventKind::Pressed(MouseButton::Left) {
            return;
        }
        let [x, y] = [event.x, event.y].map(|at| (at / MouseEvent::UNITS_PER_CELL) as u16);
        if playback.press_at(x, y) {
            self.shown = None;
        }
    }

    /// Leaves the playback, and goes on as a game that does not count. It begins paused.
    fn play_on(&mut self) {
        let Some(playback) = self.playback.take() else { return };
        self.hide_player();
        let level = playback.cursor().part;
        self.levels = playback.into_record().into_levels(level);
        self.is_unranked = true;
        self.watch = Watch::begin(self.game.grid());
        self.map = MapPanel::new(self.settings.minimap);
        self.goal = Goal::new("Unranked: this game does not count", "Unranked");
        self.release_keys();
        self.show(AppScreen::Playing);
        self.follow_outcome();
        if self.screen() == AppScreen::Playing {
            self.open(AppScreen::Paused);
        }
    }

    /// The rows of the help about the playback, and the bindings that have an effect in it.
    pub(crate) fn playback_help(&self) -> Option<(Vec<String>, Bindings)> {
        self.playback.as_ref()?;
        let [pauses, jumps] = PLAYER_HELP;
        let lines = [
            pauses,
            jumps,
            "v: the player's eyes, from above, free; Enter: play on from here, unranked",
            "marks: * find, ! alarm, x death, | end of a level",
            "in the free view, the keys that walk, turn and look fly",
        ];
        let bindings = &self.settings.bindings;
        let useful = bindings.clone().only(|action| is_useful(action, true) || flies_by(action));
        Some((lines.map(str::to_owned).to_vec(), useful))
    }
}

/// Whether an action does the same in a playback as in a game.
fn is_useful(action: Action, flies: bool) -> bool {
    match action {
        Action::Leave
        | Action::ToggleHelp
        | Action::ToggleMinimap
        | Action::ChangeMap(_)
        | Action::WidenView
        | Action::NarrowView
        | Action::ToggleStats => true,
        Action::ToggleRun => flies,
        _ => false,
    }
}

/// Whether an action moves the free camera.
fn flies_by(action: Action) -> bool {
    match action {
        Action::Want(intent) => {
            use Intent::{FineLeft, FineRight, LookAhead, Run};
            intent.walks()
                || intent.turns()
                || matches!(intent, Run | LookAhead | FineLeft | FineRight)
        }
        _ => false,
    }
}

/// Drawing.
impl App {
    /// The areas of the picture and the status line, and of the time line below them if a recorded
    /// run is shown.
    pub(crate) fn areas(&self, window: Rect) -> ([Rect; 2], Option<Rect>) {
        let rows = u16::from(self.playback.is_some());
        let area = Rect { height: window.height.saturating_sub(rows), ..window };
        let time_line = Rect { y: area.bottom(), height: rows, ..window };
        (page::picture_and_status(area), (rows > 0).then_some(time_line))
    }

    /// Draws the time line.
    pub(crate) fn draw_time_line(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let (glyphs, depth) = (self.settings.glyphs, self.depth());
        if let Some(playback) = &mut self.playback {
            playback.draw_time_line(canvas, area, glyphs, depth);
        }
    }

    /// Draws the level from above.
    pub(crate) fn draw_from_above(
        &mut self,
        canvas: &mut impl Canvas,
        area: Rect,
        options: &DrawOptions,
    ) {
        let Self { game, map, views, .. } = self;
        let Some(game) = game.grid() else { return };
        let camera = game.camera(options.field_of_view);
        let guards = game.guards().filter(|guard| !guard.is_down);
        let guards = guards.map(|it| MapMark { position: it.position, heading: it.heading });
        let marks: Vec<MapMark> = guards.collect();
        let picture = map.minimap(game, &camera, &views.grid).marks(&marks).showing_all_marks();
        let picture = picture.glyphs(options.glyphs).color_depth(options.depth);
        picture.paint(area, canvas);
        let extent = picture.extent_within(area.as_size());
        map.shown(extent, game, &camera);
    }

    /// Adds the player's figure to the world in the free view, and removes it in the others.
    pub(crate) fn show_player(&mut self) {
        if self.playback.is_none() {
            return;
        }
        if !self.flies_freely() {
            return self.hide_player();
        }
        let Some(game) = self.game.grid_mut() else { return };
        let (camera, base) = (game.camera(FieldOfView::default()), game.feet());
        let figure = |sprite: SpriteId| Figure {
            sprite,
            position: camera.position(),
            base,
            heading: camera.heading,
            frame: 0,
            opacity: u8::MAX,
        };
        game.show_guest(|sprite| Some(figure(sprite)));
    }

    fn hide_player(&mut self) {
        if let Some(game) = self.game.grid_mut().filter(|game| Game::has_guest(game)) {
            game.show_guest(|_| None);
        }
    }
}
