//! Casting through cells that do not stop every ray: doors that are ajar, shapes, glass, and masks.
//!
//! The traversal stops at every solid cell, and this module decides whether the ray goes on.
//! Between solid cells, the cost is the same as for casting at walls. Results are as exact as for
//! walls:
//!
//! - The leaf of a door is a segment of a line in the middle of its cell. The distance is computed
//!   from the position of the line by one division. If rounding leaves a doubt whether the ray
//!   misses an end of the leaf, the sign of a cross product decides. The ends belong to the leaf.
//! - Shapes are solved in closed form from the ray's origin. For a line, the distance is the
//!   quotient of two cross products, whose exact signs tell on which side of an end the ray passes.
//!   The ends belong to the line, and a ray along the line hits nothing.

use glam::DVec2;

use super::pillar::Chord;
use super::ray::{cell_before, meeting, texture_coordinate};
use super::{Crossing, Hit, Ray, Side};
use crate::numeric::{cross, sign_of_cross};
use crate::world::{Cell, Grid, Line, Opening, Outline, TileId, TileKind, World};

/// The hit of `ray` in `world`. The ray starts in the cell `start` and enters `solid_cells`. Calls
/// `passed` with the transparent faces that it enters.
pub(crate) fn cast(
    start: Option<(Cell, TileId)>,
    solid_cells: impl Iterator<Item = Crossing>,
    world: &World,
    ray: &Ray,
    passed: &mut dyn FnMut(Hit),
) -> Option<Hit> {
    let grid = world.grid();
    let leaf_in = |cell| meet_leaf(grid, ray, cell, world.opening(cell));
    let start = start.and_then(|(cell, tile)| match world.tile(tile).kind {
        TileKind::Door(_) => leaf_in(cell),
        TileKind::Shape(it) => meet_shape(ray, cell, it.outline),
        _ => None,
    });
    if start.is_some() {
        return start;
    }
    for crossing in solid_cells {
        match world.tile(crossing.tile).kind {
            TileKind::Door(_) => {
                if let Some(hit) = leaf_in(crossing.cell) {
                    return Some(hit);
                }
            }
            TileKind::Shape(it) => {
                if let Some(hit) = meet_shape(ray, crossing.cell, it.outline) {
                    return Some(hit);
                }
            }
            TileKind::Mask(_) | TileKind::Glass(_)
                if tile_before(world, ray, crossing) == Some(crossing.tile) => {}
            TileKind::Glass(glass) if glass.is_opaque() => {
                return Some(Hit::entering(ray, crossing.cell, crossing.side));
            }
            TileKind::Mask(_) | TileKind::Glass(_) => {
                passed(Hit::entering(ray, crossing.cell, crossing.side));
            }
            TileKind::Wall(_) | TileKind::Mirror(_) | TileKind::Open | TileKind::Doorway(_) => {
                return Some(Hit::entering(ray, crossing.cell, crossing.side));
            }
        }
    }
    None
}

/// The tile of the cell that `ray` leaves by a crossing.
fn tile_before(world: &World, ray: &Ray, crossing: Crossing) -> Option<TileId> {
    let [column, row] = cell_before(ray.direction(), crossing.cell, crossing.side);
    world.grid().tile(column, row)
}

/// The hit of `ray`, which passes through `cell`, on the leaf of the door there. `None` if it
/// misses the leaf.
fn meet_leaf(grid: &Grid, ray: &Ray, cell: Cell, opening: Opening) -> Option<Hit> {
    let leaf = Leaf::new(grid, cell, opening);
    if !leaf.is_ahead(ray) {
        return None;
    }
    let (t, along) = meeting(ray, leaf.side, leaf.start);
    leaf.holds(ray, along).then(|| {
        let u = texture_coordinate(ray.direction(), leaf.side, along + opening.part());
        Hit { cell, side: leaf.side, t, u }
    })
}

/// At more than this distance from an end of the leaf, a rounded position is on the correct side of
/// the end.
const UNCERTAINTY: f64 = 1e-11;

/// The part of a leaf that is not inside the jamb.
pub(crate) struct Leaf {
    /// The kind of line that contains the leaf.
    side: Side,
    /// The north or west end, at the jamb into which the leaf slides.
    pub(crate) start: DVec2,
    pub(crate) end: DVec2,
}

impl Leaf {
    pub(crate) fn new(grid: &Grid, cell: Cell, opening: Opening) -> Self {
        let (column, row) = (f64::from(cell.column), f64::from(cell.row));
        let length = 1.0 - opening.part();
        // A door has solid jambs on two sides, and open cells on the other two.
        let is_jamb_in_the_west = grid.is_solid(i64::from(cell.column) - 1, i64::from(cell.row));
        if is_jamb_in_the_west {
            let start = DVec2::new(column, row + 0.5);
            Self { side: Side::Y, start, end: DVec2::new(column + length, start.y) }
        } else {
            let start = DVec2::new(column + 0.5, row);
            Self { side: Side::X, start, end: DVec2::new(start.x, row + length) }
        }
    }

    /// Returns whether `ray` meets the line that contains the leaf.
    fn is_ahead(&self, ray: &Ray) -> bool {
        let way = self.start - ray.origin();
        let (way, direction) = match self.side {
            Side::X => (way.x, ray.direction().x),
            Side::Y => (way.y, ray.direction().y),
        };
        direction != 0.0 && (way == 0.0 || (way > 0.0) == (direction > 0.0))
    }

    /// Returns whether `ray` meets the line between both ends. `along` is the rounded distance from
    /// the start to that point, in cells.
    fn holds(&self, ray: &Ray, along: f64) -> bool {
        let length = (self.end - self.start).max_element();
        let within = along.min(length - along);
        if within.abs() > UNCERTAINTY {
            return within > 0.0;
        }
        self.offset_sign(ray, self.start) >= 0.0 && self.offset_sign(ray, self.end) <= 0.0
    }

    /// The sign of the offset from `point`, on the line, to the point where `ray` meets the line.
    fn offset_sign(&self, ray: &Ray, point: DVec2) -> f64 {
        let direction = ray.direction();
        let sign = cross(ray.origin(), direction, point).sign();
        match self.side {
            Side::X => sign * direction.x.signum(),
            Side::Y => -sign * direction.y.signum(),
        }
    }
}

/// The intersection of a ray with a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Intersection {
    /// The hit on the outside; `None` if the ray misses the shape or starts inside.
    pub(crate) hit: Option<Hit>,
    /// The `t` at which the ray leaves the shape, if it was inside. A line has no inside.
    pub(crate) end: Option<f64>,
}

impl Intersection {
    pub(crate) const NONE: Self = Self { hit: None, end: None };

    /// The intersection of `ray`, which passes through `cell`, with an object there that does not
    /// fill the cell: the leaf of a door, which has no interior, or a shape.
    pub(crate) fn of_tile(ray: &Ray, world: &World, cell: Cell, kind: TileKind) -> Self {
        match kind {
            TileKind::Door(_) => {
                Self { hit: meet_leaf(world.grid(), ray, cell, world.opening(cell)), end: None }
            }
            TileKind::Shape(it) => Self::new(ray, cell, it.outline),
            _ => Self::NONE,
        }
    }

    /// The intersection of `ray`, which passes through `cell`, with the shape of this `outline`
    /// there.
    #[inline]
    fn new(ray: &Ray, cell: Cell, outline: Outline) -> Self {
        match outline {
            Outline::Pillar(radius) => {
                let Some(chord) = Chord::new(ray, cell, radius) else { return Self::NONE };
                Self { hit: chord.hit(ray, cell, radius), end: chord.end() }
            }
            Outline::Line(line) => Self { hit: meet_line(ray, cell, line), end: None },
        }
    }
}

/// The hit of `ray`, which passes through `cell`, on the shape of this `outline` there. `None` if
/// it misses.
fn meet_shape(ray: &Ray, cell: Cell, outline: Outline) -> Option<Hit> {
    Intersection::new(ray, cell, outline).hit
}

fn meet_line(ray: &Ray, cell: Cell, line: Line) -> Option<Hit> {
    let (start, extent) = (line.start(cell), line.stretch());
    let (across, exponent) = speed_across(ray, extent);
    let side_of = |end| sign_of_cross(ray.origin(), ray.direction(), end);
    let (from_start, from_end) = (side_of(start), side_of(start + extent));
    let is_beside = from_start > 0.0 && from_end > 0.0 || from_start < 0.0 && from_end < 0.0;
    if across == 0.0 || is_beside {
        return None;
    }
    let to_line = cross(ray.origin(), extent, start);
    let is_ahead = to_line.sign() == 0.0 || (to_line.sign() > 0.0) == (across > 0.0);
    if !is_ahead {
        return None;
    }
    let t = to_line.over_scaled(across, exponent).abs();
    let along = cross(ray.origin(), ray.direction(), start).over_scaled(across, exponent);
    let along = along.clamp(0.0, 1.0) + 0.0;
    let u = if across > 0.0 { along } else { 1.0 - along };
    Some(Hit { cell, side: facing(extent.perp()), t, u })
}

/// The speed of `ray` towards a line with this `extent`, from its left or its right, rounded at
/// most once. It is divided by a power of two, whose exponent is also returned.
fn speed_across(ray: &Ray, extent: DVec2) -> (f64, i32) {
    let across = |direction: DVec2| direction.x * extent.y - direction.y * extent.x;
    if extent.x == 0.0 || extent.y == 0.0 {
        // The result is one of the components, which scaling might make underflow.
        return (across(ray.direction()), 0);
    }
    let (direction, exponent) = ray.scaled_direction();
    (across(direction), exponent)
}

/// The kind of grid line closest in direction to a surface with this `normal`.
pub(crate) fn facing(normal: DVec2) -> Side {
    if normal.x.abs() >= normal.y.abs() { Side::X } else { Side::Y }
}

#[cfg(test)]
mod tests;
