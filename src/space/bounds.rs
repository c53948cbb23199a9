//! Bounds: the rectangle of pixels that a body can cover.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::camera::SceneProjection;
use super::relative_shape::{RelativeBlock, RelativeShape, RelativeSphere};

/// A rectangle of pixels.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    pub(crate) columns: Range<u32>,
    pub(crate) rows: Range<u32>,
}

/// The least and the greatest slope relative to the middle of the picture, to the right or upwards.
type SlopeInterval = (f64, f64);

const EVERYWHERE: SlopeInterval = (f64::NEG_INFINITY, f64::INFINITY);

/// A point whose depth is less than this fraction of its distance has an unbounded slope.
const NEAR: f64 = 1e-9;

impl Bounds {
    /// The pixels whose rays may meet `shape`; `None` if there are none.
    pub(crate) fn new(shape: &RelativeShape, projection: &SceneProjection) -> Option<Self> {
        let (across, upwards) = match shape {
            RelativeShape::Plane(_) => (EVERYWHERE, EVERYWHERE),
            RelativeShape::Sphere(sphere) => of_sphere(sphere, projection)?,
            RelativeShape::Block(block) => of_block(block, projection)?,
        };
        let columns = pixels(across, projection.columns_a_cell, projection.width);
        // Rows are counted downwards.
        let (low, high) = upwards;
        let rows = pixels((-high, -low), projection.rows_a_cell, projection.height);
        let is_empty = columns.is_empty() || rows.is_empty();
        (!is_empty).then_some(Self { columns, rows })
    }

    /// The number of pixels in the rectangle.
    pub(crate) fn pixel_count(&self) -> u64 {
        self.columns.len() as u64 * self.rows.len() as u64
    }
}

/// The range of pixels with slopes in this extent, along a side of the picture that is `count`
/// pixels long. It contains one more pixel on either side because of rounding.
fn pixels((low, high): SlopeInterval, per_slope: f64, count: u32) -> Range<u32> {
    let first = low * per_slope + f64::from(count) / 2.0 - 1.5;
    let last = high * per_slope + f64::from(count) / 2.0 + 1.5;
    if first.is_nan() || last.is_nan() {
        return 0..count;
    }
    (first as u32).min(count)..(last as u32).min(count)
}

fn of_sphere(
    sphere: &RelativeSphere,
    projection: &SceneProjection,
) -> Option<(SlopeInterval, SlopeInterval)> {
    let axes = &projection.axes;
    let depth = sphere.center.dot(axes.forward);
    let side = DVec2::new(sphere.center.dot(axes.right), depth);
    let height = DVec2::new(sphere.center.dot(axes.up), depth);
    let farther_than_rounding = sphere.radius + NEAR * sphere.center.length();
    Some((tangents(side, farther_than_rounding)?, tangents(height, farther_than_rounding)?))
}

/// The slopes of the two lines through the origin that touch a circle. The components of `center`
/// are its offset to the side and its depth.
fn tangents(center: DVec2, radius: f64) -> Option<SlopeInterval> {
    if center.y <= -radius {
        return None;
    }
    let distance = center.length();
    if distance <= radius {
        return Some(EVERYWHERE);
    }
    let length = ((distance - radius) * (distance + radius)).sqrt();
    let left = center.rotate(DVec2::new(length, radius));
    let right = center.rotate(DVec2::new(length, -radius));
    let slope = |tangent: DVec2, beyond: f64| {
        if tangent.y > 0.0 { tangent.x / tangent.y } else { beyond }
    };
    Some((slope(left, f64::NEG_INFINITY), slope(right, f64::INFINITY)))
}

fn of_block(
    block: &RelativeBlock,
    projection: &SceneProjection,
) -> Option<(SlopeInterval, SlopeInterval)> {
    let axes = &projection.axes;
    let sides = [block.low, block.high];
    let corners = (0..8).map(|corner| {
        DVec3::new(sides[corner & 1].x, sides[corner >> 1 & 1].y, sides[corner >> 2 & 1].z)
    });
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (mut is_ahead, mut is_behind) = (false, false);
    for corner in corners {
        let depth = corner.dot(axes.forward);
        let margin = NEAR * corner.length();
        is_ahead |= depth > -margin;
        is_behind |= depth <= margin;
        let slopes = DVec2::new(corner.dot(axes.right), corner.dot(axes.up)) / depth;
        low = low.min(slopes);
        high = high.max(slopes);
    }
    match (is_ahead, is_behind) {
        (false, _) => None,
        (true, true) => Some((EVERYWHERE, EVERYWHERE)),
        (true, false) => Some(((low.x, high.x), (low.y, high.y))),
    }
}
