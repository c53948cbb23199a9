//! What lies over the picture of one player of a game: the map and the HUD.
//!
//! It depends on the game and the player alone, so that a game at home and a room of several show the
//! same.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::map_panel::MapPanel;
use super::{DrawOptions, hud, panels};
use crate::app::store::Preferences;
use crate::color::palette::ColorDepth;
use crate::game::{Game, PlayerId, PlayerView};
use crate::tui::canvas::Canvas;
use crate::tui::{MapMark, View};

/// A player of a game, and how their picture is drawn.
pub struct Overlay<'a> {
    game: &'a Game,
    player: PlayerView<'a>,
    options: &'a DrawOptions,
    preferences: Preferences,
    ghost: Option<MapMark>,
}

impl<'a> Overlay<'a> {
    /// The overlay of `player`'s picture; `None` if they are not in the game.
    pub fn new(
        game: &'a Game,
        player: PlayerId,
        options: &'a DrawOptions,
        preferences: Preferences,
    ) -> Option<Self> {
        Some(Self { game, player: game.seen_by(player)?, options, preferences, ghost: None })
    }

    /// Sets the ghost on the map.
    pub(crate) fn with_ghost(self, ghost: Option<MapMark>) -> Self {
        Self { ghost, ..self }
    }

    /// Draws the middle, the flash at the edge, and the compass; also sounds and the note if
    /// `shows_events`.
    pub fn draw_hud(&self, canvas: &mut impl Canvas, area: Rect, shows_events: bool) {
        let Self { player, options, .. } = self;
        options.draw_middle(canvas, area);
        let heading = player.camera(options.field_of_view).heading;
        let is_plain = options.depth == ColorDepth::Mono;
        if let Some((flash, heading)) = options.flash.as_ref().filter(|_| is_plain) {
            hud::draw_edge(canvas, area, flash, *heading);
        }
        if self.preferences.compass {
            hud::draw_compass(canvas, area, heading);
        }
        if shows_events {
            hud::draw_sounds(canvas, area, player.heard(), heading, options.depth);
            if let Some(note) = player.note() {
                hud::draw_note(canvas, area, note);
            }
        }
    }

    /// Draws the map with its panel, if it is shown. `view` is that of the picture.
    pub fn draw_map(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        panel: &mut MapPanel,
        view: &View,
    ) {
        let Self { game, player, options, ghost, .. } = self;
        let camera = &player.camera(options.field_of_view);
        panel.explore(game, camera, area.width);
        if !panel.is_shown {
            return;
        }
        let guards = game.guards().filter(|guard| !guard.is_down);
        let guards = guards.map(|it| MapMark { position: it.position, heading: it.heading });
        let others = player.others_on_map();
        let others = others.map(|it| MapMark { position: it.position, heading: it.heading });
        let marks: Vec<MapMark> = guards.chain(others).collect();
        let map = panel.minimap(game, camera, view);
        let map = map.glyphs(options.glyphs).color_depth(options.depth).marks(&marks).ghost(*ghost);
        if let Some(place) = panels::minimap(area, &map) {
            let inside = panels::framed(canvas, place, "map");
            map.paint(inside, canvas);
            let extent = map.extent_within(inside.as_size());
            panel.shown(extent, game, camera);
        }
    }
}

impl DrawOptions {
    /// Marks the middle by a character, where pixels do not show it.
    pub(crate) fn draw_middle(&self, canvas: &mut impl Canvas, area: Rect) {
        let is_plain = self.depth == ColorDepth::Mono;
        if self.marks_middle && (is_plain || !self.glyphs.has_blocks()) {
            let (x, y) = (area.x + area.width / 2, area.y + area.height / 2);
            canvas.draw_character(x, y, '+', [Color::Reset; 2]);
        }
    }
}
