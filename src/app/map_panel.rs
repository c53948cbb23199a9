//! The minimap in its panel: what of the map has been seen, how large it is, and which part shows.

use glam::DVec2;

use crate::app::MapDisplay;
use crate::app::bindings::MapChange;
use crate::game::Game;
use crate::tui::{Explored, Minimap, View};
use crate::world::Camera;

/// What the minimap keeps from one frame to the next.
#[derive(Clone, Debug)]
pub(super) struct MapPanel {
    pub(super) is_shown: bool,
    display: MapDisplay,
    explored: Explored,
    zoom: i32,
    /// How far the part that shows has been moved away from the player, in cells.
    offset: DVec2,
    /// How many cells showed last from left to right and from top to bottom.
    extent: DVec2,
}

/// How far one can zoom in or out, in levels.
const MOST_ZOOM: i32 = 6;
/// Which part of what shows the map is moved by at once.
const MOVED_BY: f64 = 0.25;

impl MapPanel {
    pub(super) fn new(display: MapDisplay) -> Self {
        Self {
            is_shown: display != MapDisplay::Off,
            display,
            explored: Explored::default(),
            zoom: 0,
            offset: DVec2::ZERO,
            extent: DVec2::ZERO,
        }
    }

    /// Forgets the level.
    pub(super) fn begin_level(&mut self) {
        self.explored = Explored::default();
        self.offset = DVec2::ZERO;
    }

    /// Takes note of what `camera` sees in a picture of so many columns.
    pub(super) fn look(&mut self, game: &Game, camera: &Camera, columns: u16) {
        if self.display == MapDisplay::All {
            return;
        }
        if let Some(corner) = game.corner() {
            self.explored.follow(corner);
        }
        self.explored.look(game.world(), camera, columns.into());
    }

    /// Which part of the level has been seen, where that is counted.
    pub(super) fn share_seen(&self, game: &Game) -> Option<f64> {
        let is_counted = self.display != MapDisplay::All && game.corner().is_none();
        is_counted.then(|| self.explored.share())
    }

    /// Shows it larger, smaller, or another part of it.
    pub(super) fn change(&mut self, change: MapChange) {
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

    /// The map of `game` as `camera` and the rays of `view` have it.
    pub(super) fn minimap<'a>(
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

    /// Takes note that so many cells showed. What is off the map is no further away to move back from.
    pub(super) fn shown(&mut self, extent: DVec2, game: &Game, camera: &Camera) {
        let grid = game.world().grid();
        let size = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
        self.extent = extent.min(size);
        let half = self.extent / 2.0;
        let center = (camera.position() + self.offset).clamp(half, size - half);
        if self.offset != DVec2::ZERO {
            self.offset = center - camera.position();
        }
    }
}
