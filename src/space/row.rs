//! A row of pixels: its rays, and the nearest hit of each.
//!
//! The rays of a row are tested against one body after the other. Each component of the directions
//! has its own array, and so do the hits. A test of neighbouring rays is therefore one loop without
//! branches.

use std::ops::Range;

use glam::DVec3;

use super::camera::SceneProjection;
use super::lanes::{LANES, Lanes, Vectors};
use super::relative_shape::RelativeShape;
use super::tree::{Nearest, Tree};

/// The index that stands for no body, for a ray that hits none.
const NONE: u64 = u64::MAX;

/// The rays of a row, in memory that is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    width: usize,
    /// The directions at the middle of the picture's height, by component. After the last column,
    /// the arrays continue for as many columns as there are lanes.
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Whether all directions have the same `z`, as for a camera without roll.
    is_level: bool,
    /// The change of all directions from the middle to this row.
    up: DVec3,
    /// The distance of the nearest hit that was found for each ray.
    t: Vec<f64>,
    /// The index of the body that is hit there, or [`NONE`]. Indices are as wide as distances, so
    /// one comparison selects both.
    found: Vec<u64>,
}

/// Neighbouring rays of a row that hit the same body, or none.
#[derive(Clone, Debug, Default)]
pub(crate) struct RayGroup {
    pub(crate) directions: Vectors,
    pub(crate) t: Lanes,
}

impl Row {
    /// Begins a picture.
    pub(crate) fn begin(&mut self, projection: &SceneProjection) {
        let Self { x, y, z, .. } = self;
        for components in [&mut *x, y, z] {
            components.clear();
        }
        self.width = projection.width as usize;
        for column in 0..projection.width + LANES as u32 {
            let across = projection.across(column);
            x.push(across.x);
            y.push(across.y);
            z.push(across.z);
        }
        self.is_level = self.z.iter().all(|&it| it == self.z[0]);
    }

    /// Whether all directions have the same `z`.
    pub(crate) fn is_level(&self) -> bool {
        self.is_level
    }

    /// Begins the row that is `up` from the middle of the picture.
    pub(crate) fn begin_row(&mut self, up: DVec3) {
        self.up = up;
        self.t.clear();
        self.t.resize(self.width, f64::INFINITY);
        self.found.clear();
        self.found.resize(self.width, NONE);
    }

    /// Tests the rays of these `columns` against the body with this index. If several bodies are at
    /// the same distance, the first one tested is hit. Returns the number of tests.
    #[inline(always)]
    pub(crate) fn test(
        &mut self,
        columns: Range<usize>,
        index: usize,
        shape: &RelativeShape,
    ) -> u64 {
        if let RelativeShape::Plane(plane) = shape {
            // If both end rays of a row point away from a plane, all rays between them do.
            let ends = [0, self.width - 1].map(|column| self.direction(column));
            if !ends.into_iter().any(|direction| plane.is_ahead(direction)) {
                return 0;
            }
        }
        let first = self.direction(0);
        let rays = Rays {
            x: &self.x[columns.clone()],
            y: &self.y[columns.clone()],
            z: &self.z[columns.clone()],
            up: self.up,
        };
        let tests = columns.len() as u64;
        let (t, found) = (&mut self.t[columns.clone()], &mut self.found[columns]);
        let index = index as u64;
        match shape {
            RelativeShape::Sphere(sphere) => rays.test(t, found, index, |it| sphere.distance(it)),
            RelativeShape::Plane(plane) if self.is_level && plane.is_horizontal() => {
                let here = plane.distance(first);
                rays.test(t, found, index, |_| here);
            }
            RelativeShape::Plane(plane) => rays.test(t, found, index, |it| plane.distance(it)),
            RelativeShape::Block(block) => rays.test(t, found, index, |it| block.distance(it)),
        }
        tests
    }

    /// Finds the hits of all rays in `tree`. `distance` returns the distance to the body with an
    /// index, in a direction.
    pub(crate) fn search(
        &mut self,
        tree: &Tree,
        mut distance: impl FnMut(usize, DVec3) -> Option<f64>,
    ) {
        for column in 0..self.width {
            let direction = self.direction(column);
            let nearest = tree.nearest(direction, |index| distance(index, direction));
            if let Some(Nearest { t, index }) = nearest {
                (self.t[column], self.found[column]) = (t, index as u64);
            }
        }
    }

    /// The index of the body that the rays from `column` on hit, and the end of the columns that
    /// hit it, at most one column for each lane.
    #[inline(always)]
    pub(crate) fn same_from(&self, column: usize) -> (Option<usize>, usize) {
        let found = self.found[column];
        let rest = &self.found[column..];
        let count = match rest.first_chunk::<LANES>() {
            Some(lanes) if lanes.iter().fold(0, |all, other| all | (other ^ found)) == 0 => LANES,
            _ => rest.iter().take(LANES).take_while(|&&other| other == found).count(),
        };
        ((found != NONE).then_some(found as usize), column + count)
    }

    /// Sets `stretch` to the rays of these columns, at most one for each lane. In the remaining
    /// lanes, the directions continue, and the last distance is repeated.
    #[inline(always)]
    pub(crate) fn take(&self, columns: Range<usize>, stretch: &mut RayGroup) {
        let RayGroup { directions, t } = stretch;
        let count = columns.len();
        let distances = &self.t[columns.clone()];
        if let Ok(distances) = distances.try_into() {
            *t = distances;
        } else {
            t[..count].copy_from_slice(distances);
            t[count..].fill(distances[count - 1]);
        }
        let lanes = columns.start..columns.start + LANES;
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|it| &it[lanes.clone()]);
        directions.fill(|lane| DVec3::new(x[lane], y[lane], z[lane]) + self.up);
    }

    fn direction(&self, column: usize) -> DVec3 {
        DVec3::new(self.x[column], self.y[column], self.z[column]) + self.up
    }
}

/// Some rays of a row.
struct Rays<'a> {
    x: &'a [f64],
    y: &'a [f64],
    z: &'a [f64],
    up: DVec3,
}

impl Rays<'_> {
    /// Tests the rays against the body with this index. Updates `t` and `found` for each ray to
    /// which it is nearer than all bodies tested before.
    #[inline(always)]
    fn test(self, t: &mut [f64], found: &mut [u64], index: u64, distance: impl Fn(DVec3) -> f64) {
        let rays = self.x.iter().zip(self.y).zip(self.z);
        for (((&x, &y), &z), (t, found)) in rays.zip(t.iter_mut().zip(found)) {
            let here = distance(DVec3::new(x, y, z) + self.up);
            let is_nearer = (here >= 0.0) & (here < *t);
            *t = if is_nearer { here } else { *t };
            *found = if is_nearer { index } else { *found };
        }
    }
}
