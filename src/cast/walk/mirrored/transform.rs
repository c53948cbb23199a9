//! The transform of an image in mirrors.

use glam::DVec2;

use crate::cast::Side;

/// The transform of an image in mirrors: from points along the straight ray to points on the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct MirrorTransform {
    x: AxisTransform,
    y: AxisTransform,
}

/// The transform along one axis: a coordinate is offset, or mirrored at 0 and then offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
struct AxisTransform {
    is_mirrored: bool,
    offset: i64,
}

impl MirrorTransform {
    /// The point on the map for a point along the straight ray.
    pub(crate) fn to_map(self, point: DVec2) -> DVec2 {
        DVec2::new(self.x.to_map(point.x), self.y.to_map(point.y))
    }

    /// The point along the straight ray for a point on the map.
    pub(crate) fn in_image(self, point: DVec2) -> DVec2 {
        DVec2::new(self.x.in_image(point.x), self.y.in_image(point.y))
    }

    /// Whether lines of kind `side` are mirrored along themselves.
    pub(crate) fn is_mirrored_along(self, side: Side) -> bool {
        match side {
            Side::X => self.y.is_mirrored,
            Side::Y => self.x.is_mirrored,
        }
    }

    /// Adds a mirror at `line`, of kind `side`. Returns the column or row on the map behind it for the one at
    /// `index` along the straight ray.
    pub(crate) fn reflect(&mut self, side: Side, line: i64, index: i64) -> i64 {
        let along = match side {
            Side::X => &mut self.x,
            Side::Y => &mut self.y,
        };
        *along = along.mirrored_at(line);
        along.index_on_map(index)
    }

    /// Whether left and right are exchanged.
    pub(crate) fn swaps_sides(self) -> bool {
        self.x.is_mirrored != self.y.is_mirrored
    }

    /// The direction on the map for a direction along the straight ray.
    pub(crate) fn direction_to_map(self, direction: DVec2) -> DVec2 {
        let along =
            |transform: AxisTransform, part: f64| if transform.is_mirrored { -part } else { part };
        DVec2::new(along(self.x, direction.x), along(self.y, direction.y))
    }
}

impl AxisTransform {
    fn to_map(self, place: f64) -> f64 {
        let offset = self.offset as f64;
        if self.is_mirrored { offset - place } else { offset + place }
    }

    fn in_image(self, place: f64) -> f64 {
        let offset = self.offset as f64;
        if self.is_mirrored { offset - place } else { place - offset }
    }

    /// The column or row of the map for the one at `index` along the straight ray.
    fn index_on_map(self, index: i64) -> i64 {
        if self.is_mirrored { self.offset - 1 - index } else { self.offset + index }
    }

    /// The transform behind a mirror at `line`.
    fn mirrored_at(self, line: i64) -> Self {
        let moved = if self.is_mirrored { -2 * line } else { 2 * line };
        Self { is_mirrored: !self.is_mirrored, offset: self.offset + moved }
    }
}
