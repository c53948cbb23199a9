use proptest::prelude::*;

use super::*;
use crate::map;
use crate::visibility::{Filter, FramePlan, FrameSize, PixelAspect};
use crate::world::{Camera, FieldOfView, Heading, World};

const SIDE: usize = 12;
/// Floor, walls, and floors of two other heights.
const TILES: &[u8] = b".#12";

fn world(cells: &[usize]) -> World {
    let mut cells: Vec<u8> = cells.iter().map(|&tile| TILES[tile]).collect();
    cells[SIDE / 2 * SIDE + SIDE / 2] = b'@';
    let rows: Vec<_> = cells.chunks(SIDE).map(String::from_utf8_lossy).collect();
    let grid = rows.join("\n");
    let text = format!(
        "ceiling = 'sky'\ngrid = \"\"\"\n{grid}\n\"\"\"\n[tiles]\n'#'.wall = 'brick'\n\
         '1'.floor_height = 0.25\n'2'.floor_height = 0.5\n[things]\n'@'.start = 0\n"
    );
    map::parse_str(&text).unwrap()
}

/// Calls `test` with the fan of a picture of this width and the view from the camera.
fn with_fan<T>(
    world: &World,
    camera: &Camera,
    width: u32,
    test: impl FnOnce(&Fan<'_>, RayStarts<'_>) -> T,
) -> T {
    let size = FrameSize::new(width, 10).unwrap();
    let projection = &Projection::new(camera, size, PixelAspect::SQUARE);
    let plan = &FramePlan::new(world, Filter::Mip);
    let scene = FrameContext { world, camera, seconds: 0.0, projection, plan };
    let (mut sectors, mut directions) = (Sectors::default(), Directions::default());
    sectors.begin(world, f64::INFINITY);
    directions.begin(projection);
    let fan = Fan::new(scene, &sectors, &directions, 0);
    let place = [camera.position().x as i64, camera.position().y as i64];
    let tile = world.grid().tile(place[0], place[1]);
    let view = RayStarts {
        sector: sectors.of_eye(tile, projection.eye()),
        image: MirrorTransform::default(),
        entries: &[SectorEntry { column: 0, place }],
        is_at_camera: true,
    };
    test(&fan, view)
}

/// Returns true if the fan of `view` finds the face that each ray hits when it is cast alone, and if the same
/// is true for the fans behind these faces, up to this depth.
fn finds_all(fan: &Fan<'_>, view: RayStarts<'_>, columns: Range<usize>, depth: u32) -> bool {
    let (mut memory, mut borders, mut of_each) = (FanMemory::new(), Vec::new(), Vec::new());
    fan.find(view, columns.clone(), &mut memory, &mut borders);
    for column in columns {
        let hit = fan.walk(view, column, fan.directions.of(column));
        extend(&mut of_each, column..column + 1, hit);
    }
    let faces = |borders: &[Border]| -> Vec<_> {
        borders.iter().map(|it| (it.columns.clone(), it.face, it.into)).collect()
    };
    let behind = |border: &Border| {
        let Some((_, tile)) = border.into else { return true };
        let entries = &[SectorEntry { column: border.columns.start, place: border.face.place }];
        let sector = fan.sectors.of(tile).lower;
        let view = RayStarts { sector, entries, is_at_camera: false, ..view };
        depth == 0 || finds_all(fan, view, border.columns.clone(), depth - 1)
    };
    faces(&borders) == faces(&of_each) && borders.iter().all(behind)
}

proptest! {
    #[test]
    fn few_rays_find_the_faces_that_all_rays_hit(
        walls in 0.0..0.5,
        others in 0.0..0.5,
        cells in prop::collection::vec(0.0..1.0, SIDE * SIDE),
        position in (0.01..11.99, 0.01..11.99),
        degrees in prop_oneof![
            0.0..360.0,
            prop::sample::select(&[0.0, 45.0, 90.0, 180.0, 225.0, 270.0][..]),
        ],
        field_of_view in prop_oneof![Just(66.0), 0.001..179.9],
        width in 1_u32..300,
    ) {
        let tile = |cell: f64| match cell {
            _ if cell < walls => 1,
            _ if cell < walls + others => 2 + usize::from(cell < walls + others / 2.0),
            _ => 0,
        };
        let world = world(&cells.into_iter().map(tile).collect::<Vec<_>>());
        let position = DVec2::from(position);
        prop_assume!(position.fract().min_element() > 1e-9);
        let heading = Heading::from_degrees(degrees).unwrap();
        let field_of_view = FieldOfView::from_degrees(field_of_view).unwrap();
        let camera = Camera::new(position, heading, field_of_view).unwrap();
        let test = |fan: &Fan<'_>, view: RayStarts<'_>| finds_all(fan, view, 0..width as usize, 3);
        prop_assert!(with_fan(&world, &camera, width, test));
    }
}

/// The number of rays cast for a picture of `room`, and the number of faces found.
fn rays_and_faces(room: &[&str], degrees: f64) -> (u64, usize) {
    let grid = room.join("\n");
    let text = format!(
        "grid = \"\"\"\n{grid}\n\"\"\"\n[tiles]\n'#'.wall = 'brick'\n[things]\n'@'.start = 0\n"
    );
    let world = map::parse_str(&text).unwrap();
    let heading = Heading::from_degrees(degrees).unwrap();
    let camera = Camera::new(DVec2::new(4.3, 4.6), heading, FieldOfView::default()).unwrap();
    with_fan(&world, &camera, 640, |fan, view| {
        let mut borders = Vec::new();
        fan.find(view, 0..640, &mut FanMemory::new(), &mut borders);
        (fan.counts.get().rays, borders.len())
    })
}

const ROOM: [&str; 6] =
    ["#########", "#.......#", "#.......#", "#.......#", "#...@...#", "#########"];

#[test]
fn a_face_costs_two_rays_at_most() {
    let with_pillars = [
        "##########",
        "#........#",
        "#.#...#..#",
        "#........#",
        "#...@....#",
        "#..#...#.#",
        "##########",
    ];
    for room in [&ROOM[..], &with_pillars] {
        for degrees in (0..360).step_by(7) {
            let (rays, faces) = rays_and_faces(room, f64::from(degrees));
            assert!(rays <= 2 * faces as u64, "{rays} rays for {faces} faces at {degrees}°");
        }
    }
}

#[test]
fn neighbouring_faces_of_a_near_wall_cost_one_ray_each() {
    let (rays, faces) = rays_and_faces(&ROOM, 270.0);
    assert!(faces >= 5 && rays <= faces as u64 + 1, "{rays} rays for {faces} faces");
}
