//! Mip levels reduce the shimmer of a turning view by at least a quarter, in levels and in the
//! gallery.

use std::path::Path;

use cellcaster::map;
use cellcaster::render::{Filter, FrameSize};
use cellcaster::world::{FieldOfView, World};
use cellcaster_lab::accuracy::shimmer;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// The largest allowed ratio.
const MOST: f64 = 0.75;

/// The ratio of the shimmer with mip levels to that without, from the start of `world`.
fn share_left(world: &World) -> f64 {
    let camera = world.start_camera(FieldOfView::default());
    let size = FrameSize::new(160, 90).unwrap();
    let [mip, nearest] =
        [Filter::Mip, Filter::Nearest].map(|filter| shimmer(world, &camera, size, filter));
    mip / nearest
}

#[test]
fn levels_turn_calmly() {
    for level in ["cellar", "museum", "citadel", "cistern", "observatory"] {
        let world = map::load(format!("{ROOT}/tests/maps/{level}.toml").as_ref()).unwrap();
        let share = share_left(&world);
        assert!(share < MOST, "{level}: {share}");
    }
}

#[test]
fn textures_far_away_turn_calmly() {
    for name in ["flat", "floor", "checker", "mip"] {
        let world = map::load(Path::new(&format!("{ROOT}/maps/gallery/{name}.toml"))).unwrap();
        let share = share_left(&world);
        assert!(share < MOST, "{name}: {share}");
    }
}
