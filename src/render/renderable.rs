//! One interface for whatever a camera can see: a grid, or a scene of bodies.

use std::fmt;

use super::{Explanation, Filter, Frame, Renderer, Surface};
use crate::world::{Camera, FieldOfView, World};

/// A place that a camera can look at, with the renderer that draws it.
///
/// A [`World`] and a [`space::Scene`](crate::space::Scene) are the two there are. A widget or a command
/// that takes any `Renderable` shows either.
///
/// ```
/// use cellcaster::render::{Frame, FrameSize, Options, PixelAspect, Renderable};
/// use cellcaster::world::FieldOfView;
///
/// fn draw<S: Renderable>(scene: &S, frame: &mut Frame) {
///     let camera = scene.start_camera(FieldOfView::default());
///     scene.render(&camera, Options::default(), &mut S::Renderer::default(), frame);
/// }
///
/// let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
/// draw(&cellcaster::map::builtin::LEVELS[0].world()?, &mut frame);
/// draw(&cellcaster::space::Scene::default(), &mut frame);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Renderable {
    /// Where a picture is taken from.
    type Camera: Copy + fmt::Debug + PartialEq;
    /// What draws frames, and keeps memory from one to the next.
    type Renderer: Clone + fmt::Debug + Default;
    /// How a frame was drawn, in lines for people.
    type Explanation: fmt::Display;

    /// A camera where the player starts.
    fn start_camera(&self, field_of_view: FieldOfView) -> Self::Camera;

    /// Draws what `camera` sees into all of `frame`.
    fn render(
        &self,
        camera: &Self::Camera,
        options: Options,
        renderer: &mut Self::Renderer,
        frame: &mut Frame,
    );

    /// As [`Renderable::render`], and returns what the frame cost.
    fn explain(
        &self,
        camera: &Self::Camera,
        options: Options,
        renderer: &mut Self::Renderer,
        frame: &mut Frame,
    ) -> Self::Explanation;

    /// The time on the clock of [`Options::seconds`] at which something in the last frame of `renderer`
    /// begins to look different by itself; `None` for never.
    fn next_change(renderer: &Self::Renderer) -> Option<f64> {
        _ = renderer;
        None
    }

    /// What the pixel `(x, y)` of the last frame of `renderer` shows; `None` where surfaces are not told
    /// apart.
    fn surface(renderer: &Self::Renderer, x: u32, y: u32) -> Option<Surface> {
        _ = (renderer, x, y);
        None
    }
}

/// How a picture is drawn, apart from its size and camera.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Options {
    /// How textures are looked up.
    pub filter: Filter,
    /// The time at which animated things are shown.
    pub seconds: f64,
    /// Whether [`Renderable::surface`] is needed for each pixel.
    pub keeps_surfaces: bool,
}

impl Renderable for World {
    type Camera = Camera;
    type Renderer = Renderer;
    type Explanation = Explanation;

    fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        Self::start_camera(self, field_of_view)
    }

    fn render(
        &self,
        camera: &Camera,
        options: Options,
        renderer: &mut Renderer,
        frame: &mut Frame,
    ) {
        options.apply(renderer);
        renderer.render(self, camera, frame);
    }

    fn explain(
        &self,
        camera: &Camera,
        options: Options,
        renderer: &mut Renderer,
        frame: &mut Frame,
    ) -> Explanation {
        options.apply(renderer);
        renderer.explain(self, camera, frame)
    }

    fn next_change(renderer: &Renderer) -> Option<f64> {
        renderer.next_change()
    }

    fn surface(renderer: &Renderer, x: u32, y: u32) -> Option<Surface> {
        renderer.surface(x, y)
    }
}

impl Options {
    fn apply(self, renderer: &mut Renderer) {
        renderer.set_filter(self.filter);
        renderer.set_time(self.seconds);
        renderer.keep_surfaces(self.keeps_surfaces);
    }
}
