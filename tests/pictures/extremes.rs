//! Extreme cameras: positions, fields of view and pixels of any size that the types allow.
//!
//! A picture is a function of its scene and its camera. A renderer and a frame that have drawn
//! another picture draw the same picture as new ones.

use std::sync::LazyLock;

use cellcaster::map::{self, Level};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::space;
use cellcaster::world::{Camera, Cell, FieldOfView, Heading, Opening, Pitch};
use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::select;

/// The view of a camera, for a grid or for bodies.
#[derive(Clone, Copy, Debug)]
struct View {
    place: DVec3,
    heading: Heading,
    /// The pitch in degrees, from −30 to 30.
    pitch: f64,
    width: FieldOfView,
    size: FrameSize,
    pixel_aspect: PixelAspect,
}

impl View {
    fn camera(&self) -> Camera {
        let camera = Camera::new(self.place.truncate(), self.heading, self.width).unwrap();
        let pitch = Pitch::from_degrees(self.pitch).unwrap();
        camera.with_eye(self.place.z).unwrap().with_pitch(pitch)
    }

    fn camera_in_space(&self) -> space::Camera {
        let place = self.place.clamp(DVec3::splat(-1e6), DVec3::splat(1e6));
        let camera = space::Camera::new(place, self.heading, self.width).unwrap();
        camera.with_elevation(space::Elevation::from_degrees(3.0 * self.pitch).unwrap())
    }
}

/// A coordinate on a map, or very far from it.
fn coordinate() -> impl Strategy<Value = f64> {
    let far = [1e-300, 1e9, 2e9, 1e17, 1e19, 1e153, 1e300, f64::MAX];
    let near = prop_oneof![0.0..20.0, (0..20).prop_map(f64::from)];
    prop_oneof![2 => near, 1 => (select(far.to_vec()), any::<bool>()).prop_map(signed)]
}

fn signed((number, is_negative): (f64, bool)) -> f64 {
    if is_negative { -number } else { number }
}

fn view() -> impl Strategy<Value = View> {
    let eye = prop_oneof![Just(0.5), -1.0..3.0, select(vec![0.0, 1.0, -1e300, f64::MAX])];
    let axis = (0..8).prop_map(|eighth| 45.0 * f64::from(eighth));
    let narrow = [5e-324, 1e-320, 1e-300, 1e-153, 1e-15, 1e-6];
    let wide = [179.0, 179.999_999, 180.0_f64.next_down()];
    let degrees = prop_oneof![select(narrow.to_vec()), select(wide.to_vec()), 1.0..179.0];
    let aspects =
        [5e-324, 1e-300, 1e-100, 1e-6, 1e-3, 0.5, 1.0, 2.0, 1e3, 1e6, 1e100, 1e300, f64::MAX];
    let pixel_aspect = select(aspects.to_vec()).prop_filter_map("not allowed", PixelAspect::new);
    let size = (1_u32..40, 1_u32..40);
    let heading = prop_oneof![0.0..360.0, axis];
    let pitch = prop_oneof![Just(0.0), -30.0..=30.0];
    ((coordinate(), coordinate(), eye), heading, pitch, degrees, size, pixel_aspect).prop_map(
        |(place, heading, pitch, degrees, (width, height), pixel_aspect)| View {
            place: place.into(),
            heading: Heading::from_degrees(heading).unwrap(),
            pitch,
            width: FieldOfView::from_degrees(degrees).unwrap(),
            size: FrameSize::new(width, height).unwrap(),
            pixel_aspect,
        },
    )
}

/// The maps of the gallery, which use every kind of tile, thing and body, with doors ajar.
static LEVELS: LazyLock<Vec<Level>> = LazyLock::new(|| {
    let folder = std::fs::read_dir("maps/gallery").unwrap();
    let mut paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let mut levels: Vec<_> = paths.iter().map(|path| map::load_level(path).unwrap()).collect();
    for level in &mut levels {
        if let Level::Grid(world) = level {
            let (width, height) = (world.grid().width(), world.grid().height());
            for (column, row) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                world.set_opening(Cell { column, row }, Opening::new(0.4).unwrap());
            }
        }
    }
    levels
});

/// A frame, and the renderers that draw into it.
struct Drawing {
    frame: Frame,
    of_grids: Renderer,
    of_bodies: space::Renderer,
}

impl Drawing {
    fn new(view: &View) -> Self {
        let frame = Frame::new(view.size, view.pixel_aspect);
        Self { frame, of_grids: Renderer::new(), of_bodies: space::Renderer::new() }
    }

    fn draw(&mut self, level: &Level, view: &View) {
        let Self { frame, of_grids, of_bodies } = self;
        frame.resize(view.size, view.pixel_aspect);
        match level {
            Level::Grid(world) => of_grids.render(world, &view.camera(), frame),
            Level::Space(scene) => of_bodies.render(scene, &view.camera_in_space(), frame),
        }
    }
}

/// Checks that the second view is drawn the same after the first view as without it.
fn check(levels: [&Level; 2], views: [&View; 2]) -> Result<(), TestCaseError> {
    let mut old = Drawing::new(views[0]);
    old.draw(levels[0], views[0]);
    old.draw(levels[1], views[1]);
    let mut fresh = Drawing::new(views[1]);
    fresh.draw(levels[1], views[1]);
    let leftovers = old.frame.rows().flatten().zip(fresh.frame.rows().flatten());
    let count = leftovers.filter(|(old, fresh)| old != fresh).count();
    prop_assert_eq!(count, 0, "pixels of an older picture are left");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn an_extreme_view_leaves_no_trace_of_the_previous_picture(
        before in any::<prop::sample::Index>(),
        level in any::<prop::sample::Index>(),
        views in [view(), view()],
    ) {
        check([before.get(&LEVELS), level.get(&LEVELS)], [&views[0], &views[1]])?;
    }
}
