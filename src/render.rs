//! Drawing: a world and a camera in, pixels out.
//!
//! A frame is drawn in two stages: `visibility` fills a draw list, and
//! `raster` draws it. A [`FramePlan`], made from the world, says how. What is in view is
//! found once; the list is drawn band by band, by several threads where the picture is large.
//!
//! The caller owns the [`Frame`] and keeps the [`Renderer`], which owns what the stages need in between;
//! drawing by one thread allocates nothing once both have grown to the size of the picture. The same
//! world, camera and time give the same pixels, in however many bands. One pass that does everything to a
//! column before it goes to the next was refused: a kind of item that a scene lacks can be left out, a
//! branch in the innermost loop can't.

mod dyn_caster;
mod explanation;
mod frame;
mod renderable;
#[cfg(test)]
mod tests;
mod threads;

use std::num::NonZero;

pub use crate::visibility::{
    CeilingLoop, Column, Filter, FramePlan, FrameSize, FrameStats, Pass, PassStats, PixelAspect,
    PlaneLoop, PortalStats, RayLoop, SkyLoop, Surface, ThingLoop, Visibility, WallLoop, WhyPortals,
};
pub use dyn_caster::DynCaster;
pub use explanation::Explanation;
pub use frame::Frame;
pub use renderable::{Options, Renderable};
pub use threads::{Threads, WhyOne};

use crate::cast::Caster;
use crate::raster::{self, RasterMemory, SkyColumn, SkyView, SurfaceBuffer};
use crate::visibility::{self, DrawList, Projection, Scene, Stats, VisibilityMemory};
use crate::world::{Camera, World};
use threads::draw_bands;

/// Draws frames, and keeps what is worth keeping from one to the next.
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    caster: DynCaster,
    filter: Filter,
    seconds: f64,
    /// How many there may be; `None` for as many as the machine has.
    threads: Option<NonZero<usize>>,
    memory: Memory,
}

/// What the stages hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
struct Memory {
    visibility: VisibilityMemory,
    list: DrawList,
    first_row_of_ground: u32,
    sky: Vec<SkyColumn>,
    surfaces: SurfaceBuffer,
    next_change: Option<f64>,
    /// One for each thread.
    raster: Vec<RasterMemory>,
}

impl Renderer {
    /// A renderer that has drawn nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A renderer that finds the walls by `caster`, where [`Renderer::new`] finds them exactly.
    pub fn with_caster(caster: DynCaster) -> Self {
        Self { caster, ..Self::default() }
    }

    /// Looks textures up by `filter` from now on.
    pub fn set_filter(&mut self, filter: Filter) {
        self.filter = filter;
    }

    /// Shows things as they are after that many `seconds` from now on; 0 at first.
    pub fn set_time(&mut self, seconds: f64) {
        self.seconds = seconds;
    }

    /// Draws by at most that many `threads` from now on; by as many as the machine has at first. Only
    /// large pictures are drawn by more than one, and they are the same then, bit for bit.
    pub fn set_threads(&mut self, threads: NonZero<usize>) {
        self.threads = Some(threads);
    }

    /// When something in the last frame begins to look different, by the clock of
    /// [`Renderer::set_time`]; `None` for never.
    pub fn next_change(&self) -> Option<f64> {
        self.memory.next_change
    }

    /// Keeps what each pixel shows from now on, or no longer, for [`Renderer::surface`].
    pub fn keep_surfaces(&mut self, are_kept: bool) {
        self.memory.surfaces.keep(are_kept);
    }

    /// Draws what `camera` sees of `world` into all of `frame`.
    pub fn render(&mut self, world: &World, camera: &Camera, frame: &mut Frame) {
        let Self { caster, filter, seconds, threads, memory } = self;
        let (filter, seconds, threads, stats) = (*filter, *seconds, *threads, &mut ());
        caster.draw(Picture { world, camera, filter, seconds, threads, memory, frame, stats });
    }

    /// As [`Renderer::render`], with the walls that `caster` finds.
    pub fn render_with<C: Caster>(
        &mut self,
        caster: &C,
        world: &World,
        camera: &Camera,
        frame: &mut Frame,
    ) {
        let Self { filter, seconds, threads, memory, .. } = self;
        let (filter, seconds, threads, stats) = (*filter, *seconds, *threads, &mut ());
        Picture { world, camera, filter, seconds, threads, memory, frame, stats }.draw(caster);
    }

    /// As [`Renderer::render`], and tells how it went. Cells are counted along exact rays, whatever
    /// the caster.
    pub fn explain(&mut self, world: &World, camera: &Camera, frame: &mut Frame) -> Explanation {
        let Self { caster, filter, seconds, threads, memory } = self;
        let mut counted = FrameStats::default();
        let (filter, seconds, threads, stats) = (*filter, *seconds, *threads, &mut counted);
        let picture = Picture { world, camera, filter, seconds, threads, memory, frame, stats };
        let (plan, threads) = caster.draw_counted(picture);
        let size = u64::from(frame.width()) * u64::from(frame.height());
        counted.overwritten = counted.pixels() - size;
        Explanation { plan, threads, stats: counted }
    }

    /// What the rays of the last frame met, from left to right, one for each column of pixels.
    pub fn columns(&self) -> &[Column] {
        &self.memory.list.columns
    }

    /// What the pixel `(x, y)` of the last frame shows, where [that is kept](Renderer::keep_surfaces);
    /// else what it shows but for things and masks before that. `None` where the frame had no column `x`.
    pub fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        let Memory { list, first_row_of_ground, surfaces, .. } = &self.memory;
        let behind = list.surface(x, y, *first_row_of_ground)?;
        Some(surfaces.surface(x, y).unwrap_or(behind))
    }
}

/// A picture to draw, with any caster.
struct Picture<'a, S> {
    world: &'a World,
    camera: &'a Camera,
    filter: Filter,
    seconds: f64,
    threads: Option<NonZero<usize>>,
    memory: &'a mut Memory,
    frame: &'a mut Frame,
    stats: &'a mut S,
}

impl<S: Stats> Picture<'_, S> {
    fn draw<C: Caster>(self, caster: &C) -> (FramePlan, Threads) {
        let mut plan = FramePlan::new(self.world, self.camera, self.filter);
        if self.memory.surfaces.are_kept() {
            plan.tell_sky_from_ceilings(self.world);
        }
        let threads = Threads::new(self.frame.size(), self.threads);
        self.draw_planned(caster, plan, threads);
        (plan, threads)
    }

    fn draw_planned<C: Caster>(self, caster: &C, plan: FramePlan, threads: Threads) {
        let Self { world, camera, seconds, memory, frame, stats, .. } = self;
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        let projection = &match plan.visibility {
            Visibility::Flat => projection.between_floor_and_ceiling(),
            Visibility::Mixed(_) | Visibility::Portals(_) => projection,
        };
        let scene = Scene { world, camera, seconds, projection, plan: &plan };
        let list = &mut memory.list;
        memory.next_change = visibility::fill(scene, caster, &mut memory.visibility, list, stats);
        memory.first_row_of_ground = projection.first_row_of_ground();
        let sky = &SkyView::new(scene, &mut memory.sky);
        let bands = (frame, &mut memory.surfaces);
        draw_bands(threads, bands, &mut memory.raster, stats, |memory, target| {
            raster::draw(scene, list, sky, memory, target);
        });
    }
}
