//! The renderer of a scene: for each row of pixels, it tests each body that reaches the row against
//! the pixels in the body's bounds.

use std::fmt;

use super::bounds::Bounds;
use super::camera::{Camera, SceneProjection};
use super::lanes::in_widest_registers;
use super::relative_shape::RelativeShape;
use super::row::Row;
use super::shading::{Shader, Shading};
use super::shadows::Shadows;
use super::tree::Tree;
use crate::color::Rgb;
use crate::render::{Frame, Options, Renderable};
use crate::world::FieldOfView;
use crate::world::scene::Scene;

/// The largest mean number of tests for a ray. With more tests, the tree is faster than the bounds
/// on the screen.
const MAX_TESTS_OF_RAY: u64 = 32;

/// The number of tests and pixels of a band, which takes a millisecond or two. A drawing can be
/// interrupted after each band.
const WORK_OF_BAND: u64 = 1 << 16;

/// Draws frames, and reuses its memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    /// The bodies that can cover a pixel.
    in_view: Vec<InView>,
    row: Row,
    /// Empty if the bounds of bodies overlap little.
    tree: Tree,
    shadows: Shadows,
    shading: Shading,
}

/// The counts of a frame of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Bodies in the scene.
    pub bodies: u64,
    /// Bodies that can cover a pixel.
    pub in_view: u64,
    /// Rays cast from the camera, one for each pixel.
    pub rays: u64,
    /// Tests of these rays against bodies.
    pub tests: u64,
    /// Rays that hit a body.
    pub hits: u64,
    /// Rays cast from these hits towards the sun.
    pub shadow_rays: u64,
    /// Tests of shadow rays against bodies, and of groups of neighbouring shadow rays against boxes
    /// around bodies.
    pub shadow_tests: u64,
}

#[derive(Clone, Debug)]
struct InView {
    /// The index in the scene.
    body: usize,
    shape: RelativeShape,
    bounds: Bounds,
}

impl Renderer {
    /// A renderer without any allocated memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Draws the view of `camera` into all of `frame`.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) {
        self.explain(scene, camera, frame);
    }

    /// Draws as [`Renderer::render`] does, in bands of rows from the top. Before each band, `go_on` is
    /// called; if it returns `false`, the rest of `frame` stays as it was. Returns whether the frame is
    /// complete.
    ///
    /// A band ends after the row in which its number of pixels and tests reaches a limit.
    pub fn render_while(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        frame: &mut Frame,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        self.draw(scene, camera, frame, go_on).1
    }

    /// Draws as [`Renderer::render`] does, and returns the counts.
    pub fn explain(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) -> Explanation {
        self.draw(scene, camera, frame, &mut || true).0
    }

    /// Draws as [`Renderer::render_while`] does, and returns the counts and whether the frame is
    /// complete.
    fn draw(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        frame: &mut Frame,
        go_on: &mut dyn FnMut() -> bool,
    ) -> (Explanation, bool) {
        let projection = SceneProjection::new(camera, frame.size(), frame.pixel_aspect());
        self.find_bodies(scene, &projection);
        self.shadows.begin(&scene.bodies, &scene.sun);
        self.row.begin(&projection);
        let mut explanation = Explanation {
            bodies: scene.bodies.len() as u64,
            in_view: self.in_view.len() as u64,
            rays: u64::from(projection.width) * u64::from(projection.height),
            tests: 0,
            hits: 0,
            shadow_rays: 0,
            shadow_tests: 0,
        };
        let shader = Shader::new(scene, &projection, self.row.is_level());
        let mut whole = frame.whole();
        let mut end_of_band = 0;
        for row in 0..projection.height {
            let pixels_before = u64::from(projection.width) * u64::from(row);
            let work = pixels_before + explanation.tests + explanation.shadow_tests;
            if work >= end_of_band {
                if !go_on() {
                    return (explanation, false);
                }
                end_of_band = work + WORK_OF_BAND;
            }
            self.row.begin_row(projection.upwards(row));
            in_widest_registers(
                #[inline(always)]
                || {
                    explanation.tests += self.cast_row(row);
                    self.shade_row(&shader, whole.row_mut(row), &mut explanation);
                },
            );
        }
        (explanation, true)
    }

    fn find_bodies(&mut self, scene: &Scene, projection: &SceneProjection) {
        self.in_view.clear();
        self.in_view.reserve(scene.bodies.len());
        self.in_view.extend(scene.bodies.iter().enumerate().filter_map(|(body, found)| {
            let shape = RelativeShape::new(&found.shape, projection.origin);
            let bounds = Bounds::new(&shape, projection)?;
            Some(InView { body, shape, bounds })
        }));
        let rays = u64::from(projection.width) * u64::from(projection.height);
        let tests: u64 = self.in_view.iter().map(|it| it.bounds.pixel_count()).sum();
        self.tree.clear();
        if tests > MAX_TESTS_OF_RAY * rays {
            self.tree.build(self.in_view.iter().map(|it| &it.shape));
        }
    }

    /// Finds the hits of the rays of `row`, and returns the number of tests.
    #[inline(always)]
    fn cast_row(&mut self, row: u32) -> u64 {
        let mut tests = 0;
        if !self.tree.is_empty() {
            self.row.search(&self.tree, |index, direction| {
                tests += 1;
                self.in_view[index].shape.distance(direction)
            });
            return tests;
        }
        for (index, InView { shape, bounds, .. }) in self.in_view.iter().enumerate() {
            if bounds.rows.contains(&row) {
                let columns = bounds.columns.start as usize..bounds.columns.end as usize;
                tests += self.row.test(columns, index, shape);
            }
        }
        tests
    }

    /// Colours the pixels of a row.
    #[inline(always)]
    fn shade_row(
        &mut self,
        shader: &Shader<'_>,
        pixels: &mut [Rgb],
        explanation: &mut Explanation,
    ) {
        let Self { row, in_view, shadows, shading, .. } = self;
        let mut column = 0;
        while column < pixels.len() {
            let (found, end) = row.same_from(column);
            let pixels = &mut pixels[column..end];
            row.take(column..end, &mut shading.stretch);
            match found.map(|index| &in_view[index]) {
                None => shader.shade_sky(shading, pixels),
                Some(InView { body, shape, .. }) => {
                    let (rays, tests) = shader.shade(*body, shape, shadows, shading, pixels);
                    explanation.hits += pixels.len() as u64;
                    explanation.shadow_rays += rays;
                    explanation.shadow_tests += tests;
                }
            }
            column = end;
        }
    }
}

impl Renderable for Scene {
    type Camera = Camera;
    type Renderer = Renderer;
    type Explanation = Explanation;

    fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        Self::start_camera(self, field_of_view)
    }

    /// Draws the view of `camera`. The options have no effect, because bodies have neither textures
    /// nor animations.
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

impl fmt::Display for Explanation {
    /// Writes a few lines of text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bodies, in_view, rays, tests, hits, shadow_rays, shadow_tests } = self;
        let without_bounds = rays * bodies;
        writeln!(f, "bodies   {in_view:>10} of {bodies} in view")?;
        writeln!(f, "rays     {rays:>10} cast, one a pixel, {hits} of them hit a body")?;
        writeln!(
            f,
            "tests    {tests:>10} of a ray against a body, of {without_bounds} without bounds"
        )?;
        writeln!(f, "shadows  {shadow_rays:>10} rays cast towards the sun, {shadow_tests} tests")
    }
}
