//! Raster: a draw list to pixels, one file for each kind of item.
//!
//! [`draw`] draws the rows of a [`DrawList`] that a [`Target`] covers: first spans, then wall
//! columns, then the layers in front of both. It does not know which way filled the list. Rules:
//!
//! - The pixels of a band do not depend on its first and last row.
//! - Every pixel's texel is computed in fixed point from its own row or column.
//! - The target counts pixels and texels where they are written.
//!
//! Rejected: one loop that selects the kind of surface for each pixel. These loops omit the kinds
//! of item that a scene lacks, without a branch.

mod band;
mod column_batch;
mod direct_columns;
mod layers;
mod pieces;
mod sampling;
mod shaded_texels;
mod sky;
mod span;
mod span_pair;
mod target;
mod texel_runs;
mod wall_column;
mod wall_part;
mod wall_run;

pub(crate) use band::Band;
use column_batch::BatchMemory;
pub(crate) use sky::{SkyColumn, SkyView};
pub(crate) use target::{SurfaceBuffer, Target};

use crate::visibility::{DrawList, Filter, Scene, Span, SpanMemory};
use sampling::{Means, MipLevels, Sampling};
use span_pair::SpanPairs;

/// The memory of a drawing thread, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct RasterMemory {
    spans: SpanMemory,
    batch: BatchMemory,
}

/// Draws the rows of `list` that `target` covers.
pub(crate) fn draw(
    scene: Scene<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut RasterMemory,
    target: &mut Target<'_>,
) {
    match scene.plan.filter {
        Filter::Mip | Filter::Nearest => {
            draw_surfaces::<MipLevels>(scene, list, sky, memory, target);
        }
        Filter::Area => draw_surfaces::<Means>(scene, list, sky, memory, target),
    }
    layers::draw(scene, list, target);
}

/// Draws what is behind the layers of `list`.
fn draw_surfaces<M: Sampling>(
    scene: Scene<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut RasterMemory,
    target: &mut Target<'_>,
) {
    let RasterMemory { spans, batch } = memory;
    let rows = target.rows();
    let mut pairs = SpanPairs::<M>::new();
    list.for_each_span(scene, &rows, spans, |span| match span {
        Span::Fill { pass, rows, color } => target.whole_rows_mut(pass, rows).fill(color),
        Span::Plane(span) => span::draw::<M>(scene, &span, target),
        Span::Pair(pair) => pairs.draw(scene, &pair, target),
        Span::Sky { row, columns, image } => sky.draw(row, columns, image, target),
    });
    M::draw_walls(scene, list, batch, target);
}
