//! How far a circle moves along a straight path before it touches something.
//!
//! Its centre traverses the grid from cell to cell, so that the longest path costs at most the
//! columns and rows of the map. In each open cell the problem is small. A solid neighbour beside
//! the cell is a wall, moved inwards by the radius. A solid neighbour across a corner is a quarter
//! disc around that corner, unless a wall beside it covers the disc. Rounding every solid cell by
//! itself was refused: each joint of a straight wall would have a quarter disc, at which rounding
//! errors could stop the player.

use glam::DVec2;

use super::outline::{TouchKind, first_touch};
use super::{Obstacles, Radius, cell_of, cell_on_map, is_clear};

/// How deep a path enters a corner's disc, relative to the radius, before it counts as a contact. A
/// player who slides around a corner leaves it along the tangent, exact to about 1e-16.
const GRAZE: f64 = 1e-14;

/// A straight path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    from: DVec2,
    /// A unit vector.
    direction: DVec2,
    length: f64,
}

impl Path {
    /// The path from a position by a displacement; `None` if that is zero.
    pub(crate) fn new(from: DVec2, displacement: DVec2) -> Option<Self> {
        // Unlike the root of a sum of squares, this neither overflows nor underflows.
        let length = libm::hypot(displacement.x, displacement.y);
        (length > 0.0).then(|| Self { from, direction: displacement / length, length })
    }

    pub(crate) fn length(self) -> f64 {
        self.length
    }

    pub(crate) fn direction(self) -> DVec2 {
        self.direction
    }

    pub(crate) fn at(self, distance: f64) -> DVec2 {
        self.from + self.direction * distance
    }

    /// The position at `distance` along the path, or one shortly before it if a circle is not clear
    /// there. The path begins at a clear position, and is free of obstacles up to `distance` except
    /// for rounding.
    pub(crate) fn last_clear<O: Obstacles>(
        self,
        obstacles: &O,
        distance: f64,
        radius: Radius,
    ) -> DVec2 {
        let retreats = std::iter::successors(Some(f64::EPSILON), |retreat| Some(2.0 * retreat));
        std::iter::once(distance)
            .chain(retreats.map(|retreat| distance - retreat))
            .take_while(|&distance| distance > 0.0)
            .map(|distance| self.at(distance))
            .find(|&center| is_clear(obstacles, center, radius))
            .unwrap_or(self.from)
    }
}

/// The first contact between a circle on a path and something solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// The position of the circle's centre, which is clear.
    pub(crate) position: DVec2,
    /// The unit vector from the obstacle to the centre.
    pub(crate) normal: DVec2,
    /// The rest of the displacement.
    pub(crate) remaining: DVec2,
    /// The column and the row of the obstacle; `None` for another circle.
    pub(crate) cell: Option<(i64, i64)>,
}

/// The first contact of a circle on `path`, if there is one.
pub(crate) fn first_contact<O: Obstacles>(
    obstacles: &O,
    path: Path,
    radius: Radius,
) -> Option<Contact> {
    let (mut column, mut row) = cell_of(path.from);
    loop {
        let room = Room { obstacles, column, row, radius };
        let Event { distance, kind } = room.next_event(path)?;
        if distance > path.length {
            return None;
        }
        match kind {
            EventKind::Leave { columns, rows } => {
                column += columns;
                row += rows;
            }
            EventKind::Touch(obstacle) => {
                let (position, normal) = obstacle.touched(obstacles, path, distance, radius);
                let remaining = path.direction * (path.length - distance);
                let cell = obstacle.cell().map(|(columns, rows)| (column + columns, row + rows));
                return Some(Contact { position, normal, remaining, cell });
            }
        }
    }
}

/// An open cell around the centre of a circle.
struct Room<'a, O> {
    obstacles: &'a O,
    column: i64,
    row: i64,
    radius: Radius,
}

/// The next event on a path.
struct Event {
    /// The distance along the path.
    distance: f64,
    kind: EventKind,
}

enum EventKind {
    /// The centre crosses into a neighbouring open cell.
    Leave { columns: i64, rows: i64 },
    /// The circle touches something solid.
    Touch(Obstacle),
}

enum Obstacle {
    /// A flat wall, touched from `position`.
    Wall { position: DVec2, normal: DVec2 },
    /// The corner of a solid cell at an offset of columns and rows.
    Corner { vertex: DVec2, cell: (i64, i64) },
    /// Another circle of the same radius.
    Circle { center: DVec2 },
    /// The shape in a cell at an offset of columns and rows.
    Shape { touch: TouchKind, cell: (i64, i64) },
}

/// The side of a room that a path approaches along one axis.
struct Side {
    /// The cell behind it, as an offset of columns and rows.
    neighbor: (i64, i64),
    /// Whether that cell is solid.
    is_wall: bool,
    /// How far the centre may go along the axis in this room.
    line: f64,
    /// The distance along the path.
    distance: f64,
}

impl<O: Obstacles> Room<'_, O> {
    fn blocks(&self, columns: i64, rows: i64) -> bool {
        self.obstacles.blocks(self.column + columns, self.row + rows)
    }

    /// The first of: either side ahead, any corner, shape or circle. `None` for a path without a
    /// direction.
    fn next_event(&self, path: Path) -> Option<Event> {
        // Of two equal events either will do: the other follows in the next room, or on the slide.
        let sides = [self.event_along_y(path), self.event_along_x(path)];
        let events = sides.into_iter().flatten();
        let events = events.chain(self.corner_events(path)).chain(self.shape_events(path));
        let events = events.chain(self.circle_events(path));
        events.reduce(|first, next| if next.distance <= first.distance { next } else { first })
    }

    fn event_along_x(&self, path: Path) -> Option<Event> {
        let side = self.side(self.column, path.from.x, path.direction.x, (1, 0))?;
        let position = DVec2::new(side.line, path.at(side.distance).y);
        Some(side.event(position))
    }

    fn event_along_y(&self, path: Path) -> Option<Event> {
        let side = self.side(self.row, path.from.y, path.direction.y, (0, 1))?;
        let position = DVec2::new(path.at(side.distance).x, side.line);
        Some(side.event(position))
    }

    /// The side that a path approaches along `axis`, on which this room is the cell `index`; `None`
    /// if the path is perpendicular to the axis.
    fn side(&self, index: i64, from: f64, direction: f64, axis: (i64, i64)) -> Option<Side> {
        if direction == 0.0 {
            return None;
        }
        let step = if direction > 0.0 { 1 } else { -1 };
        let neighbor = (axis.0 * step, axis.1 * step);
        let is_wall = self.blocks(neighbor.0, neighbor.1);
        let border = (index + i64::from(step > 0)) as f64;
        let inset = if is_wall { self.radius.0 } else { 0.0 };
        let line = border - step as f64 * inset;
        Some(Side { neighbor, is_wall, line, distance: ((line - from) / direction).max(0.0) })
    }

    fn corner_events(&self, path: Path) -> impl Iterator<Item = Event> {
        let exposed = |(columns, rows): &(i64, i64)| {
            self.blocks(*columns, *rows) && !self.blocks(*columns, 0) && !self.blocks(0, *rows)
        };
        let event = move |(columns, rows): (i64, i64)| {
            let column = self.column + i64::from(columns > 0);
            let row = self.row + i64::from(rows > 0);
            let vertex = DVec2::new(column as f64, row as f64);
            let distance = distance_to_disc(path, vertex, self.radius.0)?;
            let corner = Obstacle::Corner { vertex, cell: (columns, rows) };
            Some(Event { distance, kind: EventKind::Touch(corner) })
        };
        [(-1, -1), (1, -1), (-1, 1), (1, 1)].into_iter().filter(exposed).filter_map(event)
    }

    fn circle_events(&self, path: Path) -> impl Iterator<Item = Event> {
        self.obstacles.circles().iter().filter_map(move |&center| {
            let distance = distance_to_disc(path, center, 2.0 * self.radius.0)?;
            Some(Event { distance, kind: EventKind::Touch(Obstacle::Circle { center }) })
        })
    }

    fn shape_events(&self, path: Path) -> impl Iterator<Item = Event> {
        let around = (-1..=1).flat_map(|rows| (-1..=1).map(move |columns| (columns, rows)));
        around.filter_map(move |(columns, rows)| {
            let cell = cell_on_map(self.column + columns, self.row + rows)?;
            let outline = self.obstacles.outline(cell)?;
            let touch = first_touch(outline, cell, path, self.radius)?;
            let shape = Obstacle::Shape { touch: touch.kind, cell: (columns, rows) };
            Some(Event { distance: touch.distance, kind: EventKind::Touch(shape) })
        })
    }
}

impl Side {
    /// The event at this side, for a centre that is then at `position`.
    fn event(&self, position: DVec2) -> Event {
        let (columns, rows) = self.neighbor;
        let kind = if self.is_wall {
            let normal = -DVec2::new(columns as f64, rows as f64);
            EventKind::Touch(Obstacle::Wall { position, normal })
        } else {
            EventKind::Leave { columns, rows }
        };
        Event { distance: self.distance, kind }
    }
}

/// The distance along a path at which it enters a disc.
pub(crate) fn distance_to_disc(path: Path, center: DVec2, radius: f64) -> Option<f64> {
    let offset = path.from - center;
    let closest = -path.direction.dot(offset);
    let miss = path.direction.perp_dot(offset).abs();
    if closest <= 0.0 || miss >= radius * (1.0 - GRAZE) {
        return None;
    }
    let half_chord = ((radius - miss) * (radius + miss)).sqrt();
    Some((closest - half_chord).max(0.0))
}

impl Obstacle {
    /// The obstacle's cell, as an offset of columns and rows from that of the centre.
    fn cell(&self) -> Option<(i64, i64)> {
        match *self {
            Self::Wall { normal, .. } => Some((-normal.x as i64, -normal.y as i64)),
            Self::Corner { cell, .. } | Self::Shape { cell, .. } => Some(cell),
            Self::Circle { .. } => None,
        }
    }

    /// The position of a circle that touches this at `distance` on its path, and the normal of the
    /// contact.
    fn touched<O: Obstacles>(
        &self,
        obstacles: &O,
        path: Path,
        distance: f64,
        radius: Radius,
    ) -> (DVec2, DVec2) {
        match *self {
            Self::Wall { position, normal } if is_clear(obstacles, position, radius) => {
                (position, normal)
            }
            Self::Wall { normal, .. } => (path.last_clear(obstacles, distance, radius), normal),
            Self::Shape { touch: TouchKind::Flat { position, normal }, .. } => {
                if is_clear(obstacles, position, radius) {
                    (position, normal)
                } else {
                    (path.last_clear(obstacles, distance, radius), normal)
                }
            }
            Self::Corner { vertex, .. }
            | Self::Circle { center: vertex }
            | Self::Shape { touch: TouchKind::Round(vertex), .. } => {
                let position = path.last_clear(obstacles, distance, radius);
                let outward = position - vertex;
                (position, outward / outward.length())
            }
        }
    }
}

#[cfg(test)]
mod tests;
