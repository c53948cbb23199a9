//! The distance of sounds from one cell.
//!
//! Sound goes around corners, over low walls, and through the holes of masks. Solid walls stop it.
//! A closed door or glass is as far as [`DAMPING`] more cells.

use super::Sound;
use crate::game::flood::{Costs, Flood, STRAIGHT};
use crate::game::stored::{Reader, Stored, Unrestorable, Writer};
use crate::world::{Cell, Tile, TileKind, World};

/// The additional cost of a closed door or of glass, in half cells.
const DAMPING: u16 = 12;
/// Sound passes over walls that are at most this much higher than the floor beside them, in cells.
const LOW_WALL: f64 = 0.75;
/// The number of steps after which the field is computed again, since doors may have moved.
const OLD: u64 = 30;

/// How far sounds have to go from one cell to those around it.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct SoundField {
    center: Option<Cell>,
    flood: Flood,
    begun: u64,
}

impl SoundField {
    /// Finds the distances of the cells within `reach` around `center`. `now` is the number of the
    /// step. Returns the number of cells that were not known before.
    pub(crate) fn reach_out(&mut self, world: &World, center: Cell, reach: u16, now: u64) -> usize {
        let grid = world.grid();
        let is_old = now.saturating_sub(self.begun) > OLD;
        if self.center != Some(center) || is_old {
            self.flood.begin(center, (grid.width(), grid.height()));
            (self.center, self.begun) = (Some(center), now);
        }
        let reach = reach.min(half_cells(Sound::FARTHEST));
        let mut found = 0;
        while self.flood.radius() <= reach && self.flood.advance(&Air { world }) {
            found += 1;
        }
        found
    }

    /// The distance of `cell` from the centre, in half cells; `None` if that is beyond the reach.
    pub(crate) fn distance(&self, cell: Cell) -> Option<u16> {
        self.flood.distance(cell)
    }

    /// Forgets the distances.
    pub(crate) fn forget(&mut self) {
        self.center = None;
    }
}

impl Stored for SoundField {
    fn write(&self, out: &mut Writer) {
        let Self { center, flood, begun } = self;
        center.write(out);
        // Without a centre, nothing is known.
        if center.is_some() {
            begun.write(out);
            flood.write(out);
        }
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let Some(center) = Stored::read(input)? else { return Ok(Self::default()) };
        let begun = Stored::read(input)?;
        Ok(Self { center: Some(center), begun, flood: Flood::read(center, input)? })
    }
}

/// A reach in half cells.
pub(crate) fn half_cells(reach: u8) -> u16 {
    u16::from(reach) * STRAIGHT
}

/// The way of sound from cell to cell.
struct Air<'a> {
    world: &'a World,
}

impl Air<'_> {
    fn tile(&self, cell: Cell) -> Option<&Tile> {
        self.world.tile_in(cell)
    }

    /// Whether sound passes between two neighbours.
    fn passes(&self, one: Cell, other: Cell) -> bool {
        let (Some(one), Some(other)) = (self.tile(one), self.tile(other)) else { return false };
        is_low_beside(one, other) && is_low_beside(other, one) && have_common_air(one, other)
    }
}

impl Costs for Air<'_> {
    type Origin = Cell;

    fn origin(&self, cell: Cell) -> Cell {
        cell
    }

    fn straight(&self, &from: &Cell, to: Cell) -> Option<u16> {
        let is_dampened = self.tile(to).is_some_and(dampens);
        let cost = if is_dampened { STRAIGHT + DAMPING } else { STRAIGHT };
        self.passes(from, to).then_some(cost)
    }

    fn has_diagonal(&self, &from: &Cell, to: Cell, beside: [bool; 2]) -> bool {
        let is_free = |cell| self.tile(cell).is_some_and(|tile| !dampens(tile));
        let corners =
            [Cell { column: to.column, row: from.row }, Cell { column: from.column, row: to.row }];
        let passes =
            |corner| is_free(corner) && self.passes(from, corner) && self.passes(corner, to);
        beside != [false, false]
            && is_free(from)
            && is_free(to)
            && self.passes(from, to)
            && corners.into_iter().any(passes)
    }
}

fn dampens(tile: &Tile) -> bool {
    matches!(tile.kind, TileKind::Door(_) | TileKind::Glass(_))
}

/// Whether `tile` is no wall, or a low one beside the floor of `other`.
fn is_low_beside(tile: &Tile, other: &Tile) -> bool {
    let is_wall = matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
    !is_wall || tile.heights.floor() - other.heights.floor() <= LOW_WALL
}

/// Whether a gap of one tile overlaps a gap of the other.
fn have_common_air(one: &Tile, other: &Tile) -> bool {
    one.gaps()
        .any(|gap| other.gaps().any(|there| gap.bottom.max(there.bottom) < gap.top.min(there.top)))
}
