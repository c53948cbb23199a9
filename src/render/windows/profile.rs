//! Profiles: what a ray wants to know of a tile in every cell that it crosses.
//!
//! They are made once a frame, from where the eye is. To ask the tile itself in each cell was refused: it
//! is a large value of many cases, and a ray mostly needs to know where its gaps are.

use std::ops::Range;

use super::look::Place;
use super::{Part, Scene};
use crate::render::projection::{Projection, Rise};
use crate::world::{Gap, Heights, Tile, TileKind};

/// Those of all tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct Profiles {
    /// Those of each tile together, from the lowest up.
    slots: Vec<Slot>,
    /// Which of them are those of what is off the map, and then of each tile.
    of_tiles: Vec<Range<usize>>,
}

/// Which slot of which tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlotId(usize);

/// A gap as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) gap: Gap,
    bottom: Rise,
    /// `None` for the sky.
    top: Option<Rise>,
    /// What its bottom is.
    pub(super) below: Part,
    pub(super) holds: Holds,
}

/// What stands on the bottom of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Holds {
    Nothing,
    /// The leaf of a door, or a shape: it does not fill the cell.
    Standing,
    /// Glass or a mask, which fill it.
    Cube,
}

impl Profiles {
    /// Makes those of all tiles in `scene`.
    pub(super) fn begin(&mut self, scene: Scene<'_>) {
        self.slots.clear();
        self.of_tiles.clear();
        self.slots.push(Slot::new(scene, BOTTOMLESS, Part::Roof, Holds::Nothing));
        self.push([Slot::new(scene, BEYOND, Part::Floor, Holds::Nothing)]);
        for tile in scene.world.tiles() {
            let parts = [Part::Floor, Part::Roof];
            let gaps = tile.gaps().zip(parts);
            self.push(gaps.map(|(gap, below)| Slot::new(scene, gap, below, Holds::new(tile, gap))));
        }
    }

    fn push(&mut self, slots: impl IntoIterator<Item = Slot>) {
        let first = self.slots.len();
        self.slots.extend(slots);
        self.of_tiles.push(first..self.slots.len());
    }

    /// The slots of what is in `place`, from the lowest up.
    #[inline]
    pub(super) fn of(&self, place: Place) -> impl Iterator<Item = (SlotId, &Slot)> {
        let range = self.of_tiles[place.map_or(0, |(_, tile)| usize::from(tile.0) + 1)].clone();
        range.clone().map(SlotId).zip(&self.slots[range])
    }

    /// One of them.
    #[inline]
    pub(super) fn slot(&self, SlotId(index): SlotId) -> &Slot {
        &self.slots[index]
    }
}

impl SlotId {
    /// Where an eye is that is in no gap at all.
    pub(super) const BOTTOMLESS: Self = Self(0);
}

impl Slot {
    fn new(scene: Scene<'_>, gap: Gap, below: Part, holds: Holds) -> Self {
        let rise_to = |height| scene.projection.rise_to(height);
        let top = (gap.top < f64::INFINITY).then(|| rise_to(gap.top));
        Self { gap, bottom: rise_to(gap.bottom), top, below, holds }
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
}

impl Holds {
    fn new(tile: &Tile, gap: Gap) -> Self {
        match tile.kind {
            _ if gap.bottom != tile.heights.floor() => Self::Nothing,
            TileKind::Door(_) | TileKind::Shape(_) => Self::Standing,
            TileKind::Mask(_) | TileKind::Glass(_) => Self::Cube,
            TileKind::Open | TileKind::Doorway(_) | TileKind::Wall(_) | TileKind::Mirror(_) => {
                Self::Nothing
            }
        }
    }
}

/// What is open off the map.
const BEYOND: Gap = Gap { bottom: 0.0, top: f64::INFINITY };

/// Everything that there may be.
pub(super) const BOTTOMLESS: Gap = Gap { bottom: -2.0 * Heights::MOST, top: 2.0 * Heights::MOST };
