//! Drawing: a world and a camera in, pixels out.
//!
//! A frame is drawn in passes, each a file: `columns` casts one ray for every column of pixels,
//! `backdrop` fills in floor and ceiling, `walls` papers what the rays hit, `see_through` paints over
//! that what the rays passed. The passes share a
//! `Projection`, which is the only place that knows how the world maps to pixels.
//!
//! The caller owns the [`Frame`] and keeps the [`Renderer`], which owns what the passes need in
//! between; drawing allocates nothing once both have grown to the size of the picture. One pass that
//! does everything to a column before it goes to the next was refused: a pass that a scene has no
//! use for can be left out, a branch in the innermost loop can't.

mod backdrop;
mod columns;
mod doors;
mod frame;
mod projection;
mod see_through;
mod walls;

pub use columns::{Column, Surface};
pub use frame::{Frame, FrameSize, PixelAspect};

use crate::cast::{Caster, Method, Visitor};
use crate::world::{Camera, World};
use projection::Projection;
use see_through::Passed;

/// Draws frames, and keeps what is worth keeping from one to the next.
#[derive(Clone, Debug, Default)]
pub struct Renderer {
    method: Method,
    columns: Vec<Column>,
    passed: Passed,
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

    /// Draws what `camera` sees of `world` into all of `frame`.
    pub fn render(&mut self, world: &World, camera: &Camera, frame: &mut Frame) {
        let Self { method, columns, passed } = self;
        method.accept(Picture { world, camera, columns, passed, frame });
    }

    /// As [`Renderer::render`], with the walls that `caster` finds.
    pub fn render_with<C: Caster>(
        &mut self,
        caster: &C,
        world: &World,
        camera: &Camera,
        frame: &mut Frame,
    ) {
        let Self { columns, passed, .. } = self;
        Picture { world, camera, columns, passed, frame }.visit(caster);
    }

    /// What the rays of the last frame met, from left to right, one for each column of pixels.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }
}

/// A picture to draw, with whichever caster.
struct Picture<'a> {
    world: &'a World,
    camera: &'a Camera,
    columns: &'a mut Vec<Column>,
    passed: &'a mut Passed,
    frame: &'a mut Frame,
}

impl Visitor for Picture<'_> {
    type Output = ();

    fn visit<C: Caster>(self, caster: &C) {
        let Self { world, camera, columns, passed, frame } = self;
        let projection = Projection::new(camera, frame.size(), frame.pixel_aspect());
        columns::cast(caster, world, &projection, columns, passed);
        backdrop::draw(world, columns, frame);
        walls::draw(world, &projection, columns, frame);
        see_through::draw(world, &projection, passed, frame);
    }
}
