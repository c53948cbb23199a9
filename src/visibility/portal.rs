//! The portal way to fill a draw list: floors, ceilings and walls of any height, and mirrors.
//!
//! The rays of neighbouring columns go from cell to cell together, each with a clip range: the rows that
//! no nearer surface covers. In each cell the floor reduces it from below and the ceiling from above. At each line it
//! is divided among the faces and the gaps of the next cell, and the ray continues in every gap
//! that is still in view: mostly in one, in two if a roof is seen from below and above at once. A
//! mirror reflects the ray with the clip range of its face. Cells as sectors and lines as portals
//! are those of the Build engine (Ken Silverman, 1995).
//!
//! `walk` follows the rays from their `start` through the `tile_gaps`; `line` handles the faces and gaps at a line, and
//! `met` the faces, and the objects inside a cell. `layers` finds billboards last, and orders them with
//! the see-through faces. For a level world without mirrors, the flat way fills the same list at a
//! lower cost.

mod bundle;
mod layers;
mod line;
mod met;
mod ray_segments;
mod spans;
mod start;
mod tile_gaps;
mod walk;

use std::ops::Range;

use super::runs::{IMAGES_AT_ONCE, ImageId};
use super::{Billboard, Column, DrawList, PortalStats, Scene, Stats, WallColumn, WallSink};
use crate::world::World;
use bundle::Surroundings;
use layers::{Finder, LayerMemory};
pub(crate) use spans::for_each_span;
pub(crate) use start::PortalStart;
use tile_gaps::TileGaps;
use walk::{BundleWalk, WalkMemory};

/// The number of things in view for which memory is reserved in advance.
const MAX_THINGS: usize = 4096;

/// The memory of the portal way, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct PortalMemory {
    gaps: TileGaps,
    /// The starts of all columns.
    starts: Vec<Option<PortalStart>>,
    walk: WalkMemory,
    finder: Finder,
    layers: LayerMemory,
}

/// Fills all of `list` by exact rays. Returns the time at which a thing in view next changes its
/// appearance; `None` for never.
pub(crate) fn fill(
    scene: Scene<'_>,
    memory: &mut PortalMemory,
    list: &mut DrawList,
    stats: &mut Stats,
) -> Option<f64> {
    let width = scene.projection.columns();
    memory.make_room(scene.world, width, list);
    list.columns.resize(width, Column::UNKNOWN);
    fill_columns(scene, memory, list, stats, |_| Some(PortalStart::Camera))
}

/// Fills the columns of `list` that have a `start` by exact rays, from there on. Returns the time
/// at which a thing in view next changes its appearance; `None` for never.
pub(crate) fn fill_columns(
    scene: Scene<'_>,
    memory: &mut PortalMemory,
    list: &mut DrawList,
    stats: &mut Stats,
    start: impl FnMut(&Column) -> Option<PortalStart>,
) -> Option<f64> {
    let PortalMemory { gaps, starts, walk, finder, layers } = memory;
    list.runs.begin(list.columns.len());
    gaps.begin(scene);
    starts.clear();
    starts.extend(list.columns.iter().map(start));
    let surroundings = &Surroundings::new(scene, gaps);
    BundleWalk::new(surroundings, walk, list).follow_all(starts);
    list.runs.end(scene.projection.rows(), |column| starts[column].is_some());
    let first = list.billboards.len();
    let has_things = surroundings.has_things;
    let considered = if has_things { finder.find(scene, &walk.segments, list) } else { 0 };
    layers::fill(scene, gaps, &walk.passed, finder, layers, list);
    stats.change(|stats| {
        let drawn = list.billboards[first..].iter().filter(|it| it.is_drawn && it.is_of_thing());
        stats.things_considered += considered;
        stats.things_drawn += drawn.count() as u64;
        stats.rays += walk.stats.rays;
        stats.cells += walk.stats.cells;
        stats.looks += walk.stats.cells;
        stats.portals = PortalStats { faces: list.walls.len() as u64, ..walk.stats };
    });
    Billboard::next_change(&list.billboards, scene)
}

impl PortalMemory {
    /// Reserves memory here and in `list` for all but extreme maps, so that a turn of the camera
    /// towards more faces allocates nothing.
    pub(crate) fn make_room(&mut self, world: &World, width: usize, list: &mut DrawList) {
        self.gaps.make_room(world);
        self.starts.clear();
        self.starts.reserve(width);
        self.walk.make_room(width);
        self.finder.make_room(world, width);
        list.clear();
        list.make_room_for_portals(width);
        let billboards = world.things().len().min(MAX_THINGS) + world.figures().len();
        list.billboards.reserve(2 * billboards + IMAGES_AT_ONCE);
        self.layers.make_room(list);
    }
}

/// Passes every one of `walls` to `sink`. Those of a bundle are in succession.
pub(crate) fn for_each_wall_column(
    walls: &[WallColumn],
    rows: &Range<u32>,
    sink: &mut impl WallSink,
) {
    for wall in walls {
        let shown = wall.rows.start.max(rows.start)..wall.rows.end.min(rows.end);
        if !shown.is_empty() {
            sink.take(wall, shown);
        }
    }
}
