//! A scene: bodies, light, and where the player starts.

use glam::DVec3;

use super::body::Body;
use super::camera::{Camera, Elevation};
use super::light::{Sky, Sun};
use super::ray::{Hit, Ray};
use super::seen::Seen;
use super::{Explanation, Renderer};
use crate::render::{Frame, Options, Renderable};
use crate::world::{FieldOfView, Fog, Heading};

/// What a level of bodies consists of. It is valid by construction: each body is, and they may overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The level's name; empty where the map gives none.
    pub title: String,
    /// In the order of the map; of two that a ray hits at once, it shows the first.
    pub bodies: Vec<Body>,
    /// What lights them.
    pub sun: Sun,
    /// What is behind them.
    pub sky: Sky,
    /// What they fade into, if anything.
    pub fog: Option<Fog>,
    /// Where the player starts.
    pub start: Start,
}

/// Where the player starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Where the eye is; as near as a camera must be.
    pub(crate) position: DVec3,
    /// Which way they look.
    pub heading: Heading,
    /// How far up or down they look.
    pub elevation: Elevation,
}

impl Start {
    /// A start at `position`, in cells. `None` where no [`Camera`] could be there.
    pub fn new(position: DVec3, heading: Heading, elevation: Elevation) -> Option<Self> {
        let camera = Camera::new(position, heading, FieldOfView::default());
        camera.map(|_| Self { position, heading, elevation })
    }

    /// Where the eye is.
    pub fn position(&self) -> DVec3 {
        self.position
    }
}

impl Scene {
    /// What `ray` hits first.
    pub fn cast(&self, ray: &Ray) -> Option<Hit> {
        let mut nearest: Option<(Seen, usize, f64)> = None;
        for (index, body) in self.bodies.iter().enumerate() {
            let seen = Seen::new(&body.shape, ray.origin);
            let Some(t) = seen.distance(ray.direction) else { continue };
            if nearest.is_none_or(|(_, _, before)| t < before) {
                nearest = Some((seen, index, t));
            }
        }
        let (seen, body, t) = nearest?;
        Some(Hit { body, t, normal: seen.normal(ray.direction, t) })
    }

    /// A camera where the player starts.
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

    /// Bodies have no textures and nothing animated: of `options` nothing applies.
    fn render(&self, camera: &Camera, _: Options, renderer: &mut Renderer, frame: &mut Frame) {
        renderer.render(self, camera, frame);
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
