//! Camera rays with extreme fields of view, or with a wall close to the camera.

use glam::DVec2;

use super::{Set, hall, places};
use cellcaster::cast::Ray;
use cellcaster::world::{Camera, FieldOfView, Heading};

pub(crate) fn sets() -> Vec<Set> {
    let headings = [0.0, 30.0, 45.0, 90.0, 200.0, 315.0];
    let everywhere =
        || places().into_iter().flat_map(|place| headings.map(|degrees| (place, degrees)));
    vec![
        set("narrow view", views(everywhere(), 0.001)),
        set("wide view", views(everywhere(), 179.9)),
        set("nose to the wall", views(before_walls(), 66.0)),
    ]
}

fn set(name: &'static str, rays: Vec<Ray>) -> Set {
    Set { name, grid: hall(), rays }
}

/// Positions with the nearest wall at a distance from 1e-12 cells down to the smallest double, and
/// the heading towards it.
fn before_walls() -> Vec<(DVec2, f64)> {
    let mut places = Vec::new();
    for gap in [1e-12, 1e-15] {
        places.push((DVec2::new(1.0 + gap, 2.6), 180.0));
        places.push((DVec2::new(4.4, 1.0 + gap), 270.0));
    }
    // Only near zero are doubles close enough together: off the map, before its first column and
    // row.
    for gap in [1e-12, 1e-30, 1e-100, 1e-300, 5e-324] {
        places.push((DVec2::new(-gap, 2.6), 0.0));
        places.push((DVec2::new(4.4, -gap), 90.0));
    }
    places
}

/// The rays of 40 columns of pixels for each camera.
fn views(cameras: impl IntoIterator<Item = (DVec2, f64)>, degrees: f64) -> Vec<Ray> {
    const COLUMNS: i32 = 40;
    let field_of_view = FieldOfView::from_degrees(degrees).unwrap_or_default();
    let camera = |(place, degrees)| {
        Camera::new(place, Heading::from_degrees(degrees).unwrap_or_default(), field_of_view)
    };
    let rays = |camera: Camera| {
        (0..COLUMNS).filter_map(move |column| {
            let across = f64::from(2 * column + 1 - COLUMNS) / f64::from(COLUMNS);
            Ray::new(camera.position(), camera.direction() + camera.plane() * across).ok()
        })
    };
    cameras.into_iter().filter_map(camera).flat_map(rays).collect()
}
