//! The rows of a billboard that no ceiling hides.
//!
//! A thing may be taller than its room, and a figure may be partly above it. What is higher than the ceilings
//! shows only where the sky is over the cells in front of it. The flat way finds the ceiling of each such
//! pixel as it does for the ceiling's spans. Rejected: clip ranges from cell to cell, as the portal way has
//! them. Few things are that tall, and all others would pay for the walk.

use std::ops::Range;

use crate::visibility::Scene;
use crate::world::{Ceiling, Heights};

/// The ceilings of a level scene.
#[derive(Clone, Copy)]
pub(crate) struct Ceilings<'a> {
    scene: Scene<'a>,
    /// Whether any cell that a ray may enter is under the sky.
    is_any_open: bool,
}

impl<'a> Ceilings<'a> {
    pub(crate) fn new(scene: Scene<'a>) -> Self {
        Self { scene, is_any_open: scene.world.has_open_sky() }
    }

    /// Whether some part of `rows` of a billboard at `depth` is above the ceilings, and may show there under
    /// the sky.
    pub(crate) fn let_past(self, depth: f64, rows: &Range<u32>) -> bool {
        self.is_any_open && rows.start < self.row_of_top(depth)
    }

    /// The row of the height of the ceilings at `depth`.
    fn row_of_top(self, depth: f64) -> u32 {
        self.scene.projection.row_of_height(Heights::LEVEL.ceiling(), depth)
    }

    /// Calls `show` for each part of `rows` of a billboard at `depth` that no ceiling hides in `column`, of which
    /// the second part says whether its ray ends at a wall.
    pub(crate) fn for_each_open(
        self,
        (column, is_at_wall): (u32, bool),
        depth: f64,
        rows: Range<u32>,
        mut show: impl FnMut(Range<u32>),
    ) {
        let top = self.row_of_top(depth);
        let is_closed = is_at_wall && !self.is_any_open;
        let is_hidden = |&row: &u32| row < top && (is_closed || self.is_ceiling(column, row));
        let mut next = if is_closed { rows.start.max(top) } else { rows.start };
        while let Some(start) = (next..rows.end).find(|row| !is_hidden(row)) {
            let end = (start..top.min(rows.end)).find(is_hidden).unwrap_or(rows.end);
            show(start..end);
            next = end;
        }
    }

    /// Whether a pixel above the horizon is in front of a ceiling.
    fn is_ceiling(self, column: u32, row: u32) -> bool {
        let Scene { world, projection, .. } = self.scene;
        let mapping = projection.mapping(row).just_before(projection.origin());
        let column = column as usize;
        let corner = mapping.cells(column..column + 1).next().map(|(corner, _)| corner);
        // Casts saturate, and convert NaN to 0.
        let tile = corner
            .filter(|corner| corner.is_finite())
            .and_then(|corner| world.grid().tile(corner.x as i64, corner.y as i64));
        tile.is_some_and(|tile| world.tile(tile).ceiling != Ceiling::Sky)
    }
}
