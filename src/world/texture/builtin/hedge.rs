//! A clipped hedge.

use std::sync::LazyLock;

use super::noise::{Noise, hash};
use super::shade::{pick, shade};
use super::{SIDE, wrapped};
use crate::color::Rgb;

/// Layers of leaves on boughs of varying depth.
pub(crate) fn hedge(x: i32, y: i32) -> Rgb {
    const DEPTH: Rgb = Rgb::new(0x1c, 0x38, 0x1e);
    const GREEN: [Rgb; 3] =
        [Rgb::new(0x40, 0x7a, 0x30), Rgb::new(0x34, 0x68, 0x2c), Rgb::new(0x50, 0x8a, 0x36)];
    const BOUGHS: Noise = Noise::new(14, 16, 16);

    let leaf_here = LEAVES.iter().find_map(|leaf| Some((leaf.id, leaf.light_at(x, y)?)));
    let light = BOUGHS.at(x, y, 40);
    match leaf_here {
        Some((id, on_leaf)) => shade(pick(GREEN, id), light + on_leaf - id / 2),
        None => shade(DEPTH, light / 3),
    }
}

struct Leaf {
    /// The position of its middle.
    x: i32,
    y: i32,
    /// The vector from there to its tip, about [`TIP`] texels long.
    tip: (i32, i32),
    id: i32,
}

const TIP: i32 = 8;

impl Leaf {
    /// The light on the leaf at a texel; `None` outside it. The half above the midrib is brighter
    /// than the one below; an upright leaf is dim.
    fn light_at(&self, x: i32, y: i32) -> Option<i32> {
        let (x, y) = (wrapped(x - self.x), wrapped(y - self.y));
        // Most leaves are elsewhere.
        if x.abs().max(y.abs()) > 2 * TIP {
            return None;
        }
        let (tip_x, tip_y) = self.tip;
        // In texels times TIP, along and across the midrib.
        let along = x * tip_x + y * tip_y;
        let across = x * tip_y - y * tip_x;
        let half_width = (TIP * TIP - along * along / (TIP * TIP)) / 2;
        (across.abs() < half_width).then_some(if across * tip_x.signum() > 0 { 36 } else { -14 })
    }
}

/// The leaves, front ones first: one or two at a random position in each square of a coarse grid.
static LEAVES: LazyLock<[Leaf; 104]> = LazyLock::new(|| {
    const SPACING: i32 = 8;
    const TIPS: [(i32, i32); 6] = [(8, 0), (7, 4), (4, 7), (0, 8), (4, -7), (7, -4)];
    const SQUARES: i32 = SIDE / SPACING;
    // Coprime to the number of squares, so that it visits all of them and neighbouring leaves
    // differ in depth.
    const STRIDE: i32 = 37;

    std::array::from_fn(|index| {
        let index = index as i32;
        let square = index * STRIDE % (SQUARES * SQUARES);
        let jitter = |seed| (hash(index, square, seed) % SPACING as u32) as i32;
        Leaf {
            x: square % SQUARES * SPACING + jitter(1),
            y: square / SQUARES * SPACING + jitter(2),
            tip: TIPS[hash(index, square, 3) as usize % TIPS.len()],
            id: index,
        }
    })
});
