//! Irregular patches (a Voronoi diagram that wraps around): every texel belongs to the nearest
//! point.

use super::{SIDE, wrapped};

/// The position of a texel in a patch.
#[derive(Clone, Copy)]
pub(crate) struct Patch {
    /// Texels right of the patch's point.
    pub(crate) x: i32,
    /// Texels below the patch's point.
    pub(crate) y: i32,
    /// Sixteenths of a texel to the border of the next patch.
    pub(crate) rim: i32,
    /// The index of the patch's point.
    pub(crate) id: i32,
}

impl Patch {
    /// The patch around one of `points` that contains `(x, y)`.
    pub(crate) fn around(points: impl Iterator<Item = (i32, i32)>, x: i32, y: i32) -> Self {
        let mut nearest = FAR;
        let mut next = FAR;
        for (id, (point_x, point_y)) in (0..).zip(points) {
            let site = Site { x: wrapped(x - point_x), y: wrapped(y - point_y), id };
            if site.square() < nearest.square() {
                (nearest, next) = (site, nearest);
            } else if site.square() < next.square() {
                next = site;
            }
        }
        Self { x: nearest.x, y: nearest.y, rim: to_border(nearest, next), id: nearest.id }
    }
}

/// The vector from a texel to a point.
#[derive(Clone, Copy)]
struct Site {
    x: i32,
    y: i32,
    id: i32,
}

/// Farther than any point of the texture.
const FAR: Site = Site { x: SIDE, y: SIDE, id: 0 };

impl Site {
    fn square(self) -> i32 {
        self.x * self.x + self.y * self.y
    }
}

/// Sixteenths of a texel to the line that is equally near to both points.
fn to_border(nearest: Site, next: Site) -> i32 {
    let (x, y) = (next.x - nearest.x, next.y - nearest.y);
    (next.square() - nearest.square()) * 8 / (x * x + y * y).isqrt().max(1)
}
