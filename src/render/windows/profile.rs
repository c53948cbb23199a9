//! Profiles: what a ray wants to know of a tile in every cell that it crosses.
//!
//! They are made once a frame, from where the eye is. To ask the tile itself in each cell was refused: it
//! is a large value of many cases, and a ray mostly needs to know where its gaps are.

use super::look::Place;
use super::{Part, Scene};
use crate::render::projection::{Projection, Rise};
use crate::world::{Gap, Heights, Tile, TileKind};

/// Those of all tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct Profiles {
    /// The first one is that of what is off the map.
    list: Vec<Profile>,
}

/// What is open in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Profile {
    pub(super) lowest: Slot,
    pub(super) upper: Option<Slot>,
}

/// A gap as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) gap: Gap,
    pub(super) bottom: Rise,
    /// `None` for the sky.
    pub(super) top: Option<Rise>,
    /// What its bottom is.
    pub(super) below: Part,
    /// Whether something stands on that which does not fill the cell: a leaf or a shape.
    pub(super) holds_something: bool,
}

impl Profiles {
    /// Makes those of all tiles in `scene`.
    pub(super) fn begin(&mut self, scene: Scene<'_>) {
        let beyond = Gap { bottom: 0.0, top: f64::INFINITY };
        let beyond = Profile { lowest: Slot::new(scene, beyond, Part::Floor), upper: None };
        let of_tiles = scene.world.tiles().iter().map(|tile| Profile::new(scene, tile));
        self.list.clear();
        self.list.extend([beyond].into_iter().chain(of_tiles));
    }

    /// That of what is in `place`.
    #[inline]
    pub(super) fn of(&self, place: Place) -> &Profile {
        &self.list[place.map_or(0, |(_, tile)| usize::from(tile.0) + 1)]
    }
}

impl Profile {
    fn new(scene: Scene<'_>, tile: &Tile) -> Self {
        let mut gaps = tile.gaps();
        let lowest = gaps.next().unwrap_or(BOTTOMLESS);
        let stands = matches!(tile.kind, TileKind::Door(_) | TileKind::Shape(_));
        let holds_something = stands && lowest.bottom == tile.heights.floor();
        let lowest = Slot { holds_something, ..Slot::new(scene, lowest, Part::Floor) };
        Self { lowest, upper: gaps.next().map(|gap| Slot::new(scene, gap, Part::Roof)) }
    }

    /// From the lowest up.
    #[inline]
    pub(super) fn slots(&self) -> impl Iterator<Item = &Slot> {
        [&self.lowest].into_iter().chain(&self.upper)
    }
}

impl Slot {
    fn new(scene: Scene<'_>, gap: Gap, below: Part) -> Self {
        let rise_to = |height| scene.projection.rise_to(height);
        let top = (gap.top < f64::INFINITY).then(|| rise_to(gap.top));
        Self { gap, bottom: rise_to(gap.bottom), top, below, holds_something: false }
    }

    /// The first row that shows none of what is above it, at distance `t`.
    #[inline]
    pub(super) fn row_of_top(&self, projection: &Projection, t: f64) -> u32 {
        self.top.map_or(0, |top| projection.row_of(top, t))
    }

    /// The first row that shows none of it but what is below it, at distance `t`.
    #[inline]
    pub(super) fn row_of_bottom(&self, projection: &Projection, t: f64) -> u32 {
        projection.row_of(self.bottom, t)
    }

    /// Where an eye is that is in no gap at all.
    pub(super) fn bottomless(scene: Scene<'_>) -> Self {
        Self::new(scene, BOTTOMLESS, Part::Roof)
    }
}

/// Everything that there may be.
pub(super) const BOTTOMLESS: Gap = Gap { bottom: -2.0 * Heights::MOST, top: 2.0 * Heights::MOST };
