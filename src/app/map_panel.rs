//! The minimap's panel: the seen cells, the zoom, and the part that is shown.

use glam::DVec2;

use crate::app::MapDisplay;
use crate::app::bindings::MapChange;
use crate::game::Game;
use crate::tui::{Explored, Minimap, View};
use crate::world::Camera;

/// The state of the minimap between frames.
#[derive(Clone, Debug)]
pub struct MapPanel {
    /// Whether the map is shown.
    pub is_shown: bool,
    display: MapDisplay,
    explored: Explored,
    zoom: i32,
    /// How far the shown part has been moved away from the player, in cells.
    offset: DVec2,
    /// The numbers of cells shown last from left to right and from top to bottom.
    extent: DVec2,
}

/// The most levels of zoom in each direction.
const MOST_ZOOM: i32 = 6;
/// The share of the shown part by which the map is moved at once.
const MOVED_BY: f64 = 0.25;

impl MapPanel {
    /// A panel with this content.
    pub fn new(display: MapDisplay) -> Self {
        Self {
            is_shown: display != MapDisplay::Off,
            display,
            explored: Explored::default(),
            zoom: 0,
            offset: DVec2::ZERO,
            extent: DVec2::ZERO,
        }
    }

    /// The content of the map, as the settings page shows it.
    pub fn display(&self) -> MapDisplay {
        match (self.is_shown, self.display) {
            (false, _) => MapDisplay::Off,
            (true, MapDisplay::All) => MapDisplay::All,
            (true, _) => MapDisplay::Seen,
        }
    }

    /// Resets the panel for a new level.
    pub fn begin_level(&mut self) {
        self.explored = Explored::default();
        self.offset = DVec2::ZERO;
    }

    /// Adds the cells that `camera` sees in a picture with that many columns.
    pub(crate) fn explore(&mut self, game: &Game, camera: &Camera, columns: u16) {
        if self.display == MapDisplay::All {
            return;
        }
        if let Some(corner) = game.corner() {
            self.explored.follow(corner);
        }
        self.explored.look(game.world(), camera, columns.into());
    }

    /// The share of the level that has been seen, if that is counted.
    pub(crate) fn share_seen(&self, game: &Game) -> Option<f64> {
        let is_counted = self.display != MapDisplay::All && game.corner().is_none();
        is_counted.then(|| self.explored.share())
    }

    /// Applies a change of the zoom or of the shown part.
    pub fn change(&mut self, change: MapChange) {
        let by = self.extent * MOVED_BY;
        match change {
            MapChange::Larger => self.zoom = (self.zoom + 1).min(MOST_ZOOM),
            MapChange::Smaller => self.zoom = (self.zoom - 1).max(-MOST_ZOOM),
            MapChange::North => self.offset.y -= by.y,
            MapChange::South => self.offset.y += by.y,
            MapChange::West => self.offset.x -= by.x,
            MapChange::East => self.offset.x += by.x,
            MapChange::Center => (self.zoom, self.offset) = (0, DVec2::ZERO),
        }
    }

    /// The minimap of `game`, with the camera and the rays of the picture.
    pub(crate) fn minimap<'a>(
        &'a self,
        game: &'a Game,
        camera: &'a Camera,
        view: &'a View,
    ) -> Minimap<'a> {
        let map = Minimap::new(game.world(), camera)
            .seen(view.columns())
            .zoom(self.zoom)
            .offset(self.offset);
        match self.display {
            MapDisplay::All => map,
            MapDisplay::Seen | MapDisplay::Off => map.explored(&self.explored),
        }
    }

    /// Records that `extent` cells were shown. The offset is limited to the map, so that no key
    /// presses are needed to come back from outside.
    pub(crate) fn shown(&mut self, extent: DVec2, game: &Game, camera: &Camera) {
        let grid = game.world().grid();
        let size = grid.extent();
        self.extent = extent.min(size);
        let half = self.extent / 2.0;
        let center = (camera.position() + self.offset).clamp(half, size - half);
        if self.offset != DVec2::ZERO {
            self.offset = center - camera.position();
        }
    }
}
