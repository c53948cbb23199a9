//! Playback: a recorded run, shown as its player saw it, from above, or from anywhere.
//!
//! A playback is a game whose intents come from a script, and a cursor that moves over it in both
//! directions. It uses the game's pages, keys and picture. Reading ahead, between events, finds the
//! [marks](recorded::Mark) and the states that make the cursor fast: see [`recorded`].
//!
//! - A place that has not been read yet is shown once it is. An hour is read within two seconds.
//! - The map shows the whole level, because whoever watches has not explored it.
//! - Playing on from a place ends the playback. That game is unranked: its levels have no names, so
//!   the store keeps neither results nor saved games of them.
//! - The keys of the playback take precedence over the player's bindings. In the free view, the keys
//!   that walk, turn and look fly instead.

mod free_camera;
mod recorded;
mod time_line;

use std::time::Duration;

use ratatui::layout::Rect;

use self::recorded::{Cursor, MarkKind, RecordedRun};
use self::time_line::{Bar, TimeLine};
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
use crate::world::{Camera, Difficulty, FieldOfView, Figure, SpriteId};

/// The maximum length of a run that can be shown, in steps: a day.
pub const MAX_PLAYBACK_STEPS: u64 = 24 * 60 * 60 * STEPS_PER_SECOND as u64;

/// The speeds, in quarters of the usual one.
const SPEEDS: [(&str, u64); 7] =
    [("1/4x", 1), ("1/2x", 2), ("1x", 4), ("2x", 8), ("4x", 16), ("8x", 32), ("16x", 64)];
const USUAL_SPEED: usize = 2;
/// The distances of the arrow keys, in steps.
const FIVE_SECONDS: i64 = 5 * STEPS_PER_SECOND as i64;
const MINUTE: i64 = 60 * STEPS_PER_SECOND as i64;
/// While time passes, the key to the mark before skips a mark that was passed so recently.
const JUST_PASSED: u64 = STEPS_PER_SECOND as u64;
/// The steps to read between two looks at the clock, and at most before keys are read.
const STEPS_PER_LOOK: u32 = 64;
const MAX_READ: u32 = 1 << 17;

/// A recorded run and how it is shown. The state at the cursor is the app's game.
pub(crate) struct Playback {
    run: RecordedRun,
    cursor: Cursor,
    is_paused: bool,
    /// The index in [`SPEEDS`].
    speed: usize,
    /// The quarters of a step that are left over.
    quarters: u64,
    /// The place to go to once it is read.
    wanted: Option<u64>,
    perspective: Perspective,
    /// The place of the line on the screen.
    bar: Bar,
    /// The state on the screen: the step, the camera, and the number of steps read.
    drawn: Option<(u64, Perspective, u64)>,
}

/// Where the run is seen from.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) enum Perspective {
    /// The eyes of the player.
    #[default]
    Eyes,
    /// The map.
    Above,
    /// A camera that flies.
    Free(Camera),
}

impl Perspective {
    fn name(self) -> &'static str {
        match self {
            Self::Eyes => "eyes",
            Self::Above => "above",
            Self::Free(_) => "free",
        }
    }
}

impl Playback {
    /// A playback of `script` in `levels`, and its first state.
    fn new(levels: Levels, script: &Script, difficulty: Difficulty) -> Option<(Self, Played)> {
        let (run, start) = RecordedRun::new(levels, script, difficulty)?;
        let playback = Self {
            run,
            cursor: Cursor::default(),
            is_paused: false,
            speed: USUAL_SPEED,
            quarters: 0,
            wanted: None,
            perspective: Perspective::default(),
            bar: Bar::default(),
            drawn: None,
        };
        Some((playback, start))
    }

    /// Whether the run is seen from the map.
    pub(crate) fn is_from_above(&self) -> bool {
        self.perspective == Perspective::Above
    }

    /// Whether the run is seen through the eyes of its player.
    pub(crate) fn is_through_eyes(&self) -> bool {
        self.perspective == Perspective::Eyes
    }

    /// The camera that flies; `None` in the other views.
    pub(crate) fn camera(&self, field_of_view: FieldOfView) -> Option<Camera> {
        let Perspective::Free(mut camera) = self.perspective else { return None };
        camera.field_of_view = field_of_view;
        Some(camera)
    }

    /// Whether a part of the run has not been read.
    pub(crate) fn reads_ahead(&self) -> bool {
        !self.run.is_read()
    }

    pub(crate) fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Whether the screen shows another state than this one.
    pub(crate) fn is_stale(&self) -> bool {
        self.drawn != Some(self.to_draw())
    }

    pub(crate) fn drawn(&mut self) {
        self.drawn = Some(self.to_draw());
    }

    fn to_draw(&self) -> (u64, Perspective, u64) {
        (self.cursor.step, self.perspective, self.run.steps_read())
    }

    /// Reads ahead until `is_late`.
    fn read(&mut self, is_late: &dyn Fn() -> bool) {
        for count in 1..=MAX_READ {
            if !self.run.read() || count.is_multiple_of(STEPS_PER_LOOK) && is_late() {
                break;
            }
        }
    }

    /// The place that the keys move from.
    fn place(&self) -> u64 {
        self.wanted.unwrap_or(self.cursor.step)
    }

    /// Goes to a place, as soon as it is read.
    fn go_to(&mut self, step: u64) {
        self.wanted = Some(step);
        self.quarters = 0;
    }

    fn go_by(&mut self, steps: i64) {
        self.go_to(self.place().saturating_add_signed(steps).min(self.run.steps()));
    }

    /// Moves the cursor to the wanted place if it is read, or on by the time of `steps` steps.
    /// Returns the number of steps played.
    fn play(&mut self, steps: u64, game: &mut Played) -> u64 {
        let before = self.cursor.step;
        if let Some(wanted) = self.wanted {
            if wanted > self.run.steps_read() && !self.run.is_read() {
                return 0;
            }
            self.run.seek(wanted, &mut self.cursor, game);
            self.wanted = None;
            return 0;
        }
        if self.is_paused {
            return 0;
        }
        self.quarters += steps * SPEEDS[self.speed].1;
        for _ in 0..self.quarters / 4 {
            self.run.step(&mut self.cursor, game);
        }
        self.quarters %= 4;
        self.is_paused = self.is_over();
        self.cursor.step - before
    }

    fn is_over(&self) -> bool {
        self.run.is_read() && self.place() >= self.run.steps()
    }

    /// Pauses, or goes on: from the start if the end is shown.
    fn toggle_pause(&mut self) {
        if self.is_over() {
            self.go_to(0);
            self.is_paused = false;
        } else {
            self.is_paused ^= true;
        }
    }

    /// The mark after or before the cursor.
    fn neighbour_mark(&self, is_after: bool) -> Option<(u64, MarkKind)> {
        let place = self.place();
        let grace = if self.is_paused { 0 } else { JUST_PASSED };
        let marks = self.run.marks();
        let mark = if is_after {
            marks.iter().find(|mark| mark.step > place)
        } else {
            marks.iter().rfind(|mark| mark.step + grace < place)
        };
        mark.map(|mark| (mark.step, mark.kind))
    }

    /// The text about the speed on the time line.
    fn speed_name(&self) -> &'static str {
        if self.wanted.is_some() {
            "reading"
        } else if self.is_over() {
            "end"
        } else if self.is_paused {
            "paused"
        } else {
            SPEEDS[self.speed].0
        }
    }
}

impl App {
    /// Shows the run of `script` in `levels` from its start.
    pub(crate) fn begin_playback(&mut self, levels: Levels, script: &Script) {
        let Some((playback, start)) = Playback::new(levels, script, self.difficulty) else {
            return;
        };
        self.levels.number = playback.run.number(0);
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
        playback.read(is_late);
        if !is_shown {
            return;
        }
        let level = playback.cursor.level;
        let played = playback.play(steps, game);
        if playback.cursor.level != level {
            self.levels.number = playback.run.number(playback.cursor.level);
            self.map.begin_level();
        }
        self.notice.iter_mut().for_each(|notice| notice.moved(played));
    }

    /// Moves the free camera by a step.
    fn fly(&mut self) {
        let intents = self.wanted();
        let Self { playback: Some(playback), game, .. } = self else { return };
        if let (Perspective::Free(camera), Some(game)) = (&mut playback.perspective, game.grid()) {
            *camera = free_camera::flown(*camera, game.world(), intents);
        }
        self.controls.held.step();
        self.pointer.passed(1);
    }

    /// Whether the keys that walk move the free camera.
    pub(crate) fn flies_freely(&self) -> bool {
        let is_free = |it: &Playback| matches!(it.perspective, Perspective::Free(_));
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
        match key {
            Key::Char(',') => {
                playback.is_paused = true;
                playback.go_by(-1);
            }
            Key::Char('.') => {
                playback.is_paused = true;
                playback.go_by(1);
            }
            Key::Char('<') => playback.speed = playback.speed.saturating_sub(1),
            Key::Char('>') => playback.speed = (playback.speed + 1).min(SPEEDS.len() - 1),
            Key::Left => playback.go_by(-FIVE_SECONDS),
            Key::Right => playback.go_by(FIVE_SECONDS),
            Key::Down => playback.go_by(-MINUTE),
            Key::Up => playback.go_by(MINUTE),
            Key::Home => playback.go_to(0),
            Key::End => playback.go_to(playback.run.steps()),
            Key::Char('n' | 'b') => self.go_to_mark(key == Key::Char('n')),
            Key::Char('v') if !is_repeat => self.change_perspective(),
            Key::Enter if !is_repeat => self.play_on(),
            Key::Char(' ') if !is_repeat => playback.toggle_pause(),
            _ => match action {
                Some(Action::TogglePause) if !is_repeat => playback.toggle_pause(),
                Some(action) => return !is_useful(action, flies),
                None => {}
            },
        }
        true
    }

    fn go_to_mark(&mut self, is_after: bool) {
        let Some(playback) = &mut self.playback else { return };
        if let Some((step, kind)) = playback.neighbour_mark(is_after) {
            playback.go_to(step);
            let name = capitalized(kind.name().0);
            self.notice = Some(Goal::new(&name, &name));
        }
    }

    /// Shows the next view. Bodies have no map.
    fn change_perspective(&mut self) {
        let camera = self.game.grid().map(|game| game.camera(self.settings.field_of_view));
        let (Some(camera), Some(playback)) = (camera, &mut self.playback) else { return };
        playback.perspective = match playback.perspective {
            Perspective::Eyes => Perspective::Above,
            Perspective::Above => Perspective::Free(camera),
            Perspective::Free(_) => Perspective::Eyes,
        };
        self.release_keys();
    }

    /// Handles a mouse event: a press on the time line goes to its place.
    pub(crate) fn mouse_in_playback(&mut self, event: MouseEvent) {
        let Some(playback) = &mut self.playback else { return };
        if event.kind != MouseEventKind::Pressed(MouseButton::Left) {
            return;
        }
        let [x, y] = [event.x, event.y].map(|at| (at / MouseEvent::UNITS_PER_CELL) as u16);
        if let Some(step) = playback.bar.step_at(x, y, playback.run.steps()) {
            playback.go_to(step);
            self.shown = None;
        }
    }

    /// Leaves the playback, and goes on as a game that does not count. It begins paused.
    fn play_on(&mut self) {
        let Some(playback) = self.playback.take() else { return };
        self.hide_player();
        self.levels = playback.run.into_levels(playback.cursor.level);
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
        let lines = [
            "space pauses; , . step back and forward; < > slower, faster",
            "left right 5 s; down up a minute; Home End; n b to the mark after, before",
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
        let Some(playback) = &mut self.playback else { return };
        let line = TimeLine {
            run: &playback.run,
            step: playback.place(),
            speed: playback.speed_name(),
            view: playback.perspective.name(),
        };
        playback.bar = line.draw(canvas, area, glyphs, depth);
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
