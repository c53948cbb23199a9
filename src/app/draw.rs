//! Drawing: the picture, and what lies over it.

use ratatui::layout::{Rect, Size};

use super::overlay::Overlay;
use super::status::{StatusValues, hint};
use super::vitals::HealthSigns;
use super::{App, Bindings, DrawOptions, Ghost, Screen, banner, panels};
use crate::game::{Game, PlayerId};
use crate::tui::canvas::Canvas;

impl App {
    /// Draws the screen.
    pub fn draw(&mut self, canvas: &mut impl Canvas) {
        self.render(canvas.bounds().as_size(), &mut |_, _| true);
        self.paint(canvas);
    }

    /// Renders the picture for a window of this size; may stop once `go_on` returns `false`, which it
    /// may decide by the screen and the keys. Returns whether the picture is complete.
    pub(crate) fn render(
        &mut self,
        window: Size,
        go_on: &mut dyn FnMut(Screen, &Bindings) -> bool,
    ) -> bool {
        let area = Rect::from(window);
        if panels::is_too_small(area) {
            return true;
        }
        self.show_ghost();
        let [picture, _] = panels::picture_and_status(area);
        let (options, screen, bindings) =
            (self.draw_options(), self.screen, &self.settings.bindings);
        let go_on = &mut || go_on(screen, bindings);
        self.game.render(&options, picture.as_size(), &mut self.views, go_on)
    }

    /// Paints the rendered picture, and what lies over it, on a canvas of the same size.
    pub(crate) fn paint(&mut self, canvas: &mut impl Canvas) {
        let area = canvas.bounds();
        if panels::is_too_small(area) {
            return panels::too_small(canvas);
        }
        let [picture, status] = panels::picture_and_status(area);
        self.paint_picture(canvas, picture);
        if self.demo.is_some() {
            canvas.draw_widget(hint("up and down, Enter, Esc"), status);
        } else if self.screen.is_result() {
            canvas.draw_widget(hint("up and down, Enter"), status);
        } else {
            self.draw_status(canvas, status);
        }
        self.draw_panel(canvas, picture);
        self.draw_fault(canvas, picture);
    }

    fn draw_panel(&mut self, canvas: &mut impl Canvas, picture: Rect) {
        let bindings = &self.settings.bindings;
        match self.screen {
            Screen::Playing => {}
            Screen::Help => {
                self.help.draw(canvas, picture, (&[], bindings), self.detection.lines());
            }
            Screen::Leaving => {
                panels::leaving(canvas, picture, bindings, self.effect_of_leaving());
            }
            Screen::Title => {
                let below = banner::draw(canvas, picture, self.settings.glyphs, self.depth);
                self.menu.draw(canvas, below);
            }
            _ => self.menu.draw(canvas, picture),
        }
    }

    fn draw_status(&mut self, canvas: &mut impl Canvas, area: Rect) {
        self.status.update(&StatusValues {
            game: &self.game,
            goal: &self.goal,
            notice: self.notice.as_ref(),
            level: self.level,
            share_seen: self.game.grid().and_then(|game| self.map.share_seen(game)),
            toggles: self.controls.toggles,
            mouse: self.pointer.is_on(),
            stats: self.stats.as_ref().filter(|_| self.shows_stats),
            bindings: &self.settings.bindings,
            health_signs: HealthSigns::for_picture(self.settings.glyphs, self.depth),
        });
        canvas.draw_widget(&self.status, area);
    }

    fn paint_picture(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let options = self.draw_options();
        self.game.paint(&options, canvas, area, &self.views);
        if self.demo.is_none() {
            self.draw_map(canvas, area, &options);
            self.draw_hud(canvas, area, &options);
        }
    }

    fn draw_options(&self) -> DrawOptions {
        let is_game = self.demo.is_none();
        let heading = |game: &Game| game.camera(self.field_of_view).heading;
        let flash = self.game.grid().and_then(|game| Some((game.flash()?, heading(game))));
        DrawOptions {
            glyphs: self.settings.glyphs,
            depth: self.depth,
            shade_ink: self.terminal.shade_ink,
            cell_aspect: self.cell_aspect,
            filter: self.settings.filter,
            correction: self.store.preferences().correction,
            field_of_view: self.field_of_view,
            flash: flash.filter(|_| is_game),
            marks_middle: is_game && self.store.preferences().crosshair,
        }
    }

    /// Shows the ghost in the world of the game, or no longer.
    fn show_ghost(&mut self) {
        let is_on = self.store.preferences().ghost;
        let Some(ghost) = self.ghost.as_ref() else { return };
        if let Some(game) = self.game.grid_mut() {
            game.show_guest(|sprite| ghost.figure(sprite).filter(|_| is_on));
        }
    }

    fn draw_hud(&self, canvas: &mut impl Canvas, area: Rect, options: &DrawOptions) {
        let Some(overlay) = self.overlay(options) else {
            return options.draw_middle(canvas, area);
        };
        overlay.draw_hud(canvas, area, self.screen == Screen::Playing);
    }

    fn draw_map(&mut self, canvas: &mut impl Canvas, area: Rect, options: &DrawOptions) {
        let preferences = self.store.preferences();
        let Some(game) = self.game.grid() else { return };
        if let Some(overlay) = Overlay::new(game, PlayerId::FIRST, options, preferences) {
            let ghost = self.ghost.as_ref().filter(|_| preferences.ghost).and_then(Ghost::on_map);
            let overlay = overlay.with_ghost(ghost);
            overlay.draw_map(canvas, area, &mut self.map, &self.views.grid);
        }
    }

    fn overlay<'a>(&'a self, options: &'a DrawOptions) -> Option<Overlay<'a>> {
        let preferences = self.store.preferences();
        Overlay::new(self.game.grid()?, PlayerId::FIRST, options, preferences)
    }
}
