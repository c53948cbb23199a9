//! The fan: the rays of a picture, for which every solid tile is a wall.
//!
//! Few of them are cast. Between two rays that hit the same face, all rays hit that face: a solid cell between them
//! would be at least as wide as the face and nearer, and one of the two would hit it. So rays are cast where a face
//! ends: at the first column beyond it, then at its last one. Rejected: halving the picture, and each half. At
//! 80×48 pixels it casts 33 rays where this casts 15.
//!
//! Two rays may also hit neighbouring faces of one wall, each a cell wide. Then the rays between them hit
//! these two faces, if no cell fits between the two rays: a cell nearer than the wall is at least one cell
//! nearer, where the rays are less than one cell apart if they are less than D / (D − 1) cells apart at the
//! wall, D cells from the eye. The corner between the faces tells which ray hits which.

use glam::DVec2;

use super::column_of;
use crate::cast::{Caster, Hit, HitFace};
use crate::visibility::{Column, Projection};
use crate::world::Grid;

/// The rays of a picture.
pub(crate) struct Fan<'a, C> {
    caster: &'a C,
    grid: &'a Grid,
    projection: &'a Projection,
}

/// Two rays with known hits, and the columns from the first to the second.
struct Gap<'a> {
    projection: &'a Projection,
    hits: [&'a Hit; 2],
    faces: [HitFace; 2],
    first: usize,
    /// The number of columns from the first ray to the second.
    width: usize,
}

/// What to do with the rays of a gap. Columns are counted from that of the first ray.
enum Step {
    /// Those before this column hit the first face, and the others the second one.
    Split(usize),
    /// The ray of this column is to be cast.
    Cast(usize),
}

/// A corner whose position is less than this from the centre of a pixel is as good as on it, in columns.
const EPSILON: f64 = 1e-6;

impl<'a, C: Caster> Fan<'a, C> {
    pub(crate) fn new(caster: &'a C, grid: &'a Grid, projection: &'a Projection) -> Self {
        Self { caster, grid, projection }
    }

    /// Finds all `columns`.
    pub(crate) fn cast(&self, columns: &mut [Column]) {
        let last = columns.len() - 1;
        for index in [0, last].into_iter().take(columns.len()) {
            columns[index] = self.cast_one(index);
        }
        self.cast_between(columns, 0);
    }

    /// Casts the rays of all `columns` except the first and the last, which are known. `first` is
    /// the index of the first.
    fn cast_between(&self, mut columns: &mut [Column], mut first: usize) {
        while let [left, between @ .., right] = &mut *columns
            && !between.is_empty()
        {
            let width = between.len() + 1;
            let mut next = width / 2;
            if self.caster.is_exact()
                && let (Some(left), Some(right)) = (&left.hit, &right.hit)
            {
                let gap = Gap::new(self.projection, [left, right], first, width);
                match gap.step() {
                    Step::Split(split) => {
                        let (of_left, of_right) = between.split_at_mut(split - 1);
                        self.enter(&gap.faces[0], of_left, first + 1);
                        self.enter(&gap.faces[1], of_right, first + split);
                        return;
                    }
                    Step::Cast(column) => next = column,
                }
            }
            columns[next] = self.cast_one(first + next);
            // The smaller part by recursion, so that it is not deep.
            if next < width / 2 {
                self.cast_between(&mut columns[..=next], first);
                columns = &mut columns[next..];
                first += next;
            } else {
                self.cast_between(&mut columns[next..], first + next);
                columns = &mut columns[..=next];
            }
        }
    }

    /// Sets `columns`, of which `first` is the index of the first: their rays enter a cell by `face`.
    fn enter(&self, face: &HitFace, columns: &mut [Column], first: usize) {
        for (index, column) in (first as u32..).zip(columns) {
            let hit = face.enter(&self.projection.ray(index));
            let rows = self.projection.wall_rows(hit.t);
            *column = Column { distance: hit.t, rows, hit: Some(hit) };
        }
    }

    fn cast_one(&self, index: usize) -> Column {
        let ray = self.projection.ray(index as u32);
        column_of(self.grid, self.projection, &ray, self.caster.cast(self.grid, &ray))
    }
}

impl<'a> Gap<'a> {
    fn new(projection: &'a Projection, hits: [&'a Hit; 2], first: usize, width: usize) -> Self {
        let faces = hits.map(|hit| hit.face(projection.origin()));
        Self { projection, hits, faces, first, width }
    }

    /// What to do with the rays between both: which of them follow from the two, or which to cast.
    fn step(&self) -> Step {
        let [left, right] = &self.faces;
        let (width, last) = (self.width, self.width - 1);
        if left.is(right) {
            return Step::Split(width);
        }
        // The face on the left ends before this column.
        let end_of_left = self.column_of(left.right_end()).unwrap_or(f64::INFINITY);
        let beyond_left = self.first_column_from(end_of_left);
        if (1..=width).contains(&beyond_left) {
            let is_clear = |column: usize| (end_of_left - column as f64).abs() > EPSILON;
            let are_known = left.is_beside(right)
                && is_clear(beyond_left - 1)
                && is_clear(beyond_left)
                && self.has_no_room_for_a_cell();
            return if are_known {
                Step::Split(beyond_left)
            } else {
                Step::Cast(beyond_left.min(last))
            };
        }
        if beyond_left == 0 {
            return Step::Cast(1);
        }
        // The face on the right, or another one, is in front.
        let start_of_right = self.column_of(right.left_end()).unwrap_or(0.0);
        let first_of_right = self.first_column_from(start_of_right);
        Step::Cast(if first_of_right == 0 {
            width / 2
        } else {
            (first_of_right - 1).clamp(1, last)
        })
    }

    /// Whether no cell in front of the line of both faces fits between the rays.
    fn has_no_room_for_a_cell(&self) -> bool {
        let Self { projection, hits: [left, right], first, width, .. } = *self;
        let place = |column: usize, hit: &Hit| projection.ray(column as u32).at(hit.t);
        let apart = (place(first, left) - place(first + width, right)).abs().max_element();
        let to_line = self.faces[0].distance_to_line(projection.origin());
        // Rounding is far less than a hundredth.
        apart * (to_line - 1.0) < 0.99 * to_line
    }

    /// The position of `point` in columns from that of the first ray, where integers are the centres of
    /// columns; `None` if it is behind the camera.
    fn column_of(&self, point: DVec2) -> Option<f64> {
        let place = self.projection.place(point);
        (place.depth > 0.0).then_some(place.column - 0.5 - self.first as f64)
    }

    /// The first column whose centre is not before `position`; one after the second ray for all further
    /// ones.
    fn first_column_from(&self, position: f64) -> usize {
        let position = position.max(0.0).min(self.width as f64 + 1.0);
        // On old processors `f64::ceil` is a call.
        let column = position as u32;
        column as usize + usize::from(f64::from(column) < position)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::num::NonZero;

    use super::*;
    use crate::cast::{Exact, Ray};
    use crate::visibility::{FrameSize, PixelAspect};
    use crate::world::{Camera, FieldOfView, Heading};

    struct Counted(Cell<usize>);

    impl Caster for Counted {
        fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
            self.0.update(|rays| rays + 1);
            Exact.cast(grid, ray)
        }

        fn is_exact(&self) -> bool {
            true
        }
    }

    /// The number of rays for a picture of `grid`, and the number of faces in it.
    fn rays_and_faces(grid: &Grid, degrees: f64) -> (usize, usize) {
        let size =
            FrameSize { width: NonZero::new(640).unwrap(), height: NonZero::new(9).unwrap() };
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(DVec2::new(4.3, 4.6), heading, FieldOfView::default()).unwrap();
        let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
        let mut columns = vec![Column::UNKNOWN; projection.columns()];
        let caster = Counted(Cell::new(0));
        Fan::new(&caster, grid, &projection).cast(&mut columns);
        let hits = || columns.iter().map(|column| column.hit.as_ref().unwrap());
        let faces = hits().zip(hits().skip(1));
        let ends = faces.filter(|(one, other)| (one.cell, one.side) != (other.cell, other.side));
        (caster.0.get(), 1 + ends.count())
    }

    #[test]
    fn a_face_costs_two_rays_at_most() {
        let rooms = [
            ["#########", "#.......#", "#.......#", "#.......#", "#.......#", "#########"]
                .as_slice(),
            &[
                "##########",
                "#........#",
                "#.#...#..#",
                "#........#",
                "#........#",
                "#..#...#.#",
                "##########",
            ],
        ];
        for rows in rooms {
            let grid = Grid::sketch(rows).unwrap();
            for degrees in (0..360).step_by(7) {
                let (rays, faces) = rays_and_faces(&grid, f64::from(degrees));
                assert!(rays <= 2 * faces, "{rays} rays for {faces} faces at {degrees}°");
            }
        }
    }

    #[test]
    fn neighbouring_faces_of_a_near_wall_cost_one_ray_each() {
        let grid = Grid::sketch(&[
            "#########",
            "#.......#",
            "#.......#",
            "#.......#",
            "#.......#",
            "#########",
        ]);
        let (rays, faces) = rays_and_faces(&grid.unwrap(), 270.0);
        assert!(faces >= 5 && rays <= faces + 1, "{rays} rays for {faces} faces");
    }
}
