//! Drawing: the picture, and what lies over it.

use ratatui::layout::Rect;

use super::status::{StatusValues, hint};
use super::{App, DrawOptions, Screen, banner, panels};
use crate::canvas::Canvas;

impl App {
    pub(super) fn draw(&mut self, canvas: &mut impl Canvas) {
        let area = canvas.bounds();
        if panels::is_too_small(area) {
            return panels::too_small(canvas);
        }
        let [picture, status] = panels::picture_and_status(area);
        self.draw_picture(canvas, picture);
        if self.demo.is_some() {
            canvas.draw_widget(hint("up down choose   enter opens   esc goes back"), status);
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
            Screen::Leaving => panels::leaving(canvas, picture, bindings),
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
        });
        canvas.draw_widget(&self.status, area);
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
        if self.demo.is_none() {
            self.draw_map(canvas, area);
        }
    }

    fn draw_map(&mut self, canvas: &mut impl Canvas, area: Rect) {
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
