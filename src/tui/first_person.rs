//! The first-person view: a widget that shows what a camera sees.

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::widgets::StatefulWidget;

use super::canvas::{Canvas, draw_characters};
use super::correction::{Edge, outline};
use super::{CellAspect, Correction, GlyphSet, ascii, blocks};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::render::{Filter, Frame, FrameSize, Options, PixelAspect, Renderable};
use crate::world::World;
#[cfg(feature = "terminal")]
use crate::world::{Camera, Figure};

/// A widget that shows what a camera sees of a [`World`], or of a [`Scene`](crate::space::Scene) of
/// bodies.
///
/// Its state, a [`View`], keeps the picture and the renderer's memory between frames.
///
/// ```
/// use cellcaster::tui::{FirstPerson, View};
/// use cellcaster::world::FieldOfView;
/// use ratatui::buffer::Buffer;
/// use ratatui::layout::Rect;
/// use ratatui::widgets::StatefulWidget;
///
/// let world = cellcaster::map::builtin::LEVELS[0].world()?;
/// let camera = world.start_camera(FieldOfView::default());
/// let mut buffer = Buffer::empty(Rect::new(0, 0, 80, 24));
/// FirstPerson::new(&world, &camera).render(buffer.area, &mut buffer, &mut View::default());
/// assert_eq!(buffer[(0, 0)].symbol(), "▀");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FirstPerson<'a, S: Renderable = World> {
    scene: &'a S,
    camera: &'a S::Camera,
    glyphs: GlyphSet,
    depth: ColorDepth,
    shade_ink: ShadeInk,
    correction: Correction,
    cell_aspect: CellAspect,
    filter: Filter,
    seconds: f64,
}

impl<'a, S: Renderable> FirstPerson<'a, S> {
    /// A widget that shows `scene` from `camera` in half blocks and true colour, on cells twice as
    /// high as wide.
    pub fn new(scene: &'a S, camera: &'a S::Camera) -> Self {
        Self {
            scene,
            camera,
            glyphs: GlyphSet::default(),
            depth: ColorDepth::default(),
            shade_ink: ShadeInk::default(),
            correction: Correction::default(),
            cell_aspect: CellAspect::default(),
            filter: Filter::default(),
            seconds: 0.0,
        }
    }

    /// Sets the glyph set. In [`GlyphSet::Ascii`], the characters of a grid show surfaces, and the
    /// characters of bodies show brightness. Shading gives a body its shape, and a surface has only four
    /// characters.
    #[must_use]
    pub fn glyphs(self, glyphs: GlyphSet) -> Self {
        Self { glyphs, ..self }
    }

    /// Sets the colour depth.
    #[must_use]
    pub fn color_depth(self, depth: ColorDepth) -> Self {
        Self { depth, ..self }
    }

    /// Sets how the terminal draws the shades ░, ▒ and ▓, which mix the colours of a small palette.
    #[must_use]
    pub fn shade_ink(self, shade_ink: ShadeInk) -> Self {
        Self { shade_ink, ..self }
    }

    /// Sets the correction for the player's eyesight.
    #[must_use]
    pub fn correction(self, correction: Correction) -> Self {
        Self { correction, ..self }
    }

    /// Sets the shape of a cell.
    #[must_use]
    pub fn cell_aspect(self, cell_aspect: CellAspect) -> Self {
        Self { cell_aspect, ..self }
    }

    /// Sets the texture filter.
    #[must_use]
    pub fn filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// Sets the time in seconds. Animated things depend on it. [`View::next_change`] returns the time of
    /// the next change.
    #[must_use]
    pub fn time(self, seconds: f64) -> Self {
        Self { seconds, ..self }
    }

    /// Renders the picture for an area of this size into `view`, as pixels only.
    ///
    /// Rendering the widget calls this function and [`FirstPerson::paint`]. Call them separately to
    /// paint a large picture in bands of rows.
    pub fn draw(&self, size: Size, view: &mut View<S>) {
        self.draw_while(size, view, &mut || true);
    }

    /// Does the same as [`FirstPerson::draw`], but may stop once `go_on` returns `false`. Returns true if
    /// the picture is complete. The picture can be painted in either case: where it is incomplete, it
    /// shows earlier pictures.
    pub fn draw_while(
        &self,
        size: Size,
        view: &mut View<S>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let Some(View { renderer, frame, luma }) = self.resized(size, view) else { return true };
        let is_complete =
            self.scene.render_while(self.camera, self.options(), renderer, frame, go_on);
        if is_complete {
            self.correction.apply(frame, self.glyphs.pixels_per_cell(), luma);
        }
        is_complete
    }

    /// Does the same as [`FirstPerson::draw`] and returns the frame's cost, or `None` if the area
    /// has no cells.
    pub fn explain(&self, size: Size, view: &mut View<S>) -> Option<S::Explanation> {
        let View { renderer, frame, .. } = self.resized(size, view)?;
        Some(self.scene.explain(self.camera, self.options(), renderer, frame))
    }

    /// Fills `area` with cells of the picture in `view`, beginning with the picture's row of cells
    /// `first_row`.
    ///
    /// # Panics
    /// If the picture has fewer cells than `area` needs.
    pub fn paint(&self, view: &View<S>, first_row: u16, area: Rect, canvas: &mut impl Canvas) {
        if area.is_empty() {
            return;
        }
        let View { renderer, frame, .. } = view;
        let [_, rows_per_cell] = self.glyphs.pixels_per_cell();
        let above = u32::from(first_row) * rows_per_cell;
        let surface = |x, y| S::surface(renderer, x, y);
        match self.glyphs {
            GlyphSet::Half | GlyphSet::Quadrant | GlyphSet::Sextant | GlyphSet::Octant => {
                let colors = (self.depth, self.shade_ink);
                blocks::draw_frame(area, canvas, self.glyphs, colors, above, frame, surface);
            }
            GlyphSet::Ascii => {
                let is_beside_thing =
                    |x, y| outline(frame.size(), surface, x, y) == Some(Edge::Outer);
                draw_characters(area, canvas, |x, y| {
                    let y = above + y;
                    let color = frame.pixel(x, y);
                    let character = match surface(x, y) {
                        Some(_) if self.depth == ColorDepth::Mono && is_beside_thing(x, y) => ' ',
                        Some(surface) => ascii::character(surface, color),
                        None => ascii::ramp_character(color),
                    };
                    (character, ascii::picture_colors(self.depth, color))
                });
            }
            GlyphSet::Ramp => draw_characters(area, canvas, |x, y| {
                let color = frame.pixel(x, above + y);
                (ascii::ramp_character(color), ascii::picture_colors(self.depth, color))
            }),
        }
    }

    /// Resizes the frame of `view` to an area of this size. Returns `None` if the area has no cells.
    fn resized<'v>(&self, size: Size, view: &'v mut View<S>) -> Option<&'v mut View<S>> {
        let [columns, rows] = self.glyphs.pixels_per_cell();
        let (width, height) = (u32::from(size.width) * columns, u32::from(size.height) * rows);
        let size = FrameSize::new(width, height)?;
        view.frame.resize(size, self.cell_aspect.of_pixels(self.glyphs));
        Some(view)
    }

    fn options(&self) -> Options {
        let keeps_surfaces = match self.glyphs {
            GlyphSet::Ascii => true,
            GlyphSet::Ramp => false,
            _ => self.depth == ColorDepth::Mono,
        };
        Options { filter: self.filter, seconds: self.seconds, keeps_surfaces }
    }
}

impl<S: Renderable> Clone for FirstPerson<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Renderable> Copy for FirstPerson<'_, S> {}

/// The state of a [`FirstPerson`]: the last picture, and the renderer with its memory.
#[derive(Clone, Debug)]
pub struct View<S: Renderable = World> {
    renderer: S::Renderer,
    frame: Frame,
    /// Memory for a [`Correction`].
    luma: Vec<u8>,
}

impl<S: Renderable> Default for View<S> {
    fn default() -> Self {
        let smallest = FrameSize { width: NonZeroU32::MIN, height: NonZeroU32::MIN };
        let frame = Frame::new(smallest, PixelAspect::SQUARE);
        Self { renderer: S::Renderer::default(), frame, luma: Vec::new() }
    }
}

impl<S: Renderable> View<S> {
    /// The pixels of the last picture, to change them before they are painted.
    #[cfg(feature = "terminal")]
    pub(crate) fn frame_mut(&mut self) -> &mut Frame {
        &mut self.frame
    }

    /// The time of the next change in the last picture that does not depend on the camera, as in
    /// [`FirstPerson::time`]. `None` if there is no such change.
    pub fn next_change(&self) -> Option<f64> {
        S::next_change(&self.renderer)
    }
}

impl View {
    /// Returns true if `figure` may be visible in the last picture, wherever the figure was then. `world`
    /// and `camera` must be the world and the camera of the picture.
    #[cfg(feature = "terminal")]
    pub(crate) fn may_show(&self, world: &World, camera: &Camera, figure: &Figure) -> bool {
        self.renderer.may_show(world, camera, &self.frame, figure)
    }

    /// The distances at which the last picture's rays ended, in cells, from left to right.
    pub fn distances(&self) -> &[f64] {
        self.renderer.distances()
    }
}

impl<S: Renderable> StatefulWidget for FirstPerson<'_, S> {
    type State = View<S>;

    fn render(self, area: Rect, buffer: &mut Buffer, view: &mut View<S>) {
        let area = area.intersection(buffer.area);
        self.draw(area.as_size(), view);
        self.paint(view, 0, area, buffer);
    }
}
