//! The layers of what the portal way found: what is seen through, and billboards between that.

use super::billboards::{Finder, RayPart};
use super::tile_gaps::TileGaps;
use crate::visibility::layer_order::put_in_order;
use crate::visibility::{DrawList, Layer, Scene};

/// What a ray passes.
#[derive(Clone, Debug)]
pub(super) enum Passed {
    /// An index into the masked and translucent columns.
    SeeThrough(usize),
    /// The billboards in a part of the ray.
    Billboards(RayPart),
}

/// Memory for layers that are put in order; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct LayerMemory {
    /// Those of each column together, from far to near.
    by_column: Vec<Layer>,
}

impl LayerMemory {
    /// Makes room for as many layers as there is room for in `list`.
    pub(super) fn make_room(&mut self, list: &DrawList) {
        self.by_column.clear();
        self.by_column.reserve(list.layers.capacity());
    }
}

/// Makes the layers of `list` from what rays passed: in each column, what is nearer comes later.
pub(super) fn fill(
    scene: Scene<'_>,
    gaps: &TileGaps,
    passed: &[Passed],
    finder: &Finder,
    memory: &mut LayerMemory,
    list: &mut DrawList,
) {
    let by_column = &mut memory.by_column;
    by_column.clear();
    for passed in passed.iter().rev() {
        match passed {
            &Passed::SeeThrough(index) => by_column.push(Layer::SeeThrough(index)),
            Passed::Billboards(part) => {
                finder.cut(scene, gaps, part, &mut list.billboards, |column| {
                    by_column.push(Layer::Billboard(column));
                });
            }
        }
    }
    put_in_order(by_column, &list.see_through, &mut list.layers);
}
