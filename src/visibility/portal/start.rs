//! Starts: the columns that the portal way fills, and where their rays begin.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::bundle::{Bundle, Clip, Surroundings};
use super::tile_gaps::{GapId, Place};
use super::walk::BundleWalk;
use crate::cast::{Course, Hit};
use crate::visibility::face_column::place_before;
use crate::visibility::runs::{ImageId, Shown};
use crate::visibility::{Column, PortalStats};
use crate::world::TileId;

/// The start of the portal way in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PortalStart {
    /// At the camera, with all rows.
    Camera,
    /// Where the ray has crossed the first line into a cell that is not level, with the rows of the column.
    Line,
    /// The same, with the rows above those, too.
    LineUnderSky,
}

impl PortalStart {
    /// The rows that the portal way fills in `column` of a picture of this `height`.
    pub(crate) fn rows(self, column: &Column, height: u32) -> Range<u32> {
        match self {
            Self::Camera => 0..height,
            Self::Line => column.rows.clone(),
            Self::LineUnderSky => 0..column.rows.end,
        }
    }
}

impl BundleWalk<'_> {
    /// Follows the ray of each column that has one of `starts`.
    pub(crate) fn follow_all(&mut self, starts: &[Option<PortalStart>]) {
        let fans_out = self.surroundings.scene.projection.fans_out();
        let mut first = 0;
        while first < starts.len() {
            let is_next = |&column: &usize| !(fans_out && self.are_together(starts, column));
            let end = (first + 1..starts.len()).find(is_next).unwrap_or(starts.len());
            if let Some(start) = starts[first] {
                self.follow_together(first..end, start);
            }
            first = end;
        }
    }

    /// Whether the ray of `column` begins in one bundle with that of the column before it.
    fn are_together(&self, starts: &[Option<PortalStart>], column: usize) -> bool {
        let columns = [column - 1, column];
        let [before, start] = columns.map(|column| starts[column]);
        let are_alike = before == start
            && match start {
                None => return true,
                Some(PortalStart::Camera) => true,
                Some(PortalStart::Line | PortalStart::LineUnderSky) => {
                    let [one, other] = columns.map(|column| {
                        let hit = self.list.columns[column].hit.as_ref();
                        hit.map(|hit| (hit.cell, hit.side))
                    });
                    one == other
                }
            };
        let [one, other] = columns.map(|column| {
            let DVec2 { x, y } = self.memory.directions[column];
            [x > 0.0, x < 0.0, y > 0.0, y < 0.0]
        });
        are_alike && one == other
    }

    /// Follows the rays of `columns`, which begin together at `start`.
    fn follow_together(&mut self, columns: Range<usize>, start: PortalStart) {
        let PortalStats { rays, .. } = &mut self.memory.stats;
        *rays += columns.len() as u64;
        self.memory.clips.clear();
        let of_bundle = columns.start as u32..columns.end as u32;
        if start == PortalStart::Camera {
            self.start_at_camera(of_bundle);
        } else {
            self.start_at_line(of_bundle, start);
        }
        self.follow_stored();
        let projection = self.surroundings.scene.projection;
        for column in &mut self.list.columns[columns] {
            let row_of = |height| projection.row_of_height(height, column.distance);
            column.rows = row_of(1.0)..row_of(0.0);
        }
    }

    /// Stores the rays of `columns` for later, from the line on that all of them have hit.
    fn start_at_line(&mut self, columns: Range<u32>, start: PortalStart) {
        let &Surroundings { scene, gaps, .. } = self.surroundings;
        let height = scene.projection.rows();
        let Some(hit) = self.list.columns[columns.start as usize].hit else { return };
        for column in columns.clone() {
            let of_column = &mut self.list.columns[column as usize];
            let known = mem::replace(of_column, Column::UNKNOWN);
            let Some(Hit { t, .. }) = known.hit else { return };
            of_column.distance = t;
            let rows = start.rows(&known, height);
            self.list.runs.show(column, 0..rows.start, Shown::Flat);
            self.list.runs.show(column, rows.end..height, Shown::Flat);
            self.memory.clips.push(Clip { rows, from: t, start: t });
            self.memory.distances[column as usize] = t;
        }
        let (grid, ray) = (scene.world.grid(), self.ray(columns.start));
        let (course, crossed) = Course::entering(grid, &ray, (hit.cell, hit.side));
        let place = place_before(grid, ray.direction(), &hit);
        let Some(gap) = gaps.of(place).next() else { return };
        let mut bundle = first_bundle(course, place, gap, columns);
        if self.cross_line(&mut bundle, &crossed) {
            self.store(bundle);
        }
    }

    /// Stores the rays of `columns` for later, from the camera on.
    fn start_at_camera(&mut self, columns: Range<u32>) {
        let &Surroundings { scene, gaps, .. } = self.surroundings;
        let grid = scene.world.grid();
        let eye = scene.projection.eye();
        self.list.columns[columns.start as usize..columns.end as usize].fill(Column::UNKNOWN);
        let course = Course::new(grid, &self.ray(columns.start));
        let place = course.cell(grid);
        let gap_in = |place| gaps.of(place).find(|&id| gaps.gap(id).gap.holds(eye));
        // For an eye inside a solid part, the cell counts as the map's own floor.
        let ground = place.map(|(cell, _)| (cell, TileId(0)));
        let (place, gap) = match (gap_in(place), gap_in(ground)) {
            (Some(gap), _) => (place, gap),
            (None, Some(gap)) => (ground, gap),
            (None, None) => (ground, GapId::BOTTOMLESS),
        };
        let clip = Clip { rows: 0..scene.projection.rows(), from: 0.0, start: 0.0 };
        self.memory.clips.resize(columns.len(), clip);
        self.store(first_bundle(course, place, gap, columns));
    }
}

/// The bundle of `columns` that begins a walk.
fn first_bundle(course: Course, place: Place, gap: GapId, columns: Range<u32>) -> Bundle {
    let image = ImageId::NONE;
    Bundle {
        course,
        place,
        gap,
        image,
        columns,
        first_clip: 0,
        clips_in_use: 0,
        has_met_standing: false,
    }
}
