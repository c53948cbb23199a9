//! Drawing: the picture, the panels over it, and the check for whether they are out of date.
//!
//! - A guard who moves behind the ends of all rays in the last picture is out of view, and needs no
//!   new picture. Rejected: comparing the pixels of two pictures. It saves the bytes, but not the
//!   drawing.
//! - A picture of many bodies in a large window takes seconds. It is interrupted by an event that
//!   quits or suspends the program or resizes the window, by the key that leaves, and by any key
//!   while a panel is shown. After a key, the next frame shows the panel over the unfinished
//!   picture, and the frame after that renders the picture again. Other keys wait. If they also
//!   interrupted the picture, it would never be complete while a key repeats.

use std::fmt::Write;
use std::time::Duration;

use ratatui::layout::{Rect, Size};

use crate::app::controls::{Action, Bindings};
use crate::app::picture::{DrawOptions, Overlay, Suspicion};
use crate::app::playback::Playback;
use crate::app::playback::player::Perspective;
use crate::app::played::Viewpoint;
use crate::app::recording::Ghost;
use crate::app::screen::AppScreen;
use crate::app::status::whole_seconds;
use crate::app::status::{HealthSigns, Part, hint};
use crate::app::{App, PictureState, page, title};
use crate::game::{Game, PlayerId, STEP};
use crate::terminal::{Event, Phase};
use crate::tui::canvas::Canvas;
use crate::tui::legend;
use crate::world::{Camera, Figure};

impl App {
    /// Renders and paints the whole screen.
    pub(crate) fn draw(&mut self, canvas: &mut impl Canvas) {
        self.render(canvas.bounds().as_size(), &mut |_, _| true);
        self.paint(canvas);
    }

    /// Renders the picture for a window of this size. Rendering may stop once `go_on` returns
    /// `false`; `go_on` receives the current screen and the bindings. Returns whether the picture
    /// is complete.
    pub(crate) fn render(
        &mut self,
        window: Size,
        go_on: &mut dyn FnMut(AppScreen, &Bindings) -> bool,
    ) -> bool {
        let area = Rect::from(window);
        if page::is_too_small(area) {
            return true;
        }
        self.show_ghost();
        self.show_player();
        let ([picture, _], _) = self.areas(area);
        let (options, camera) = (self.draw_options(), self.free_camera());
        let (screen, bindings) = (self.screen(), &self.settings.bindings);
        let go_on = &mut || go_on(screen, bindings);
        self.game.render(&options, camera, picture.as_size(), &mut self.views, go_on)
    }

    /// Paints the rendered picture and everything over it on a canvas of the same size.
    pub(crate) fn paint(&mut self, canvas: &mut impl Canvas) {
        let area = canvas.bounds();
        if page::is_too_small(area) {
            return page::too_small(canvas);
        }
        let ([picture, status], time_line) = self.areas(area);
        self.paint_picture(canvas, picture);
        if let Some(time_line) = time_line {
            self.draw_time_line(canvas, time_line);
        }
        if self.demo.is_some() {
            canvas.draw_widget(hint("up and down, Enter, Esc"), status);
        } else if self.shows_result() {
            canvas.draw_widget(hint("up and down, Enter"), status);
        } else {
            self.draw_status(canvas, status);
        }
        self.draw_panel(canvas, picture);
        self.draw_fault(canvas, picture);
    }

    fn draw_panel(&mut self, canvas: &mut impl Canvas, picture: Rect) {
        let bindings = &self.settings.bindings;
        match self.screen() {
            AppScreen::Playing => {}
            AppScreen::Help => {
                let (further, bindings) =
                    self.playback_help().unwrap_or_else(|| (Vec::new(), bindings.clone()));
                let keys = (&further[..], &bindings);
                let legend = legend(self.settings.glyphs, self.depth());
                let notes = self.detection.lines().chain(legend.into_iter().map(str::to_owned));
                self.pages.help.draw(canvas, picture, keys, notes);
            }
            AppScreen::Leaving => {
                page::leaving(canvas, picture, bindings, self.effect_of_leaving());
            }
            AppScreen::Title => {
                let below = title::draw_banner(canvas, picture, self.settings.glyphs, self.depth());
                self.pages.menu.draw(canvas, below);
            }
            AppScreen::Dead => {
                let beside = self.draw_look_back(canvas, picture, &self.draw_options());
                self.pages.menu.draw(canvas, beside);
            }
            _ => self.pages.menu.draw(canvas, picture),
        }
    }

    fn draw_status(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let signs = HealthSigns::for_picture(self.settings.glyphs, self.depth());
        let take_back = self.useful_take_back_key();
        let Self { game, goal, notice, levels, map, controls, pointer, settings, .. } = self;
        let (grid, level) = (game.grid(), levels.number);
        let player = grid.and_then(|game| game.seen_by(PlayerId::FIRST));
        let mission = grid.filter(|game| game.is_mission()).zip(player);
        let notice = notice.as_ref().filter(|notice| notice.is_shown());
        let stats = self.stats.as_ref().filter(|_| settings.shows_stats);
        let is_unranked = self.is_unranked;
        self.status.rewrite(|line| {
            if let Some((game, player)) = &mission {
                line.write_vitals(game, player, signs)?;
            }
            let unranked = if is_unranked { "unranked: " } else { "" };
            line.both(Part::Title, format_args!("{unranked}{}", game.title()))?;
            if level.is_one_of_several() {
                let [short, long] = line.forms(Part::Level);
                level.write_short(short)?;
                write!(long, "{level}")?;
            }
            if let Some(site) = grid.and_then(Game::site) {
                line.both(Part::Site, format_args!("{}, {}", site.column, site.row))?;
            }
            let lamp = mission.is_some_and(|(_, player)| player.lamp_is_lit());
            line.write_modes(controls.toggles, pointer.is_on(), lamp)?;
            line.write_keys(grid.into_iter().flat_map(Game::keys))?;
            if let Some(key) = take_back {
                line.both(Part::TakeBack, format_args!("{key}: 10 s back"))?;
            }
            if let (None, Some(message)) = (notice, grid.and_then(Game::message)) {
                line.both(Part::Notice, format_args!("{message}"))?;
            } else if let Some(goal) = notice.or(Some(goal)).filter(|goal| goal.is_shown()) {
                let [short, long] = line.forms(Part::Notice);
                short.push_str(&goal.short);
                long.push_str(&goal.text);
            }
            if let Some(stats) = stats {
                line.write_stats(stats)?;
            }
            if let Some(share) = grid.and_then(|game| map.share_seen(game)) {
                line.both(Part::Seen, format_args!("{:.0} % seen", (share * 100.0).floor()))?;
            }
            line.both(Part::Time, format_args!("{}", whole_seconds(game.elapsed())))?;
            line.write_help(&settings.bindings)
        });
        canvas.draw_widget(&self.status, area);
    }

    fn paint_picture(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let options = self.draw_options();
        if self.playback.as_ref().is_some_and(|it| it.perspective() == Perspective::Above) {
            return self.draw_from_above(canvas, area, &options);
        }
        let camera = self.free_camera();
        self.game.paint(&options, camera, canvas, area, &self.views);
        if self.demo.is_some() || camera.is_some() {
            return;
        }
        let looks_back = self.looks_back_in(area);
        let preferences = self.store.preferences();
        let game = self.game.grid();
        let overlay =
            game.and_then(|game| Overlay::new(game, PlayerId::FIRST, &options, preferences));
        let Some(overlay) = overlay else { return options.draw_middle(canvas, area) };
        let ghost = self.ghost.as_ref().filter(|_| preferences.ghost).and_then(Ghost::on_map);
        let map = if looks_back {
            None
        } else {
            overlay.draw_map(canvas, area, &mut self.map, &self.views.grid, ghost)
        };
        overlay.draw_hud(canvas, area, map, self.screen() == AppScreen::Playing);
    }

    fn draw_options(&self) -> DrawOptions {
        let sees = self.playback.as_ref().is_none_or(|it| it.perspective() == Perspective::Eyes);
        let is_game = self.demo.is_none() && sees;
        let heading = |game: &Game| game.camera(self.settings.field_of_view).heading;
        let flash = self.game.grid().and_then(|game| Some((game.flash()?, heading(game))));
        DrawOptions {
            glyphs: self.settings.glyphs,
            depth: self.depth(),
            shade_ink: self.terminal.shade_ink,
            cell_aspect: self.settings.cell_aspect.or(self.terminal.aspect).unwrap_or_default(),
            filter: self.settings.filter,
            correction: self.store.preferences().correction,
            field_of_view: self.settings.field_of_view,
            flash: flash.filter(|_| is_game),
            marks_middle: is_game && self.store.preferences().crosshair,
        }
    }

    /// The camera that flies through a recorded run, if it is seen from there.
    fn free_camera(&self) -> Option<Camera> {
        self.playback.as_ref()?.camera(self.settings.field_of_view)
    }

    /// Adds the ghost to the game's world, or removes it if it is switched off.
    fn show_ghost(&mut self) {
        let is_on = self.store.preferences().ghost;
        let Some(ghost) = self.ghost.as_ref() else { return };
        if let Some(game) = self.game.grid_mut() {
            game.show_guest(|sprite| ghost.figure(sprite).filter(|_| is_on));
        }
    }
}

impl App {
    /// Returns true if the screen is out of date.
    pub(crate) fn is_stale(&self) -> bool {
        let Some(shown) = &self.shown else { return true };
        if let Some(playback) = &self.playback {
            return playback.is_stale();
        }
        (shown.viewpoint, shown.revision) != self.surroundings()
            || !self.figures_in_view().eq(&shown.figures)
            || !self.suspicions().eq(shown.suspicions.iter().copied())
            || self.moment_shown() != shown.moment
            || self.steps_to_animation() == Some(0)
    }

    /// The viewpoint, and a number that grows with every visible change apart from the figures.
    fn surroundings(&self) -> (Viewpoint, u64) {
        let ghost = self.ghost.as_ref().map_or(0, Ghost::steps);
        (self.game.viewpoint(self.settings.field_of_view), self.game.revision() + ghost)
    }

    /// The figures that the last picture and its map would show if they were drawn now with the
    /// same surroundings. The result may contain figures that are hidden.
    fn figures_in_view(&self) -> impl Iterator<Item = &Figure> {
        let figures = self.game.grid().into_iter().flat_map(|game| {
            let camera = game.camera(self.settings.field_of_view);
            game.figures().map(move |figure| (game.world(), camera, figure))
        });
        let in_view = figures
            .filter(|(world, camera, figure)| self.views.grid.may_show(world, camera, figure));
        in_view.map(|(.., figure)| figure)
    }

    /// The suspicion of each guard, in view or not.
    fn suspicions(&self) -> impl Iterator<Item = Option<Suspicion>> {
        let guards = self.game.grid().into_iter().flat_map(Game::guards);
        guards.map(|guard| Suspicion::of(&guard))
    }

    /// The number of steps until the next animation; `None` for never.
    fn steps_to_animation(&self) -> Option<u64> {
        let steps = (self.animates_at? - self.game.elapsed()) / STEP;
        Some(steps.round().max(0.0) as u64)
    }

    /// Records that the screen is up to date.
    pub(crate) fn drawn(&mut self) {
        let (viewpoint, revision) = self.surroundings();
        let figures = self.figures_in_view().copied().collect();
        let suspicions = self.suspicions().collect();
        let moment = self.moment_shown();
        self.shown = Some(PictureState { viewpoint, revision, figures, suspicions, moment });
        self.playback.iter_mut().for_each(Playback::drawn);
        let soonest = self.game.elapsed() + STEP;
        self.animates_at = self.views.grid.next_change().map(|change| change.max(soonest));
    }

    /// The time at which the game changes without an event; `None` for never.
    pub(crate) fn next_change(&self) -> Option<Duration> {
        if self.demo.is_some() {
            return Some(self.clock.step_after(0));
        }
        if self.screen() != AppScreen::Playing {
            return self.pages.pending_until().into_iter().chain(self.next_moment()).min();
        }
        if self.controls.held.has_taps() {
            return Some(self.clock.step_after(0));
        }
        if let Some(playback) = &self.playback {
            let flies =
                self.flies_freely() && (!self.wanted().is_empty() || self.pointer.is_busy());
            return (flies || !playback.is_paused()).then(|| self.clock.step_after(0));
        }
        if !self.is_at_rest(self.wanted()) {
            return Some(self.clock.step_after(0));
        }
        let steps = self.steps_to_animation()?;
        Some(self.clock.step_after(steps.saturating_sub(1)))
    }

    /// Returns true if the player wants nothing and the next step changes only what others do.
    pub(crate) fn waits_for_others(&self) -> bool {
        let wanted = self.wanted();
        self.screen() == AppScreen::Playing
            && self.demo.is_none()
            && self.playback.is_none()
            && wanted.is_empty()
            && !self.controls.held.has_taps()
            && !self.is_at_rest(wanted)
    }
}

/// A function that returns true if an event that matches its argument has arrived.
type HasArrived<'a> = dyn FnMut(&dyn Fn(&Event) -> bool) -> bool + 'a;

/// The result of rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rendered {
    Complete,
    /// Parts of the picture are old. It is painted anyway, because the panel over it is new.
    Partial,
    /// An event must be handled first, and nothing is painted.
    Interrupted,
}

impl App {
    /// Renders the picture for a window of this size, unless an event must be handled first.
    /// `has_arrived` returns whether such an event has arrived.
    pub(crate) fn render_unless(
        &mut self,
        window: Size,
        has_arrived: &mut HasArrived<'_>,
    ) -> Rendered {
        if self.is_interrupted {
            let (screen, bindings) = (self.screen(), &self.settings.bindings);
            // Such an event may have arrived before the key that interrupted the last picture.
            if has_arrived(&|event| comes_first(event, screen, bindings)) {
                return Rendered::Interrupted;
            }
            self.is_interrupted = false;
            let is_complete = self.render(window, &mut |_, _| false);
            return if is_complete { Rendered::Complete } else { Rendered::Partial };
        }
        let is_complete = self.render(window, &mut |screen, bindings| {
            !has_arrived(&|event| comes_first(event, screen, bindings))
        });
        self.is_interrupted = !is_complete;
        if is_complete { Rendered::Complete } else { Rendered::Interrupted }
    }
}

/// Returns true if `event` must be handled before the picture is finished.
fn comes_first(event: &Event, screen: AppScreen, bindings: &Bindings) -> bool {
    match event {
        Event::Quit(_) | Event::Suspend | Event::Resized => true,
        Event::Key(event) => {
            let leaves = || {
                let key = bindings.resolve(*event).key;
                bindings.action(key) == Some(Action::Leave)
            };
            event.phase == Phase::Press && (screen != AppScreen::Playing || leaves())
        }
        _ => false,
    }
}
