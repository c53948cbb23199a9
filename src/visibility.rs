//! Visibility: a world and a camera to a draw list.
//!
//! A [`DrawList`] contains the items of a frame: horizontal planes, upright faces, and the layers in front of
//! both. The [walk](walk) fills it sector by sector, and [`raster`](crate::raster) draws it. Rules:
//!
//! - Rows and columns are sampled at the centres of pixels. A point exactly between two pixels belongs to the
//!   lower or the right one.
//! - Every number is computed from its own row or column, never from a neighbour's number. No error
//!   accumulates, and a band of rows is identical to the same rows of the whole frame.
//! - A list allocates nothing once it has grown to the size of the frame.
//!
//! Rejected: drawing each column while its ray is followed. The pixels in a row of floor share a distance, a
//! light and a mip level, and a span computes these once for many pixels.

mod billboard;
mod draw_list;
mod face;
mod fan;
mod layers;
mod lighting;
mod plan;
mod projection;
mod span_mapping;
mod stats;
mod surface;
mod texture_stepper;
mod visible_cells;
mod walk;

pub(crate) use billboard::Billboard;
#[cfg(feature = "terminal")]
pub(crate) use billboard::may_show;
pub(crate) use draw_list::{Backdrop, BillboardPart, DrawList, Layer, PlaneKind, VisiblePlane};
pub(crate) use face::{Face, FaceColumn, Facing, Material, Rows};
pub(crate) use lighting::Lighting;
pub use plan::{Filter, FramePlan, PlaneLoop, WallLoop};
pub use projection::Projection;
pub use projection::{FrameSize, PixelAspect};
pub(crate) use span_mapping::{SpanMapping, TexelPlaces};
pub(crate) use stats::StatsCounter;
pub use stats::{FrameStats, Pass, PassStats, WalkStats};
pub use surface::Surface;
pub(crate) use texture_stepper::FaceTexels;

use crate::world::{Camera, World};
use layers::LayerMemory;
use walk::WalkMemory;

/// A world, the camera that views it, and the projection and plan of the frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameContext<'a> {
    pub(crate) world: &'a World,
    pub(crate) camera: &'a Camera,
    /// The time for which animated sprites are drawn, in seconds.
    pub(crate) seconds: f64,
    pub(crate) projection: &'a Projection,
    pub(crate) plan: &'a FramePlan,
}

/// Memory that visibility reuses from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibilityMemory {
    walk: WalkMemory,
    layers: LayerMemory,
}

/// Fills `list` with the contents of `scene`. Returns the time at which a thing in view next changes its
/// appearance; `None` for never.
pub(crate) fn fill(
    scene: FrameContext<'_>,
    memory: &mut VisibilityMemory,
    list: &mut DrawList,
    stats: &mut StatsCounter,
) -> Option<f64> {
    let VisibilityMemory { walk, layers } = memory;
    let width = scene.projection.columns();
    list.begin(width);
    walk.make_room(width);
    if scene.plan.has_layers {
        layers.make_room(scene.world, width, list);
    }
    list.sectors.begin(scene.world, walk::top_of_sky(scene));
    list.directions.begin(scene.projection);
    let counts = walk::walk(scene, walk, list);
    list.join_planes(scene.projection.eye());
    let considered = layers::fill(scene, layers, list);
    stats.change(|stats| {
        let drawn = list.billboards.iter().filter(|it| it.is_drawn && it.is_of_thing());
        stats.things_considered += considered;
        stats.things_drawn += drawn.count() as u64;
        let faces = (list.faces.len() + list.see_through.len()) as u64;
        stats.walk = WalkStats { faces, ..counts };
    });
    Billboard::next_change(&list.billboards, scene)
}
