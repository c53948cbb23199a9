//! Collision of a circle with obstacles. The circle is never inside an obstacle, never passes
//! through one, and slides along walls.
//!
//! The predicate [`is_clear`] decides where the circle may be, and no position that fails it is
//! ever accepted. If rounding puts a contact slightly inside an obstacle, the circle moves back
//! along its path to a position that passes. So the circle is clear after a step because it was
//! clear before. Rejected: moving first and pushing out of walls afterwards. It picks the wrong
//! side of a wall at speed, and jitters in corners.
//!
//! The sweep computes how far a circle moves along a straight path before it touches something. Its
//! centre traverses the grid from cell to cell, so the longest path costs at most the columns and
//! rows of the map. Within one open cell the problem is small. A solid neighbour beside the cell is
//! a wall, moved inwards by the radius. A solid neighbour across a corner is a quarter disc around
//! that corner, unless a wall beside it covers the disc. Rejected: rounding every solid cell
//! separately. Each joint of a straight wall would have a quarter disc, at which rounding errors
//! could stop the player.
//!
//! A shape is a disc around a pillar, or a line with round ends. The centre stays farther away from
//! a line than the radius, by [`SKIN`]. A position at exactly the radius from a slanted line cannot
//! be represented in doubles. Rounding would stop a player who slides along such a line in every
//! step.
//!
//! A [`WorldObstacles`] presents the world as obstacles for one body, given the height of its feet and its
//! own height. A cell has gaps, between a floor and a ceiling or above a roof. A player is clear of
//! the cell if one gap contains the whole body. For feet at one height, the world is therefore
//! two-dimensional: some cells block, the others do not, and the sweep needs nothing else.
//!
//! A thing that blocks fills its cell up to its height. A player can jump onto it or over it, but
//! cannot walk up onto it, however low it is. Maps use a floor for that. Rejected: a box as wide as
//! the picture. A map defines for each cell whether it is free, and the author sees that in the
//! grid.

use std::array::IntoIter;
use std::iter::{self, Flatten};

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::fall::VerticalRange;
use crate::world::{Cell, Gap, Line, Outline, Tile, TileKind, World};

/// The maximum number of walls that a body may touch in one step. A corner has two. A body that
/// touches more is stuck between them, and stops.
const MAX_CONTACTS: usize = 4;
/// The depth, relative to the radius, to which a path may enter a corner's disc before it counts as
/// a contact. A player who slides around a corner leaves it along the tangent, exact to about
/// 1e-16.
const GRAZE: f64 = 1e-14;
/// The extra distance between a circle and a line, beyond the radius, in cells.
const SKIN: f64 = 1e-9;
/// A path that approaches a line by less than this per cell counts as parallel to it.
const PARALLEL: f64 = 1e-12;

/// The radius of a circle that can stand in the middle of any open cell. It is above 0 and at most
/// half a cell, so that only the eight cells around its own are in reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radius(f64);

impl Radius {
    /// A radius in cells; `None` outside the range.
    pub(crate) const fn new(cells: f64) -> Option<Self> {
        if cells > 0.0 && cells <= 0.5 { Some(Self(cells)) } else { None }
    }

    /// The radius in cells.
    pub(crate) const fn cells(self) -> f64 {
        self.0
    }
}

/// The obstacles for a circle.
pub(crate) trait Obstacles {
    /// Whether a cell is solid. Cells outside the map are solid, so nobody leaves the map.
    fn blocks(&self, column: i64, row: i64) -> bool;

    /// The shape in a cell that does not block, if any.
    fn outline(&self, cell: Cell) -> Option<Outline> {
        _ = cell;
        None
    }

    /// The centres of other circles of the same radius that block.
    fn circles(&self) -> &[DVec2] {
        &[]
    }

    /// Whether a cell that a circle around `center` touches no longer blocks. Either the cell gives
    /// way, or the circle has been lifted onto it.
    fn gives_way(&mut self, column: i64, row: i64, center: DVec2, radius: Radius) -> bool {
        _ = (column, row, center, radius);
        false
    }
}

/// The position of a body, in cells, and its velocity, in cells per second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MovingBody {
    pub(crate) position: DVec2,
    pub(crate) velocity: DVec2,
}

/// Moves a body by `displacement`, of any length, and slides it along obstacles. The body loses the
/// part of its velocity that points into an obstacle.
pub(crate) fn slide<O: Obstacles>(
    obstacles: &mut O,
    body: MovingBody,
    displacement: DVec2,
    radius: Radius,
) -> MovingBody {
    let MovingBody { mut position, mut velocity } = body;
    let mut remaining = displacement;
    let mut contacts = 0;
    while contacts < MAX_CONTACTS {
        let Some(path) = StraightPath::new(position, remaining) else {
            return MovingBody { position, velocity };
        };
        let Some(contact) = first_contact(obstacles, path, radius) else {
            let position = path.last_clear(obstacles, path.length, radius);
            return MovingBody { position, velocity };
        };
        position = contact.position;
        let gives_way = |(column, row)| obstacles.gives_way(column, row, position, radius);
        if contact.cell.is_some_and(gives_way) {
            remaining = contact.remaining;
            continue;
        }
        contacts += 1;
        remaining = without_inward(contact.remaining, contact.normal);
        velocity = without_inward(velocity, contact.normal);
    }
    MovingBody { position, velocity: DVec2::ZERO }
}

/// Moves a circle by `displacement`, or up to the first contact. Returns its position and whether
/// there was a contact.
pub(crate) fn fly<O: Obstacles>(
    obstacles: &O,
    position: DVec2,
    displacement: DVec2,
    radius: Radius,
) -> (DVec2, bool) {
    let Some(path) = StraightPath::new(position, displacement) else { return (position, false) };
    match first_contact(obstacles, path, radius) {
        Some(contact) => (contact.position, true),
        None => (path.last_clear(obstacles, path.length, radius), false),
    }
}

/// `vector` without its component against `normal`, a unit vector.
fn without_inward(vector: DVec2, normal: DVec2) -> DVec2 {
    vector - normal * vector.dot(normal).min(0.0)
}

/// Whether a circle around `center` overlaps no obstacle. It may touch one. Cells are closed
/// squares.
pub(crate) fn is_clear<O: Obstacles>(obstacles: &O, center: DVec2, radius: Radius) -> bool {
    let least = 2.0 * radius.0;
    let is_apart = |other: &DVec2| other.distance_squared(center) >= least * least;
    obstacles.circles().iter().all(is_apart)
        && overlapped(center, radius).all(|(column, row)| {
            let stands_clear = |cell| {
                let outline = obstacles.outline(cell);
                outline.is_none_or(|outline| is_clear_of_outline(outline, cell, center, radius))
            };
            !obstacles.blocks(column, row) && cell_on_map(column, row).is_none_or(stands_clear)
        })
}

/// The columns and rows of the cells that a circle around `center` overlaps, row by row.
fn overlapped(center: DVec2, radius: Radius) -> impl Iterator<Item = (i64, i64)> {
    let along = |place: f64, index: i64| {
        let (before, after) = (place - index as f64, (index + 1) as f64 - place);
        index - i64::from(before < radius.0)..=index + i64::from(after < radius.0)
    };
    let (column, row) = cell_of(center);
    let columns = along(center.x, column);
    along(center.y, row)
        .flat_map(move |row| columns.clone().map(move |column| (column, row)))
        .filter(move |&(column, row)| !is_clear_of(center, column, row, radius))
}

/// Whether a circle around `center` overlaps `cell`, solid or not. Touching does not count as
/// overlapping.
pub(crate) fn overlaps(center: DVec2, cell: Cell, radius: Radius) -> bool {
    !is_clear_of(center, i64::from(cell.column), i64::from(cell.row), radius)
}

fn is_clear_of(center: DVec2, column: i64, row: i64, Radius(radius): Radius) -> bool {
    square_distance(center, column, row) >= radius * radius
}

/// The squared distance from `point` to the nearest point of a cell.
fn square_distance(point: DVec2, column: i64, row: i64) -> f64 {
    let low = DVec2::new(column as f64, row as f64);
    (low - point).max(point - (low + DVec2::ONE)).max(DVec2::ZERO).length_squared()
}

/// The cell at a column and a row; `None` if either is negative.
fn cell_on_map(column: i64, row: i64) -> Option<Cell> {
    Some(Cell { column: u32::try_from(column).ok()?, row: u32::try_from(row).ok()? })
}

fn cell_of(point: DVec2) -> (i64, i64) {
    (point.x.floor() as i64, point.y.floor() as i64)
}

/// The height of the feet and of the body, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stature {
    pub(crate) feet: f64,
    pub(crate) height: f64,
}

impl Stature {
    /// Whether `gap` contains the body.
    fn fits(self, gap: Gap) -> bool {
        // The same difference as in `room`, so that a player whose head touches the ceiling is
        // clear.
        gap.bottom <= self.feet && self.feet <= gap.top - self.height
    }
}

/// The world as obstacles for a body of one stature.
#[derive(Clone, Copy)]
pub(crate) struct WorldObstacles<'a> {
    pub(crate) world: &'a World,
    pub(crate) stature: Stature,
    /// The highest step that the player can climb; 0 in the air.
    pub(crate) step: f64,
    /// Whether the world has shapes.
    pub(crate) has_shapes: bool,
    /// The positions of players in the way. Each is a column without an upper end.
    pub(crate) others: &'a [DVec2],
}

impl Obstacles for WorldObstacles<'_> {
    fn blocks(&self, column: i64, row: i64) -> bool {
        self.gap(column, row).is_none()
    }

    fn outline(&self, cell: Cell) -> Option<Outline> {
        if !self.has_shapes {
            return None;
        }
        let tile = self.tile(i64::from(cell.column), i64::from(cell.row))?;
        match tile.kind {
            // A shape reaches at most to the ceiling.
            TileKind::Shape(shape) if self.stature.feet < tile.top_of_what_stands() => {
                Some(shape.outline)
            }
            _ => None,
        }
    }

    fn circles(&self) -> &[DVec2] {
        self.others
    }

    /// Lifts the body onto a step, if there is room.
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

impl WorldObstacles<'_> {
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

    /// The range of heights at which a thing blocks a cell of `tile`, if any.
    fn thing_in_the_way(&self, column: i64, row: i64, tile: Tile) -> Option<Gap> {
        if !self.world.grid().is_occupied(column, row) {
            return None;
        }
        let things = self.world.things_in(cell_on_map(column, row)?).iter();
        let sprite = things.map(|thing| self.world.sprite(thing.sprite)).find(|it| it.blocks)?;
        let base = sprite.base(tile.heights);
        Some(Gap { bottom: base, top: base + sprite.height.cells() })
    }

    /// The heights in a cell that are one step up: its floors and the top of its shape. Things do
    /// not count as steps.
    fn steps_up(&self, column: i64, row: i64) -> impl Iterator<Item = f64> + use<> {
        let Stature { feet, .. } = self.stature;
        let most = feet + self.step;
        let tile = self.tile(column, row);
        let floors = tile.into_iter().flat_map(gaps).map(|gap| gap.bottom);
        let shapes = tile.filter(|tile| matches!(tile.kind, TileKind::Shape(_)));
        let tops = shapes.map(|tile| tile.top_of_what_stands());
        floors.chain(tops).filter(move |&height| height > feet && height <= most)
    }

    /// Whether the body has room around `center`.
    pub(crate) fn is_clear(&self, center: DVec2, radius: Radius) -> bool {
        is_clear(self, center, radius)
    }

    /// The height to which floors that have risen around the feet lift a body whose circle is
    /// around `center`, by at most a step. `None` if there are no such floors, or no room.
    pub(crate) fn lifted(&self, center: DVec2, radius: Radius) -> Option<f64> {
        let Stature { feet, .. } = self.stature;
        let tiles = overlapped(center, radius).filter_map(|(column, row)| self.tile(column, row));
        let floors = tiles.flat_map(|tile| tile.gaps()).map(|gap| gap.bottom);
        let above = |&floor: &f64| feet < floor && floor <= feet + self.step;
        let feet = floors.filter(above).reduce(f64::max)?;
        let lifted = Self { stature: Stature { feet, ..self.stature }, ..*self };
        lifted.is_clear(center, radius).then_some(feet)
    }

    /// The lowest and the highest height of the feet of a player whose circle around `center` is
    /// clear.
    pub(crate) fn room(&self, center: DVec2, radius: Radius) -> VerticalRange {
        let gaps = overlapped(center, radius)
            .filter_map(|(column, row)| self.gap_above_shapes(column, row, center, radius));
        let most = VerticalRange { floor: f64::NEG_INFINITY, ceiling: f64::INFINITY };
        gaps.fold(most, |room, gap| VerticalRange {
            floor: room.floor.max(gap.bottom),
            ceiling: room.ceiling.min(gap.top - self.stature.height),
        })
    }

    /// The gap of a cell that contains the body of a player whose circle is around `center`. If the
    /// circle overlaps a shape, only the part of the gap above the shape.
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
                    && !is_clear_of_outline(shape.outline, cell, center, radius) =>
            {
                Some(Gap { bottom: gap.bottom.max(top), ..gap })
            }
            _ => Some(gap),
        }
    }
}

/// The gaps of `tile` for a player. A door, glass or a mask fills a gap up to its top.
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

/// The parts of `gap` below and above `filled`.
pub(crate) fn around(gap: Gap, filled: Gap) -> Flatten<IntoIter<Option<Gap>, 2>> {
    let below = Gap { top: gap.top.min(filled.bottom), ..gap };
    let above = Gap { bottom: gap.bottom.max(filled.top), ..gap };
    let is_open = |gap: &Gap| gap.bottom < gap.top;
    [Some(below).filter(is_open), Some(above).filter(is_open)].into_iter().flatten()
}

/// A straight path.
#[derive(Clone, Copy, Debug)]
struct StraightPath {
    from: DVec2,
    /// A unit vector.
    direction: DVec2,
    length: f64,
}

impl StraightPath {
    /// The path from a position by a displacement; `None` if the displacement is zero.
    fn new(from: DVec2, displacement: DVec2) -> Option<Self> {
        // Unlike the root of a sum of squares, this neither overflows nor underflows.
        let length = libm::hypot(displacement.x, displacement.y);
        (length > 0.0).then(|| Self { from, direction: displacement / length, length })
    }

    fn at(self, distance: f64) -> DVec2 {
        self.from + self.direction * distance
    }

    /// The position at `distance` along the path, or a position shortly before it if a circle is
    /// not clear there. The path begins at a clear position and, except for rounding, has no
    /// obstacle up to `distance`.
    fn last_clear<O: Obstacles>(self, obstacles: &O, distance: f64, radius: Radius) -> DVec2 {
        let retreats = iter::successors(Some(f64::EPSILON), |retreat| Some(2.0 * retreat));
        iter::once(distance)
            .chain(retreats.map(|retreat| distance - retreat))
            .take_while(|&distance| distance > 0.0)
            .map(|distance| self.at(distance))
            .find(|&center| is_clear(obstacles, center, radius))
            .unwrap_or(self.from)
    }
}

/// The first contact between a circle on a path and something solid.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// The position of the circle's centre, which is clear.
    position: DVec2,
    /// The unit vector from the obstacle to the centre.
    normal: DVec2,
    /// The remaining displacement.
    remaining: DVec2,
    /// The column and the row of the obstacle; `None` for another circle.
    cell: Option<(i64, i64)>,
}

/// The first contact of a circle on `path`, if any.
fn first_contact<O: Obstacles>(
    obstacles: &O,
    path: StraightPath,
    radius: Radius,
) -> Option<Contact> {
    let (mut column, mut row) = cell_of(path.from);
    loop {
        let around = OpenCell { obstacles, column, row, radius };
        let PathEvent { distance, kind } = around.next_event(path)?;
        if distance > path.length {
            return None;
        }
        match kind {
            PathEventKind::Leave { columns, rows } => {
                column += columns;
                row += rows;
            }
            PathEventKind::Touch { kind, cell } => {
                let (position, normal) = kind.contact(obstacles, path, distance, radius);
                let remaining = path.direction * (path.length - distance);
                let cell = cell.map(|(columns, rows)| (column + columns, row + rows));
                return Some(Contact { position, normal, remaining, cell });
            }
        }
    }
}

/// The open cell that contains the centre of a circle.
struct OpenCell<'a, O> {
    obstacles: &'a O,
    column: i64,
    row: i64,
    radius: Radius,
}

/// The next event on a path.
struct PathEvent {
    /// The distance along the path.
    distance: f64,
    kind: PathEventKind,
}

enum PathEventKind {
    /// The centre crosses into a neighbouring open cell.
    Leave { columns: i64, rows: i64 },
    /// The circle touches something solid.
    Touch {
        kind: TouchKind,
        /// The cell of the obstacle, as an offset of columns and rows; `None` for another circle.
        cell: Option<(i64, i64)>,
    },
}

/// The part of an obstacle that a circle touches.
#[derive(Clone, Copy, Debug)]
enum TouchKind {
    /// A round part around this centre: a corner, a pillar, an end of a line, or another circle.
    Round(DVec2),
    /// A wall, or the side of a line. The circle's centre is at `position`, and `normal` points to
    /// it.
    Flat { position: DVec2, normal: DVec2 },
}

/// The side of an open cell that a path approaches along one axis.
struct CellSide {
    /// The cell behind the side, as an offset of columns and rows.
    neighbor: (i64, i64),
    /// Whether that cell is solid.
    is_wall: bool,
    /// The coordinate that the centre may reach along the axis in this cell.
    line: f64,
    /// The distance along the path.
    distance: f64,
}

impl<O: Obstacles> OpenCell<'_, O> {
    fn blocks(&self, columns: i64, rows: i64) -> bool {
        self.obstacles.blocks(self.column + columns, self.row + rows)
    }

    /// The first event among both sides ahead and all corners, shapes and circles. `None` for a
    /// path without a direction.
    fn next_event(&self, path: StraightPath) -> Option<PathEvent> {
        // Of two equal events, either will do: the other follows in the next cell, or on the slide.
        let sides = [self.event_along_y(path), self.event_along_x(path)];
        let events = sides.into_iter().flatten();
        let events = events.chain(self.corner_events(path)).chain(self.shape_events(path));
        let events = events.chain(self.circle_events(path));
        events.reduce(|first, next| if next.distance <= first.distance { next } else { first })
    }

    fn event_along_x(&self, path: StraightPath) -> Option<PathEvent> {
        let side = self.side(self.column, path.from.x, path.direction.x, (1, 0))?;
        let position = DVec2::new(side.line, path.at(side.distance).y);
        Some(side.event(position))
    }

    fn event_along_y(&self, path: StraightPath) -> Option<PathEvent> {
        let side = self.side(self.row, path.from.y, path.direction.y, (0, 1))?;
        let position = DVec2::new(path.at(side.distance).x, side.line);
        Some(side.event(position))
    }

    /// The side that a path approaches along `axis`, on which this cell has the index `index`.
    /// `None` if the path is perpendicular to the axis.
    fn side(&self, index: i64, from: f64, direction: f64, axis: (i64, i64)) -> Option<CellSide> {
        if direction == 0.0 {
            return None;
        }
        let step = if direction > 0.0 { 1 } else { -1 };
        let neighbor = (axis.0 * step, axis.1 * step);
        let is_wall = self.blocks(neighbor.0, neighbor.1);
        let border = (index + i64::from(step > 0)) as f64;
        let inset = if is_wall { self.radius.0 } else { 0.0 };
        let line = border - step as f64 * inset;
        Some(CellSide { neighbor, is_wall, line, distance: ((line - from) / direction).max(0.0) })
    }

    fn corner_events(&self, path: StraightPath) -> impl Iterator<Item = PathEvent> {
        let exposed = |(columns, rows): &(i64, i64)| {
            self.blocks(*columns, *rows) && !self.blocks(*columns, 0) && !self.blocks(0, *rows)
        };
        let event = move |(columns, rows): (i64, i64)| {
            let column = self.column + i64::from(columns > 0);
            let row = self.row + i64::from(rows > 0);
            let vertex = DVec2::new(column as f64, row as f64);
            let distance = distance_to_disc(path, vertex, self.radius.0)?;
            Some(PathEvent::touch(distance, TouchKind::Round(vertex), Some((columns, rows))))
        };
        [(-1, -1), (1, -1), (-1, 1), (1, 1)].into_iter().filter(exposed).filter_map(event)
    }

    fn circle_events(&self, path: StraightPath) -> impl Iterator<Item = PathEvent> {
        self.obstacles.circles().iter().filter_map(move |&center| {
            let distance = distance_to_disc(path, center, 2.0 * self.radius.0)?;
            Some(PathEvent::touch(distance, TouchKind::Round(center), None))
        })
    }

    fn shape_events(&self, path: StraightPath) -> impl Iterator<Item = PathEvent> {
        let around = (-1..=1).flat_map(|rows| (-1..=1).map(move |columns| (columns, rows)));
        around.filter_map(move |(columns, rows)| {
            let cell = cell_on_map(self.column + columns, self.row + rows)?;
            let outline = self.obstacles.outline(cell)?;
            let (distance, kind) = first_touch(outline, cell, path, self.radius)?;
            Some(PathEvent::touch(distance, kind, Some((columns, rows))))
        })
    }
}

impl CellSide {
    /// The event at this side, when the centre is at `position`.
    fn event(&self, position: DVec2) -> PathEvent {
        let (columns, rows) = self.neighbor;
        if self.is_wall {
            let normal = -DVec2::new(columns as f64, rows as f64);
            PathEvent::touch(
                self.distance,
                TouchKind::Flat { position, normal },
                Some(self.neighbor),
            )
        } else {
            PathEvent { distance: self.distance, kind: PathEventKind::Leave { columns, rows } }
        }
    }
}

impl PathEvent {
    fn touch(distance: f64, kind: TouchKind, cell: Option<(i64, i64)>) -> Self {
        Self { distance, kind: PathEventKind::Touch { kind, cell } }
    }
}

/// The distance along a path at which it enters a disc.
fn distance_to_disc(path: StraightPath, center: DVec2, radius: f64) -> Option<f64> {
    let offset = path.from - center;
    let closest = -path.direction.dot(offset);
    let miss = path.direction.perp_dot(offset).abs();
    if closest <= 0.0 || miss >= radius * (1.0 - GRAZE) {
        return None;
    }
    let half_chord = ((radius - miss) * (radius + miss)).sqrt();
    Some((closest - half_chord).max(0.0))
}

impl TouchKind {
    /// The position of a circle that touches this part at `distance` on its path, and the normal of
    /// the contact.
    fn contact<O: Obstacles>(
        self,
        obstacles: &O,
        path: StraightPath,
        distance: f64,
        radius: Radius,
    ) -> (DVec2, DVec2) {
        match self {
            Self::Flat { position, normal } if is_clear(obstacles, position, radius) => {
                (position, normal)
            }
            Self::Flat { normal, .. } => (path.last_clear(obstacles, distance, radius), normal),
            Self::Round(center) => {
                let position = path.last_clear(obstacles, distance, radius);
                let outward = position - center;
                (position, outward / outward.length())
            }
        }
    }
}

/// Whether a circle around `center` does not overlap an outline in `cell`. It may touch it.
fn is_clear_of_outline(
    outline: Outline,
    cell: Cell,
    center: DVec2,
    Radius(radius): Radius,
) -> bool {
    outline.distance(cell, center) >= radius
}

/// The first contact of a circle on `path` with an outline in `cell`, and its distance along the path.
fn first_touch(
    outline: Outline,
    cell: Cell,
    path: StraightPath,
    Radius(radius): Radius,
) -> Option<(f64, TouchKind)> {
    let round = |center: DVec2, radius: f64| {
        Some((distance_to_disc(path, center, radius)?, TouchKind::Round(center)))
    };
    match outline {
        Outline::Pillar(pillar) => round(cell.center(), radius + pillar.cells()),
        Outline::Line(line) => {
            let start = line.start(cell);
            let touches = [
                first_touch_of_side(line, start, path, radius),
                round(start, radius),
                round(start + line.stretch(), radius),
            ];
            touches.into_iter().flatten().min_by(|one, other| one.0.total_cmp(&other.0))
        }
    }
}

fn first_touch_of_side(
    line: Line,
    start: DVec2,
    path: StraightPath,
    radius: f64,
) -> Option<(f64, TouchKind)> {
    let stretch = line.stretch();
    let length = stretch.length();
    let normal = stretch.perp() / length;
    let offset = path.at(0.0) - start;
    let normal = if offset.dot(normal) < 0.0 { -normal } else { normal };
    let away = offset.dot(normal) - (radius + SKIN);
    let approach = -path.direction.dot(normal);
    if approach <= PARALLEL {
        return None;
    }
    let distance = (away / approach).max(0.0);
    let point = path.at(distance);
    let along = (point - start).dot(stretch) / length;
    // The centre is off by rounding, or because the path began inside the skin.
    let position = point + normal * (radius + SKIN - (point - start).dot(normal));
    let kind = TouchKind::Flat { position, normal };
    (0.0..=length).contains(&along).then_some((distance, kind))
}

#[cfg(test)]
mod tests;
