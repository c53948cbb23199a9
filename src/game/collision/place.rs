//! What is in the way of somebody, by how high they stand and how tall they are.
//!
//! A cell has gaps, between a floor and a ceiling or above a roof. Somebody is clear of it where one
//! of them holds all of them, from feet to head. So for feet at one height the world is flat again:
//! some cells block and the others do not, and the sweep needs to know of nothing else.

use glam::DVec2;

use super::{Obstacles, Radius, cell_of, is_clear, is_clear_of};
use crate::game::fall::Room;
use crate::world::{Cell, Gap, Outline, Tile, TileKind, World};

/// How high somebody stands, and how tall they are just now, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::game) struct Stature {
    pub(in crate::game) feet: f64,
    pub(in crate::game) height: f64,
}

impl Stature {
    /// Whether all of somebody is in `gap`.
    fn fits(self, gap: Gap) -> bool {
        // The same difference as in `room`, so that who hits their head is clear.
        gap.bottom <= self.feet && self.feet <= gap.top - self.height
    }
}

/// The world as somebody finds it.
#[derive(Clone, Copy)]
pub(in crate::game) struct Place<'a> {
    pub(in crate::game) world: &'a World,
    pub(in crate::game) stature: Stature,
    /// How much higher a floor may be for them to step onto it; 0 for who is in the air.
    pub(in crate::game) step: f64,
    /// Whether there are any shapes to look for.
    pub(in crate::game) has_shapes: bool,
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
            // It reaches no further than to the ceiling.
            TileKind::Shape(shape) if self.stature.feet < tile.heights.ceiling() => {
                Some(shape.outline)
            }
            _ => None,
        }
    }

    /// Steps up, where there is room for it.
    fn gives_way(&mut self, column: i64, row: i64, center: DVec2, radius: Radius) -> bool {
        let Some(feet) = self.step_up(column, row) else { return false };
        let lifted = Self { stature: Stature { feet, ..self.stature }, ..*self };
        let has_room = is_clear(&lifted, center, radius);
        if has_room {
            *self = lifted;
        }
        has_room
    }
}

impl Place<'_> {
    /// The gap of a cell that holds all of somebody.
    fn gap(&self, column: i64, row: i64) -> Option<Gap> {
        let stature = self.stature;
        self.tile(column, row).and_then(|tile| gaps(tile).find(|&gap| stature.fits(gap)))
    }

    /// The tile of a cell; `None` where that is off the map, or something stands in the way.
    fn tile(&self, column: i64, row: i64) -> Option<Tile> {
        let grid = self.world.grid();
        let id = grid.tile(column, row).filter(|_| !grid.is_occupied(column, row))?;
        Some(self.world.tile(id))
    }

    /// The height of the lowest floor in a cell that is a step up from here, with room to stand.
    fn step_up(&self, column: i64, row: i64) -> Option<f64> {
        let Stature { feet, height } = self.stature;
        let is_step = |gap: &Gap| {
            let stature = Stature { feet: gap.bottom, height };
            gap.bottom > feet && gap.bottom <= feet + self.step && stature.fits(*gap)
        };
        gaps(self.tile(column, row)?).find(is_step).map(|gap| gap.bottom)
    }

    /// Whether somebody has room around `center`.
    pub(in crate::game) fn is_clear(&self, center: DVec2, radius: Radius) -> bool {
        is_clear(self, center, radius)
    }

    /// How low and how high the feet may be of somebody whose circle is around `center`, which is
    /// clear.
    pub(in crate::game) fn room(&self, center: DVec2, radius: Radius) -> Room {
        let (column, row) = cell_of(center);
        let around =
            (row - 1..=row + 1).flat_map(|row| (column - 1..=column + 1).map(move |c| (c, row)));
        let gaps = around
            .filter(|&(column, row)| !is_clear_of(center, column, row, radius))
            .filter_map(|(column, row)| self.gap(column, row));
        let most = Room { floor: f64::NEG_INFINITY, ceiling: f64::INFINITY };
        gaps.fold(most, |room, gap| Room {
            floor: room.floor.max(gap.bottom),
            ceiling: room.ceiling.min(gap.top - self.stature.height),
        })
    }
}

/// What is open in a cell of `tile` to who walks: what stands in a gap fills it up to the ceiling.
fn gaps(tile: Tile) -> impl Iterator<Item = Gap> {
    let is_filled = match tile.kind {
        TileKind::Open
        | TileKind::Doorway(_)
        | TileKind::Wall(_)
        | TileKind::Mirror(_)
        | TileKind::Shape(_) => false,
        TileKind::Door(_) | TileKind::Mask(_) | TileKind::Glass(_) => true,
    };
    let top = tile.heights.ceiling();
    let above = move |gap: Gap| match gap {
        gap if !is_filled => Some(gap),
        Gap { top: end, .. } if end <= top => None,
        Gap { bottom, top: end } => Some(Gap { bottom: bottom.max(top), top: end }),
    };
    tile.gaps().filter_map(above)
}
