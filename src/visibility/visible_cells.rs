//! The cells in view: for each row of the map, an interval of columns.
//!
//! What is in view is the area between the camera and the ends of all rays. Its outline is followed once,
//! from end to end, and the interval of each row that it crosses grows to hold it. That takes as long as
//! the area is wide, however large the map is. The rectangle around it was refused: in view of a diagonal
//! corridor it holds everything on both sides of that. So was a list of the cells that rays enter: to
//! have each of them once takes a mark for every cell of the map.

use std::ops::Range;

use glam::DVec2;

use super::{Column, Scene};
use crate::world::{Thing, World};

/// What is seen is taken to be that much larger all around, in cells: more than rounding amounts to.
const HAIR: f64 = 1e-6;

/// Which things may be in view; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibleCells {
    /// How far beside what is seen the middle of a thing may be that reaches into it.
    margin: f64,
    /// How many rows the map has.
    row_count: u32,
    first_row: u32,
    intervals: Vec<Interval>,
    /// Whether all things are taken to be in view: there are so few that asking where takes longer.
    shows_all: bool,
}

/// What is seen of a row, and up to a margin above and below it.
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
    /// Takes in what the rays of `columns` show, from the camera to their ends.
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

    /// Takes all things of `world` to be in view, if they are few.
    pub(crate) fn shows_all_of(&mut self, world: &World) -> bool {
        const FEW: usize = 16;
        self.shows_all = world.things().len() <= FEW;
        self.shows_all
    }

    /// Forgets what was seen, and is ready to follow lines between two places from north to south.
    pub(crate) fn begin(&mut self, world: &World, north: f64, south: f64) {
        self.margin = world.widest_sprite() / 2.0 + HAIR;
        self.row_count = world.grid().height();
        let rows = self.reached(north, south, self.row_count);
        self.first_row = rows.start;
        self.intervals.clear();
        self.make_room(world);
        self.intervals.resize(rows.len(), Interval::NONE);
    }

    /// Needs no more memory after this, whatever is seen of `world`.
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

    /// Takes in what lies on the straight line between two places: corners of the outline, or the ends of
    /// what is seen along a ray.
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

    /// Which of `count` cells have their middle between `low` and `high`, or up to a margin beside.
    fn reached(&self, low: f64, high: f64, count: u32) -> Range<u32> {
        let first_from = |place: f64| (place - 0.5).ceil().clamp(0.0, f64::from(count)) as u32;
        first_from(low - self.margin)..first_from(high + self.margin)
    }
}

/// Where the rays of `columns` end, from left to right; those left out that end nowhere near the map.
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
        Billboard, DrawList, Filter, FramePlan, FrameSize, PixelAspect, Projection, flat,
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
            flat::find_columns(scene, (&Exact, world.grid()), memory, &mut list, &mut ());
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
