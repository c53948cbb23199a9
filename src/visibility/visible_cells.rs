//! The cells in view: an interval of columns for each row of the map.
//!
//! The visible area is between the camera and the ends of all rays. Its outline is followed once,
//! and the interval of each row that it crosses is extended to contain it. The time depends on the
//! size of the area and not on the size of the map.
//!
//! Rejected: the bounding rectangle, which contains everything on both sides of a diagonal
//! corridor; and a list of the cells that rays enter, since listing each once needs a mark for
//! every cell of the map.

use std::ops::Range;

use glam::DVec2;

use super::{Column, Scene};
use crate::world::{Thing, World};

/// The margin around the visible area, in cells: more than the rounding error.
const EPSILON: f64 = 1e-6;

/// The things that may be in view, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleCells {
    /// The greatest distance from the visible area to the middle of a thing that extends into it.
    margin: f64,
    /// The number of rows of the map.
    row_count: u32,
    first_row: u32,
    intervals: Vec<Interval>,
    /// Whether all things count as visible: they are so few that a lookup by cell takes longer.
    shows_all: bool,
}

/// The visible part of a row, and of a margin above and below it.
#[derive(Clone, Copy, Debug)]
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn include(&mut self, x: f64) {
        *self = Self { low: self.low.min(x), high: self.high.max(x) };
    }
}

impl VisibleCells {
    /// Includes the area that the rays of `columns` cross, from the camera to their ends.
    pub(crate) fn outline(&mut self, scene: Scene<'_>, columns: &[Column]) {
        if self.shows_all_of(scene.world) {
            return;
        }
        let origin = scene.projection.origin();
        let ends = || ends(scene, columns);
        let span = |(low, high): (f64, f64), end: DVec2| (low.min(end.y), high.max(end.y));
        let (low, high) = ends().fold((origin.y, origin.y), span);
        self.begin(scene.world, low, high);
        ends().chain([origin]).fold(origin, |one, other| {
            self.follow(one, other);
            other
        });
    }

    /// Makes all things of `world` count as visible, if they are few. Returns whether they do.
    pub(crate) fn shows_all_of(&mut self, world: &World) -> bool {
        const FEW: usize = 16;
        self.shows_all = world.things().len() <= FEW;
        self.shows_all
    }

    /// Removes all intervals, and prepares for lines between `north` and `south`.
    pub(crate) fn begin(&mut self, world: &World, north: f64, south: f64) {
        self.margin = world.widest_sprite() / 2.0 + EPSILON;
        self.row_count = world.grid().height();
        let rows = self.reached(north, south, self.row_count);
        self.first_row = rows.start;
        self.intervals.clear();
        self.make_room(world);
        self.intervals.resize(rows.len(), Interval::NONE);
    }

    /// Reserves memory for any view of `world`.
    pub(crate) fn make_room(&mut self, world: &World) {
        let missing = (world.grid().height() as usize).saturating_sub(self.intervals.len());
        self.intervals.reserve(missing);
    }

    /// The things of which a part may be in view, row by row.
    pub(crate) fn things<'a>(&self, world: &'a World) -> impl Iterator<Item = &'a Thing> {
        let all: &[Thing] = if self.shows_all { world.things() } else { &[] };
        let intervals: &[Interval] = if self.shows_all { &[] } else { &self.intervals };
        let width = world.grid().width();
        let rows = (self.first_row..).zip(intervals);
        let reached = rows
            .map(move |(row, interval)| (row, self.reached(interval.low, interval.high, width)));
        let reached = reached.filter(|(_, columns)| !columns.is_empty());
        let reached = reached
            .flat_map(|(row, columns)| world.things_between(row, columns.start, columns.end - 1));
        all.iter().chain(reached)
    }

    /// Includes the straight line between two points: corners of the outline, or the ends of the
    /// visible part of a ray.
    pub(crate) fn follow(&mut self, one: DVec2, other: DVec2) {
        let (top, bottom) = if one.y <= other.y { (one, other) } else { (other, one) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let x_at = |y: f64| top.x + (y - top.y) * slope;
        for row in self.reached(top.y, bottom.y, self.row_count) {
            let middle = f64::from(row) + 0.5;
            let (from, to) = (middle - self.margin, middle + self.margin);
            let interval = &mut self.intervals[(row - self.first_row) as usize];
            interval.include(if from <= top.y { top.x } else { x_at(from) });
            interval.include(if to >= bottom.y { bottom.x } else { x_at(to) });
        }
    }

    /// The indices of the cells, of `count`, whose middle is between `low` and `high` or within the
    /// margin.
    fn reached(&self, low: f64, high: f64, count: u32) -> Range<u32> {
        // Rounding up is a function call on older processors.
        let first_from = |place: f64| {
            let place = (place - 0.5).clamp(0.0, f64::from(count));
            let below = place as u32;
            below + u32::from(f64::from(below) < place)
        };
        first_from(low - self.margin)..first_from(high + self.margin)
    }
}

/// The ends of the rays of `columns`, from left to right, except those nowhere near the map.
fn ends(scene: Scene<'_>, columns: &[Column]) -> impl Iterator<Item = DVec2> {
    let projection = scene.projection;
    let end = |(x, column): (u32, &Column)| {
        projection.origin() + projection.direction_of(x) * column.distance
    };
    (0..).zip(columns).map(end).filter(|end| end.is_finite())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::cast::{Exact, MirrorTransform};
    use crate::map;
    use crate::visibility::flat::FlatMemory;
    use crate::visibility::{
        Billboard, DrawList, Filter, FramePlan, FrameSize, PixelAspect, Projection, Stats, flat,
    };
    use crate::world::{Camera, FieldOfView, Heading};

    const SIDE: usize = 16;

    /// A map of walls and plants, some of them so high that they are wider than a cell.
    fn world(cells: &[char]) -> World {
        let rows: String =
            cells.chunks(SIDE).map(|row| row.iter().collect::<String>() + "\n").collect();
        let text = format!(
            "grid = '''\n{}'''\ntiles.'#'.wall = 'brick'\n[things]\n'@' = {{ start = 0 }}\n\
             'p' = {{ sprite = 'plant' }}\n'P' = {{ sprite = 'table', height = 3 }}\n",
            rows.replacen('.', "@", 1)
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
    }

    fn place(thing: &Thing) -> (u32, u32) {
        (thing.cell.row, thing.cell.column)
    }

    proptest! {
        #[test]
        fn nothing_in_view_is_left_out(
            cells in prop::collection::vec(
                prop::sample::select(&['.', '.', 'p', 'p', 'p', 'P', '#'][..]),
                SIDE * SIDE,
            ),
            position in (-6.0..22.0, -6.0..22.0),
            degrees in prop_oneof![0.0..360.0, prop::sample::select(&[0.0, 45.0, 90.0, 270.0][..])],
            field_of_view in prop_oneof![Just(66.0), 1.0..179.0],
        ) {
            prop_assume!(cells.contains(&'.'));
            let world = &world(&cells);
            let camera = Camera::new(
                position.into(),
                Heading::from_degrees(degrees).unwrap(),
                FieldOfView::from_degrees(field_of_view).unwrap(),
            )
            .unwrap();
            let size = FrameSize::new(40, 24).unwrap();
            let plan = &FramePlan::new(world, &camera, Filter::Mip);
            let projection = &Projection::new(&camera, size, PixelAspect::SQUARE);
            let scene = Scene { world, camera: &camera, seconds: 0.0, projection, plan };
            let mut list = DrawList::default();
            let memory = &mut FlatMemory::default();
            flat::find_columns(scene, (&Exact, world.grid()), memory, &mut list, &mut Stats::default());
            let columns = &list.columns;

            let mut visible = VisibleCells::default();
            visible.outline(scene, columns);
            let considered: Vec<_> = visible.things(world).map(place).collect();
            prop_assert!(considered.is_sorted_by(|one, other| one < other), "each of them once");
            let considered: BTreeSet<_> = considered.into_iter().collect();
            for thing in world.things() {
                let billboard = Billboard::of_thing(scene, MirrorTransform::default(), *thing);
                let is_in_view = billboard.is_some_and(|it| {
                    it.columns.clone().any(|x| it.depth < columns[x as usize].distance)
                });
                prop_assert!(!is_in_view || considered.contains(&place(thing)), "{thing:?}");
            }
        }
    }
}
