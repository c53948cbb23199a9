//! Pictures that must be equal.

use std::num::NonZero;

use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Heading, Pitch, World};
use glam::DVec2;

use crate::bytes::Bytes;

/// Fields of view in degrees, up to the ends of the allowed range.
const FIELDS: [f64; 8] = [66.0, 90.0, 30.0, 5.0, 120.0, 179.0, 1e-3, 5e-324];
const ASPECTS: [f64; 8] = [1.0, 1.0, 0.5, 2.0, 0.1, 10.0, 1e-300, 1e300];
const COORDINATES: [f64; 8] = [0.0, 0.5, 1.0, -1.0, 1e-300, 1e9, -1e300, f64::MAX];

/// The size and shape of a picture, and its field of view.
pub(crate) struct Format {
    pub(crate) size: FrameSize,
    pub(crate) pixel_aspect: PixelAspect,
    pub(crate) field_of_view: FieldOfView,
}

impl Format {
    pub(crate) fn new(choices: &mut Bytes) -> Self {
        let (width, height) = (48 - choices.below(48) as u32, 36 - choices.below(36) as u32);
        Self {
            size: FrameSize::new(width, height).expect("neither is 0"),
            pixel_aspect: PixelAspect::new(choices.pick(&ASPECTS)).unwrap_or(PixelAspect::SQUARE),
            field_of_view: FieldOfView::from_degrees(choices.pick(&FIELDS)).unwrap_or_default(),
        }
    }

    pub(crate) fn frame(&self) -> Frame {
        Frame::new(self.size, self.pixel_aspect)
    }
}

/// A camera anywhere, mostly on the map.
pub(crate) fn camera(world: &World, format: &Format, choices: &mut Bytes) -> Camera {
    let mut coordinate = |side: u32| match choices.below(8) {
        0 => choices.pick(&COORDINATES),
        1 => f64::from(choices.byte()) / 2.0,
        _ => choices.between(0.0, f64::from(side)),
    };
    let place = DVec2::new(coordinate(world.grid().width()), coordinate(world.grid().height()));
    let heading = Heading::from_degrees(choices.between(0.0, 360.0)).unwrap_or_default();
    let camera = Camera::new(place, heading, format.field_of_view).expect("it is finite");
    let eye = if choices.flag() { choices.pick(&COORDINATES) } else { choices.between(-2.0, 4.0) };
    let pitch = Pitch::from_degrees(choices.between(-30.0, 30.0)).unwrap_or_default();
    camera.with_eye(eye).unwrap_or(camera).with_pitch(pitch)
}

/// A renderer and a frame that have drawn all previous pictures.
pub(crate) struct Old {
    renderer: Renderer,
    frame: Frame,
}

impl Old {
    pub(crate) fn new(format: &Format) -> Self {
        Self { renderer: Renderer::new(), frame: format.frame() }
    }

    /// Draws a picture in every way, and checks that all results are equal.
    pub(crate) fn check(
        &mut self,
        world: &World,
        camera: &Camera,
        format: &Format,
        choices: &mut Bytes,
    ) {
        let filter = choices.pick(&[Filter::Mip, Filter::Nearest, Filter::Area]);
        let seconds = f64::from(choices.byte()) / 16.0;
        let keeps_surfaces = choices.flag();
        let prepare = |renderer: &mut Renderer, threads: usize| {
            renderer.set_filter(filter);
            renderer.set_time(seconds);
            renderer.keep_surfaces(keeps_surfaces);
            renderer.set_threads(NonZero::new(threads).unwrap_or(NonZero::<usize>::MIN));
        };
        let mut fresh = (Renderer::new(), format.frame());
        prepare(&mut fresh.0, 1);
        let explained = fresh.0.explain(world, camera, &mut fresh.1);

        self.frame.resize(format.size, format.pixel_aspect);
        prepare(&mut self.renderer, 1);
        self.renderer.render(world, camera, &mut self.frame);
        check_equal(&self.frame, &fresh.1, "after another picture");

        let mut several = (Renderer::new(), format.frame());
        prepare(&mut several.0, 3);
        let counted = several.0.explain(world, camera, &mut several.1);
        check_equal(&several.1, &fresh.1, "with several threads");
        assert_eq!(counted.stats, explained.stats);
        for (x, y) in [(0, 0), (format.size.width.get() / 2, format.size.height.get() / 2)] {
            let surfaces = [&several.0, &self.renderer, &fresh.0].map(|it| it.surface(x, y));
            assert_eq!(surfaces[0], surfaces[2]);
            assert_eq!(surfaces[1], surfaces[2]);
        }
    }
}

pub(crate) fn check_equal(one: &Frame, other: &Frame, when: &str) {
    assert_eq!(one.size(), other.size());
    for (y, rows) in one.rows().zip(other.rows()).enumerate() {
        for (x, (one, other)) in rows.0.iter().zip(rows.1).enumerate() {
            assert_eq!(one, other, "pixel {x}, {y} {when}");
        }
    }
}
