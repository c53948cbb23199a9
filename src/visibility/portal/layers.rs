//! The layers of the portal way: see-through faces, and the billboards between them.

use super::billboards::{Finder, RayPart};
use super::tile_gaps::TileGaps;
use crate::visibility::chains::Chains;
use crate::visibility::layer_order::put_in_order;
use crate::visibility::{DrawList, Layer, Scene};

/// An item that a ray passes.
#[derive(Clone, Debug)]
pub(crate) enum Passed {
    /// An index into the masked and translucent columns.
    SeeThrough(usize),
    /// The billboards in a part of the ray.
    Billboards(RayPart),
}

/// Memory for ordering layers, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerMemory {
    /// The layers of each column together, from far to near.
    by_column: Vec<Layer>,
}

impl LayerMemory {
    /// Reserves memory for as many layers as `list` has memory for.
    pub(crate) fn make_room(&mut self, list: &DrawList) {
        self.by_column.clear();
        self.by_column.reserve(list.layers.capacity());
    }
}

/// Makes the layers of `list` from the items that rays passed: in each column, nearer items come
/// later.
pub(crate) fn fill(
    scene: Scene<'_>,
    gaps: &TileGaps,
    passed: &Chains<Passed>,
    finder: &Finder,
    memory: &mut LayerMemory,
    list: &mut DrawList,
) {
    let by_column = &mut memory.by_column;
    by_column.clear();
    for passed in (0..passed.width()).flat_map(|column| passed.latest_first(column)) {
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
