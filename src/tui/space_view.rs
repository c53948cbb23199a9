//! The view into a scene of bodies, in cells.

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::widgets::StatefulWidget;

use super::{CellAspect, GlyphMode, ascii, half_blocks, ramp};
use crate::canvas::Canvas;
use crate::color::palette::ColorDepth;
use crate::render::{Frame, FrameSize, PixelAspect};
use crate::space::{Camera, Explanation, Renderer, Scene};

/// A widget that shows what a camera sees of bodies.
///
/// Its state, a [`SpaceMemory`], keeps the memory for the picture from one drawing to the next. Without
/// block characters a cell shows how bright it is: it is the shades that make a body round, and the
/// four that each surface of a grid has are too few for them.
#[derive(Clone, Copy, Debug)]
pub struct SpaceView<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    glyphs: GlyphMode,
    depth: ColorDepth,
    cell_aspect: CellAspect,
}

impl<'a> SpaceView<'a> {
    /// What `camera` sees of `scene`: half blocks in true colour, on cells twice as high as wide.
    pub fn new(scene: &'a Scene, camera: &'a Camera) -> Self {
        Self {
            scene,
            camera,
            glyphs: GlyphMode::default(),
            depth: ColorDepth::default(),
            cell_aspect: CellAspect::default(),
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

    /// Draws the picture for an area of that size into `memory`, as pixels only, and tells how it went;
    /// `None` where the area has no cells.
    ///
    /// With [`SpaceView::paint`] this is what rendering the widget does.
    pub fn draw(&self, size: Size, memory: &mut SpaceMemory) -> Option<Explanation> {
        let height = u32::from(size.height) * self.glyphs.pixels_per_cell();
        let size = FrameSize::new(u32::from(size.width), height)?;
        let SpaceMemory { renderer, frame } = memory;
        frame.resize(size, self.cell_aspect.of_pixels(self.glyphs));
        Some(renderer.explain(self.scene, self.camera, frame))
    }

    /// Fills `area` with the cells of the picture in `memory`, from its row of cells `first_row` on.
    ///
    /// # Panics
    /// Where the picture has fewer cells than that.
    pub fn paint(
        &self,
        memory: &SpaceMemory,
        first_row: u16,
        area: Rect,
        canvas: &mut impl Canvas,
    ) {
        let above = u32::from(first_row) * self.glyphs.pixels_per_cell();
        let frame = &memory.frame;
        match self.glyphs {
            GlyphMode::Half => {
                half_blocks::draw_frame(area, canvas, self.depth, above, frame);
            }
            GlyphMode::Ascii | GlyphMode::Ramp => {
                ascii::draw_picture(area, canvas, self.depth, |x, y| {
                    let color = frame.pixel(x, above + y);
                    (color, ramp::character(color))
                });
            }
        }
    }
}

/// What a [`SpaceView`] keeps between drawings.
#[derive(Clone, Debug)]
pub struct SpaceMemory {
    renderer: Renderer,
    frame: Frame,
}

impl Default for SpaceMemory {
    fn default() -> Self {
        let smallest = FrameSize { width: NonZeroU32::MIN, height: NonZeroU32::MIN };
        Self { renderer: Renderer::new(), frame: Frame::new(smallest, PixelAspect::SQUARE) }
    }
}

impl StatefulWidget for SpaceView<'_> {
    type State = SpaceMemory;

    fn render(self, area: Rect, buffer: &mut Buffer, memory: &mut SpaceMemory) {
        let area = area.intersection(buffer.area);
        self.draw(area.as_size(), memory);
        self.paint(memory, 0, area, buffer);
    }
}
