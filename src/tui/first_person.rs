//! The first-person view: what a camera sees, in cells.

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::widgets::StatefulWidget;

use super::{CellAspect, GlyphMode, ascii, half_blocks, ramp};
use crate::canvas::Canvas;
use crate::color::palette::ColorDepth;
use crate::render::{
    Column, DynCaster, Explanation, Filter, Frame, FrameSize, PixelAspect, Renderer, Surface,
};
use crate::world::{Camera, World};

/// A widget that shows what a camera sees.
///
/// Its state, a [`View`], keeps the memory for the picture from one drawing to the next.
#[derive(Clone, Copy, Debug)]
pub struct FirstPerson<'a> {
    world: &'a World,
    camera: &'a Camera,
    glyphs: GlyphMode,
    depth: ColorDepth,
    cell_aspect: CellAspect,
    filter: Filter,
    seconds: f64,
}

impl<'a> FirstPerson<'a> {
    /// What `camera` sees of `world`: half blocks in true colour, on cells twice as high as wide.
    pub fn new(world: &'a World, camera: &'a Camera) -> Self {
        Self {
            world,
            camera,
            glyphs: GlyphMode::default(),
            depth: ColorDepth::default(),
            cell_aspect: CellAspect::default(),
            filter: Filter::default(),
            seconds: 0.0,
        }
    }

    /// With those characters.
    #[must_use]
    pub fn glyphs(self, glyphs: GlyphMode) -> Self {
        Self { glyphs, ..self }
    }

    /// With that many colours.
    #[must_use]
    pub fn color_depth(self, depth: ColorDepth) -> Self {
        Self { depth, ..self }
    }

    /// On cells of that shape.
    #[must_use]
    pub fn cell_aspect(self, cell_aspect: CellAspect) -> Self {
        Self { cell_aspect, ..self }
    }

    /// With textures looked up like that.
    #[must_use]
    pub fn filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// With things as they are after so many seconds; [`View::next_change`] tells when to draw again.
    #[must_use]
    pub fn time(self, seconds: f64) -> Self {
        Self { seconds, ..self }
    }

    /// Draws the picture for an area of that size into `view`, as pixels only.
    ///
    /// With [`FirstPerson::paint`] this is what rendering the widget does. Apart, they serve who has
    /// no room for the cells of the whole picture at once.
    pub fn draw(&self, size: Size, view: &mut View) {
        let Some(View { renderer, frame }) = self.prepare(size, view) else { return };
        renderer.render(self.world, self.camera, frame);
    }

    /// As [`FirstPerson::draw`], and tells how it went; `None` where the area has no cells.
    pub fn explain(&self, size: Size, view: &mut View) -> Option<Explanation> {
        let View { renderer, frame } = self.prepare(size, view)?;
        Some(renderer.explain(self.world, self.camera, frame))
    }

    /// `view`, ready to be drawn to; `None` where the area has no cells.
    fn prepare<'v>(&self, size: Size, view: &'v mut View) -> Option<&'v mut View> {
        let height = u32::from(size.height) * self.glyphs.pixels_per_cell();
        let size = FrameSize::new(u32::from(size.width), height)?;
        view.frame.resize(size, self.cell_aspect.of_pixels(self.glyphs));
        view.renderer.set_filter(self.filter);
        view.renderer.set_time(self.seconds);
        view.renderer.keep_surfaces(self.glyphs == GlyphMode::Ascii);
        Some(view)
    }

    /// Fills `area` with the cells of the picture in `view`, from its row of cells `first_row` on.
    ///
    /// # Panics
    /// Where the picture has fewer cells than that.
    pub fn paint(&self, view: &View, first_row: u16, area: Rect, canvas: &mut impl Canvas) {
        let View { renderer, frame } = view;
        let above = u32::from(first_row) * self.glyphs.pixels_per_cell();
        match self.glyphs {
            GlyphMode::Half => {
                half_blocks::draw_frame(area, canvas, self.depth, above, frame);
            }
            GlyphMode::Ascii => ascii::draw_picture(area, canvas, self.depth, |x, y| {
                let color = frame.pixel(x, above + y);
                let surface = renderer.surface(x, above + y).unwrap_or(Surface::Sky);
                (color, ascii::character(surface, color))
            }),
            GlyphMode::Ramp => ascii::draw_picture(area, canvas, self.depth, |x, y| {
                let color = frame.pixel(x, above + y);
                (color, ramp::character(color))
            }),
        }
    }
}

/// What a [`FirstPerson`] keeps between drawings: the picture, and what the rays met.
#[derive(Clone, Debug)]
pub struct View {
    renderer: Renderer,
    frame: Frame,
}

impl Default for View {
    fn default() -> Self {
        let smallest = FrameSize { width: NonZeroU32::MIN, height: NonZeroU32::MIN };
        Self { renderer: Renderer::new(), frame: Frame::new(smallest, PixelAspect::SQUARE) }
    }
}

impl View {
    /// A view whose renderer finds the walls by `caster`.
    pub fn with_caster(caster: DynCaster) -> Self {
        Self { renderer: Renderer::with_caster(caster), ..Self::default() }
    }

    /// When something in the last picture begins to look different, by the clock of
    /// [`FirstPerson::time`]; `None` for never.
    pub fn next_change(&self) -> Option<f64> {
        self.renderer.next_change()
    }

    /// What the rays of the last drawing met, from left to right.
    pub fn columns(&self) -> &[Column] {
        self.renderer.columns()
    }
}

impl StatefulWidget for FirstPerson<'_> {
    type State = View;

    fn render(self, area: Rect, buffer: &mut Buffer, view: &mut View) {
        let area = area.intersection(buffer.area);
        self.draw(area.as_size(), view);
        self.paint(view, 0, area, buffer);
    }
}
