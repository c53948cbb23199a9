//! Mip levels reduce the shimmer of a turning view by at least a quarter, in levels and in the
//! gallery.

use std::path::Path;

use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// The largest allowed ratio.
const MAX: f64 = 0.75;

/// The mean change of a channel from frame to frame, in steps of 8 bits, over sixty frames.
/// `camera` turns by a ninth of a degree before each. Edges that move change pixels with every
/// filter.
fn shimmer(world: &World, camera: &Camera, size: FrameSize, filter: Filter) -> f64 {
    const TURNS: u32 = 60;
    /// A ninth of a degree, in radians.
    const TURN: f64 = 0.002;
    let mut camera = *camera;
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    let mut before = Frame::new(size, PixelAspect::SQUARE);
    let mut after = before.clone();
    renderer.render(world, &camera, &mut before);
    let (mut sum, mut count) = (0_u64, 0_u64);
    for _ in 0..TURNS {
        camera.heading = camera.heading.turned(TURN);
        renderer.render(world, &camera, &mut after);
        for (one, other) in before.rows().flatten().zip(after.rows().flatten()) {
            let channels = one.channels().into_iter().zip(other.channels());
            sum += channels.map(|(one, other)| u64::from(one.abs_diff(other))).sum::<u64>();
            count += 3;
        }
        std::mem::swap(&mut before, &mut after);
    }
    sum as f64 / count.max(1) as f64
}

/// The shimmer with mip levels divided by the shimmer without, from the start of `world`.
fn share_left(world: &World) -> f64 {
    let camera = world.start_camera(FieldOfView::default());
    let size = FrameSize::new(160, 90).unwrap();
    let [mip, nearest] =
        [Filter::Mip, Filter::Nearest].map(|filter| shimmer(world, &camera, size, filter));
    mip / nearest
}

#[test]
fn levels_flicker_little_while_turning() {
    for level in ["cellar", "museum", "citadel", "cistern", "observatory"] {
        let world = map::load(format!("{ROOT}/tests/maps/{level}.toml").as_ref()).unwrap();
        let share = share_left(&world);
        assert!(share < MAX, "{level}: {share}");
    }
}

#[test]
fn distant_textures_flicker_little_while_turning() {
    for name in ["flat", "floor", "checker", "mip"] {
        let world = map::load(Path::new(&format!("{ROOT}/maps/gallery/{name}.toml"))).unwrap();
        let share = share_left(&world);
        assert!(share < MAX, "{name}: {share}");
    }
}
