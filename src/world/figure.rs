//! Figures: sprites that move.
//!
//! A [`Thing`](super::Thing) stands in the middle of a cell, where a frame finds it by its cell. A
//! figure is at any place, and its owner sets its height, heading and frame: a guard, a thrown
//! stone, a cloud of smoke. A game replaces all figures at once after each step, so that none can
//! be left behind. Rules:
//!
//! - A frame considers every figure. There are tens, and each costs one projection; sorting them
//!   by cell was refused, because they change their cells all the time.
//! - A figure has the light of the cell that it is in. No part of it is drawn behind the edge of the
//!   map, as of a thing.
//! - A figure never changes with time, and causes no
//!   [next change](crate::render::Renderer::next_change).

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Cell, Heading, Light, Sprite, SpriteId, World};

/// A sprite at any place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Its sprite, among those of the world; a figure with any other is not drawn.
    pub sprite: SpriteId,
    /// The place of its middle, on the map.
    pub position: DVec2,
    /// The height of its lower edge, in cells.
    pub base: f64,
    /// The direction of its front.
    pub heading: Heading,
    /// The frame of the sprite that it shows; the last one, if there is no such frame.
    pub frame: u8,
    /// How much of it shows instead of what is behind: from 0 for none to 255 for all. The opacity of
    /// each texel is multiplied by it, in 255ths, and rounded to the nearest whole number.
    pub opacity: u8,
}

impl Figure {
    /// The cell that it is in; `None` west or north of the map, where there are no cells.
    pub fn cell(&self) -> Option<Cell> {
        let DVec2 { x, y } = self.position;
        (x >= 0.0 && y >= 0.0).then_some(Cell { column: x as u32, row: y as u32 })
    }
}

impl World {
    /// The figures, in the order in which they were set.
    pub fn figures(&self) -> &[Figure] {
        &self.figures
    }

    /// Replaces all figures.
    pub fn set_figures(&mut self, figures: impl Iterator<Item = Figure>) {
        self.figures.clear();
        self.figures.extend(figures);
    }

    /// Adds a sprite, for figures to refer to.
    pub(crate) fn add_sprite(&mut self, sprite: Sprite) -> SpriteId {
        let id = SpriteId(self.sprites.len() as u16);
        self.sprites = self.sprites.iter().cloned().chain([sprite]).collect();
        id
    }

    /// The greatest height that a figure reaches; 0 if there is none.
    pub(crate) fn top_of_figures(&self) -> f64 {
        let sprite = |figure: &Figure| self.sprites.get(usize::from(figure.sprite.0));
        let height = |figure: &Figure| sprite(figure).map_or(0.0, |sprite| sprite.height.cells());
        self.figures.iter().map(|figure| figure.base + height(figure)).fold(0.0, f64::max)
    }

    /// The light on `figure`; off the map, that of the map's own floor.
    pub(crate) fn light_on(&self, figure: &Figure) -> Light {
        let off_map = self.ground().light.unwrap_or(Light::FULL);
        figure.cell().map_or(off_map, |cell| self.light_in(cell))
    }
}
