//! The game as a program: a state that keys and time change, and that draws itself.
//!
//! The state knows no terminal and no clock: keys and times are handed to it, and a [`Replay`] plays
//! it off screen. [`play`] is the loop around it that has both.

mod clock;
mod levels;
mod panels;
mod recording;
mod replay;
mod run;

use std::time::Duration;

pub use levels::Levels;
use ratatui::Frame;
use ratatui::layout::Rect;
pub use recording::Recording;
pub use replay::Replay;
pub use run::play;

use super::bindings::{Action, Bindings};
use super::held::HeldKeys;
use super::{CellAspect, FirstPerson, GlyphMode, Minimap, View};
use crate::cast::Method;
use crate::game::{Game, Intent, Intents, STEP};
use crate::palette::ColorDepth;
use crate::render::Filter;
use crate::terminal::{Key, KeyEvent, Phase};
use crate::world::{Camera, FieldOfView, World};
use clock::Clock;
use recording::ScriptRecorder;

/// How the game is shown and steered.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Which key does what.
    pub bindings: Bindings,
    /// The time between two frames, while something moves.
    pub frame_time: Duration,
    /// How wide the view is at first.
    pub field_of_view: FieldOfView,
    /// The shape of a cell; `None` for what the terminal says.
    pub cell_aspect: Option<CellAspect>,
    /// Which characters stand for pixels.
    pub glyphs: GlyphMode,
    /// How many colours there are; `None` for what the terminal has.
    pub depth: Option<ColorDepth>,
    /// How walls are found.
    pub method: Method,
    /// How textures are looked up.
    pub filter: Filter,
}

/// What shows besides the picture, and what keys do meanwhile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Screen {
    Playing,
    Paused,
    Help,
    LevelDone,
    End,
}

/// What of the game shows in a picture of it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scene {
    camera: Camera,
    revision: u64,
}

struct App {
    later_levels: Box<dyn Iterator<Item = World>>,
    game: Game,
    /// Seconds taken by the levels before this one.
    earlier: f64,
    screen: Screen,
    settings: Settings,
    depth: ColorDepth,
    cell_aspect: CellAspect,
    field_of_view: FieldOfView,
    held: HeldKeys,
    runs: bool,
    ducks: bool,
    /// What counts for the next step even if its key is up again by then.
    pressed: Intents,
    shows_minimap: bool,
    has_left: bool,
    clock: Clock,
    view: View,
    /// What the screen shows; `None` where it must be drawn again.
    shown: Option<Scene>,
    /// When, by the game's clock, something in the picture looks different by itself.
    animates_at: Option<f64>,
    next_frame: Duration,
    /// Where what is wanted is noted down.
    script: Option<ScriptRecorder>,
}

/// By how much a key widens or narrows the view, and how far, in degrees.
const VIEW_STEP: f64 = 6.0;
const NARROWEST_VIEW: f64 = 30.0;
const WIDEST_VIEW: f64 = 120.0;

impl App {
    fn new(levels: Levels, settings: Settings) -> Self {
        let Levels { first, rest } = levels;
        Self {
            later_levels: rest,
            game: Game::new(first),
            earlier: 0.0,
            screen: Screen::Playing,
            field_of_view: settings.field_of_view,
            depth: settings.depth.unwrap_or_default(),
            cell_aspect: settings.cell_aspect.unwrap_or_default(),
            view: View::with_method(settings.method.clone()),
            settings,
            held: HeldKeys::default(),
            runs: false,
            ducks: false,
            pressed: Intents::new(),
            shows_minimap: true,
            has_left: false,
            clock: Clock::default(),
            shown: None,
            animates_at: None,
            next_frame: Duration::ZERO,
            script: None,
        }
    }

    /// Lets the game go on until `now`.
    fn advance(&mut self, now: Duration) {
        self.held.expire(now);
        let steps = self.clock.steps_until(now);
        if self.screen != Screen::Playing {
            return;
        }
        let intents = self.intents();
        let quiet = self.game.quiet_steps(intents).min(steps);
        self.game.wait(quiet);
        let mut moving = 0;
        while moving < (steps - quiet).min(Clock::MOST_STEPS) && !self.game.is_finished() {
            self.game.step(intents);
            moving += 1;
        }
        self.record(intents, quiet + moving);
        if steps > 0 {
            self.pressed = Intents::new();
        }
        if self.game.is_finished() {
            self.show(Screen::LevelDone);
        }
    }

    fn intents(&self) -> Intents {
        let wanted = self.held.iter().filter_map(|key| match self.settings.bindings.action(key) {
            Some(Action::Want(intent)) => Some(intent),
            _ => None,
        });
        let aims = self.held.iter().any(|key| self.turns(key) && !self.held.is_certain(key));
        let others = [
            self.runs.then_some(Intent::Run),
            self.ducks.then_some(Intent::Duck),
            aims.then_some(Intent::Aim),
        ];
        wanted.chain(self.pressed.iter()).chain(others.into_iter().flatten()).collect()
    }

    /// Whether `key` turns the player, or their gaze. What may be a tap turns slowly: it is to aim with, and on
    /// most terminals nobody says when it ends.
    fn turns(&self, key: Key) -> bool {
        let turns = [Intent::TurnLeft, Intent::TurnRight, Intent::LookUp, Intent::LookDown];
        let turns = turns.map(|turn| Some(Action::Want(turn)));
        turns.contains(&self.settings.bindings.action(key))
    }

    /// How the player walks, as far as they need not hold a key for it.
    fn gait(&self) -> panels::Gait {
        panels::Gait { runs: self.runs, ducks: self.ducks }
    }

    fn scene(&self) -> Scene {
        Scene { camera: self.camera(), revision: self.game.revision() }
    }

    fn camera(&self) -> Camera {
        self.game.camera(self.field_of_view)
    }

    /// Whether the screen shows something that is no longer so, and may be drawn again at `now`.
    fn is_due(&self, now: Duration) -> bool {
        self.is_stale() && now >= self.next_frame
    }

    fn is_stale(&self) -> bool {
        self.shown != Some(self.scene()) || self.steps_to_animation() == Some(0)
    }

    /// In how many steps something in the picture looks different by itself; `None` for never.
    fn steps_to_animation(&self) -> Option<u64> {
        let steps = (self.animates_at? - self.game.elapsed()) / STEP;
        Some(steps.round().max(0.0) as u64)
    }

    fn drawn(&mut self, now: Duration) {
        self.shown = Some(self.scene());
        let soonest = self.game.elapsed() + STEP;
        self.animates_at = self.view.next_change().map(|change| change.max(soonest));
        // Counted from when this frame was due, or the time that drawing takes would slow them down.
        let frame_time = self.settings.frame_time;
        self.next_frame = Some(self.next_frame + frame_time)
            .filter(|&next| now < next)
            .unwrap_or(now + frame_time);
    }

    /// When something will happen without an event; `None` for never.
    fn wakes_at(&self) -> Option<Duration> {
        let frame = if self.is_stale() {
            Some(self.next_frame)
        } else {
            self.next_change().map(|change| change.max(self.next_frame))
        };
        frame.into_iter().chain(self.held.next_expiry()).min()
    }

    /// When the game will change by itself; `None` for never.
    fn next_change(&self) -> Option<Duration> {
        if self.screen != Screen::Playing {
            return None;
        }
        let quiet = Some(self.game.quiet_steps(self.intents())).filter(|&quiet| quiet < u64::MAX);
        let before_animation = self.steps_to_animation().map(|steps| steps.saturating_sub(1));
        let steps = quiet.into_iter().chain(before_animation).min()?;
        Some(self.clock.step_after(steps))
    }

    fn key(&mut self, event: KeyEvent, now: Duration) {
        self.advance(now);
        let action = self.settings.bindings.action(event.key);
        if let Some(Action::Want(_)) = action {
            let bindings = &self.settings.bindings;
            let opposes = |other| {
                action.zip(bindings.action(other)).is_some_and(|(one, other)| one.opposes(other))
            };
            self.held.note(event, now, opposes);
        }
        if event.phase != Phase::Release {
            self.press(event.key, action);
        }
    }

    fn press(&mut self, key: Key, action: Option<Action>) {
        match (self.screen, action) {
            (Screen::LevelDone, _) if is_confirmation(key) => self.next_level(),
            (Screen::End, _) if is_confirmation(key) => self.has_left = true,
            (Screen::Help, Some(Action::Leave)) if key == Key::Escape => self.show(Screen::Playing),
            (_, Some(Action::Leave)) => self.has_left = true,
            (Screen::Playing, Some(Action::ToggleHelp)) => self.show(Screen::Help),
            (Screen::Playing, Some(Action::TogglePause)) => self.show(Screen::Paused),
            (Screen::Help, Some(Action::ToggleHelp))
            | (Screen::Paused, Some(Action::TogglePause)) => self.show(Screen::Playing),
            (_, Some(Action::ToggleMinimap)) => {
                self.shows_minimap = !self.shows_minimap;
                self.shown = None;
            }
            (
                Screen::Playing,
                Some(Action::Want(tap @ (Intent::Open | Intent::Jump | Intent::LookAhead))),
            ) => self.pressed.insert(tap),
            (_, Some(Action::ToggleDuck)) => {
                self.ducks = !self.ducks;
                self.shown = None;
            }
            (_, Some(Action::ToggleRun)) => {
                self.runs = !self.runs;
                self.shown = None;
            }
            (_, Some(Action::WidenView)) => self.widen_view(VIEW_STEP),
            (_, Some(Action::NarrowView)) => self.widen_view(-VIEW_STEP),
            _ => {}
        }
    }

    fn show(&mut self, screen: Screen) {
        self.screen = screen;
        self.shown = None;
    }

    fn widen_view(&mut self, degrees: f64) {
        let view = (self.field_of_view.degrees() + degrees).clamp(NARROWEST_VIEW, WIDEST_VIEW);
        if let Some(view) = FieldOfView::from_degrees(view) {
            self.field_of_view = view;
        }
    }

    fn next_level(&mut self) {
        let Some(world) = self.later_levels.next() else { return self.show(Screen::End) };
        self.earlier += self.game.elapsed();
        self.game = Game::new(world);
        self.held.clear();
        self.show(Screen::Playing);
    }

    /// The terminal has another size, or has told more about itself.
    fn terminal_changed(&mut self, told_aspect: Option<CellAspect>, told_depth: ColorDepth) {
        self.cell_aspect = self.settings.cell_aspect.or(told_aspect).unwrap_or_default();
        self.depth = self.settings.depth.unwrap_or(told_depth);
        self.shown = None;
    }

    /// The program was stopped, and goes on: the time in between does not count.
    fn resumed(&mut self, now: Duration) {
        self.clock.skip_to(now);
        self.held.clear();
        self.shown = None;
    }

    fn draw(&mut self, frame: &mut Frame) {
        let area = frame.area();
        if panels::is_too_small(area) {
            return panels::too_small(frame);
        }
        let [picture, status] = panels::picture_and_status(area);
        self.draw_picture(frame, picture);
        panels::status(frame, status, &self.game, self.gait(), &self.settings.bindings);
        let seconds = self.game.elapsed();
        match self.screen {
            Screen::Playing => {}
            Screen::Paused => panels::paused(frame, picture, &self.settings.bindings),
            Screen::Help => panels::help(frame, picture, &self.settings.bindings),
            Screen::LevelDone => panels::level_done(frame, picture, self.game.world(), seconds),
            Screen::End => panels::end(frame, picture, self.earlier + seconds),
        }
    }

    fn draw_picture(&mut self, frame: &mut Frame, area: Rect) {
        let camera = self.camera();
        let world = self.game.world();
        let picture = FirstPerson::new(world, &camera)
            .glyphs(self.settings.glyphs)
            .color_depth(self.depth)
            .cell_aspect(self.cell_aspect)
            .filter(self.settings.filter)
            .time(self.game.elapsed());
        frame.render_stateful_widget(picture, area, &mut self.view);
        if !self.shows_minimap {
            return;
        }
        let map = Minimap::new(world, &camera)
            .seen(self.view.columns())
            .glyphs(self.settings.glyphs)
            .color_depth(self.depth);
        if let Some(panel) = panels::minimap(area, &map) {
            let inside = panels::framed(frame, panel, "map");
            frame.render_widget(map, inside);
        }
    }
}

fn is_confirmation(key: Key) -> bool {
    matches!(key, Key::Enter | Key::Char(' '))
}
