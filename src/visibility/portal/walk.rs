//! The walk of the portal way: rays, followed through the gaps in bundles.
//!
//! A bundle is neighbouring columns whose rays have crossed the same lines. Their cell, its gaps and its
//! faces are looked up once for all of them. Each column has its own clip range, and its own distance to a
//! line, which is computed from its own ray. Where the first and the last ray of a bundle cross lines of
//! different kinds, it is divided: all rays have one origin, so that those which pass a corner on one side
//! are neighbours.
//!
//! Rejected: a walk for each column, which looks up every cell and every gap once for each column.

use std::mem;
use std::ops::Range;

use glam::DVec2;

use super::bundle::{Bundle, Clip, Surroundings};
use super::layers::{Passed, RayPart};
use super::ray_segments::RaySegment;
use super::tile_gaps::{Holds, VisibleGap};
use crate::cast::{Crossed, Ray, Side};
use crate::visibility::runs::{Chains, FlatSurface, ImageId, Part, Shown};
use crate::visibility::{DrawList, PortalStats, Scene};
use crate::world::{Cell, TileId};

/// The results of walks besides the draw list, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct WalkMemory {
    /// The bundles that remain to be followed.
    bundles: Vec<Bundle>,
    /// The clips of these bundles.
    pub(crate) clips: Vec<Clip>,
    /// The see-through faces, and the parts in which billboards may show: in each column, further
    /// ones come later.
    pub(crate) passed: Chains<Passed>,
    /// The segments of the rays on the map.
    pub(crate) segments: Vec<RaySegment>,
    pub(crate) stats: PortalStats,
    /// The directions of the rays of all columns.
    pub(crate) directions: Vec<DVec2>,
    /// The distances at which the rays of a bundle cross a line, by column.
    pub(crate) distances: Vec<f64>,
    /// The rows of the bottom and the top of a gap at these distances, by column.
    pub(crate) bottoms: Vec<u32>,
    pub(crate) tops: Vec<u32>,
    /// The ends of the rows that may show the next solid part behind a line, by column.
    pub(crate) ends: Vec<u32>,
}

/// The walk of the rays of a frame.
pub(crate) struct BundleWalk<'a> {
    pub(crate) surroundings: &'a Surroundings<'a>,
    pub(crate) memory: &'a mut WalkMemory,
    pub(crate) list: &'a mut DrawList,
}

impl WalkMemory {
    /// Removes the results of the last frame.
    fn begin(&mut self, scene: Scene<'_>) {
        let width = scene.projection.columns();
        self.passed.begin(width);
        self.segments.clear();
        self.stats = PortalStats::default();
        self.directions.clear();
        let columns = 0..width as u32;
        self.directions.extend(columns.map(|column| scene.projection.direction_of(column)));
    }

    /// Reserves memory for all but extreme maps, in pictures of `width` columns.
    pub(crate) fn make_room(&mut self, width: usize) {
        const OF_A_COLUMN: usize = 16;
        self.bundles.reserve(2 * width);
        self.clips.clear();
        self.clips.reserve(width * OF_A_COLUMN);
        self.passed.reserve(width, OF_A_COLUMN);
        self.segments.clear();
        self.segments.reserve(width * OF_A_COLUMN);
        self.directions.clear();
        self.directions.reserve(width);
        self.distances.resize(width, 0.0);
        for rows in [&mut self.bottoms, &mut self.tops, &mut self.ends] {
            rows.resize(width, 0);
        }
    }
}

impl<'a> BundleWalk<'a> {
    /// The walk of the rays of a frame, before it begins.
    pub(crate) fn new(
        surroundings: &'a Surroundings<'a>,
        memory: &'a mut WalkMemory,
        list: &'a mut DrawList,
    ) -> Self {
        memory.begin(surroundings.scene);
        Self { surroundings, memory, list }
    }

    /// The ray of `column`.
    #[inline]
    pub(crate) fn ray(&self, column: u32) -> Ray {
        let origin = self.surroundings.scene.projection.origin();
        Ray::of_camera(origin, self.memory.directions[column as usize])
    }

    /// Stores `bundle` for later.
    pub(crate) fn store(&mut self, bundle: Bundle) {
        let clips_in_use = self.memory.clips.len();
        self.memory.bundles.push(Bundle { clips_in_use, ..bundle });
    }

    /// Whether no ray of `bundle` has ended.
    pub(crate) fn is_open(&self, bundle: &Bundle) -> bool {
        self.memory.clips[bundle.clips()].iter().all(|clip| !clip.rows.is_empty())
    }

    /// Stores the parts of `bundle` whose rays have not ended.
    pub(crate) fn store_open(&mut self, bundle: &Bundle) {
        let mut columns = bundle.columns.clone();
        while let Some(part) = self.next_open(bundle, &mut columns) {
            self.store(part);
        }
    }

    /// The part of `bundle` in the first of `columns` whose rays have not ended, which are removed from
    /// there.
    pub(crate) fn next_open(&self, bundle: &Bundle, columns: &mut Range<u32>) -> Option<Bundle> {
        let is_open = |column: &u32| !self.memory.clips[bundle.clip(*column)].rows.is_empty();
        let start = columns.clone().find(is_open)?;
        let end = (start..columns.end).find(|column| !is_open(column)).unwrap_or(columns.end);
        columns.start = end;
        Some(bundle.part(start..end))
    }

    /// Follows all bundles that are stored.
    pub(crate) fn follow_stored(&mut self) {
        while let Some(bundle) = self.memory.bundles.pop() {
            self.memory.clips.truncate(bundle.clips_in_use);
            self.follow(bundle);
        }
    }

    /// Follows `bundle` until a ray ends, or to the end. The rays that continue then are stored.
    fn follow(&mut self, mut bundle: Bundle) {
        let grid = self.surroundings.scene.world.grid();
        loop {
            let holds = self.surroundings.gaps.gap(bundle.gap).holds;
            if holds == Holds::Standing && !bundle.has_met_standing {
                bundle.has_met_standing = true;
                self.meet_standing(&bundle);
                if !self.is_open(&bundle) {
                    self.store_open(&bundle);
                    return;
                }
            }
            let side = self.divide(&mut bundle);
            let Some(crossed) = bundle.course.cross(grid, side) else { continue };
            bundle.has_met_standing = false;
            if crossed.into.is_some() {
                self.memory.stats.cells += bundle.columns.len() as u64;
                let tile = |(_, tile): (Cell, TileId)| tile;
                if crossed.into.map(tile) == bundle.place.map(tile) {
                    // The next cell has the same heights.
                    bundle.place = crossed.into;
                    continue;
                }
            }
            self.find_distances(&bundle, &crossed);
            self.close(&bundle);
            if !self.cross_line(&mut bundle, &crossed) {
                return;
            }
        }
    }

    /// Leaves in `bundle` the first rays, which cross a line of one kind next, and returns that kind. The
    /// others are stored.
    fn divide(&mut self, bundle: &mut Bundle) -> Side {
        let (order, [x, y]) = (&self.surroundings.order, bundle.course.lines());
        let directions = &self.memory.directions;
        let side_of = |column: u32| order.next(directions[column as usize], x, y);
        let Range { start, end } = bundle.columns;
        let side = side_of(start);
        if end - start > 1 && side_of(end - 1) != side {
            let (mut last, mut split) = (start, end - 1);
            while split - last > 1 {
                let middle = u32::midpoint(last, split);
                *(if side_of(middle) == side { &mut last } else { &mut split }) = middle;
            }
            self.store(bundle.part(split..end));
            bundle.columns.end = split;
        }
        side
    }

    /// Finds the distances at which the rays of `bundle` have crossed a line.
    fn find_distances(&mut self, bundle: &Bundle, crossed: &Crossed) {
        let WalkMemory { directions, distances, .. } = &mut *self.memory;
        let rays = directions[bundle.indices()].iter().zip(&mut distances[bundle.indices()]);
        let origin = self.surroundings.scene.projection.origin();
        match crossed.side {
            Side::X => rays.for_each(|(it, t)| *t = crossed.distance(origin.x, it.x)),
            Side::Y => rays.for_each(|(it, t)| *t = crossed.distance(origin.y, it.y)),
        }
    }

    /// Finds the rows of the bottom and the top of `gap` at the distances of the rays of `bundle`.
    pub(crate) fn find_rows(&mut self, bundle: &Bundle, gap: &VisibleGap) {
        let projection = self.surroundings.scene.projection;
        let WalkMemory { distances, bottoms, tops, .. } = &mut *self.memory;
        let indices = bundle.indices();
        let rows = (&mut bottoms[indices.clone()], &mut tops[indices.clone()]);
        gap.find_rows(projection, &distances[indices], rows);
    }

    /// Shows floor and ceiling of the cell of `bundle`, which its rays leave at the distances found, and
    /// removes their rows from the clip ranges.
    pub(crate) fn close(&mut self, bundle: &Bundle) {
        let Surroundings { scene, gaps, has_things, .. } = *self.surroundings;
        let (eye, gap) = (scene.projection.eye(), gaps.gap(bundle.gap));
        self.find_rows(bundle, gap);
        let tile = bundle.place.map(|(_, tile)| tile);
        let image = bundle.image;
        let surface = |part| Shown::Plane(FlatSurface { tile, part, image });
        let shows_bottom = eye > gap.gap.bottom;
        let shows_top = eye < gap.gap.top && gap.gap.top < f64::INFINITY;
        let WalkMemory { clips, passed, distances, bottoms, tops, .. } = &mut *self.memory;
        let indices = bundle.indices();
        let distances = &distances[indices.clone()];
        let rows = bottoms[indices.clone()].iter().zip(&tops[indices.clone()]);
        let reached = &mut self.list.columns[indices];
        let clips = clips[bundle.clips()].iter_mut();
        let clips = bundle.columns.clone().zip(clips).zip(distances.iter().zip(rows));
        for ((column, clip), (&t, (&bottom, &top))) in clips {
            if has_things {
                let part = RayPart::new(bundle, column, clip, t, None);
                passed.push(column, Passed::Billboards(part));
            }
            let Range { start, end } = clip.rows;
            if shows_bottom {
                self.list.runs.show(column, bottom.max(start)..end, surface(gap.below));
            }
            if shows_top {
                self.list.runs.show(column, start..top.min(end), surface(Part::Ceiling));
            }
            (clip.rows, clip.from) = (start.max(top)..end.min(bottom), t);
        }
        if image == ImageId::NONE {
            for (column, t) in reached.iter_mut().zip(distances) {
                column.distance = column.distance.max(*t);
            }
        }
        self.end_covered(bundle);
    }

    /// Ends the rays of `bundle` whose rows are all covered.
    fn end_covered(&mut self, bundle: &Bundle) {
        for column in bundle.columns.clone() {
            if self.memory.clips[bundle.clip(column)].rows.is_empty() {
                self.end(bundle, column);
            }
        }
    }

    /// Ends the ray of `column`, unless it has ended, and stores its segment.
    pub(crate) fn end(&mut self, bundle: &Bundle, column: u32) {
        let clip = &mut self.memory.clips[bundle.clip(column)];
        clip.rows = 0..0;
        let ends = [mem::replace(&mut clip.start, f64::INFINITY), clip.from];
        if self.surroundings.has_things && ends[0] < ends[1] {
            let (ray, transform) = (self.ray(column), bundle.course.transform());
            let ends = ends.map(|t| transform.to_map(ray.at(t)));
            self.memory.segments.push(RaySegment { ends, image: bundle.image });
        }
    }
}
