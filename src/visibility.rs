//! Visibility: a world and a camera to a draw list.
//!
//! A [`DrawList`] holds what a frame shows: spans of floor, ceiling and sky along rows, wall columns,
//! masked and translucent columns, and billboards. There are two ways to fill it:
//!
//! - `flat`: every ray ends at the first wall. Few rays are cast, and floor and ceiling are what is
//!   left of each column. It serves what is level.
//! - `portal`: a ray goes on above, below and behind what it meets, with the rows that are still open:
//!   its clip range. It serves heights and mirrors.
//!
//! The pixels are the business of [`raster`](crate::raster), which does not know which way the list
//! was filled. Rules:
//!
//! - Rows and columns are taken at the centres of pixels; what lies exactly between two belongs to the
//!   lower or the right one.
//! - Every number is computed from its own row or column, never from the one beside it, so no error
//!   adds up, and a band of rows is the same as those rows of the whole frame.
//! - A list allocates nothing once it has grown to the size of the frame.
//!
//! Drawing each column while its ray is followed was refused: a row of floor shares its distance, its
//! light and its mip level, which are found once for many pixels when it is drawn as a span.

mod billboard;
mod column;
mod draw_list;
mod facing;
mod filter;
mod flat;
mod frame_size;
mod layer_order;
mod lighting;
mod plan;
mod portal;
mod projection;
mod ray_counter;
mod runs;
mod scene;
mod span_mapping;
mod stats;
mod texture_stepper;
mod visible_cells;

pub(crate) use billboard::Billboard;
pub use column::{Column, Surface};
pub(crate) use draw_list::{
    BillboardColumn, DrawList, Extent, Layer, Material, PlaneSpan, SeeThroughColumn, Span,
    SpanMemory, WallColumn, WallSink,
};
pub(crate) use facing::Facing;
pub use filter::Filter;
pub use frame_size::{FrameSize, PixelAspect};
pub(crate) use lighting::{Faded, FullyLit, Lighting, SideLit};
pub use plan::{
    CeilingLoop, FramePlan, PlaneLoop, RayLoop, SkyLoop, ThingLoop, Visibility, WallLoop,
    WhyPortals,
};
pub(crate) use projection::Projection;
pub(crate) use scene::Scene;
pub(crate) use span_mapping::{SpanMapping, TexelPlaces};
pub(crate) use stats::Stats;
pub use stats::{FrameStats, Pass, PassStats, PortalStats};
pub(crate) use texture_stepper::TextureStepper;

use crate::cast::{Caster, ExactOnLevel};
use flat::{FlatMemory, PortalStarts};
use portal::PortalMemory;

/// What finding out what is in view needs from one frame to the next; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(crate) struct VisibilityMemory {
    flat: FlatMemory,
    portal: PortalMemory,
}

/// Fills `list` with what `scene` shows, with the walls that `caster` finds where the flat way serves alone.
/// Returns when a thing in view will look different; `None` for never.
pub(crate) fn fill<C: Caster, S: Stats>(
    scene: Scene<'_>,
    caster: &C,
    memory: &mut VisibilityMemory,
    list: &mut DrawList,
    stats: &mut S,
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
            // What the flat way finds is before what is behind a line.
            let in_portals = if list.flat_columns.is_empty() {
                None
            } else {
                let starts = PortalStarts::new(world);
                portal::fill_columns(scene, portal, list, stats, |column| starts.of(column))
            };
            let in_flat = flat::fill_layers(scene, flat, list, stats);
            [in_flat, in_portals].into_iter().flatten().reduce(f64::min)
        }
    }
}
