//! Portal starts: the part of a column that the flat way leaves to the portal way.
//!
//! That is the part behind the first line into a cell that is not level. The flat way fills floor
//! and ceiling up to that line, as before a wall, and the things and see-through faces there. Under the
//! sky, what is higher than a level wall shows above it, so that such a wall is left to the portal way, too.
//! If only things are higher, the flat way shows them above the wall.

use crate::cast::Hit;
use crate::visibility::portal::PortalStart;
use crate::visibility::{Column, DrawList, Scene};
use crate::world::{Ceiling, Cell, Heights, Tile, TileKind, World};

/// The starts of the portal way in the columns of a scene.
pub(crate) struct PortalStarts<'a> {
    world: &'a World,
    overhead: Overhead,
    /// Whether nothing shows above a level wall.
    walls_hide_all: bool,
    /// The last cell, and the start of rays that end at it. Mostly, many neighbouring columns show the same
    /// cell.
    latest: Option<(Cell, Option<PortalStart>)>,
}

/// The kinds of ceiling in cells with a level floor.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Overhead {
    Sky,
    Ceiling,
    Both,
}

impl<'a> PortalStarts<'a> {
    pub(crate) fn new(world: &'a World) -> Self {
        let is_floor = |tile: &&Tile| tile.is_level() && !matches!(tile.kind, TileKind::Wall(_));
        let is_open = |tile: &Tile| tile.ceiling == Ceiling::Sky;
        let floors = || world.tiles().iter().filter(is_floor);
        let overhead = match (floors().any(is_open), floors().all(is_open)) {
            (false, _) => Overhead::Ceiling,
            (true, true) => Overhead::Sky,
            (true, false) => Overhead::Both,
        };
        let is_higher = |tile: &Tile| tile.top() > Heights::LEVEL_WALL.floor();
        let walls_hide_all = overhead == Overhead::Ceiling || !world.tiles().iter().any(is_higher);
        Self { world, overhead, walls_hide_all, latest: None }
    }

    /// The start in `column`; `None` if the flat way fills all of it.
    pub(crate) fn of(&mut self, column: &Column) -> Option<PortalStart> {
        let Hit { cell, .. } = *column.hit.as_ref()?;
        match self.latest {
            Some((known, start)) if known == cell => start,
            _ => self.latest.insert((cell, self.start_at(cell))).1,
        }
    }

    /// The start of rays that end at `cell`; `None` if the flat way fills their columns.
    fn start_at(&self, cell: Cell) -> Option<PortalStart> {
        if !self.leave(cell) {
            return None;
        }
        // A ray hits a door or a shape within a cell.
        let is_at_line = |tile: &Tile| !tile.is_level() || matches!(tile.kind, TileKind::Wall(_));
        if !self.world.tile_in(cell).is_some_and(is_at_line) {
            return Some(PortalStart::Camera);
        }
        Some(match self.overhead {
            Overhead::Sky => PortalStart::LineUnderSky,
            Overhead::Ceiling => PortalStart::Line,
            // The part behind the first line may show above a ceiling, in the rows of the sky.
            Overhead::Both => PortalStart::Camera,
        })
    }

    /// Whether the flat way leaves what is behind the border of `cell`, in which a ray ends.
    fn leave(&self, cell: Cell) -> bool {
        !(self.walls_hide_all && self.world.tile_in(cell).is_some_and(Tile::is_level))
    }

    /// Whether the flat way fills nothing of the columns that it leaves to the portal way.
    fn are_at_camera(&self) -> bool {
        self.overhead == Overhead::Both
    }
}

/// Removes the parts left to the portal way from the columns of the flat way.
pub(crate) fn leave_to_portals(scene: Scene<'_>, list: &mut DrawList) {
    let DrawList { columns, flat_columns, is_flat, .. } = list;
    let mut starts = PortalStarts::new(scene.world);
    let is_left = |column: &Column| column.hit.as_ref().is_some_and(|hit| starts.leave(hit.cell));
    let cell = |column: &Column| column.hit.map(|hit| hit.cell);
    // Mostly, many neighbouring columns show the same cell.
    let mut cells = columns.chunk_by(|one, other| cell(one) == cell(other));
    if !cells.any(|columns| is_left(&columns[0])) {
        return;
    }
    *is_flat = !(starts.are_at_camera() && columns.iter().all(is_left));
    let height = scene.projection.rows();
    flat_columns.extend(columns.iter().map(|column| {
        let Some(start) = starts.of(column) else { return column.clone() };
        let distance = if start == PortalStart::Camera { 0.0 } else { column.distance };
        let hit = column.hit.map(|hit| Hit { t: -1.0, ..hit });
        Column { hit, distance, rows: start.rows(column, height) }
    }));
}
