//! The minimap: the map from above, with north at the top.
//!
//! Floor is shaded by its height. Cells that the player has not seen can be hidden; [`Explored`]
//! stores the seen ones. Nothing on the map is as bright as the arrow for the player.

mod explored;
mod map_point;
mod picture;
mod top_view;
mod window;

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
#[cfg(feature = "terminal")]
use ratatui::layout::Size;
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::glyphs::color_at;
use super::{GlyphSet, ascii, blocks};
use crate::color::Rgb;
use crate::color::palette::{self, ColorDepth};
use crate::render::Column;
use crate::tui::canvas::Canvas;
use crate::world::{Camera, Heading, World};
pub use explored::Explored;
use map_point::MapPoint;
use picture::Picture;
use top_view::TopView;
use window::Window;

/// A widget that shows the map from above: walls in their colours, floor by its height, the player
/// as an arrow, and the visible part of the floor, by the rays of the picture.
///
/// The map is as large as its area allows, with a whole number of pixels per cell. A map that does
/// not fit scrolls with the player.
#[derive(Clone, Copy, Debug)]
pub struct Minimap<'a> {
    world: &'a World,
    camera: &'a Camera,
    columns: &'a [Column],
    explored: Option<&'a Explored>,
    marks: &'a [MapMark],
    ghost: Option<MapMark>,
    glyphs: GlyphSet,
    depth: ColorDepth,
    zoom: i32,
    offset: DVec2,
}

impl<'a> Minimap<'a> {
    /// A map of `world` with `camera` on it, in half blocks and true colour.
    pub fn new(world: &'a World, camera: &'a Camera) -> Self {
        Self {
            world,
            camera,
            columns: &[],
            explored: None,
            marks: &[],
            ghost: None,
            glyphs: GlyphSet::default(),
            depth: ColorDepth::default(),
            zoom: 0,
            offset: DVec2::ZERO,
        }
    }

    /// Sets the hits that bound the visible floor. They must be those of a picture by the same
    /// camera.
    #[must_use]
    pub fn seen(self, columns: &'a [Column]) -> Self {
        Self { columns, ..self }
    }

    /// Shows only the cells in `explored`. By default, the whole map is shown.
    #[must_use]
    pub fn explored(self, explored: &'a Explored) -> Self {
        Self { explored: Some(explored), ..self }
    }

    /// Sets the marks of those who move. A mark shows only where the floor is visible.
    #[must_use]
    pub fn marks(self, marks: &'a [MapMark]) -> Self {
        Self { marks, ..self }
    }

    /// Sets the mark of a ghost. It shows wherever it is on the map.
    #[must_use]
    pub fn ghost(self, ghost: Option<MapMark>) -> Self {
        Self { ghost, ..self }
    }

    /// Sets the zoom. Each level about doubles or halves the map's size; 0 is the size that fits.
    /// The map is not made smaller than the size that shows all of it.
    #[must_use]
    pub fn zoom(self, levels: i32) -> Self {
        Self { zoom: levels, ..self }
    }

    /// Moves the shown part by that many cells to the east and the south of the player, up to the
    /// edge of the map.
    #[must_use]
    pub fn offset(self, cells: DVec2) -> Self {
        Self { offset: cells, ..self }
    }

    /// Sets the glyph set.
    #[must_use]
    pub fn glyphs(self, glyphs: GlyphSet) -> Self {
        Self { glyphs, ..self }
    }

    /// Sets the colour depth.
    #[must_use]
    pub fn color_depth(self, depth: ColorDepth) -> Self {
        Self { depth, ..self }
    }
}

impl Widget for Minimap<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        self.paint(area, buffer);
    }
}

impl Minimap<'_> {
    /// Draws the map on `area` of any canvas, as rendering the widget does on a buffer.
    pub fn paint(&self, area: Rect, canvas: &mut impl Canvas) {
        let area = area.intersection(canvas.bounds());
        if area.is_empty() {
            return;
        }
        let window = self.window(area);
        let seen = (self.columns, self.explored);
        let top_view = TopView::new(self.world, self.camera, seen, window.pixel());
        let picture = Picture { top_view, window };
        match self.glyphs {
            GlyphSet::Half | GlyphSet::Quadrant | GlyphSet::Sextant | GlyphSet::Octant => {
                self.draw_mosaics(&picture, area, canvas);
            }
            GlyphSet::Ascii | GlyphSet::Ramp => ascii::draw(area, canvas, self.depth, |x, y| {
                let point = picture.point(x, y);
                (point.color(), point.character())
            }),
        }
        if let Some(ghost) = &self.ghost {
            draw_pointer(ghost, self.ghost_look(), &picture, area, canvas);
        }
        for mark in self.marks.iter().filter(|mark| picture.top_view.is_visible(mark.position)) {
            draw_pointer(mark, self.mark_look(), &picture, area, canvas);
        }
        if let Some((x, y)) = window.cell(self.camera.position()) {
            self.draw_player((area.x + x, area.y + y), canvas);
        }
    }

    /// The part of `room` that the map fills; the rest would be blank.
    #[cfg(feature = "terminal")]
    pub(crate) fn size_within(&self, room: Size) -> Size {
        window::size_within(room, self.glyphs, self.world, self.zoom)
    }

    /// The number of the map's cells that an area of that size shows.
    #[cfg(feature = "terminal")]
    pub(crate) fn extent_within(&self, room: Size) -> DVec2 {
        self.window(Rect::from(room)).extent()
    }

    fn window(&self, area: Rect) -> Window {
        let center = self.camera.position() + self.offset;
        Window::new(area, self.glyphs, self.world, center, self.zoom)
    }

    fn draw_mosaics(&self, picture: &Picture, area: Rect, canvas: &mut impl Canvas) {
        let color = |point: MapPoint| match self.depth {
            ColorDepth::Indexed16 => palette::of_256(point.index_of_16()),
            _ => point.color(),
        };
        if self.depth == ColorDepth::Mono {
            return self.draw_lit_mosaics(picture, area, canvas);
        }
        blocks::draw(area, canvas, self.glyphs, self.depth, |y| {
            let row = picture.row(y);
            move |x| color(row.point(x))
        });
    }

    /// Draws the map without colour. Things are letters.
    fn draw_lit_mosaics(&self, picture: &Picture, area: Rect, canvas: &mut impl Canvas) {
        let [columns, rows] = self.glyphs.pixels_per_cell();
        for (row, y) in (0..).zip(area.top()..area.bottom()) {
            for (column, x) in (0..).zip(area.left()..area.right()) {
                let dots = || {
                    let places = (0..rows).flat_map(|row| (0..columns).map(move |x| (x, row)));
                    let places = places.map(|(x, y)| (columns * column + x, rows * row + y));
                    places.map(|(x, y)| (picture.point(x, y), (x, y)))
                };
                let thing = dots().find(|(point, _)| point.is_thing());
                let lit =
                    || blocks::lit(self.glyphs, dots().map(|(point, (x, y))| point.is_lit(x, y)));
                let character =
                    thing.map_or_else(|| lit().character(), |(point, _)| point.character());
                canvas.draw_character(x, y, character, [Color::Reset; 2]);
            }
        }
    }

    fn mark_look(&self) -> Look {
        let pointers = match self.glyphs {
            GlyphSet::Ascii | GlyphSet::Ramp => [')', 'u', '(', 'n'],
            _ => ['▸', '▾', '◂', '▴'],
        };
        (pointers, self.colors([MARK_TEXT, MARK], [15, 9]))
    }

    /// A ghost is hollow, or a letter, and pale: it is nobody who could see the player.
    fn ghost_look(&self) -> Look {
        let pointers = match self.glyphs {
            GlyphSet::Ascii | GlyphSet::Ramp => ['g'; 4],
            _ => ['▹', '▿', '◃', '▵'],
        };
        (pointers, self.colors([GHOST_TEXT, GHOST], [15, 6]))
    }

    /// The text and the background of a mark.
    fn colors(&self, colors: [Rgb; 2], of_16: [u8; 2]) -> [Color; 2] {
        match self.depth {
            ColorDepth::Mono => [Color::Reset; 2],
            ColorDepth::Indexed16 => of_16.map(Color::Indexed),
            ColorDepth::Indexed256 | ColorDepth::True => {
                colors.map(|color| color_at(self.depth, color))
            }
        }
    }

    /// Draws the arrow in the cell at `x` and `y`.
    fn draw_player(&self, (x, y): (u16, u16), canvas: &mut impl Canvas) {
        let arrows = match self.glyphs {
            GlyphSet::Ascii | GlyphSet::Ramp => ['>', '\\', 'v', '/', '<', '\\', '^', '/'],
            _ => ['→', '↘', '↓', '↙', '←', '↖', '↑', '↗'],
        };
        let eighth = (self.camera.heading.degrees() / 45.0).round() as usize % arrows.len();
        let colors = self.colors([Rgb::BLACK, PLAYER], [0, 11]);
        canvas.draw_character(x, y, arrows[eighth], colors);
    }
}

/// Draws a mark that points in one of four directions.
fn draw_pointer(
    mark: &MapMark,
    (pointers, colors): Look,
    picture: &Picture,
    area: Rect,
    canvas: &mut impl Canvas,
) {
    let Some((x, y)) = picture.window.cell(mark.position) else { return };
    if x >= area.width || y >= area.height {
        return;
    }
    let quarter = (mark.heading.degrees() / 90.0).round() as usize % pointers.len();
    canvas.draw_character(area.x + x, area.y + y, pointers[quarter], colors);
}

/// Somebody on the map besides the player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapMark {
    /// The position, in cells.
    pub position: DVec2,
    /// The direction in which they look.
    pub heading: Heading,
}

/// The pointers to the east, south, west and north, and the colours of the text and the background.
type Look = ([char; 4], [Color; 2]);

/// The colour of a mark, which is darker than the arrow.
const MARK_TEXT: Rgb = Rgb::new(0xb8, 0xb0, 0xb0);
/// The background of a mark.
const MARK: Rgb = Rgb::new(0xc0, 0x30, 0x28);
/// The colour of a ghost, and its background.
const GHOST_TEXT: Rgb = Rgb::new(0xb8, 0xc0, 0xd0);
const GHOST: Rgb = Rgb::new(0x38, 0x58, 0x78);
/// The background of the arrow.
const PLAYER: Rgb = Rgb::new(0xff, 0xf0, 0x50);
