//! What the filter by area needs to know: rays between the centres of pixels, and where faces end.

use glam::DVec2;

use super::Projection;
use crate::cast::{HitFace, Ray, Side};

/// The top and the bottom of a wall of height 1 in a picture, which are straight lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceEnds {
    /// The rows that a cell of height covers at the left edge of the picture, and their change from column to
    /// column.
    rows: f64,
    change: f64,
    horizon: f64,
    /// The top and the bottom, in cells below the eye.
    heights: [f64; 2],
}

impl Projection {
    /// The direction of a ray `place` columns from the left edge, of which 0.5 is the middle of the first.
    #[inline]
    pub(crate) fn direction_at(&self, place: f64) -> DVec2 {
        let width = f64::from(self.width);
        self.direction + self.plane * ((place * 2.0 - width) / width)
    }

    /// The ray there.
    pub(crate) fn ray_at(&self, place: f64) -> Ray {
        Ray::of_camera(self.origin, self.direction_at(place))
    }

    /// The ends of `face`.
    pub(crate) fn face_ends(&self, face: &HitFace) -> FaceEnds {
        let (side, to_line) = (face.side(), face.distance_to_line(self.origin));
        let [middle, across] = [self.direction, self.plane].map(|direction| match side {
            Side::X => direction.x,
            Side::Y => direction.y,
        });
        // The inverse of the distance to the camera plane changes evenly across the picture.
        let rows = (self.focal_length / to_line).min(FAR);
        let rows = if face.is_ahead() { rows } else { -rows };
        self.ends(rows * (middle - across), rows * across * (2.0 / f64::from(self.width)))
    }

    /// The ends of a wall of height 1 at distance `t` everywhere.
    pub(crate) fn level_ends(&self, t: f64) -> FaceEnds {
        self.ends((self.focal_length / t).min(FAR), 0.0)
    }

    fn ends(&self, rows: f64, change: f64) -> FaceEnds {
        let heights = [self.eye - 1.0, self.eye];
        FaceEnds { rows, change, horizon: self.horizon, heights }
    }

    /// The width and the height of the part of a wall's side, in cells, that a pixel covers there.
    #[inline]
    pub(crate) fn pixel_extent_on_wall(&self, t: f64, slope: f64) -> DVec2 {
        DVec2::new(t / (self.focal_length_across * slope.abs()), t / self.focal_length)
    }
}

impl FaceEnds {
    /// The rows that a cell of height covers `place` columns from the left edge.
    #[inline]
    pub(crate) fn rows_at(&self, place: f64) -> f64 {
        self.rows + self.change * place
    }

    /// The top and the bottom there, in rows from the top of the picture.
    #[inline]
    pub(crate) fn at(&self, place: f64) -> [f64; 2] {
        let rows = self.rows_at(place);
        self.heights.map(|height| self.horizon + height * rows)
    }
}

/// More rows than any picture has, for a cell of height.
const FAR: f64 = 1e9;
