//! The portal way to fill a draw list: floors, ceilings and walls of any height, and mirrors.
//!
//! The ray of a column goes from cell to cell with a clip range: the rows that nothing nearer covers. In
//! each cell the floor closes it from below and the ceiling from above; at each line it is divided among
//! the faces and the gaps of the next cell, and the ray goes on in every gap that is still in view: mostly
//! one, two where a roof is seen from below and above at once. A mirror turns the ray back with the clip
//! range that its face had. Cells as sectors and lines as portals are those of the Build engine (Ken
//! Silverman, 1995).
//!
//! `walk` follows the rays from the `tile_gaps`, `line` says what is met at a line and `standing` what is
//! met inside a cell. `billboards` are found last, and `layers` puts them in order with what is seen
//! through. Where a world is level and has no mirrors, the flat way fills the same list with less.

mod billboards;
mod layers;
mod line;
mod ray_segments;
mod spans;
mod standing;
mod tile_gaps;
mod walk;

use super::layer_order::by_columns;
use super::runs::ImageId;
use super::{Billboard, DrawList, PortalStats, Scene, Stats, WallColumn, WallSink};
use billboards::Finder;
use layers::LayerMemory;
pub(super) use spans::for_each_span;
use tile_gaps::TileGaps;
use walk::{ColumnWalk, Surroundings, WalkMemory};

/// How many columns of pixels are drawn together.
const BLOCK: usize = 120;

/// What the portal way remembers from one frame to the next; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct PortalMemory {
    gaps: TileGaps,
    walk: WalkMemory,
    finder: Finder,
    layers: LayerMemory,
}

/// Fills `list` by exact rays. Returns when a thing in view will look different; `None` for never.
pub(super) fn fill<S: Stats>(
    scene: Scene<'_>,
    memory: &mut PortalMemory,
    list: &mut DrawList,
    stats: &mut S,
) -> Option<f64> {
    let PortalMemory { gaps, walk, finder, layers } = memory;
    let width = scene.projection.columns();
    list.begin_portals(width);
    gaps.begin(scene);
    walk.begin(width);
    let surroundings = &Surroundings::new(scene, gaps);
    for (x, ray) in (0..).zip(scene.projection.rays()) {
        let column = ColumnWalk::new(surroundings, x, walk, list).follow(&ray);
        list.columns.push(column);
    }
    let has_things = surroundings.has_things;
    let considered = if has_things { finder.find(scene, &walk.segments, list) } else { 0 };
    layers::fill(scene, gaps, &walk.passed, finder, layers, list);
    stats.change(|stats| {
        let drawn = list.billboards.iter().filter(|it| it.is_drawn && it.is_of_thing());
        stats.things_considered += considered;
        stats.things_drawn += drawn.count() as u64;
        stats.rays += walk.stats.rays;
        stats.cells += walk.stats.cells;
        stats.looks += walk.stats.cells;
        stats.portals = PortalStats { faces: list.walls.len() as u64, ..walk.stats };
    });
    Billboard::next_change(&list.billboards, scene)
}

/// Hands every one of `walls` to `sink`: neighbours in a block of columns one after the other, as the first
/// faces of each mostly are parts of one wall or step, and so are those behind them.
pub(super) fn for_each_wall_column(walls: &[WallColumn], sink: &mut impl WallSink) {
    for mut columns in by_columns::<BLOCK, _>(walls, |wall| wall.column as usize) {
        while columns.iter().any(|column| !column.is_empty()) {
            for wall in columns.iter_mut().filter_map(|column| column.split_off_first()) {
                sink.take(wall);
            }
        }
    }
}
