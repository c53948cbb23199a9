//! The flat way to fill a draw list: each ray ends at the first wall.
//!
//! Few rays are cast: the [fan](fan) of a picture is found from some of them. Rays that hit a tile which
//! may be passed are cast again, and the hits that they pass are recorded.

mod ceilings;
mod fan;
mod layers;
mod parts;
mod planes;
mod portal_starts;
mod wall;

use glam::DVec2;

use super::column::Column;
use super::stats::RayCounter;
use super::{DrawList, Filter, Projection, Scene, Stats};
use crate::cast::{Caster, Hit, Ray};
use crate::world::{Cell, Grid, TileKind, World};
use fan::Fan;
pub(crate) use layers::{FlatMemory, PassedHits};
pub(crate) use planes::{PlaneRow, for_each_span};
pub(crate) use portal_starts::PortalStarts;
pub(crate) use wall::{for_each_wall_column, for_each_wall_part, for_each_wall_run};

/// Finds the columns of `list`, with the walls that `caster` finds in `grid`, and the starts of the
/// columns that are left to the portal way.
pub(crate) fn find_columns<C: Caster>(
    scene: Scene<'_>,
    (caster, grid): (&C, &Grid),
    memory: &mut FlatMemory,
    list: &mut DrawList,
    stats: &mut Stats,
) {
    list.clear();
    list.is_flat = true;
    let (columns, passed) = (&mut list.columns, &mut memory.passed);
    if stats.are_kept() {
        let counter = RayCounter::new(caster, grid);
        cast(&counter, grid, scene, columns, passed);
        stats.change(|stats| counter.add_to(stats));
    } else {
        cast(caster, grid, scene, columns, passed);
    }
    if scene.world.level_grid().is_some() {
        portal_starts::leave_to_portals(scene, list);
    }
    if scene.plan.filter == Filter::Area && list.is_flat {
        parts::find(scene, list);
    }
}

/// Fills the layers of `list`, whose columns are known, in front of the layers already in it.
/// Returns the time at which a thing in view next changes its appearance; `None` for never.
pub(crate) fn fill_layers(
    scene: Scene<'_>,
    memory: &mut FlatMemory,
    list: &mut DrawList,
    stats: &mut Stats,
) -> Option<f64> {
    if list.is_flat { layers::fill(scene, memory, list, stats) } else { None }
}

/// Casts the ray of every column into `columns` and the hits that it passes into `passed`, and
/// overwrites both.
fn cast<C: Caster>(
    caster: &C,
    grid: &Grid,
    scene: Scene<'_>,
    columns: &mut Vec<Column>,
    passed: &mut PassedHits,
) {
    let Scene { world, projection, .. } = scene;
    passed.clear();
    let is_of_walls = world.is_of_walls();
    if !is_of_walls {
        passed.make_room_for(projection.columns());
    }
    let cast_through = |index: usize, passed: &mut PassedHits| {
        let ray = projection.ray(index as u32);
        let hit = caster.cast_through(world, &ray, |hit| passed.push(index, hit));
        column_of(grid, projection, &ray, hit)
    };
    if !projection.fans_out() || stands_in_what_may_be_hit(world, projection.origin()) {
        columns.clear();
        columns.extend((0..projection.columns()).map(|index| cast_through(index, passed)));
        return;
    }
    columns.resize(projection.columns(), Column::UNKNOWN);
    Fan::new(caster, grid, projection).cast(columns);
    if is_of_walls {
        return;
    }
    for (index, column) in columns.iter_mut().enumerate() {
        if column.hit.as_ref().is_some_and(|hit| may_be_passed(world, hit.cell)) {
            *column = cast_through(index, passed);
        }
    }
}

/// Whether `cell` ends rays, is level, and is not a wall.
fn may_be_passed(world: &World, cell: Cell) -> bool {
    world
        .tile_in(cell)
        .is_some_and(|tile| !matches!(tile.kind, TileKind::Wall(_)) && tile.is_level())
}

/// Whether `place` is in, or at the edge of, a cell whose content a ray may hit without entering
/// the cell.
fn stands_in_what_may_be_hit(world: &World, place: DVec2) -> bool {
    let around = |along: f64| [along.floor() as i64, (along.ceil() - 1.0) as i64];
    let cells = around(place.x).map(|column| around(place.y).map(|row| (column, row)));
    cells.as_flattened().iter().any(|&(column, row)| {
        let tile = world.grid().tile(column, row);
        let kind = tile.map(|tile| world.tile(tile).kind);
        matches!(kind, Some(TileKind::Door(_) | TileKind::Shape(_)))
    })
}

/// The column of a `ray` with this hit.
#[inline]
fn column_of(grid: &Grid, projection: &Projection, ray: &Ray, hit: Option<Hit>) -> Column {
    let distance = hit.map_or_else(|| distance_to_edge(grid, ray), |hit| hit.t);
    Column { hit, distance, rows: projection.wall_rows(distance) }
}

/// The place of `point` in the picture, in columns from its left edge; `None` if it is behind the camera.
fn place_of(projection: &Projection, point: DVec2) -> Option<f64> {
    let place = projection.place(point);
    (place.depth > 0.0).then_some(place.column)
}

/// The distance along `ray` to the edge of the map; 0 if the ray is off the map and never enters
/// it.
fn distance_to_edge(grid: &Grid, ray: &Ray) -> f64 {
    let edges = DVec2::new(f64::from(grid.width()), f64::from(grid.height()));
    let along = |origin: f64, direction: f64, edge: f64| {
        if direction > 0.0 {
            (edge - origin) / direction
        } else if direction < 0.0 {
            origin / -direction
        } else {
            f64::INFINITY
        }
    };
    let (origin, direction) = (ray.origin(), ray.direction());
    let leaves = along(origin.x, direction.x, edges.x).min(along(origin.y, direction.y, edges.y));
    // Of two zeros, `max` returns either; adding zero turns −0 into +0.
    leaves.max(0.0) + 0.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::cast::Exact;
    use crate::map;
    use crate::visibility::{FramePlan, FrameSize, PixelAspect};
    use crate::world::{Camera, FieldOfView, Heading};

    const SIDE: usize = 12;
    /// Floor, walls, and tiles that may be passed.
    const TILES: &[u8] = b".#+%~o/";

    /// A map of such tiles, with a start in the middle.
    fn world(cells: &[u8]) -> World {
        let mut cells = cells.to_vec();
        hang_doors(&mut cells);
        let rows: Vec<_> = cells.chunks(SIDE).map(String::from_utf8_lossy).collect();
        let grid = rows.join("\n");
        let text = format!(
            "grid = \"\"\"\n{grid}\n\"\"\"
            [tiles]
            '#'.wall = 'brick'
            '+'.door = 'oak'
            '%'.mask = 'grate'
            '~'.glass = '#406080'
            'o' = {{ pillar = 'stone', radius = 0.3 }}
            '/' = {{ diagonal = 'stone', from = 'south-west' }}
            [things]
            '@'.start = 0"
        );
        map::parse_str(&text).unwrap()
    }

    /// Places a wall on either side of each door, and floor before and behind it, or removes the
    /// door if the place is needed by another; and places the start.
    fn hang_doors(cells: &mut [u8]) {
        let is_inside = |place: usize| {
            [place % SIDE, place / SIDE].iter().all(|along| (1..SIDE - 1).contains(along))
        };
        let around = |place| [place - 1, place + 1, place - SIDE, place + SIDE];
        for place in (0..cells.len()).filter(|&place| is_inside(place)) {
            if cells[place] == b'+' {
                around(place).into_iter().zip(*b"##..").for_each(|(at, tile)| cells[at] = tile);
            }
        }
        cells[SIDE / 2 * SIDE + SIDE / 2] = b'@';
        for place in 0..cells.len() {
            let hangs = || around(place).map(|at| cells[at]) == *b"##..";
            if cells[place] == b'+' && !(is_inside(place) && hangs()) {
                cells[place] = b'.';
            }
        }
    }

    /// A coordinate on the map or near it, or on a line between cells.
    fn place() -> impl Strategy<Value = f64> {
        let line = (0..=SIDE).prop_map(|line| line as f64);
        prop_oneof![2 => -2.0..SIDE as f64 + 2.0, 1 => line]
    }

    proptest! {
        #[test]
        fn few_rays_find_the_hits_of_all_rays(
            (floor, walls) in (0.3..1.0, 0.0..1.0),
            cells in prop::collection::vec(0.0..1.0, SIDE * SIDE),
            position in (place(), place()),
            degrees in prop_oneof![
                0.0..360.0,
                prop::sample::select(&[0.0, 45.0, 90.0, 180.0, 225.0, 270.0][..]),
            ],
            field_of_view in prop_oneof![Just(66.0), 0.001..179.9],
            width in 1_u32..300,
        ) {
            let walls = floor + (1.0 - floor) * walls;
            let tile = |cell: f64| match cell {
                _ if cell < floor => b'.',
                _ if cell < walls => b'#',
                _ => TILES[2 + ((cell - walls) / (1.0 - walls) * 5.0) as usize],
            };
            let world = world(&cells.into_iter().map(tile).collect::<Vec<_>>());
            let camera = Camera::new(
                position.into(),
                Heading::from_degrees(degrees).unwrap(),
                FieldOfView::from_degrees(field_of_view).unwrap(),
            )
            .unwrap();
            let size = FrameSize::new(width, 10).unwrap();
            let projection = &Projection::new(&camera, size, PixelAspect::SQUARE);
            let plan = &FramePlan::new(&world, &camera, Filter::Mip);
            let scene = Scene { world: &world, camera: &camera, seconds: 0.0, projection, plan };
            let (mut columns, mut passed) = (Vec::new(), PassedHits::default());
            cast(&Exact, world.grid(), scene, &mut columns, &mut passed);
            let mut expected_passed = PassedHits::default();
            let expected = projection.rays().enumerate().map(|(index, ray)| {
                Exact.cast_through(&world, &ray, |hit| expected_passed.push(index, hit))
            });
            let expected: Vec<_> = expected.collect();
            let hits: Vec<_> = columns.into_iter().map(|column| column.hit).collect();
            prop_assert_eq!(hits, expected);
            prop_assert_eq!(passed, expected_passed);
        }
    }
}
