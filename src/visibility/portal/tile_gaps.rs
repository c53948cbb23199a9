//! Tile gaps: the values of a tile that a ray needs in every cell.
//!
//! They are made once a frame, for the height of the eye. Rejected: reading the tile itself in each
//! cell. It is a large value of many cases, and a ray mostly needs only the positions of its gaps.

use std::ops::Range;

use crate::visibility::projection::Rise;
use crate::visibility::runs::Part;
use crate::visibility::{Projection, Scene};
use crate::world::{Cell, Gap, Heights, Tile, TileId, TileKind, World};

/// The location of a ray: in a cell, or off the map.
pub(crate) type Place = Option<(Cell, TileId)>;

/// The gaps of all tiles.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileGaps {
    /// The gaps of each tile together, from the lowest up.
    gaps: Vec<VisibleGap>,
    /// The indices of the gaps: those off the map, then those of each tile.
    of_tiles: Vec<Range<u32>>,
}

/// The index of a gap of a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapId(u32);

/// A gap as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisibleGap {
    pub(crate) gap: Gap,
    bottom: Rise,
    /// The rise to its top; `None` for the sky.
    top: Option<Rise>,
    /// The part of the cell at its bottom.
    pub(crate) below: Part,
    pub(crate) holds: Holds,
}

/// The object that stands at the bottom of a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holds {
    Nothing,
    /// The leaf of a door, or a shape, which does not fill the cell.
    Standing,
    /// Glass or a mask, which fills the cell.
    Cube,
}

impl TileGaps {
    /// Makes the gaps of all tiles in `scene`.
    pub(crate) fn begin(&mut self, scene: Scene<'_>) {
        self.gaps.clear();
        self.of_tiles.clear();
        self.gaps.push(VisibleGap::new(scene, BOTTOMLESS, Part::Roof, Holds::Nothing));
        self.push([VisibleGap::new(scene, BEYOND, Part::Floor, Holds::Nothing)]);
        for tile in scene.world.tiles() {
            let parts = [Part::Floor, Part::Roof];
            let gaps = tile.gaps().zip(parts);
            self.push(
                gaps.map(|(gap, below)| VisibleGap::new(scene, gap, below, Holds::new(tile, gap))),
            );
        }
    }

    /// Reserves memory for the gaps of all tiles of `world`.
    pub(crate) fn make_room(&mut self, world: &World) {
        const OF_A_TILE: usize = 2;
        self.gaps.clear();
        self.of_tiles.clear();
        self.gaps.reserve((world.tiles().len() + 1) * OF_A_TILE);
        self.of_tiles.reserve(world.tiles().len() + 1);
    }

    fn push(&mut self, gaps: impl IntoIterator<Item = VisibleGap>) {
        let first = self.gaps.len();
        self.gaps.extend(gaps);
        self.of_tiles.push(first as u32..self.gaps.len() as u32);
    }

    /// The gaps in `place`, from the lowest up.
    #[inline]
    pub(crate) fn of(&self, place: Place) -> impl Iterator<Item = GapId> {
        let tile = place.map_or(0, |(_, tile)| usize::from(tile.0) + 1);
        self.of_tiles[tile].clone().map(GapId)
    }

    /// The gaps in `place`: the upper one, and the lower one if there are two.
    #[inline]
    pub(crate) fn upper_and_lower(&self, place: Place) -> Option<(GapId, Option<GapId>)> {
        let mut gaps = self.of(place);
        let lowest = gaps.next()?;
        Some(gaps.next().map_or((lowest, None), |upper| (upper, Some(lowest))))
    }

    /// The gap with this index.
    #[inline]
    pub(crate) fn gap(&self, GapId(index): GapId) -> &VisibleGap {
        &self.gaps[index as usize]
    }
}

impl GapId {
    /// The gap of an eye that is in no other gap.
    pub(crate) const BOTTOMLESS: Self = Self(0);
}

impl VisibleGap {
    fn new(scene: Scene<'_>, gap: Gap, below: Part, holds: Holds) -> Self {
        let rise_to = |height| scene.projection.rise_to(height);
        let top = (gap.top < f64::INFINITY).then(|| rise_to(gap.top));
        Self { gap, bottom: rise_to(gap.bottom), top, below, holds }
    }

    /// The first row that shows nothing above the gap, at distance `t`.
    #[inline]
    pub(crate) fn row_of_top(&self, projection: &Projection, t: f64) -> u32 {
        self.top.map_or(0, |top| projection.row_of(top, t))
    }

    /// Finds the rows of the bottom and the top of the gap at each of `distances`.
    pub(crate) fn find_rows(
        &self,
        projection: &Projection,
        distances: &[f64],
        (bottoms, tops): (&mut [u32], &mut [u32]),
    ) {
        projection.rows_of(self.bottom, distances, bottoms);
        match self.top {
            Some(top) => projection.rows_of(top, distances, tops),
            None => tops.fill(0),
        }
    }

    /// The first row that shows only surfaces below the gap, at distance `t`.
    #[inline]
    pub(crate) fn row_of_bottom(&self, projection: &Projection, t: f64) -> u32 {
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

/// The gap off the map.
const BEYOND: Gap = Gap { bottom: 0.0, top: f64::INFINITY };

/// A gap that contains all heights.
pub(crate) const BOTTOMLESS: Gap = Gap { bottom: -2.0 * Heights::MAX, top: 2.0 * Heights::MAX };
