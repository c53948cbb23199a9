//! Drawing: the picture, and what lies over it.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::status::{StatusValues, hint};
use super::vitals::HealthSigns;
use super::{App, DrawOptions, Screen, banner, hud, panels};
use crate::canvas::Canvas;
use crate::color::palette::ColorDepth;
use crate::game::Game;
use crate::tui::{GlyphMode, MapMark};

impl App {
    pub(super) fn draw(&mut self, canvas: &mut impl Canvas) {
        let area = canvas.bounds();
        if panels::is_too_small(area) {
            return panels::too_small(canvas);
        }
        let [picture, status] = panels::picture_and_status(area);
        self.draw_picture(canvas, picture);
        if self.demo.is_some() {
            canvas.draw_widget(hint("up and down, Enter, Esc"), status);
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
            Screen::Help => self.help.draw(canvas, picture, bindings, self.detection.lines()),
            Screen::Leaving => {
                let effect = if self.is_descent() { "ends the run" } else { "leaves" };
                panels::leaving(canvas, picture, bindings, effect);
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
            level: self.level,
            share_seen: self.game.grid().and_then(|game| self.map.share_seen(game)),
            toggles: self.controls.toggles,
            mouse: self.pointer.is_on(),
            stats: self.stats.as_ref().filter(|_| self.shows_stats),
            bindings: &self.settings.bindings,
            health_signs: match (self.settings.glyphs, self.depth) {
                (_, ColorDepth::Mono) => HealthSigns::Digits,
                (GlyphMode::Half, _) => HealthSigns::Hearts,
                _ => HealthSigns::Digits,
            },
        });
        canvas.draw_widget(&self.status, area);
    }

    fn draw_picture(&mut self, canvas: &mut impl Canvas, area: Rect) {
        self.show_ghost();
        let is_game = self.demo.is_none();
        let heading = |game: &Game| game.camera(self.field_of_view).heading;
        let flash = self.game.grid().and_then(|game| Some((game.flash()?, heading(game))));
        let options = DrawOptions {
            glyphs: self.settings.glyphs,
            depth: self.depth,
            cell_aspect: self.cell_aspect,
            filter: self.settings.filter,
            field_of_view: self.field_of_view,
            flash: flash.filter(|_| is_game),
            marks_middle: is_game && self.store.preferences().crosshair,
        };
        self.game.draw(&options, canvas, area, &mut self.views);
        if is_game {
            self.draw_map(canvas, area);
            self.draw_hud(canvas, area, &options);
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
        let preferences = self.store.preferences();
        let is_plain = self.depth == ColorDepth::Mono;
        if options.marks_middle && (is_plain || options.glyphs != GlyphMode::Half) {
            let (x, y) = (area.x + area.width / 2, area.y + area.height / 2);
            canvas.draw_character(x, y, '+', [Color::Reset; 2]);
        }
        let Some(game) = self.game.grid() else { return };
        let heading = game.camera(self.field_of_view).heading;
        if let Some((flash, heading)) = options.flash.as_ref().filter(|_| is_plain) {
            hud::draw_edge(canvas, area, flash, *heading);
        }
        if preferences.compass {
            hud::draw_compass(canvas, area, heading);
        }
        if self.screen == Screen::Playing {
            hud::draw_sounds(canvas, area, game.heard(), heading, self.depth);
            if let Some(note) = game.note() {
                hud::draw_note(canvas, area, note);
            }
        }
    }

    fn draw_map(&mut self, canvas: &mut impl Canvas, area: Rect) {
        let Some(game) = self.game.grid() else { return };
        let camera = &game.camera(self.field_of_view);
        self.map.explore(game, camera, area.width);
        if !self.map.is_shown {
            return;
        }
        let marks: Vec<MapMark> = game
            .guards()
            .filter(|guard| !guard.is_down)
            .map(|guard| MapMark { position: guard.position, heading: guard.heading })
            .collect();
        let map = self.map.minimap(game, camera, &self.views.grid);
        let map = map.glyphs(self.settings.glyphs).color_depth(self.depth).marks(&marks);
        if let Some(panel) = panels::minimap(area, &map) {
            let inside = panels::framed(canvas, panel, "map");
            map.paint(inside, canvas);
            let extent = map.extent_within(inside.as_size());
            self.map.shown(extent, game, camera);
        }
    }
}
