//! The layers of a level scene: the faces that rays passed, and the billboards between them.
//!
//! The ends of the rays are known, and with them the visible part of the map: only things there are
//! considered, and those that are higher than walls. They are painted from far to near, in each column as far
//! as no wall covers them. Under the sky, a billboard shows in the rows above the wall, too: all walls are
//! equally high and higher than the eye, so that the first one hides the most. A face that a ray passed, such
//! as a grate, is painted before the first thing that is nearer. Rejected: a depth for each pixel. One for each
//! column is equivalent.
//!
//! Colours are mixed as sRGB values, as in the frame. Rejected: mixing linear light. It needs a
//! table in each direction for every pixel, and tints looked no more like glass.

use std::cmp::Ordering;
use std::ops::Range;

use super::ceilings::Ceilings;
use super::distance_to_edge;
use super::wall::light_of;
use crate::cast::{Hit, MirrorTransform};
use crate::visibility::draw_list::put_in_order;
use crate::visibility::visible_cells::VisibleCells;
use crate::visibility::{
    Billboard, BillboardColumn, Column, DrawList, Extent, Facing, Layer, Material, Scene,
    SeeThroughColumn, Stats, ThingLoop,
};
use crate::world::{Cell, Heights, Light, Thing, Tile, TileKind};

/// The number of things in view for which memory is reserved in advance, so that a turn of the
/// camera towards more of them allocates nothing.
const MAX_AT_FIRST: usize = 4096;

/// The height of everything solid in a level scene, in cells.
const WALL_TOP: f64 = Heights::LEVEL.ceiling();

/// The number of layers in each column for which memory is reserved in advance.
const LAYERS_OF_A_COLUMN: usize = 16;

/// The memory of the flat way, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FlatMemory {
    pub(crate) passed: PassedHits,
    left: PassedLeft,
    visible: VisibleCells,
    /// The layers before they are put in order.
    by_column: Vec<Layer>,
}

/// The hits that all rays of a frame passed: column by column from the left, and in each from near
/// to far.
///
/// In reverse they are in the order of painting. Rejected: a list for each column, each of which
/// would be an allocation.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PassedHits {
    list: Vec<(usize, Hit)>,
}

/// The passed hits of each column that are not layers yet; empty if no ray passed any.
#[derive(Clone, Debug, Default)]
struct PassedLeft {
    of_columns: Vec<Range<usize>>,
}

/// Fills the layers of `list`, whose columns are known. Returns the time at which one of the
/// billboards next changes its appearance; `None` for never.
pub(crate) fn fill(
    scene: Scene<'_>,
    memory: &mut FlatMemory,
    list: &mut DrawList,
    stats: &mut Stats,
) -> Option<f64> {
    let FlatMemory { passed, left, visible, by_column } = memory;
    if scene.plan.things == ThingLoop::None {
        list.make_room_for_layers(passed.list.capacity());
        let first = list.layers.len();
        for &(column, ref hit) in passed.list.iter().rev() {
            push_hit(scene, column, hit, list);
        }
        let is_glass = |tile: &Tile| matches!(tile.kind, TileKind::Glass(_));
        if scene.world.tiles().iter().any(is_glass) {
            by_column.clear();
            by_column.reserve(list.layers.capacity());
            by_column.extend(list.layers.drain(first..));
            put_in_order(by_column, &list.see_through, &mut list.layers);
        }
        return None;
    }
    let first = list.billboards.len();
    let ceilings = Ceilings::new(scene);
    let considered = find_billboards(scene, ceilings, visible, list);
    stats.change(|stats| {
        stats.things_considered += considered;
        stats.things_drawn += (list.billboards.len() - first) as u64;
    });
    left.begin(passed, list.columns.len());
    list.make_room_for_layers(passed.list.capacity());
    for index in first..list.billboards.len() {
        let Billboard { depth, ref columns, ref rows, .. } = list.billboards[index];
        let is_past_ceilings = ceilings.let_past(depth, rows);
        let rows = rows.clone();
        for x in columns.clone() {
            let column = &list.flat_columns()[x as usize];
            let is_at_wall = column.hit.is_some();
            let mut rows = rows.clone();
            if depth >= column.distance {
                if !(is_past_ceilings && shows_above_wall(scene, x, column, depth)) {
                    continue;
                }
                rows.end = rows.end.min(column.rows.start);
            }
            push_behind(depth, x as usize, scene, (passed, left), list);
            ceilings.for_each_open((x, is_at_wall), depth, rows, |rows| {
                let column = BillboardColumn { column: x, rows, billboard: index };
                list.layers.push(Layer::Billboard(column));
            });
        }
    }
    for column in 0..left.of_columns.len() {
        push_behind(0.0, column, scene, (passed, left), list);
    }
    Billboard::next_change(&list.billboards[first..], scene)
}

/// Finds the billboards in view, from far to near. Returns the number of things and figures
/// considered.
fn find_billboards(
    scene: Scene<'_>,
    ceilings: Ceilings<'_>,
    visible: &mut VisibleCells,
    list: &mut DrawList,
) -> u64 {
    let world = scene.world;
    let first = list.billboards.len();
    if first == 0 {
        let things = world.things().len().min(MAX_AT_FIRST);
        list.billboards.reserve(things + world.figures().len());
    }
    let most_layers = list.columns.len() * LAYERS_OF_A_COLUMN;
    list.layers.reserve(most_layers.saturating_sub(list.layers.len()));
    visible.outline(scene, list.flat_columns());
    let DrawList { billboards, columns, flat_columns, .. } = list;
    let columns = if flat_columns.is_empty() { columns } else { flat_columns };
    let is_in_view = |billboard: &Billboard| {
        let &Billboard { depth, ref rows, columns: Range { start, end }, .. } = billboard;
        let covered = &columns[start as usize..end as usize];
        covered.iter().any(|column| depth < column.distance)
            || ceilings.let_past(depth, rows)
                && (start..).zip(covered).any(|(x, column)| {
                    rows.start < column.rows.start && shows_above_wall(scene, x, column, depth)
                })
    };
    let direct = MirrorTransform::default();
    let mut considered = world.figures().len() as u64;
    let mut consider = |thing: &Thing| {
        considered += 1;
        billboards.extend(Billboard::of_thing(scene, direct, *thing).filter(is_in_view));
    };
    if world.has_open_sky() && world.limit_of_things() > WALL_TOP {
        // They show above walls, and need not be in a visible cell.
        world.things_above(WALL_TOP).for_each(&mut consider);
        visible.things(world).filter(|thing| !world.is_above(thing, WALL_TOP)).for_each(consider);
    } else {
        visible.things(world).for_each(consider);
    }
    billboards.extend(Billboard::of_figures(scene, direct).filter(is_in_view));
    let found = &mut list.billboards[first..];
    for billboard in &mut *found {
        billboard.is_drawn = true;
    }
    for Billboard { rows, depth, .. } in &mut *found {
        rows.end = rows.end.min(scene.projection.row_of_height(0.0, *depth));
    }
    found.sort_unstable_by(from_far_to_near);
    considered
}

/// Whether a billboard at `depth`, behind the end of the ray of `column`, shows above that end: the flat way
/// fills the column up to a wall, and the billboard is not behind the edge of the map.
fn shows_above_wall(scene: Scene<'_>, x: u32, column: &Column, depth: f64) -> bool {
    let ends_at_wall = column.hit.is_some_and(|hit| hit.t >= 0.0);
    ends_at_wall && depth < distance_to_edge(scene.world.grid(), &scene.projection.ray(x))
}

fn from_far_to_near(one: &Billboard, other: &Billboard) -> Ordering {
    other.depth.total_cmp(&one.depth).then_with(|| one.order.cmp(&other.order))
}

impl PassedHits {
    /// Removes all hits and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.list.clear();
    }

    /// Reserves memory for the hits that this number of `rays` pass in all but extreme maps, so
    /// that a turn of the camera towards more of them allocates nothing.
    pub(crate) fn make_room_for(&mut self, rays: usize) {
        const OF_A_RAY: usize = 8;
        self.list.reserve(rays * OF_A_RAY);
    }

    /// Adds a hit that the ray of `column` passed: columns from the left, hits from near to far.
    pub(crate) fn push(&mut self, column: usize, hit: Hit) {
        self.list.push((column, hit));
    }
}

impl PassedLeft {
    /// Finds the hits of each of `columns` columns, none of which is a layer yet.
    fn begin(&mut self, passed: &PassedHits, columns: usize) {
        let Self { of_columns } = self;
        of_columns.clear();
        of_columns.reserve(columns);
        if passed.list.is_empty() {
            return;
        }
        of_columns.resize(columns, 0..0);
        for (index, &(column, _)) in passed.list.iter().enumerate() {
            let left = &mut of_columns[column];
            *left = if Range::is_empty(left) { index..index + 1 } else { left.start..index + 1 };
        }
    }

    /// Removes and returns the furthest remaining hit in `column`, if it is at `depth` or further
    /// away.
    fn take_behind(&mut self, passed: &PassedHits, column: usize, depth: f64) -> Option<Hit> {
        let left = self.of_columns.get_mut(column).filter(|left| !Range::is_empty(left))?;
        let (_, hit) = passed.list[left.end - 1];
        (hit.t >= depth).then(|| {
            left.end -= 1;
            hit
        })
    }
}

/// Makes layers of the remaining hits that the ray of `column` passed at `depth` or further away.
fn push_behind(
    depth: f64,
    column: usize,
    scene: Scene<'_>,
    (passed, left): (&PassedHits, &mut PassedLeft),
    list: &mut DrawList,
) {
    while let Some(hit) = left.take_behind(passed, column, depth) {
        push_hit(scene, column, &hit, list);
    }
}

/// Makes a layer of a hit that the ray of `column` passed.
fn push_hit(scene: Scene<'_>, column: usize, hit: &Hit, list: &mut DrawList) {
    if hit.t > list.flat_columns()[column].distance {
        // The portal way fills this part of the column.
        return;
    }
    let Cell { column: x, row: y } = hit.cell;
    let world = scene.world;
    let material = match world.grid().tile(i64::from(x), i64::from(y)).map(|id| world.tile(id).kind)
    {
        Some(TileKind::Mask(texture)) => Material::Masked(texture),
        Some(TileKind::Glass(glass)) if !glass.is_clear() => Material::Translucent(glass),
        _ => return,
    };
    let (column, facing) = (column as u32, Facing::Side(hit.side));
    let is_lit = scene.plan.walls.faded;
    list.push_see_through(SeeThroughColumn {
        column,
        rows: scene.projection.wall_rows(hit.t),
        facing,
        slope: facing.slope(scene.projection.direction_of(column)),
        t: hit.t,
        u: hit.u,
        light: if is_lit { light_of(scene, column, hit) } else { Light::FULL },
        material,
        extent: Extent::Level,
    });
}
