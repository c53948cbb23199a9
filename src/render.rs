//! Drawing: turns a world and a camera into pixels.
//!
//! A frame is drawn in two stages: `visibility` fills a draw list, and `raster` draws it. A
//! [`FramePlan`], made from the world, selects the loops of both. The list is filled once. It is
//! drawn in bands of rows, by several threads if the frame is large.
//!
//! The caller owns the [`Frame`] and keeps the [`Renderer`], which owns the memory of the stages.
//! Drawing by one thread allocates nothing once both have grown to the size of the frame. The same
//! world, camera and time give the same pixels, in any number of bands.
//!
//! Rejected: one pass that finishes each column before the next. It would branch in the innermost
//! loop on features that the scene does not have.

mod frame;
mod renderable;
mod samples;
#[cfg(all(test, feature = "terminal"))]
mod tests;
mod threads;

use std::fmt;
use std::num::NonZero;

pub use crate::visibility::{
    Filter, FramePlan, FrameSize, FrameStats, Pass, PassStats, PixelAspect, PlaneLoop, Projection,
    Surface, WalkStats, WallLoop,
};
pub use frame::Frame;
pub use renderable::{Options, Renderable};
pub use threads::{OneThreadReason, Threads};

use crate::raster::{self, SkyMemory, SkyView, SurfaceBuffer};
use crate::visibility::{self, DrawList, FrameContext, StatsCounter, VisibilityMemory};
#[cfg(feature = "terminal")]
use crate::world::Figure;
use crate::world::{Camera, World};
use threads::{ThreadMemory, draw_bands};

/// Draws frames, and reuses its memory from frame to frame.
///
/// ```
/// use cellcaster::map::builtin;
/// use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
/// use cellcaster::world::FieldOfView;
///
/// let world = builtin::LEVELS[0].world()?;
/// let camera = world.start_camera(FieldOfView::default());
/// let mut frame = Frame::new(FrameSize::new(160, 90).unwrap(), PixelAspect::SQUARE);
///
/// let mut renderer = Renderer::new();
/// renderer.set_filter(Filter::Nearest);
/// renderer.keep_surfaces(true);
/// renderer.render(&world, &camera, &mut frame);
///
/// // Each pixel of the frame shows some surface.
/// assert!(renderer.surface(80, 45).is_some());
/// assert_eq!(renderer.surface(160, 45), None);
///
/// // Draw again when the next sprite changes its picture.
/// if let Some(seconds) = renderer.next_change() {
///     renderer.set_time(seconds);
///     renderer.render(&world, &camera, &mut frame);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    filter: Filter,
    seconds: f64,
    /// The most threads; `None` for the number that the machine runs at once.
    threads: Option<NonZero<usize>>,
    memory: Memory,
}

/// The memory of the stages, reused from frame to frame.
#[derive(Clone, Debug, Default)]
struct Memory {
    visibility: VisibilityMemory,
    list: DrawList,
    sky: SkyMemory,
    surfaces: SurfaceBuffer,
    next_change: Option<f64>,
    threads: Vec<ThreadMemory>,
}

impl Renderer {
    /// A renderer that has drawn no frame.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the filter with which textures are sampled from the next frame on. The default is
    /// [`Filter::Mip`].
    pub fn set_filter(&mut self, filter: Filter) {
        self.filter = filter;
    }

    /// Sets the time at which the next frames show things, in seconds. The default is 0.
    pub fn set_time(&mut self, seconds: f64) {
        self.seconds = seconds;
    }

    /// Sets the largest number of threads that draw a frame. The default is the number that the
    /// machine runs at once. Only large frames are drawn by more than one thread. The pixels are
    /// the same for any number, bit for bit.
    pub fn set_threads(&mut self, threads: NonZero<usize>) {
        self.threads = Some(threads);
    }

    /// The time at which something in the last frame next changes its appearance, in seconds on the
    /// clock of [`Renderer::set_time`]; `None` if nothing will change.
    pub fn next_change(&self) -> Option<f64> {
        self.memory.next_change
    }

    /// Sets whether the next frames record the surface of each pixel, for [`Renderer::surface`]. By
    /// default, they do not.
    pub fn keep_surfaces(&mut self, are_kept: bool) {
        self.memory.surfaces.keep(are_kept);
    }

    /// Draws the view of `camera` into all of `frame`.
    pub fn render(&mut self, world: &World, camera: &Camera, frame: &mut Frame) {
        self.draw(world, camera, frame, &mut StatsCounter::default());
    }

    /// Draws as [`Renderer::render`] does, and returns the plan and the counts.
    pub fn explain(&mut self, world: &World, camera: &Camera, frame: &mut Frame) -> Explanation {
        let mut counted = StatsCounter::kept();
        let (plan, threads) = self.draw(world, camera, frame, &mut counted);
        let mut stats = counted.counts();
        let samples = u64::from(self.filter.samples(frame.size()).get());
        stats.overwritten = stats.pixels() - frame.size().area() as u64 * samples * samples;
        Explanation { plan, threads, stats }
    }

    /// Whether `figure` may be visible from the camera of `frame`, the last frame that was drawn.
    /// The position of the figure in that frame does not matter. `world` and `camera` must be the
    /// ones with which the frame was drawn.
    #[cfg(feature = "terminal")]
    pub(crate) fn may_show(
        &self,
        world: &World,
        camera: &Camera,
        frame: &Frame,
        figure: &Figure,
    ) -> bool {
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        world.has_mirrors() || visibility::may_show(world, &projection, self.distances(), figure)
    }

    /// The distances from the camera plane at which the last frame's rays ended, at a wall or at the
    /// edge of the map, in cells. There is one for each column of pixels, from left to right.
    pub fn distances(&self) -> &[f64] {
        &self.memory.list.distances
    }

    /// The surface that the pixel `(x, y)` of the last frame shows; `None` if there is no such pixel, or if
    /// [surfaces were not kept](Renderer::keep_surfaces).
    pub fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        self.memory.surfaces.surface(x, y)
    }

    fn draw(
        &mut self,
        world: &World,
        camera: &Camera,
        frame: &mut Frame,
        stats: &mut StatsCounter,
    ) -> (FramePlan, Threads) {
        let Self { filter, seconds, threads, memory } = self;
        let plan = FramePlan::new(world, *filter);
        let samples = filter.samples(frame.size());
        let threads = Threads::new(frame.size(), samples, *threads);
        let projection =
            Projection::of_samples(camera, frame.size(), frame.pixel_aspect(), samples.get());
        let scene =
            FrameContext { world, camera, seconds: *seconds, projection: &projection, plan: &plan };
        let list = &mut memory.list;
        memory.next_change = visibility::fill(scene, &mut memory.visibility, list, stats);
        let sky = &SkyView::new(scene, list, &mut memory.sky);
        let bands = (frame, &mut memory.surfaces);
        draw_bands(threads, samples, bands, &mut memory.threads, stats, |memory, target| {
            raster::draw(scene, list, sky, memory, target);
        });
        samples::keep_middles(&mut list.distances, samples.get());
        (plan, threads)
    }
}

/// The plan of a frame and its cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// The loops that drew it.
    pub plan: FramePlan,
    /// The threads that drew it.
    pub threads: Threads,
    /// The counts.
    pub stats: FrameStats,
}

impl fmt::Display for Explanation {
    /// Writes a few lines of text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { plan, threads, stats } = self;
        write!(f, "{plan}")?;
        writeln!(f, "threads  {threads}")?;
        writeln!(f)?;
        let WalkStats { rays, cells, looks, sectors, faces, bounces } = stats.walk;
        let spans = stats.spans;
        writeln!(f, "rays     {rays:>10} cast, into {cells} cells, by {looks} looks")?;
        writeln!(
            f,
            "sectors  {sectors:>10} entered, {faces} faces, {spans} spans, {bounces} bounces"
        )?;
        let passes = [
            ("ceiling", Pass::Ceiling),
            ("floor", Pass::Floor),
            ("sky", Pass::Sky),
            ("walls", Pass::Walls),
            ("through", Pass::SeeThrough),
            ("things", Pass::Things),
        ];
        for (name, pass) in passes {
            let counts = stats.of(pass);
            let (pixels, texels) = (counts.pixels, counts.texels);
            writeln!(f, "{name:8} {pixels:>10} pixels written, {texels} texels read")?;
        }
        let (considered, drawn) = (stats.things_considered, stats.things_drawn);
        writeln!(f, "in view  {considered:>10} things considered, {drawn} of them drawn")?;
        let (pixels, overwritten) = (stats.pixels(), stats.overwritten);
        writeln!(f, "all      {pixels:>10} pixels written, {overwritten} of them overwritten")
    }
}
