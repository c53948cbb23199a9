//! The minimap: the map from above, north up.
//!
//! Floor is shaded by its height, and what has not been seen can be left out: [`Explored`] is what has. Nothing on it
//! is as bright as the arrow that stands for the player.

mod chart;
mod explored;
mod place;
mod window;

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
#[cfg(feature = "terminal")]
use ratatui::layout::Size;
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::glyphs::color_at;
use super::{GlyphMode, ascii, half_blocks};
use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::ColorDepth;
use crate::render::Column;
use crate::world::{Camera, World};
use chart::Chart;
pub use explored::Explored;
use place::Place;
use window::Window;

/// A widget that shows the map from above: walls in their colours, floor by its height, the player as an arrow, and
/// the part of the floor that is in view, by the rays that the picture was drawn from.
///
/// It is as large as fits its area, in whole pixels a cell. A map that is too large for that scrolls
/// with the player.
#[derive(Clone, Copy, Debug)]
pub struct Minimap<'a> {
    world: &'a World,
    camera: &'a Camera,
    columns: &'a [Column],
    explored: Option<&'a Explored>,
    glyphs: GlyphMode,
    depth: ColorDepth,
    zoom: i32,
    offset: DVec2,
}

impl<'a> Minimap<'a> {
    /// The map of `world` with `camera` on it, in half blocks and true colour.
    pub fn new(world: &'a World, camera: &'a Camera) -> Self {
        Self {
            world,
            camera,
            columns: &[],
            explored: None,
            glyphs: GlyphMode::default(),
            depth: ColorDepth::default(),
            zoom: 0,
            offset: DVec2::ZERO,
        }
    }

    /// With the field of view that `columns` saw; they are those of a picture by the same camera.
    #[must_use]
    pub fn seen(self, columns: &'a [Column]) -> Self {
        Self { columns, ..self }
    }

    /// With nothing but what is `explored`; without this, all of the map shows.
    #[must_use]
    pub fn explored(self, explored: &'a Explored) -> Self {
        Self { explored: Some(explored), ..self }
    }

    /// So many levels larger than fits the area, or smaller where that is not all of the map: a level doubles or
    /// halves it, about.
    #[must_use]
    pub fn zoom(self, levels: i32) -> Self {
        Self { zoom: levels, ..self }
    }

    /// Around a place so many cells to the east and the south of the player, as far as the map goes on there.
    #[must_use]
    pub fn offset(self, cells: DVec2) -> Self {
        Self { offset: cells, ..self }
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
}

impl Widget for Minimap<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        self.paint(area, buffer);
    }
}

impl Minimap<'_> {
    /// Draws it on `area`, as rendering the widget does on that of a buffer.
    pub fn paint(&self, area: Rect, canvas: &mut impl Canvas) {
        let area = area.intersection(canvas.bounds());
        if area.is_empty() {
            return;
        }
        let window = self.window(area);
        let seen = (self.columns, self.explored);
        let chart = Chart::new(self.world, self.camera, seen, window.pixel());
        let picture = Picture { chart, window };
        match self.glyphs {
            GlyphMode::Half => self.draw_halves(&picture, area, canvas),
            GlyphMode::Ascii | GlyphMode::Ramp => ascii::draw(area, canvas, self.depth, |x, y| {
                let place = picture.place(x, y);
                (place.color(), place.character())
            }),
        }
        if let Some((x, y)) = window.cell(self.camera.position()) {
            self.draw_player((area.x + x, area.y + y), canvas);
        }
    }

    /// How much of `room` shows something of the map; the rest would be blank.
    #[cfg(feature = "terminal")]
    pub(crate) fn size_within(&self, room: Size) -> Size {
        window::size_within(room, self.glyphs, self.world, self.zoom)
    }

    /// How many cells of the map an area of that size shows.
    #[cfg(feature = "terminal")]
    pub(crate) fn extent_within(&self, room: Size) -> DVec2 {
        self.window(Rect::from(room)).extent()
    }

    fn window(&self, area: Rect) -> Window {
        let center = self.camera.position() + self.offset;
        Window::new(area, self.glyphs, self.world, center, self.zoom)
    }

    fn draw_halves(&self, picture: &Picture, area: Rect, canvas: &mut impl Canvas) {
        let row = |y| (0..u32::from(area.width)).map(move |x| picture.place(x, y));
        match self.depth {
            ColorDepth::True | ColorDepth::Indexed256 => {
                for (y, upper) in (area.top()..area.bottom()).zip((0..).step_by(2)) {
                    let color = |place: Place| color_at(self.depth, place.color());
                    let halves = row(upper).zip(row(upper + 1));
                    let colors = halves.map(|(top, bottom)| [color(top), color(bottom)]);
                    canvas.draw_halves(area.x, y, colors);
                }
            }
            ColorDepth::Indexed16 => {
                for (y, upper) in (area.top()..area.bottom()).zip((0..).step_by(2)) {
                    let color = |place: Place| Color::Indexed(place.index_of_16());
                    let halves = row(upper).zip(row(upper + 1));
                    let colors = halves.map(|(top, bottom)| [color(top), color(bottom)]);
                    canvas.draw_halves(area.x, y, colors);
                }
            }
            ColorDepth::Mono => {
                for (y, upper) in (area.top()..area.bottom()).zip((0..).step_by(2)) {
                    for (x, (top, bottom)) in (0..).zip(row(upper).zip(row(upper + 1))) {
                        let character = in_mono((top, bottom), (x, upper));
                        canvas.draw_character(area.x + x as u16, y, character, [Color::Reset; 2]);
                    }
                }
            }
        }
    }

    /// Draws the arrow at `place`.
    fn draw_player(&self, (x, y): (u16, u16), canvas: &mut impl Canvas) {
        let arrows = match self.glyphs {
            GlyphMode::Half => ['→', '↘', '↓', '↙', '←', '↖', '↑', '↗'],
            GlyphMode::Ascii | GlyphMode::Ramp => ['>', '\\', 'v', '/', '<', '\\', '^', '/'],
        };
        let eighth = (self.camera.heading.degrees() / 45.0).round() as usize % arrows.len();
        let colors = match self.depth {
            ColorDepth::Mono => [Color::Reset; 2],
            ColorDepth::Indexed16 => [Color::Indexed(0), Color::Indexed(11)],
            ColorDepth::Indexed256 | ColorDepth::True => {
                [Rgb::BLACK, PLAYER].map(|color| color_at(self.depth, color))
            }
        };
        canvas.draw_character(x, y, arrows[eighth], colors);
    }
}

/// What the arrow is drawn on.
const PLAYER: Rgb = Rgb::new(0xff, 0xf0, 0x50);

/// What pixels are asked of.
struct Picture<'a> {
    chart: Chart<'a>,
    window: Window,
}

impl Picture<'_> {
    /// What a pixel shows: of several cells, what matters most.
    #[inline]
    fn place(&self, x: u32, y: u32) -> Place {
        let point = self.window.point(x, y);
        let [columns, rows] = self.window.cells_per_pixel();
        if (columns, rows) == (1, 1) {
            return self.chart.row(point.y).place(point.x);
        }
        // The middles of as many cells around the pixel's own.
        let along = |point: f64, count: u32| {
            let first = point - f64::from(count - 1) / 2.0;
            (0..count).map(move |index| first + f64::from(index))
        };
        let places = along(point.y, rows).flat_map(|y| {
            let row = self.chart.row(y);
            along(point.x, columns).map(move |x| row.place(x))
        });
        places.max_by_key(|place| place.importance()).unwrap_or(Place::Void)
    }
}

/// The character for two places, one above the other, where there are no colours: things are letters.
fn in_mono((top, bottom): (Place, Place), (x, y): (u32, u32)) -> char {
    let letter = [top, bottom]
        .into_iter()
        .find(|place| matches!(place, Place::Exit | Place::Key | Place::Ornament));
    letter.map_or_else(
        || half_blocks::lit_glyph(top.is_lit(x, y), bottom.is_lit(x, y + 1)),
        Place::character,
    )
}
