//! The minimap: the map from above, north up.

mod chart;

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::glyphs::color_at;
use super::{Canvas, GlyphMode, ascii, half_blocks};
use crate::palette::ColorDepth;
use crate::render::Column;
use crate::world::{Camera, Rgb, World};
use chart::Chart;

/// A widget that shows the map from above: walls in their colours, the player as an arrow, and the
/// part of the floor that is seen, by the rays that the picture was drawn from.
///
/// It is as large as fits its area, in whole pixels a cell. A map that is too large for that scrolls
/// with the player.
#[derive(Clone, Copy, Debug)]
pub struct Minimap<'a> {
    world: &'a World,
    camera: &'a Camera,
    columns: &'a [Column],
    glyphs: GlyphMode,
    depth: ColorDepth,
}

impl<'a> Minimap<'a> {
    /// The map of `world` with `camera` on it, in half blocks and true colour.
    pub fn new(world: &'a World, camera: &'a Camera) -> Self {
        Self {
            world,
            camera,
            columns: &[],
            glyphs: GlyphMode::default(),
            depth: ColorDepth::default(),
        }
    }

    /// With the field of view that `columns` saw; they are those of a picture by the same camera.
    #[must_use]
    pub fn seen(self, columns: &'a [Column]) -> Self {
        Self { columns, ..self }
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

/// The arrow.
const PLAYER: Color = Color::Yellow;

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
        let window = Window::new(area, self.glyphs, self.world, self.camera.position());
        let chart = Chart::new(self.world, self.camera, self.columns, window.pixel());
        let place = |x, y| {
            let point = window.point(x, y);
            chart.row(point.y).place(point.x)
        };
        match self.glyphs {
            GlyphMode::Half => half_blocks::draw(area, canvas, self.depth, 0, |y| {
                let row = chart.row(window.point(0, y).y);
                let points = (0..area.width.into()).map(move |x| window.point(x, y));
                points.map(move |point| row.place(point.x).color())
            }),
            GlyphMode::Ascii | GlyphMode::Ramp => ascii::draw(area, canvas, self.depth, |x, y| {
                let place = place(x, y);
                (place.color(), place.character())
            }),
        }
        if let Some((x, y)) = window.cell(self.camera.position()) {
            let ground = match self.glyphs {
                GlyphMode::Half => place(x.into(), 2 * u32::from(y) + 1).color(),
                GlyphMode::Ascii | GlyphMode::Ramp => Rgb::BLACK,
            };
            self.draw_player((area.x + x, area.y + y), ground, canvas);
        }
    }

    /// How much of `room` shows something of the map; the rest would be blank.
    #[cfg(feature = "terminal")]
    pub(super) fn size_within(&self, room: Size) -> Size {
        let pixels_per_cell = f64::from(self.glyphs.pixels_per_cell());
        let pixels = pixels_within(room, self.glyphs);
        let needed = map_size(self.world) * scale(self.world, pixels, self.glyphs);
        let needed = needed.min(pixels);
        Size::new(needed.x as u16, (needed.y / pixels_per_cell).ceil() as u16)
    }

    /// Draws the arrow at `place`, on ground of that colour.
    fn draw_player(&self, (x, y): (u16, u16), ground: Rgb, canvas: &mut impl Canvas) {
        let arrows = match self.glyphs {
            GlyphMode::Half => ['→', '↘', '↓', '↙', '←', '↖', '↑', '↗'],
            GlyphMode::Ascii | GlyphMode::Ramp => ['>', '\\', 'v', '/', '<', '\\', '^', '/'],
        };
        let eighth = (self.camera.heading.degrees() / 45.0).round() as usize % arrows.len();
        let text = if self.depth == ColorDepth::Mono { Color::Reset } else { PLAYER };
        canvas.draw_character(x, y, arrows[eighth], [text, color_at(self.depth, ground)]);
    }
}

/// The part of the map that shows in an area.
#[derive(Clone, Copy, Debug)]
struct Window {
    /// Pixels of the area from left to right and from top to bottom.
    size: DVec2,
    /// Pixels for a cell of the map.
    scale: DVec2,
    /// Where the area's top left corner is, in pixels from the map's.
    corner: DVec2,
    pixels_per_cell: u32,
}

impl Window {
    /// All of the map and as large as possible, or as much as fits around `center`.
    fn new(area: Rect, glyphs: GlyphMode, world: &World, center: DVec2) -> Self {
        let pixels_per_cell = glyphs.pixels_per_cell();
        let size = pixels_within(area.as_size(), glyphs);
        let map = map_size(world);
        let scale = scale(world, size, glyphs);
        let spare = size - map * scale;
        let corner_along = |spare: f64, center: f64, size: f64| {
            if spare >= 0.0 {
                -(spare / 2.0).floor()
            } else {
                (center - size / 2.0).floor().clamp(0.0, -spare)
            }
        };
        let center = center * scale;
        let corner = DVec2::new(
            corner_along(spare.x, center.x, size.x),
            corner_along(spare.y, center.y, size.y),
        );
        Self { size, scale, corner, pixels_per_cell }
    }

    /// How many cells of the map a pixel is wide.
    fn pixel(&self) -> f64 {
        1.0 / self.scale.x
    }

    /// The point of the map that the centre of a pixel shows.
    fn point(&self, x: u32, y: u32) -> DVec2 {
        (DVec2::new(f64::from(x), f64::from(y)) + 0.5 + self.corner) / self.scale
    }

    /// The cell of the area that shows `point`.
    fn cell(&self, point: DVec2) -> Option<(u16, u16)> {
        let pixel = (point * self.scale - self.corner).floor();
        let shows = pixel.cmpge(DVec2::ZERO).all() && pixel.cmplt(self.size).all();
        shows.then(|| (pixel.x as u16, (pixel.y as u32 / self.pixels_per_cell) as u16))
    }
}

/// Cells of the map from left to right and from top to bottom.
fn map_size(world: &World) -> DVec2 {
    DVec2::new(f64::from(world.grid().width()), f64::from(world.grid().height()))
}

fn pixels_within(cells: Size, glyphs: GlyphMode) -> DVec2 {
    let height = u32::from(cells.height) * glyphs.pixels_per_cell();
    DVec2::new(f64::from(cells.width), f64::from(height))
}

/// How many of `pixels` a cell of the map gets: as many whole ones as let all of the map be seen.
fn scale(world: &World, pixels: DVec2, glyphs: GlyphMode) -> DVec2 {
    // A pixel of half blocks is about square; a whole cell is about twice as high as wide.
    let smallest = match glyphs {
        GlyphMode::Half => DVec2::new(1.0, 1.0),
        GlyphMode::Ascii | GlyphMode::Ramp => DVec2::new(2.0, 1.0),
    };
    smallest * (pixels / (map_size(world) * smallest)).min_element().floor().max(1.0)
}
