//! What blocks a player, by the height of the feet and of the body.
//!
//! A cell has gaps, between a floor and a ceiling or above a roof. A player is clear of the cell if
//! one gap contains the whole body. So for feet at one height the world is two-dimensional: some
//! cells block and the others do not, and the sweep needs nothing else.
//!
//! A thing that blocks fills its cell up to its height: a player can jump onto it or over it.
//! Nobody walks up onto one, however low it is; use a floor for that. A box as wide as the picture
//! was refused: a map says for each cell whether it is free, and the author sees that in the grid.

use std::array::IntoIter;
use std::iter::Flatten;

use glam::DVec2;

use super::{Obstacles, Radius, cell_on_map, is_clear, outline, overlapped};
use crate::game::fall::Room;
use crate::world::{Cell, Gap, Outline, Tile, TileKind, World};

/// The height of the feet and of the body, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stature {
    pub(crate) feet: f64,
    pub(crate) height: f64,
}

impl Stature {
    /// Whether `gap` contains the body.
    fn fits(self, gap: Gap) -> bool {
        // The same difference as in `room`, so that a player whose head touches is clear.
        gap.bottom <= self.feet && self.feet <= gap.top - self.height
    }
}

/// The world for a player of some stature.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) world: &'a World,
    pub(crate) stature: Stature,
    /// The highest step that the player can climb; 0 in the air.
    pub(crate) step: f64,
    /// Whether the world has shapes.
    pub(crate) has_shapes: bool,
    /// The positions of players in the way, who are columns without an upper end.
    pub(crate) others: &'a [DVec2],
}

impl Obstacles for Place<'_> {
    fn blocks(&self, column: i64, row: i64) -> bool {
        self.gap(column, row).is_none()
    }

    fn outline(&self, cell: Cell) -> Option<Outline> {
        if !self.has_shapes {
            return None;
        }
        let tile = self.tile(i64::from(cell.column), i64::from(cell.row))?;
        match tile.kind {
            // It reaches up to the ceiling at most.
            TileKind::Shape(shape) if self.stature.feet < tile.top_of_what_stands() => {
                Some(shape.outline)
            }
            _ => None,
        }
    }

    fn circles(&self) -> &[DVec2] {
        self.others
    }

    /// Steps up, if there is room.
    fn gives_way(&mut self, column: i64, row: i64, center: DVec2, radius: Radius) -> bool {
        let at = |feet| Self { stature: Stature { feet, ..self.stature }, ..*self };
        let mut steps = self.steps_up(column, row).map(at);
        let Some(lifted) = steps.find(|lifted| is_clear(lifted, center, radius)) else {
            return false;
        };
        *self = lifted;
        true
    }
}

impl Place<'_> {
    /// The gap of a cell that contains the body.
    fn gap(&self, column: i64, row: i64) -> Option<Gap> {
        let tile = self.tile(column, row)?;
        let fits = |gap: &Gap| self.stature.fits(*gap);
        let Some(thing) = self.thing_in_the_way(column, row, tile) else {
            return gaps(tile).find(fits);
        };
        gaps(tile).flat_map(|gap| around(gap, thing)).find(fits)
    }

    /// The tile of a cell; `None` outside the map.
    fn tile(&self, column: i64, row: i64) -> Option<Tile> {
        let id = self.world.grid().tile(column, row)?;
        Some(self.world.tile(id))
    }

    /// The range of heights at which a thing blocks a cell of `tile`, if one does.
    fn thing_in_the_way(&self, column: i64, row: i64, tile: Tile) -> Option<Gap> {
        if !self.world.grid().is_occupied(column, row) {
            return None;
        }
        let things = self.world.things_in(cell_on_map(column, row)?).iter();
        let sprite = things.map(|thing| self.world.sprite(thing.sprite)).find(|it| it.blocks)?;
        let base = sprite.base(tile.heights);
        Some(Gap { bottom: base, top: base + sprite.height.cells() })
    }

    /// The heights in a cell that are one step up: its floors and the top of its shape. Things are
    /// no steps.
    fn steps_up(&self, column: i64, row: i64) -> impl Iterator<Item = f64> + use<> {
        let Stature { feet, .. } = self.stature;
        let most = feet + self.step;
        let tile = self.tile(column, row);
        let floors = tile.into_iter().flat_map(gaps).map(|gap| gap.bottom);
        let shapes = tile.filter(|tile| matches!(tile.kind, TileKind::Shape(_)));
        let tops = shapes.map(|tile| tile.top_of_what_stands());
        floors.chain(tops).filter(move |&height| height > feet && height <= most)
    }

    /// Whether the player has room around `center`.
    pub(crate) fn is_clear(&self, center: DVec2, radius: Radius) -> bool {
        is_clear(self, center, radius)
    }

    /// The height to which floors that have risen around the feet lift a body whose circle is around `center`, by
    /// a step at most; `None` if there are no such floors, or no room.
    pub(crate) fn lifted(&self, center: DVec2, radius: Radius) -> Option<f64> {
        let Stature { feet, .. } = self.stature;
        let tiles = overlapped(center, radius).filter_map(|(column, row)| self.tile(column, row));
        let floors = tiles.flat_map(|tile| tile.gaps()).map(|gap| gap.bottom);
        let above = |&floor: &f64| feet < floor && floor <= feet + self.step;
        let feet = floors.filter(above).reduce(f64::max)?;
        let lifted = Self { stature: Stature { feet, ..self.stature }, ..*self };
        lifted.is_clear(center, radius).then_some(feet)
    }

    /// The lowest and the highest position of the feet of a player whose circle around `center` is
    /// clear.
    pub(crate) fn room(&self, center: DVec2, radius: Radius) -> Room {
        let gaps = overlapped(center, radius)
            .filter_map(|(column, row)| self.gap_above_shapes(column, row, center, radius));
        let most = Room { floor: f64::NEG_INFINITY, ceiling: f64::INFINITY };
        gaps.fold(most, |room, gap| Room {
            floor: room.floor.max(gap.bottom),
            ceiling: room.ceiling.min(gap.top - self.stature.height),
        })
    }

    /// The gap of a cell that contains the body of a player whose circle is around `center`: only
    /// its part above the shape, if the circle overlaps that.
    fn gap_above_shapes(
        &self,
        column: i64,
        row: i64,
        center: DVec2,
        radius: Radius,
    ) -> Option<Gap> {
        let gap = self.gap(column, row)?;
        if !self.has_shapes {
            return Some(gap);
        }
        let (tile, cell) = (self.tile(column, row)?, cell_on_map(column, row)?);
        let top = tile.top_of_what_stands();
        match tile.kind {
            TileKind::Shape(shape)
                if top <= self.stature.feet
                    && !outline::is_clear_of(shape.outline, cell, center, radius) =>
            {
                Some(Gap { bottom: gap.bottom.max(top), ..gap })
            }
            _ => Some(gap),
        }
    }
}

/// The gaps of `tile` for a player: a door, glass or a mask fills a gap up to its top.
fn gaps(tile: Tile) -> impl Iterator<Item = Gap> {
    let filled = match tile.kind {
        TileKind::Open
        | TileKind::Doorway(_)
        | TileKind::Wall(_)
        | TileKind::Mirror(_)
        | TileKind::Shape(_) => None,
        TileKind::Door(_) | TileKind::Mask(_) | TileKind::Glass(_) => {
            Some(Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() })
        }
    };
    tile.gaps().flat_map(move |gap| match filled {
        None => [Some(gap), None].into_iter().flatten(),
        Some(filled) => around(gap, filled),
    })
}

/// The parts of a gap below and above what fills a part of it.
fn around(gap: Gap, filled: Gap) -> Flatten<IntoIter<Option<Gap>, 2>> {
    let below = Gap { top: gap.top.min(filled.bottom), ..gap };
    let above = Gap { bottom: gap.bottom.max(filled.top), ..gap };
    let is_open = |gap: &Gap| gap.bottom < gap.top;
    [Some(below).filter(is_open), Some(above).filter(is_open)].into_iter().flatten()
}
