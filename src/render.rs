//! Drawing: a world and a camera in, pixels out.
//!
//! A frame is drawn by a [`Plan`], made from the world, in passes, each a file: `columns` casts one
//! ray for every column of pixels, `planes` lays floor and ceiling, `sky` fills in what is open,
//! `walls` papers what the rays hit, `see_through` paints over that what the rays passed. The passes
//! share a `Projection`, which is the only place that knows how the world maps to pixels.
//!
//! The caller owns the [`Frame`] and keeps the [`Renderer`], which owns what the passes need in
//! between; drawing allocates nothing once both have grown to the size of the picture. One pass that
//! does everything to a column before it goes to the next was refused: a pass that a scene has no
//! use for can be left out, a branch in the innermost loop can't.

mod columns;
mod doors;
mod explanation;
mod filter;
mod frame;
mod lay;
mod plan;
mod planes;
mod projection;
mod see_through;
mod shade;
mod sky;
mod tally;
mod texels_down;
mod track;
mod walls;

pub use columns::{Column, Surface};
pub use explanation::Explanation;
pub use filter::Filter;
pub use frame::{Frame, FrameSize, PixelAspect};
pub use plan::{CeilingLoop, Plan, PlaneLoop, SkyLoop, WallLoop};
pub use tally::{Counts, Pass, PassCounts};

use crate::cast::{Caster, Method, Visitor};
use crate::world::{Camera, World};
use planes::{Plane, PlaneKind};
use projection::Projection;
use see_through::Passed;
use sky::{SkyColumn, SkyView};
use tally::Tally;
use walls::Papers;

/// Draws frames, and keeps what is worth keeping from one to the next.
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    method: Method,
    filter: Filter,
    memory: Memory,
}

/// What the passes hand on to each other; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
struct Memory {
    columns: Vec<Column>,
    passed: Passed,
    /// For each column, how many rows show the floor or the ceiling, whichever is being drawn.
    visible: Vec<u32>,
    sky: Vec<SkyColumn>,
    papers: Papers,
}

impl Renderer {
    /// A renderer that has drawn nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A renderer that finds the walls by `method`, where [`Renderer::new`] finds them exactly.
    pub fn with_method(method: Method) -> Self {
        Self { method, ..Self::default() }
    }

    /// Looks textures up by `filter` from now on.
    pub fn set_filter(&mut self, filter: Filter) {
        self.filter = filter;
    }

    /// Draws what `camera` sees of `world` into all of `frame`.
    pub fn render(&mut self, world: &World, camera: &Camera, frame: &mut Frame) {
        let Self { method, filter, memory } = self;
        method.accept(Picture { world, camera, filter: *filter, memory, frame, tally: &mut () });
    }

    /// As [`Renderer::render`], with the walls that `caster` finds.
    pub fn render_with<C: Caster>(
        &mut self,
        caster: &C,
        world: &World,
        camera: &Camera,
        frame: &mut Frame,
    ) {
        let Self { filter, memory, .. } = self;
        let picture = Picture { world, camera, filter: *filter, memory, frame, tally: &mut () };
        picture.visit(caster);
    }

    /// As [`Renderer::render`], and tells how it went. Cells are counted along exact rays, whatever
    /// the method of finding walls.
    pub fn explain(&mut self, world: &World, camera: &Camera, frame: &mut Frame) -> Explanation {
        let Self { method, filter, memory } = self;
        let mut counts = Counts::default();
        let tally = &mut counts;
        let plan = method.accept(Picture { world, camera, filter: *filter, memory, frame, tally });
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        counts.rays = u64::from(frame.width());
        counts.cells = explanation::cells_entered(world.grid(), &projection);
        let size = u64::from(frame.width()) * u64::from(frame.height());
        counts.overwritten = counts.pixels() - size;
        Explanation { plan, counts }
    }

    /// What the rays of the last frame met, from left to right, one for each column of pixels.
    pub fn columns(&self) -> &[Column] {
        &self.memory.columns
    }
}

/// A picture to draw, with whichever caster.
struct Picture<'a, T> {
    world: &'a World,
    camera: &'a Camera,
    filter: Filter,
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

impl<T: Tally> Visitor for Picture<'_, T> {
    type Output = Plan;

    fn visit<C: Caster>(self, caster: &C) -> Plan {
        let Self { world, camera, filter, memory, frame, tally } = self;
        let Memory { columns, passed, visible, sky, papers } = memory;
        let plan = Plan::new(world, filter);
        let projection = &Projection::new(camera, frame.size(), frame.pixel_aspect());
        columns::cast(caster, world, projection, columns, passed);
        let scene = Scene { world, projection, columns, filter };
        let height = frame.height();

        let sky = &SkyView::new(world, projection, filter, sky);
        match plan.ceiling {
            CeilingLoop::Sky => sky.draw_overhead(plan.sky, scene, frame, tally),
            CeilingLoop::Laid(plane) => {
                visible.clear();
                visible.extend(columns.iter().map(|column| column.rows_of_ceiling(height)));
                Plane { scene, kind: PlaneKind::Ceiling, sky, visible }.draw(plane, frame, tally);
                sky.draw_beyond_edge(scene, frame, tally);
            }
        }
        visible.clear();
        visible.extend(columns.iter().map(|column| column.rows_of_floor(height)));
        Plane { scene, kind: PlaneKind::Floor, sky, visible }.draw(plan.floor, frame, tally);
        walls::draw(scene, plan.walls, papers, frame, tally);
        see_through::draw(scene, passed, frame, tally);
        plan
    }
}
