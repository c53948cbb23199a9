//! The part of the map that a picture shows: for each row of cells, the stretch of it.
//!
//! What is seen is the area between the camera and the ends of all rays. Its outline is followed once,
//! from end to end, and in each row that it crosses the stretch grows to hold it. That is as long as
//! what is seen is wide, and no longer the larger the map is. The rectangle around it was refused: in
//! view of a diagonal corridor it holds everything on both sides of that. So was a list of the cells
//! that rays enter: to have each of them once takes a mark for every cell of the map.

use std::ops::Range;

use glam::DVec2;

use super::Scene;
use crate::render::Column;
use crate::world::{Thing, World};

/// What is seen is taken to be that much larger all around, in cells: more than rounding amounts to.
const HAIR: f64 = 1e-6;

/// Which things may be in view; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(in crate::render) struct Sight {
    /// How far beside what is seen the middle of a thing may be that reaches into it.
    margin: f64,
    /// How many rows the map has.
    row_count: u32,
    first_row: u32,
    stretches: Vec<Stretch>,
}

/// What is seen of a row, and up to a margin above and below it.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    low: f64,
    high: f64,
}

impl Stretch {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn include(&mut self, x: f64) {
        *self = Self { low: self.low.min(x), high: self.high.max(x) };
    }
}

impl Sight {
    /// Finds out what the rays of `scene` show.
    pub(super) fn look(&mut self, scene: Scene<'_>) {
        let origin = scene.projection.origin();
        let span = |(low, high): (f64, f64), end: DVec2| (low.min(end.y), high.max(end.y));
        let (low, high) = ends(scene).fold((origin.y, origin.y), span);
        self.begin(scene.world, low, high);
        let corners = ends(scene).chain([origin]);
        corners.fold(origin, |one, other| {
            self.follow(one, other);
            other
        });
    }

    /// Forgets what was seen, and is ready to follow lines between two places from north to south.
    pub(in crate::render) fn begin(&mut self, world: &World, north: f64, south: f64) {
        self.margin = world.widest_sprite() / 2.0 + HAIR;
        self.row_count = world.grid().height();
        let rows = self.reached(north, south, self.row_count);
        self.first_row = rows.start;
        self.stretches.clear();
        self.make_room(world);
        self.stretches.resize(rows.len(), Stretch::NONE);
    }

    /// Needs no more memory after this, whatever is seen of `world`.
    pub(in crate::render) fn make_room(&mut self, world: &World) {
        let missing = (world.grid().height() as usize).saturating_sub(self.stretches.len());
        self.stretches.reserve(missing);
    }

    /// The things of which a part may be in view, row by row.
    pub(in crate::render) fn things<'a>(
        &self,
        world: &'a World,
    ) -> impl Iterator<Item = &'a Thing> {
        let width = world.grid().width();
        let rows = (self.first_row..).zip(&self.stretches);
        let reached =
            rows.map(move |(row, stretch)| (row, self.reached(stretch.low, stretch.high, width)));
        let reached = reached.filter(|(_, columns)| !columns.is_empty());
        reached.flat_map(|(row, columns)| world.things_between(row, columns.start, columns.end - 1))
    }

    /// Takes in what lies on the straight line between two places: corners of the outline, or the ends of
    /// what is seen along a ray.
    pub(in crate::render) fn follow(&mut self, one: DVec2, other: DVec2) {
        let (top, bottom) = if one.y <= other.y { (one, other) } else { (other, one) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let x_at = |y: f64| top.x + (y - top.y) * slope;
        for row in self.reached(top.y, bottom.y, self.row_count) {
            let middle = f64::from(row) + 0.5;
            let (from, to) = (middle - self.margin, middle + self.margin);
            let stretch = &mut self.stretches[(row - self.first_row) as usize];
            stretch.include(if from <= top.y { top.x } else { x_at(from) });
            stretch.include(if to >= bottom.y { bottom.x } else { x_at(to) });
        }
    }

    /// Which of `count` cells have their middle between `low` and `high`, or up to a margin beside.
    fn reached(&self, low: f64, high: f64, count: u32) -> Range<u32> {
        let first_from = |place: f64| (place - 0.5).ceil().clamp(0.0, f64::from(count)) as u32;
        first_from(low - self.margin)..first_from(high + self.margin)
    }
}

/// Where the rays end, from left to right; those left out that end nowhere near the map.
fn ends(scene: Scene<'_>) -> impl Iterator<Item = DVec2> {
    let Scene { projection, columns, .. } = scene;
    let end = |(x, column): (u32, &Column)| {
        projection.origin() + projection.direction_of(x) * column.distance
    };
    (0..).zip(columns).map(end).filter(|end| end.is_finite())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::super::Billboard;
    use super::*;
    use crate::cast::Exact;
    use crate::map;
    use crate::render::see_through::Passed;
    use crate::render::{Filter, FrameSize, PixelAspect, Projection, columns};
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
            let projection = &Projection::new(&camera, size, PixelAspect::SQUARE);
            let (mut columns, mut passed) = (Vec::new(), Passed::default());
            columns::cast(&Exact, world, projection, &mut columns, &mut passed);
            let scene = Scene { world, projection, columns: &columns, filter: Filter::Mip };

            let mut sight = Sight::default();
            sight.look(scene);
            let considered: Vec<_> = sight.things(world).map(place).collect();
            prop_assert!(considered.is_sorted_by(|one, other| one < other), "each of them once");
            let considered: BTreeSet<_> = considered.into_iter().collect();
            for thing in world.things() {
                let is_in_view = Billboard::new(scene, *thing).is_some();
                prop_assert!(!is_in_view || considered.contains(&place(thing)), "{thing:?}");
            }
        }
    }
}
