//! The minimap: the map from above, with north at the top.
//!
//! Floor is shaded by its height. Cells that the player has not seen can be hidden; [`Explored`] stores the seen
//! cells. Nothing on the map is as bright as the arrow for the player.

mod explored;
#[cfg(feature = "terminal")]
mod legend;
mod top_view;

use glam::DVec2;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::Widget;

pub use self::explored::Explored;
#[cfg(feature = "terminal")]
pub(crate) use self::legend::legend;
use self::top_view::{MapPoint, MapRow, TopView};
use super::canvas::{Canvas, draw_characters};
use super::glyphs::color_at;
use super::{GlyphSet, blocks};
use crate::color::Rgb;
use crate::color::palette::{self, ColorDepth};
use crate::game::SightCone;
use crate::world::{Camera, Heading, World};

/// A widget that shows the map from above: walls in their colours, floor by its height, the player as an arrow, and
/// the visible part of the floor, bounded by the rays of the picture.
///
/// The map is as large as its area allows, with a whole number of pixels per cell. A map that does
/// not fit scrolls with the player.
#[derive(Clone, Copy, Debug)]
pub struct Minimap<'a> {
    world: &'a World,
    camera: &'a Camera,
    distances: &'a [f64],
    explored: Option<&'a Explored>,
    marks: &'a [MapMark],
    cones: &'a [SightCone],
    shows_all_marks: bool,
    is_faded: bool,
    ghost: Option<MapMark>,
    glyphs: GlyphSet,
    depth: ColorDepth,
    zoom: i32,
    /// The columns and rows for each cell of the map; `None` for the size that fits.
    cell_size: Option<[u32; 2]>,
    offset: DVec2,
}

impl<'a> Minimap<'a> {
    /// A map of `world` with `camera` on it, in half blocks and true colour.
    pub fn new(world: &'a World, camera: &'a Camera) -> Self {
        Self {
            world,
            camera,
            distances: &[],
            explored: None,
            marks: &[],
            cones: &[],
            shows_all_marks: false,
            is_faded: false,
            ghost: None,
            glyphs: GlyphSet::default(),
            depth: ColorDepth::default(),
            zoom: 0,
            cell_size: None,
            offset: DVec2::ZERO,
        }
    }

    /// Sets the distances of the rays that bound the visible floor. They must come from a picture
    /// by the same camera.
    #[must_use]
    pub fn seen(self, distances: &'a [f64]) -> Self {
        Self { distances, ..self }
    }

    /// Shows only the cells in `explored`. By default, the whole map is shown.
    #[must_use]
    pub fn explored(self, explored: &'a Explored) -> Self {
        Self { explored: Some(explored), ..self }
    }

    /// Sets the marks of other characters. A mark shows only where the floor is visible.
    #[must_use]
    pub fn marks(self, marks: &'a [MapMark]) -> Self {
        Self { marks, ..self }
    }

    /// Sets the floor that guards look at, which is tinted. A cone shows only if its guard is where the floor is
    /// visible.
    #[must_use]
    pub fn cones(self, cones: &'a [SightCone]) -> Self {
        Self { cones, ..self }
    }

    /// Shows marks wherever they are on the map.
    #[must_use]
    pub fn showing_all_marks(self) -> Self {
        Self { shows_all_marks: true, ..self }
    }

    /// Draws the map darker, apart from the marks, the exit and the floor that guards look at. The field of view is
    /// not tinted.
    #[must_use]
    pub fn faded(self, is_faded: bool) -> Self {
        Self { is_faded, ..self }
    }

    /// Sets the mark of a ghost. It shows wherever it is on the map.
    #[must_use]
    pub fn ghost(self, ghost: Option<MapMark>) -> Self {
        Self { ghost, ..self }
    }

    /// Sets the zoom. Each level roughly doubles or halves the map's size. At 0, the map has the size that fits. It
    /// is never made smaller than the size that shows all of it.
    #[must_use]
    pub fn zoom(self, levels: i32) -> Self {
        Self { zoom: levels, ..self }
    }

    /// Draws each cell of the map on this many columns and rows, whatever the zoom.
    #[must_use]
    pub fn cell_size(self, columns: u32, rows: u32) -> Self {
        Self { cell_size: Some([columns, rows]), ..self }
    }

    /// Moves the shown part by this many cells to the east and the south of the player, up to the edge of the map.
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
        let seen = (self.distances, self.explored);
        // The width of a pixel in cells of the map.
        let pixel = 1.0 / window.scale.x;
        let top_view = TopView::new(self.world, self.camera, seen, pixel).watched(self.cones);
        let picture = MapPicture { top_view, window };
        match self.glyphs {
            GlyphSet::Half | GlyphSet::Quadrant | GlyphSet::Sextant | GlyphSet::Octant => {
                self.draw_mosaics(&picture, area, canvas);
            }
            GlyphSet::Ascii | GlyphSet::Ramp => draw_characters(area, canvas, |x, y| {
                let point = self.shown(picture.point(x, y));
                let colors = [self.color(point), Rgb::BLACK];
                (point.look().character, colors.map(|color| color_at(self.depth, color)))
            }),
        }
        let ghost_pointers =
            if self.glyphs.has_blocks() { ['▹', '▿', '◃', '▵'] } else { ['g'; 4] };
        let mut draw = |mark: &MapMark, pointers: &[char], colors: [Color; 2]| {
            window.draw(canvas, area, mark, pointers, colors);
        };
        if let Some(ghost) = &self.ghost {
            // The ghost is hollow, or a letter, and pale, because it cannot see the player.
            draw(ghost, &ghost_pointers, self.colors([GHOST_TEXT, GHOST], [15, 6]));
        }
        let colors = self.colors([MARK_TEXT, MARK], [15, 9]);
        let is_shown =
            |mark: &MapMark| self.shows_all_marks || picture.top_view.is_visible(mark.position);
        for mark in self.marks.iter().filter(|mark| is_shown(mark)) {
            draw(mark, self.pointers(), colors);
        }
        let player = MapMark { position: self.camera.position(), heading: self.camera.heading };
        draw(&player, self.arrows(), self.colors([Rgb::BLACK, PLAYER], [0, 11]));
    }

    /// Draws an arrow for another player on the same `area`, wherever that player is on the map, on a `ground`.
    pub fn paint_arrow(&self, area: Rect, canvas: &mut impl Canvas, mark: &MapMark, ground: Rgb) {
        let area = area.intersection(canvas.bounds());
        if !area.is_empty() {
            let colors = [Rgb::BLACK, ground].map(|color| color_at(self.depth, color));
            self.window(area).draw(canvas, area, mark, self.arrows(), colors);
        }
    }

    /// Draws the mark of a guard on the same `area`, wherever the guard is on the map, in `color`.
    #[cfg(feature = "terminal")]
    pub(crate) fn paint_mark(
        &self,
        area: Rect,
        canvas: &mut impl Canvas,
        mark: &MapMark,
        color: Rgb,
    ) {
        let area = area.intersection(canvas.bounds());
        if !area.is_empty() {
            let colors = [Rgb::BLACK, color].map(|color| color_at(self.depth, color));
            self.window(area).draw(canvas, area, mark, self.pointers(), colors);
        }
    }

    /// Draws a part of a path on the same `area`, in `color`.
    #[cfg(feature = "terminal")]
    pub(crate) fn paint_dot(
        &self,
        area: Rect,
        canvas: &mut impl Canvas,
        position: DVec2,
        is_own: bool,
        color: Rgb,
    ) {
        let area = area.intersection(canvas.bounds());
        if area.is_empty() {
            return;
        }
        let dot = match (self.glyphs.has_blocks(), is_own) {
            (true, true) => '•',
            (true, false) => '·',
            (false, true) => '*',
            (false, false) => ':',
        };
        if let Some((x, y)) = self.window(area).cell(position) {
            let colors = [color, top_view::BASE].map(|color| color_at(self.depth, color));
            canvas.draw_character(area.x + x, area.y + y, dot, colors);
        }
    }

    /// Pointers to the east, south, west and north, for guards.
    fn pointers(&self) -> &'static [char] {
        if self.glyphs.has_blocks() { &['▸', '▾', '◂', '▴'] } else { &[')', 'u', '(', 'n'] }
    }

    /// Arrows to the east, south-east, south and so on.
    fn arrows(&self) -> &'static [char] {
        if self.glyphs.has_blocks() {
            &['→', '↘', '↓', '↙', '←', '↖', '↑', '↗']
        } else {
            &['>', '\\', 'v', '/', '<', '\\', '^', '/']
        }
    }

    /// The size of the part of `room` that the map fills. The rest would be blank.
    #[cfg(feature = "terminal")]
    pub(crate) fn size_within(&self, room: Size) -> Size {
        let pixels = pixels_within(room, self.glyphs);
        let needed = self.world.grid().extent() * self.scale(pixels);
        let needed = needed.ceil().min(pixels);
        let [columns, rows] = self.glyphs.pixels_per_cell().map(f64::from);
        Size::new((needed.x / columns).ceil() as u16, (needed.y / rows).ceil() as u16)
    }

    /// The number of the map's cells that an area of this size shows.
    #[cfg(feature = "terminal")]
    pub(crate) fn extent_within(&self, room: Size) -> DVec2 {
        let MapViewport { size, scale, .. } = self.window(Rect::from(room));
        size / scale
    }

    fn window(&self, area: Rect) -> MapViewport {
        let size = pixels_within(area.as_size(), self.glyphs);
        let center = self.camera.position() + self.offset;
        MapViewport::new(size, self.glyphs, self.world, center, self.scale(size))
    }

    /// The number of pixels per cell of the map in an area of this many pixels.
    fn scale(&self, pixels: DVec2) -> DVec2 {
        if let Some([columns, rows]) = self.cell_size {
            let [across, down] = self.glyphs.pixels_per_cell();
            return DVec2::new(f64::from(columns * across), f64::from(rows * down));
        }
        scale(self.world, pixels, self.glyphs, self.zoom)
    }

    fn draw_mosaics(&self, picture: &MapPicture, area: Rect, canvas: &mut impl Canvas) {
        let color = |point: MapPoint| match (self.depth, self.is_faded && !point.stays()) {
            (ColorDepth::Indexed16, false) => palette::of_256(point.look().index_of_16),
            (ColorDepth::Indexed16, true) => palette::of_256(point.look().faded_index_of_16()),
            _ => self.color(point),
        };
        if self.depth == ColorDepth::Mono {
            return self.draw_lit_mosaics(picture, area, canvas);
        }
        blocks::draw(area, canvas, self.glyphs, self.depth, |y| {
            let row = picture.row(y);
            move |x| color(self.shown(row.point(x)))
        });
    }

    /// Draws the map without colour. Things are letters.
    fn draw_lit_mosaics(&self, picture: &MapPicture, area: Rect, canvas: &mut impl Canvas) {
        let [columns, rows] = self.glyphs.pixels_per_cell();
        draw_characters(area, canvas, |column, row| {
            let dots = || {
                let places = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
                let places = places.map(|(x, y)| (columns * column + x, rows * row + y));
                places.map(|(x, y)| (self.shown(picture.point(x, y)), (x, y)))
            };
            let thing = dots().find(|(point, _)| point.is_thing());
            let lit = || blocks::lit(self.glyphs, dots().map(|(point, (x, y))| point.is_lit(x, y)));
            let character =
                thing.map_or_else(|| lit().character(), |(point, _)| point.look().character);
            (character, [Color::Reset; 2])
        });
    }

    /// `point` as the map shows it.
    fn shown(&self, point: MapPoint) -> MapPoint {
        if self.is_faded { point.out_of_view() } else { point }
    }

    fn color(&self, point: MapPoint) -> Rgb {
        if self.is_faded { point.faded_color() } else { point.color() }
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
}

/// A character on the map other than the player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapMark {
    /// The position, in cells.
    pub position: DVec2,
    /// The direction in which the character looks.
    pub heading: Heading,
}

/// The colour of a mark, which is darker than the arrow.
const MARK_TEXT: Rgb = Rgb::new(0xb8, 0xb0, 0xb0);
/// The background of a mark.
const MARK: Rgb = Rgb::new(0xc0, 0x30, 0x28);
/// The colour of a ghost, and its background.
const GHOST_TEXT: Rgb = Rgb::new(0xb8, 0xc0, 0xd0);
const GHOST: Rgb = Rgb::new(0x38, 0x58, 0x78);
/// The background of the arrow.
const PLAYER: Rgb = Rgb::new(0xff, 0xf0, 0x50);

/// The numbers of pixels per cell of the map, for the levels of the zoom. Below 1, a pixel shows several cells.
const SCALES: [f64; 10] = [0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0];

/// The part of the map that an area shows.
#[derive(Clone, Copy, Debug)]
struct MapViewport {
    /// The width and the height of the area in pixels.
    size: DVec2,
    /// The number of pixels per cell of the map.
    scale: DVec2,
    /// The position of the area's top left corner, in pixels from the map's top left corner.
    corner: DVec2,
    /// The numbers of the map's cells that a pixel shows from left to right and from top to bottom.
    cells_per_pixel: [u32; 2],
    pixels_per_cell: [u32; 2],
}

impl MapViewport {
    /// The whole map if it fits into `size` pixels, or else the part around `center`.
    fn new(size: DVec2, glyphs: GlyphSet, world: &World, center: DVec2, scale: DVec2) -> Self {
        let pixels_per_cell = glyphs.pixels_per_cell();
        let map = world.grid().extent();
        let spare = size - map * scale;
        let corner_along = |spare: f64, center: f64, size: f64| {
            if spare >= 0.0 {
                -(spare / 2.0).floor()
            } else {
                (center - size / 2.0).floor().clamp(0.0, (-spare).ceil())
            }
        };
        let center = center * scale;
        let corner = DVec2::new(
            corner_along(spare.x, center.x, size.x),
            corner_along(spare.y, center.y, size.y),
        );
        // Computed once, because rounding up is a function call on older processors.
        let cells_per_pixel = [scale.x, scale.y].map(|scale| (1.0 / scale).ceil() as u32);
        Self { size, scale, corner, cells_per_pixel, pixels_per_cell }
    }

    /// The distance of the centres of a column of pixels from the map's western edge.
    fn x_of(&self, column: u32) -> f64 {
        (f64::from(column) + 0.5 + self.corner.x) / self.scale.x
    }

    /// The distance of the centres of a row of pixels from the map's northern edge.
    fn y_of(&self, row: u32) -> f64 {
        (f64::from(row) + 0.5 + self.corner.y) / self.scale.y
    }

    /// Draws the pointer for a mark, which the first of `pointers` shows looking east.
    fn draw(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        mark: &MapMark,
        pointers: &[char],
        colors: [Color; 2],
    ) {
        let Some((x, y)) = self.cell(mark.position) else { return };
        let turns = mark.heading.degrees() / 360.0 * pointers.len() as f64;
        let pointer = pointers[turns.round() as usize % pointers.len()];
        canvas.draw_character(area.x + x, area.y + y, pointer, colors);
    }

    /// The cell of the area that shows `point`.
    fn cell(&self, point: DVec2) -> Option<(u16, u16)> {
        let pixel = (point * self.scale - self.corner).floor();
        let shows = pixel.cmpge(DVec2::ZERO).all() && pixel.cmplt(self.size).all();
        let [columns, rows] = self.pixels_per_cell;
        shows.then(|| ((pixel.x as u32 / columns) as u16, (pixel.y as u32 / rows) as u16))
    }
}

fn pixels_within(cells: Size, glyphs: GlyphSet) -> DVec2 {
    let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
    DVec2::new(f64::from(cells.width) * columns, f64::from(cells.height) * rows)
}

/// The number of pixels per cell of the map: the largest whole number with which the whole map fits into `pixels`,
/// but at least one, enlarged or reduced by `zoom` levels. The map is not reduced further than necessary to fit.
fn scale(world: &World, pixels: DVec2, glyphs: GlyphSet, zoom: i32) -> DVec2 {
    // A cell is about twice as high as wide.
    let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
    let smallest = DVec2::new(2.0 * columns / rows, 1.0);
    let exact = (pixels / (world.grid().extent() * smallest)).min_element();
    let fit = exact.floor().max(1.0);
    smallest
        * match zoom {
            0 => fit,
            1.. => {
                let larger = SCALES.iter().filter(|&&scale| scale > fit);
                larger.take(zoom.unsigned_abs() as usize).last().copied().unwrap_or(fit)
            }
            _ => {
                let is_needed = |scale: f64| exact < 1.0 && 2.0 * scale > exact;
                let smaller = SCALES.iter().rev().filter(|&&scale| scale < fit && is_needed(scale));
                smaller.take(zoom.unsigned_abs() as usize).last().copied().unwrap_or(fit)
            }
        }
}

/// The pixels of a map and the part of it that is shown. A row of pixels finds its row of tiles and things once, not
/// for each pixel.
struct MapPicture<'a> {
    top_view: TopView<'a>,
    window: MapViewport,
}

impl<'a> MapPicture<'a> {
    /// The pixels in row `y`.
    fn row(&self, y: u32) -> PixelRow<'_, 'a> {
        let y = self.window.y_of(y);
        PixelRow { picture: self, y, middle: self.top_view.row(y) }
    }

    /// The map point at a pixel.
    fn point(&self, x: u32, y: u32) -> MapPoint {
        self.row(y).point(x)
    }
}

/// A row of pixels of a map.
struct PixelRow<'p, 'a> {
    picture: &'p MapPicture<'a>,
    /// The position of the middle of the pixels.
    y: f64,
    /// The points in the middle of the pixels.
    middle: MapRow<'p>,
}

impl PixelRow<'_, '_> {
    /// The map point at a pixel. If a pixel covers several cells, it is the most important one.
    #[inline]
    fn point(&self, x: u32) -> MapPoint {
        let window = &self.picture.window;
        let x = window.x_of(x);
        match window.cells_per_pixel {
            [1, 1] => self.middle.point(x),
            cells => self.most_important(x, cells),
        }
    }

    /// The most important point of the pixel at `x`, which covers this number of cells.
    #[inline(never)]
    fn most_important(&self, x: f64, [columns, rows]: [u32; 2]) -> MapPoint {
        let top_view = &self.picture.top_view;
        // The pixel covers this number of cells in each direction; each is sampled at its middle.
        let along = |middle: f64, count: u32| {
            let first = middle - f64::from(count - 1) / 2.0;
            (0..count).map(move |index| first + f64::from(index))
        };
        let points = along(self.y, rows).flat_map(|y| {
            let row = top_view.row(y);
            along(x, columns).map(move |x| row.point(x))
        });
        points.max_by_key(|point| point.look().importance).unwrap_or(MapPoint::Void)
    }
}
