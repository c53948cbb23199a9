//! One interface to grids and to scenes of bodies.

use std::fmt;

use super::{Explanation, Filter, Frame, Renderer, Surface};
use crate::world::{Camera, FieldOfView, World};

/// A grid or a scene of bodies, with its camera and its renderer.
///
/// [`World`] and [`space::Scene`](crate::space::Scene) implement it. A widget or a command that
/// takes any `Renderable` shows either.
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
    /// The place, direction and field of view of a picture.
    type Camera: Copy + fmt::Debug + PartialEq;
    /// Draws frames, and reuses its memory from frame to frame.
    type Renderer: Clone + fmt::Debug + Default;
    /// The plan and the cost of a frame, in lines of text.
    type Explanation: fmt::Display;

    /// A camera at the player's start.
    fn start_camera(&self, field_of_view: FieldOfView) -> Self::Camera;

    /// Draws the view of `camera` into all of `frame`.
    fn render(
        &self,
        camera: &Self::Camera,
        options: Options,
        renderer: &mut Self::Renderer,
        frame: &mut Frame,
    );

    /// Draws as [`Renderable::render`] does, but may stop once `go_on` returns `false`, and then leaves
    /// the rest of `frame` as it was. Returns whether the frame is complete.
    ///
    /// A grid never stops early. The slowest known grid, with thousands of things between mirrors,
    /// takes about a second in the largest terminals. Bodies can take several seconds.
    fn render_while(
        &self,
        camera: &Self::Camera,
        options: Options,
        renderer: &mut Self::Renderer,
        frame: &mut Frame,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        _ = go_on;
        self.render(camera, options, renderer, frame);
        true
    }

    /// Draws as [`Renderable::render`] does, and returns the plan and the cost.
    fn explain(
        &self,
        camera: &Self::Camera,
        options: Options,
        renderer: &mut Self::Renderer,
        frame: &mut Frame,
    ) -> Self::Explanation;

    /// The time at which something in the last frame of `renderer` next changes its appearance, on
    /// the clock of [`Options::seconds`]; `None` if nothing will change.
    fn next_change(renderer: &Self::Renderer) -> Option<f64> {
        _ = renderer;
        None
    }

    /// The surface that the pixel `(x, y)` of the last frame of `renderer` shows; `None` if the
    /// renderer does not distinguish surfaces.
    fn surface(renderer: &Self::Renderer, x: u32, y: u32) -> Option<Surface> {
        _ = (renderer, x, y);
        None
    }
}

/// The options of a drawing, apart from size and camera.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Options {
    /// The filter with which textures are sampled.
    pub filter: Filter,
    /// The time at which animated things are shown, in seconds.
    pub seconds: f64,
    /// Whether the renderer records the surface of each pixel, for [`Renderable::surface`].
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
