//! Visibility: a world and a camera to a draw list.
//!
//! A [`DrawList`] holds the contents of a frame: spans of floor, ceiling and sky along rows, wall
//! columns, masked and translucent columns, and billboards. There are two ways to fill it:
//!
//! - `flat`: each ray ends at the first wall. Few rays are cast, and floor and ceiling are the rest
//!   of each column. It serves level scenes.
//! - `portal`: a ray continues above, below and behind a face, with the rows that are still
//!   uncovered: its clip range. It serves heights and mirrors.
//!
//! [`raster`](crate::raster) draws the list and does not know which way filled it. Rules:
//!
//! - Rows and columns are sampled at the centres of pixels. A point exactly between two belongs to
//!   the lower or the right one.
//! - Every number is computed from its own row or column, never from that of a neighbour, so that
//!   no error accumulates. A band of rows is identical to those rows of the whole frame.
//! - A list allocates nothing once it has grown to the size of the frame.
//!
//! Rejected: drawing each column while its ray is followed. A row of floor shares its distance, its
//! light and its mip level, which a span finds once for many pixels.

mod billboard;
mod column;
mod draw_list;
mod face_column;
mod flat;
mod lighting;
mod plan;
mod portal;
mod projection;
mod runs;
mod span_mapping;
mod stats;
mod texture_stepper;
mod visible_cells;
mod wall_part;

pub(crate) use billboard::Billboard;
#[cfg(feature = "terminal")]
pub(crate) use billboard::may_show;
pub use column::{Column, Surface};
pub(crate) use draw_list::{
    BillboardColumn, DrawList, DrawnPlane, Layer, PlaneSpan, Span, SpanMemory, SpanPair,
};
pub(crate) use face_column::{
    Extent, Facing, Material, SeeThroughColumn, WallColumn, WallRun, WallSink,
};
pub(crate) use lighting::{Faded, FullyLit, Lighting, SideLit};
pub use plan::{
    CeilingLoop, Filter, FramePlan, PlaneLoop, RayLoop, SkyLoop, ThingLoop, Visibility, WallLoop,
    WhyPortals,
};
pub use projection::Projection;
pub use projection::{FrameSize, PixelAspect};
pub(crate) use span_mapping::{SpanMapping, TexelPlaces};
pub(crate) use stats::Stats;
pub use stats::{FrameStats, Pass, PassStats, PortalStats};
pub(crate) use texture_stepper::{FaceTexels, TextureStepper, WallTexels};
pub(crate) use wall_part::WallPart;

use crate::cast::{Caster, ExactOnLevel};
use crate::world::texture::{MipLevel, Texture};
use crate::world::{Camera, TextureId, World};
use flat::{FlatMemory, PortalStarts};
use portal::PortalMemory;

/// A world, the camera that views it, and the projection and plan of the frame.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) world: &'a World,
    pub(crate) camera: &'a Camera,
    /// The time at which sprites are shown, in seconds.
    pub(crate) seconds: f64,
    pub(crate) projection: &'a Projection,
    pub(crate) plan: &'a FramePlan,
}

impl<'a> Scene<'a> {
    /// The level of detail of `texture` for a face at distance `t`, which the ray approaches by `slope`
    /// cells per unit of `t`.
    #[inline]
    pub(crate) fn lod_on_face(self, texture: &Texture, t: f64, slope: f64) -> usize {
        let area = self.projection.pixel_area_on_wall(t, slope);
        self.plan.filter.lod(area * texture.area())
    }

    /// The mip level of the texture `id` for such a face.
    #[inline]
    pub(crate) fn level_on_face(self, id: TextureId, t: f64, slope: f64) -> &'a MipLevel {
        let texture = self.world.texture(id);
        texture.level(self.lod_on_face(texture, t, slope))
    }
}

/// The memory of both ways, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibilityMemory {
    flat: FlatMemory,
    portal: PortalMemory,
}

/// Fills `list` with the contents of `scene`. If the flat way serves alone, `caster` finds the
/// walls. Returns the time at which a thing in view next changes its appearance; `None` for never.
pub(crate) fn fill<C: Caster>(
    scene: Scene<'_>,
    caster: &C,
    memory: &mut VisibilityMemory,
    list: &mut DrawList,
    stats: &mut Stats,
) -> Option<f64> {
    let VisibilityMemory { flat, portal } = memory;
    let world = scene.world;
    match scene.plan.visibility {
        Visibility::Flat => {
            flat::find_columns(scene, (caster, world.grid()), flat, list, stats);
            flat::fill_layers(scene, flat, list, stats)
        }
        Visibility::Portals(_) => portal::fill(scene, portal, list, stats),
        Visibility::Mixed(_) => {
            let grid = world.level_grid().unwrap_or(world.grid());
            portal.make_room(world, scene.projection.columns(), list);
            flat::find_columns(scene, (&ExactOnLevel { grid }, grid), flat, list, stats);
            // The flat layers are in front of those of the portal way, which are behind a line.
            let in_portals = if list.flat_columns.is_empty() {
                None
            } else {
                let mut starts = PortalStarts::new(world);
                portal::fill_columns(scene, portal, list, stats, |column| starts.of(column))
            };
            let in_flat = flat::fill_layers(scene, flat, list, stats);
            [in_flat, in_portals].into_iter().flatten().reduce(f64::min)
        }
    }
}
