//! Raster: turns a draw list into pixels, with one file for each kind of item.
//!
//! [`draw`] draws the rows of a [`DrawList`] that a [`Target`] covers: first planes, then faces, then the layers in
//! front of both. Rules:
//!
//! - The pixels of a band do not depend on its first and last row.
//! - Every pixel's texel is computed in fixed point from its own row or column.
//! - The target counts pixels and texels where they are written.
//!
//! Rejected: one loop that selects the kind of surface for each pixel. With one loop for each kind,
//! a scene never runs the loops of the kinds that it lacks, and no pixel needs a branch.

mod band;
mod faces;
mod layers;
mod pieces;
mod planes;
mod sky;
mod span;
mod target;
mod texture_columns;

pub(crate) use band::Band;
use planes::PlaneMemory;
pub(crate) use sky::{SkyMemory, SkyView};
pub(crate) use target::{SurfaceBuffer, Target};

use crate::visibility::{DrawList, FrameContext};

/// The memory of a drawing thread, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct RasterMemory {
    planes: PlaneMemory,
}

/// Draws the rows of `list` that `target` covers.
pub(crate) fn draw(
    scene: FrameContext<'_>,
    list: &DrawList,
    sky: &SkyView<'_>,
    memory: &mut RasterMemory,
    target: &mut Target<'_>,
) {
    planes::draw(scene, list, sky, &mut memory.planes, target);
    faces::draw(scene, list, target);
    layers::draw(scene, list, target);
}
