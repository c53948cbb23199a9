use std::collections::BTreeSet;

use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::map;
use crate::world::{FieldOfView, Heading};

const SIDE: usize = 12;

/// A map of these rows under the sky, with tiles of several heights.
fn world(rows: &[String]) -> World {
    world_under("'sky'", "", rows)
}

/// A map of these rows with this ceiling. `more` is text of its header.
fn world_under(ceiling: &str, more: &str, rows: &[String]) -> World {
    let text = format!(
        "ceiling = {ceiling}\n{more}grid = '''\n{}\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n\
         'H' = {{ wall = 'brick', height = 3 }}\n'l' = {{ wall = 'brick', height = 0.3 }}\n\
         '_' = {{ floor_height = -2 }}\n'=' = {{ floor_height = 0.6 }}\n\
         'm' = {{ mirror = true, height = 3 }}\n'g' = {{ glass = '#80ff80' }}\n\
         [things]\n'@' = {{ start = 0 }}\n",
        rows.join("\n")
    );
    map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn rows(drawing: &[&str]) -> Vec<String> {
    drawing.iter().map(|&row| row.to_owned()).collect()
}

fn camera(position: DVec2, degrees: f64) -> Camera {
    let heading = Heading::from_degrees(degrees).unwrap();
    Camera::new(position, heading, FieldOfView::default()).unwrap()
}

fn seen(world: &World, camera: &Camera, rays: u32) -> BTreeSet<(u32, u32)> {
    let mut explored = Explored::default();
    explored.look(world, camera, rays);
    explored.cells().into_iter().map(|Cell { column, row }| (column, row)).collect()
}

/// The cells of a row that are seen from the first one, looking along the row: `x` for seen cells.
fn seen_along(row: &str, eye: f64) -> String {
    let border = "#".repeat(row.chars().count());
    let world = world(&rows(&[&border, row, &border]));
    let camera = camera(DVec2::new(0.5, 1.5), 0.0).with_eye(eye).unwrap();
    let seen = seen(&world, &camera, 1);
    (0..row.len() as u32)
        .map(|column| if seen.contains(&(column, 1)) { 'x' } else { '.' })
        .collect()
}

#[test]
fn walls_hide_the_cells_behind_them() {
    assert_eq!(seen_along("@....#..", 0.5), "xxxxxx..");
    assert_eq!(seen_along("@..H....", 0.5), "xxxx....");
}

#[test]
fn a_low_wall_hides_the_floor_just_behind_it() {
    // From an eye at 0.5, over a wall of height 0.3 that ends 3.5 cells away, the floor shows from
    // 8.75 cells on.
    assert_eq!(seen_along("@..l............", 0.5), "xxxx.....xxxxxxx");
    // A higher wall shows above the low one.
    assert_eq!(seen_along("@..l..H.", 0.5), "xxxx..x.");
}

#[test]
fn the_floor_of_a_pit_is_hidden_from_afar_and_the_face_of_a_step_is_seen() {
    assert_eq!(seen_along("@...__", 0.5), "xxxx..");
    assert_eq!(seen_along("@__.", 0.5), "x..x");
    assert_eq!(seen_along("@..=..", 0.5), "xxxx..");
    assert_eq!(seen_along("@..=....", 1.5), "xxxx..xx");
}

#[test]
fn a_mirror_adds_no_cells() {
    assert_eq!(seen_along("@..m", 0.5), "xxxx");
    let world = world(&rows(&["#####", "#..@m", "#####"]));
    let seen = seen(&world, &camera(DVec2::new(3.5, 1.5), 0.0), 80);
    assert!(!seen.contains(&(1, 1)) && !seen.contains(&(2, 1)), "{seen:?}");
}

#[test]
fn seen_cells_are_kept_when_the_window_moves_back() {
    let world = world(&rows(&["########", "#@.....#", "########"]));
    let mut explored = Explored::default();
    explored.look(&world, &camera(DVec2::new(1.5, 1.5), 0.0), 40);
    let before = explored.cells();
    assert!(!before.is_empty());
    explored.follow(Site { column: 3, row: -1 });
    let moved: Vec<Cell> = before
        .iter()
        .filter(|cell| cell.column >= 3 && cell.row < 2)
        .map(|cell| Cell { column: cell.column - 3, row: cell.row + 1 })
        .collect();
    assert_eq!(explored.cells(), moved);
    explored.follow(Site { column: -1000, row: 77 });
    assert_eq!(explored.cells(), []);
    explored.follow(Site::default());
    assert_eq!(explored.cells(), before);
}

/// The cells that a ray crosses up to the first wall, from the midpoints between the lines that it
/// crosses.
fn crossed(world: &World, origin: DVec2, direction: DVec2) -> Option<Vec<(u32, u32)>> {
    let lines = |origin: f64, direction: f64| {
        (0..=SIDE).map(move |line| (line as f64 - origin) / direction)
    };
    let mut places: Vec<f64> = lines(origin.x, direction.x)
        .chain(lines(origin.y, direction.y))
        .filter(|t| *t > 0.0)
        .collect();
    places.push(0.0);
    places.sort_by(f64::total_cmp);
    // If a ray passes through a corner, rounding decides.
    if places.windows(2).any(|pair| pair[1] - pair[0] < 1e-9) {
        return None;
    }
    let mut cells = Vec::new();
    for pair in places.windows(2) {
        let point = origin + direction * f64::midpoint(pair[0], pair[1]);
        let (column, row) = (point.x.floor() as i64, point.y.floor() as i64);
        let Some(tile) = world.grid().tile(column, row) else { break };
        cells.push((column as u32, row as u32));
        if world.grid().is_solid_tile(tile) {
            break;
        }
    }
    Some(cells)
}

proptest! {
    /// Rays that take the shortcut through cells with the observer's own gap see the same as rays
    /// that do not.
    #[test]
    fn the_shortcut_through_equal_cells_sees_the_same_cells(
        tiles in prop::collection::vec(0..40_usize, SIDE * SIDE),
        place in (1..11_usize, 1..11_usize, 0..5_usize, 0..5_usize),
        degrees in prop_oneof![(0..8_u32).prop_map(|eighth| f64::from(eighth) * 45.0), 0.0..360.0],
        eye in prop_oneof![Just(0.5), -0.5..2.5],
        ceiling in prop_oneof![Just("'sky'"), Just("'wood'")],
        fog in prop::bool::weighted(0.3),
        rays in 1..60_u32,
    ) {
        let (column, row, east, south) = place;
        let character = |(index, &tile): (usize, &usize)| match b"##HHll__==mmg+".get(tile) {
            _ if index == row * SIDE + column => '@',
            Some(b'+') | None => '.',
            Some(&tile) => tile.into(),
        };
        let drawing: Vec<char> = tiles.iter().enumerate().map(character).collect();
        let drawing: Vec<String> = drawing.chunks(SIDE).map(|row| row.iter().collect()).collect();
        let fog = if fog { "fog = { color = '#000000', distance = 0.7 }\n" } else { "" };
        let world = world_under(ceiling, fog, &drawing);
        let position = DVec2::new(column as f64 + 0.25 * east as f64, row as f64 + 0.25 * south as f64);
        let camera = camera(position, degrees).with_eye(eye).unwrap();
        let mut stepping = Observer::new(&world, &camera);
        stepping.forget_passages();
        let mut expected = Explored::default();
        expected.look_by(&stepping, &world, &camera, rays);
        let mut explored = Explored::default();
        explored.look(&world, &camera, rays);
        prop_assert_eq!(explored.cells(), expected.cells());
        prop_assert_eq!(explored.share(), expected.share());
    }

    #[test]
    fn a_flat_map_shows_exactly_the_cells_that_rays_cross(
        walls in prop::collection::vec(prop::bool::weighted(0.2), SIDE * SIDE),
        position in (1.01..10.99, 1.01..10.99),
        degrees in 0.0..360.0,
        rays in 1..60_u32,
    ) {
        let position = DVec2::from(position);
        let own = position.y as usize * SIDE + position.x as usize;
        let cell = |(place, &wall): (usize, &bool)| {
            if place == own { '@' } else if wall { '#' } else { '.' }
        };
        let drawing: Vec<char> = walls.iter().enumerate().map(cell).collect();
        let drawing: Vec<String> = drawing.chunks(SIDE).map(|row| row.iter().collect()).collect();
        let world = world(&drawing);
        let camera = camera(position, degrees);
        let plane = camera.direction().perp() * camera.field_of_view.half_width();
        let mut expected = BTreeSet::new();
        for column in 0..rays {
            let across = 2.0 * (f64::from(column) + 0.5) / f64::from(rays) - 1.0;
            let cells = crossed(&world, position, camera.direction() + plane * across);
            prop_assume!(cells.is_some());
            expected.extend(cells.unwrap());
        }
        prop_assert_eq!(seen(&world, &camera, rays), expected);
    }
}
