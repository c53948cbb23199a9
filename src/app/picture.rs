//! How the picture of one player is drawn, and the map and the HUD over it.
//!
//! All of it depends on the game and the player alone, so that a game at home and a room of several
//! show the same.

use ratatui::layout::{Rect, Size};
use ratatui::style::Color;

use crate::app::map_panel::MapPanel;
use crate::app::store::Preferences;
use crate::app::{hud, panels};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::game::{Flash, Game, PlayerId, PlayerView};
use crate::render::{Filter, Frame, Renderable};
use crate::terminal::Protocol;
use crate::tui::canvas::Canvas;
use crate::tui::{CellAspect, Correction, FirstPerson, GlyphSet, MapMark, View};
use crate::world::{FieldOfView, Heading};

/// How the terminal shows pictures, as far as it is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerminalLook {
    /// The shape of a cell.
    pub aspect: Option<CellAspect>,
    /// The colour depth.
    pub depth: ColorDepth,
    /// How the terminal draws shades.
    pub shade_ink: ShadeInk,
    /// The finest blocks that the terminal is known to draw well.
    pub glyphs: GlyphSet,
}

impl TerminalLook {
    /// The terminal at the other end of `protocol`.
    pub fn of(protocol: &Protocol) -> Self {
        Self {
            aspect: protocol.size().cell_aspect.and_then(CellAspect::new),
            depth: protocol.color_depth(),
            shade_ink: protocol.shade_ink(),
            glyphs: protocol.glyph_support(),
        }
    }
}

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
pub struct DrawOptions {
    /// The glyph set.
    pub glyphs: GlyphSet,
    /// The colour depth.
    pub depth: ColorDepth,
    /// How the terminal draws shades.
    pub shade_ink: ShadeInk,
    /// The shape of a cell.
    pub cell_aspect: CellAspect,
    /// The texture filter.
    pub filter: Filter,
    /// How pictures are changed for the player's eyes.
    pub correction: Correction,
    /// The field of view.
    pub field_of_view: FieldOfView,
    /// The flash at the edge, and the direction of view.
    pub flash: Option<(Flash, Heading)>,
    /// Whether a dot marks the middle.
    pub marks_middle: bool,
}

impl DrawOptions {
    /// Draws `scene` from `camera` at the time `seconds`.
    pub fn draw<S: Renderable>(
        &self,
        scene: &S,
        camera: &S::Camera,
        seconds: f64,
        canvas: &mut impl Canvas,
        area: Rect,
        view: &mut View<S>,
    ) {
        let picture = self.picture(scene, camera, seconds);
        self.render(&picture, area.as_size(), view, &mut || true);
        picture.paint(view, 0, area, canvas);
    }

    /// The picture of `scene` from `camera` at the time `seconds`.
    pub(crate) fn picture<'a, S: Renderable>(
        &self,
        scene: &'a S,
        camera: &'a S::Camera,
        seconds: f64,
    ) -> FirstPerson<'a, S> {
        FirstPerson::new(scene, camera)
            .glyphs(self.glyphs)
            .color_depth(self.depth)
            .shade_ink(self.shade_ink)
            .cell_aspect(self.cell_aspect)
            .filter(self.filter)
            .correction(self.correction)
            .time(seconds)
    }

    /// Renders `picture` for an area of this size into `view`; may stop once `go_on` returns `false`.
    /// Returns whether the picture is complete.
    pub(crate) fn render<S: Renderable>(
        &self,
        picture: &FirstPerson<'_, S>,
        size: Size,
        view: &mut View<S>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let is_complete = picture.draw_while(size, view, go_on);
        let has_pixels = size.width > 0 && size.height > 0;
        if is_complete && has_pixels && self.depth != ColorDepth::Mono {
            self.change_pixels(view.frame_mut());
        }
        is_complete
    }

    /// Tints and marks the pixels of a picture in colours.
    fn change_pixels(&self, frame: &mut Frame) {
        if let Some((flash, heading)) = &self.flash {
            hud::tint(frame, flash, *heading);
        }
        if self.marks_middle && self.glyphs.has_blocks() {
            hud::mark_middle(frame);
        }
    }
}

/// `view` after a key that widens or narrows it, in degrees by 6 from 30 to 120.
pub fn widened(view: FieldOfView, widens: bool) -> FieldOfView {
    let by = if widens { 6.0 } else { -6.0 };
    FieldOfView::from_degrees((view.degrees() + by).clamp(30.0, 120.0)).unwrap_or(view)
}

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

    /// Draws the map with its panel, if it is shown. `view` has drawn the picture.
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
