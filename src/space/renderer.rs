//! The renderer of a scene: for each row of pixels, it tests each body that reaches the row against
//! the pixels in the body's bounds.

use glam::DVec3;

use super::bounds::Bounds;
use super::camera::{Camera, Projection};
use super::checker::Footprint;
use super::explanation::Explanation;
use super::relative_shape::RelativeShape;
use super::scene::Scene;
use super::shadows::Shadows;
use super::tree::{Nearest, Tree};
use crate::color::Rgb;
use crate::render::Frame;
use crate::world::Fog;

/// With more tests of a ray on average, the tree is faster than the bounds on the screen.
const MOST_TESTS_OF_RAY: u64 = 32;

/// The number of tests and pixels of a band, after which a drawing can be interrupted: a millisecond or
/// two.
const WORK_OF_BAND: u64 = 1 << 16;

/// Draws frames, and reuses its memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    /// The bodies that can cover a pixel.
    in_view: Vec<InView>,
    /// The nearest hits so far of the rays of a row.
    nearest: Vec<Option<Nearest>>,
    /// The directions of the rays of the middle row.
    directions: Vec<DVec3>,
    /// Empty where the bounds of bodies overlap little.
    tree: Tree,
    shadows: Shadows,
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
    /// A band ends after the row in which the number of its pixels and of tests of its rays exceeds a
    /// limit.
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
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        self.find_bodies(scene, &projection);
        self.shadows.begin(&scene.bodies, &scene.sun);
        self.directions.clear();
        self.directions.extend((0..projection.width).map(|column| projection.across(column)));
        let mut explanation = Explanation {
            bodies: scene.bodies.len() as u64,
            in_view: self.in_view.len() as u64,
            rays: u64::from(projection.width) * u64::from(projection.height),
            tests: 0,
            hits: 0,
            shadow_rays: 0,
            shadow_tests: 0,
        };
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
            let up = projection.upwards(row);
            explanation.tests += self.cast_row(row, up);
            let pixels = whole.row_mut(row);
            self.shade_row(scene, &projection, up, pixels, &mut explanation);
        }
        (explanation, true)
    }

    fn find_bodies(&mut self, scene: &Scene, projection: &Projection) {
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
        if tests > MOST_TESTS_OF_RAY * rays {
            self.tree.build(self.in_view.iter().map(|it| &it.shape));
        }
    }

    /// Finds the hits of the rays of `row`, and returns the number of tests.
    fn cast_row(&mut self, row: u32, up: DVec3) -> u64 {
        if self.tree.is_empty() {
            self.cast_row_by_bounds(row, up)
        } else {
            self.cast_row_by_tree(up)
        }
    }

    fn cast_row_by_tree(&mut self, up: DVec3) -> u64 {
        let Self { in_view, nearest, directions, tree, .. } = self;
        let mut tests = 0;
        nearest.clear();
        nearest.extend(directions.iter().map(|&across| {
            tree.nearest(across + up, |index| {
                tests += 1;
                in_view[index].shape.distance(across + up)
            })
        }));
        tests
    }

    fn cast_row_by_bounds(&mut self, row: u32, up: DVec3) -> u64 {
        let Self { in_view, nearest, directions, .. } = self;
        nearest.clear();
        nearest.resize(directions.len(), None);
        let mut tests = 0;
        for (index, InView { shape, bounds, .. }) in in_view.iter().enumerate() {
            if !bounds.rows.contains(&row) {
                continue;
            }
            if let RelativeShape::Plane(plane) = shape {
                // If both end rays of a row point away from a plane, all rays between them do.
                let ends = [directions.first(), directions.last()];
                if !ends.into_iter().flatten().any(|&across| plane.is_ahead(across + up)) {
                    continue;
                }
            }
            let columns = bounds.columns.start as usize..bounds.columns.end as usize;
            tests += columns.len() as u64;
            for (nearest, &across) in nearest[columns.clone()].iter_mut().zip(&directions[columns])
            {
                let Some(t) = shape.distance(across + up) else { continue };
                if nearest.is_none_or(|before| t < before.t) {
                    *nearest = Some(Nearest { t, index });
                }
            }
        }
        tests
    }

    /// Colours the pixels of a row.
    fn shade_row(
        &self,
        scene: &Scene,
        projection: &Projection,
        up: DVec3,
        pixels: &mut [Rgb],
        explanation: &mut Explanation,
    ) {
        let steps = projection.steps();
        for ((pixel, nearest), &across) in
            pixels.iter_mut().zip(&self.nearest).zip(&self.directions)
        {
            let direction = across + up;
            let Some(Nearest { t, index }) = *nearest else {
                *pixel = scene.sky_color(direction);
                continue;
            };
            explanation.hits += 1;
            let InView { body, shape, .. } = self.in_view[index];
            let normal = shape.normal(direction, t);
            let point = projection.origin + direction * t;
            let footprint = || Footprint::new(direction, t, normal, steps);
            let color = scene.bodies[body].texture.mean_color(point, normal, footprint);
            let brightness = self.brightness(scene, body, point, normal, explanation);
            *pixel = lit(color, brightness, scene.fog, t);
        }
    }

    /// The brightness of `point` on the surface of `body`, which has this `normal` there.
    fn brightness(
        &self,
        scene: &Scene,
        body: usize,
        point: DVec3,
        normal: DVec3,
        explanation: &mut Explanation,
    ) -> f64 {
        let (in_sun, ambient) = (scene.sun.brightness(normal), scene.sun.ambient.get());
        if in_sun <= ambient {
            return ambient;
        }
        explanation.shadow_rays += 1;
        if self.shadows.hides_sun(point, body, &mut explanation.shadow_tests) {
            ambient
        } else {
            in_sun
        }
    }
}

/// `color` with this brightness, and with the fog of the distance `t`.
fn lit(color: Rgb, brightness: f64, fog: Option<Fog>, t: f64) -> Rgb {
    const WHOLE: f64 = 256.0;
    let (behind, clearness) = match fog {
        Some(fog) => (fog.color, fog.clearness(t)),
        None => (Rgb::BLACK, 1.0),
    };
    let own = (WHOLE * brightness * clearness).round() as u32;
    color.blended(own, behind, 256 - (WHOLE * clearness).round() as u32)
}
