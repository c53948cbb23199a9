//! Drawing: a world and a camera in, pixels out.
//!
//! A frame is drawn by a [`Plan`], made from the world, in passes, each a file: `columns` casts one
//! ray for every column of pixels, `planes` lays floor and ceiling, `sky` fills in what is open,
//! `walls` papers what the rays hit, `see_through` paints over that what the rays passed, and `things`
//! what stands between all that. The passes share a `Projection`, which is the only place that knows
//! how the world maps to pixels. `level` runs them, those after the first for each band of rows, which
//! several threads share out where the picture is large; `windows` has passes of its own.
//!
//! The caller owns the [`Frame`] and keeps the [`Renderer`], which owns what the passes need in
//! between; drawing by one thread allocates nothing once both have grown to the size of the picture.
//! One pass that does everything to a column before it goes to the next was refused: a pass that a
//! scene has no use for can be left out, a branch in the innermost loop can't.

mod band;
mod coat;
mod columns;
mod doors;
mod dyn_caster;
mod explanation;
mod filter;
mod frame;
mod lay;
mod level;
mod marks;
mod paper;
mod plan;
mod planes;
mod projection;
mod renderable;
mod runs;
mod see_through;
mod shade;
mod sky;
mod tally;
mod texels_down;
mod things;
mod threads;
mod track;
mod walls;
mod windows;

pub use columns::{Column, Surface};
pub use dyn_caster::DynCaster;
pub use explanation::Explanation;
pub use filter::Filter;
pub use frame::{Frame, FrameSize, PixelAspect};
pub use plan::{
    CeilingLoop, Geometry, Plan, PlaneLoop, RayLoop, SkyLoop, ThingLoop, WallLoop, WhyWindows,
};
pub use renderable::{Options, Renderable};
pub use tally::{Counts, Pass, PassCounts};
pub use threads::{Threads, WhyOne};

use std::num::NonZero;

use crate::cast::Caster;
use crate::world::{Camera, World};
use explanation::RaysOf;
use level::Worker;
use marks::Marks;
use projection::Projection;
use see_through::Passed;
use sky::{SkyColumn, SkyView};
use tally::Tally;
use things::InView;
pub use windows::WindowCounts;
use windows::Windows;

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

/// What the passes hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
struct Memory {
    columns: Vec<Column>,
    first_row_of_ground: u32,
    passed: Passed,
    sky: Vec<SkyColumn>,
    in_view: InView,
    marks: Marks,
    next_change: Option<f64>,
    windows: Windows,
    /// By which passes the last frame was drawn.
    geometry: Option<Geometry>,
    /// One for each thread.
    workers: Vec<Worker>,
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

    /// Shows things as they are after so many `seconds` from now on; 0 at first.
    pub fn set_time(&mut self, seconds: f64) {
        self.seconds = seconds;
    }

    /// Draws by at most so many `threads` from now on; by as many as the machine has at first. Only
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
        self.memory.marks.keep(are_kept);
    }

    /// Draws what `camera` sees of `world` into all of `frame`.
    pub fn render(&mut self, world: &World, camera: &Camera, frame: &mut Frame) {
        let Self { caster, filter, seconds, threads, memory } = self;
        let (filter, seconds, threads, tally) = (*filter, *seconds, *threads, &mut ());
        caster.draw(Picture { world, camera, filter, seconds, threads, memory, frame, tally });
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
        let (filter, seconds, threads, tally) = (*filter, *seconds, *threads, &mut ());
        Picture { world, camera, filter, seconds, threads, memory, frame, tally }.draw(caster);
    }

    /// As [`Renderer::render`], and tells how it went. Cells are counted along exact rays, whatever
    /// the caster.
    pub fn explain(&mut self, world: &World, camera: &Camera, frame: &mut Frame) -> Explanation {
        let Self { caster, filter, seconds, threads, memory } = self;
        let mut counts = Counts::default();
        let (filter, seconds, threads, tally) = (*filter, *seconds, *threads, &mut counts);
        let picture = Picture { world, camera, filter, seconds, threads, memory, frame, tally };
        let plan = caster.draw_counted(picture);
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        match plan.geometry {
            Geometry::Level => {
                let rays = caster.count_rays(RaysOf { world, projection: &projection });
                (counts.rays, counts.cells, counts.looks) = (rays.rays, rays.cells, rays.looks);
            }
            Geometry::Windows(_) => {
                counts.rays = u64::from(frame.width());
                let spans = counts.windows.spans;
                counts.windows = WindowCounts { spans, ..memory.windows.counts() };
                counts.cells = counts.windows.cells;
                counts.looks = counts.cells;
            }
        }
        let size = u64::from(frame.width()) * u64::from(frame.height());
        counts.overwritten = counts.pixels() - size;
        Explanation { plan, counts }
    }

    /// What the rays of the last frame met, from left to right, one for each column of pixels.
    pub fn columns(&self) -> &[Column] {
        &self.memory.columns
    }

    /// What the pixel `(x, y)` of the last frame shows, where [that is kept](Renderer::keep_surfaces);
    /// else what it shows but for things and masks before that. `None` where the frame had no column `x`.
    pub fn surface(&self, x: u32, y: u32) -> Option<Surface> {
        let Memory { columns, first_row_of_ground, marks, windows, geometry, .. } = &self.memory;
        let column = columns.get(x as usize)?;
        marks.surface(x, y).or_else(|| match geometry {
            Some(Geometry::Windows(_)) => windows.surface(x, y),
            _ => Some(column.surface(y, *first_row_of_ground)),
        })
    }
}

/// A picture to draw, with whichever caster.
struct Picture<'a, T> {
    world: &'a World,
    camera: &'a Camera,
    filter: Filter,
    seconds: f64,
    threads: Option<NonZero<usize>>,
    memory: &'a mut Memory,
    frame: &'a mut Frame,
    tally: &'a mut T,
}

/// What the passes draw from.
#[derive(Clone, Copy)]
struct Scene<'a> {
    world: &'a World,
    projection: &'a Projection,
    columns: &'a [Column],
    filter: Filter,
}

impl<T: Tally> Picture<'_, T> {
    fn draw<C: Caster>(self, caster: &C) -> Plan {
        let Self { world, camera, filter, threads, .. } = self;
        let plan = Plan::new(world, camera, filter, self.frame.size(), threads);
        match plan.geometry {
            Geometry::Level => level::draw(self, plan, caster),
            Geometry::Windows(_) => self.draw_windows(plan),
        }
        plan
    }

    /// Draws by exact rays, whatever the caster: the others know nothing but walls.
    fn draw_windows(self, plan: Plan) {
        let Self { world, camera, filter, seconds, memory, frame, tally, .. } = self;
        let Memory { columns, sky, windows, marks, next_change, geometry, .. } = memory;
        *geometry = Some(plan.geometry);
        let projection = &Projection::new(camera, frame.size(), frame.pixel_aspect());
        let sky = &SkyView::new(world, projection, filter, sky);
        let scene = windows::Scene::new(world, projection, filter, plan.walls);
        let viewer = windows::Viewer { camera, seconds };
        let notes = (windows, columns, marks);
        *next_change = windows::draw(scene, viewer, (plan.threads, sky), notes, frame, tally);
    }
}
