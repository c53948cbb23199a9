//! Irregular patches: every texel belongs to the nearest of some points, and the texture wraps.

use super::{SIDE, wrapped};

/// A texel's place in a patch.
#[derive(Clone, Copy)]
pub(super) struct Patch {
    /// Texels from the patch's point to the right.
    pub(super) x: i32,
    /// Texels from the patch's point down.
    pub(super) y: i32,
    /// Sixteenths of a texel to the border with the nearest other patch.
    pub(super) rim: i32,
    /// Which patch it is: the index of its point.
    pub(super) id: i32,
}

impl Patch {
    /// The patch that holds the texel `(x, y)`, of those around `points`.
    pub(super) fn around(points: impl Iterator<Item = (i32, i32)>, x: i32, y: i32) -> Self {
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

/// A point as seen from a texel, or rather the way back from it.
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

/// Sixteenths of a texel to the line that is as near to one site as to the other.
fn to_border(nearest: Site, next: Site) -> i32 {
    let (x, y) = (next.x - nearest.x, next.y - nearest.y);
    (next.square() - nearest.square()) * 8 / (x * x + y * y).isqrt().max(1)
}
