//! A scene: bodies, light, and the player's start.

use glam::DVec3;

use super::body::Body;
use super::camera::{Camera, Elevation};
use super::light::{Sun, sky_color};
use super::ray::{Hit, Ray};
use super::relative_shape::RelativeShape;
use super::{Explanation, Renderer};
use crate::color::Rgb;
use crate::render::{Frame, Options, Renderable};
use crate::world::{FieldOfView, Fog, Heading, SkyGradient};

/// A level made of bodies. Each body is valid by construction, and bodies may overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The level's name; empty if the map has none.
    pub title: String,
    /// The bodies in the order of the map. Where a ray hits two at once, the first is visible.
    pub bodies: Vec<Body>,
    /// The directional light.
    pub sun: Sun,
    /// The background.
    pub sky: SkyGradient,
    /// The fog, if there is any.
    pub fog: Option<Fog>,
    /// The player's start.
    pub start: Start,
}

/// The position and direction in which the player starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// The position of the eye, within the limits of a camera.
    pub(crate) position: DVec3,
    /// The compass direction.
    pub heading: Heading,
    /// The angle above or below the horizon.
    pub elevation: Elevation,
}

impl Start {
    /// A start at `position`, in cells. `None` if a [`Camera`] cannot be there.
    pub fn new(position: DVec3, heading: Heading, elevation: Elevation) -> Option<Self> {
        let camera = Camera::new(position, heading, FieldOfView::default());
        camera.map(|_| Self { position, heading, elevation })
    }

    /// The position of the eye.
    pub fn position(&self) -> DVec3 {
        self.position
    }
}

impl Scene {
    /// The first hit of `ray`.
    pub fn cast(&self, ray: &Ray) -> Option<Hit> {
        let mut nearest: Option<(RelativeShape, usize, f64)> = None;
        for (index, body) in self.bodies.iter().enumerate() {
            let relative = RelativeShape::new(&body.shape, ray.origin);
            let Some(t) = relative.distance(ray.direction) else { continue };
            if nearest.is_none_or(|(_, _, before)| t < before) {
                nearest = Some((relative, index, t));
            }
        }
        let (relative, body, t) = nearest?;
        Some(Hit { body, t, normal: relative.normal(ray.direction, t) })
    }

    /// The colour of the sky in this direction.
    pub fn sky_color(&self, direction: DVec3) -> Rgb {
        sky_color(self.sky, direction)
    }

    /// A camera at the player's start.
    #[expect(clippy::missing_panics_doc, reason = "a start is where a camera can be")]
    pub fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        let Start { position, heading, elevation } = self.start;
        Camera::new(position, heading, field_of_view)
            .expect("a start is where a camera can be")
            .with_elevation(elevation)
    }
}

impl Renderable for Scene {
    type Camera = Camera;
    type Renderer = Renderer;
    type Explanation = Explanation;

    fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        Self::start_camera(self, field_of_view)
    }

    /// Draws the view of `camera`. No option applies: bodies have neither textures nor animations.
    fn render(&self, camera: &Camera, _: Options, renderer: &mut Renderer, frame: &mut Frame) {
        renderer.render(self, camera, frame);
    }

    fn render_while(
        &self,
        camera: &Camera,
        _: Options,
        renderer: &mut Renderer,
        frame: &mut Frame,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        renderer.render_while(self, camera, frame, go_on)
    }

    fn explain(
        &self,
        camera: &Camera,
        _: Options,
        renderer: &mut Renderer,
        frame: &mut Frame,
    ) -> Explanation {
        renderer.explain(self, camera, frame)
    }
}
