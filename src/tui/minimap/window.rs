//! The part of the map that an area shows, and its scale.

use glam::DVec2;
use ratatui::layout::{Rect, Size};

use crate::tui::GlyphSet;
use crate::world::World;

/// The numbers of pixels per cell of the map, for the levels of the zoom; below 1, a pixel shows
/// several cells.
const SCALES: [f64; 10] = [0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0];

/// The part of the map that an area shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
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

impl Window {
    /// The whole map if it fits, or the part around `center`, enlarged or reduced by `zoom` levels.
    pub(crate) fn new(
        area: Rect,
        glyphs: GlyphSet,
        world: &World,
        center: DVec2,
        zoom: i32,
    ) -> Self {
        let pixels_per_cell = glyphs.pixels_per_cell();
        let size = pixels_within(area.as_size(), glyphs);
        let map = map_size(world);
        let scale = scale(world, size, glyphs, zoom);
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
        // Rounding up is a function call on older processors.
        let cells_per_pixel = [scale.x, scale.y].map(|scale| (1.0 / scale).ceil() as u32);
        Self { size, scale, corner, cells_per_pixel, pixels_per_cell }
    }

    /// The width of a pixel in cells of the map.
    pub(crate) fn pixel(&self) -> f64 {
        1.0 / self.scale.x
    }

    /// The numbers of the map's cells that a pixel shows from left to right and from top to bottom.
    pub(crate) fn cells_per_pixel(&self) -> [u32; 2] {
        self.cells_per_pixel
    }

    /// The distance of the centres of a column of pixels from the map's western edge.
    pub(crate) fn x_of(&self, column: u32) -> f64 {
        (f64::from(column) + 0.5 + self.corner.x) / self.scale.x
    }

    /// The distance of the centres of a row of pixels from the map's northern edge.
    pub(crate) fn y_of(&self, row: u32) -> f64 {
        (f64::from(row) + 0.5 + self.corner.y) / self.scale.y
    }

    /// The cell of the area that shows `point`.
    pub(crate) fn cell(&self, point: DVec2) -> Option<(u16, u16)> {
        let pixel = (point * self.scale - self.corner).floor();
        let shows = pixel.cmpge(DVec2::ZERO).all() && pixel.cmplt(self.size).all();
        let [columns, rows] = self.pixels_per_cell;
        shows.then(|| ((pixel.x as u32 / columns) as u16, (pixel.y as u32 / rows) as u16))
    }

    /// The numbers of the map's cells that are shown from left to right and from top to bottom.
    #[cfg(feature = "terminal")]
    pub(crate) fn extent(&self) -> DVec2 {
        self.size / self.scale
    }
}

/// The part of `room` that the map fills; the rest would be blank.
#[cfg(feature = "terminal")]
pub(crate) fn size_within(room: Size, glyphs: GlyphSet, world: &World, zoom: i32) -> Size {
    let pixels = pixels_within(room, glyphs);
    let needed = map_size(world) * scale(world, pixels, glyphs, zoom);
    let needed = needed.ceil().min(pixels);
    let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
    Size::new((needed.x / columns).ceil() as u16, (needed.y / rows).ceil() as u16)
}

/// The width and the height of the map in cells.
pub(crate) fn map_size(world: &World) -> DVec2 {
    DVec2::new(f64::from(world.grid().width()), f64::from(world.grid().height()))
}

fn pixels_within(cells: Size, glyphs: GlyphSet) -> DVec2 {
    let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
    DVec2::new(f64::from(cells.width) * columns, f64::from(cells.height) * rows)
}

/// The number of pixels per cell of the map: the largest whole number with which the whole map fits
/// into `pixels`, but at least one, enlarged or reduced by `zoom` levels. The map is not reduced
/// further than to fit.
fn scale(world: &World, pixels: DVec2, glyphs: GlyphSet, zoom: i32) -> DVec2 {
    // A cell is about twice as high as wide.
    let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
    let smallest = DVec2::new(2.0 * columns / rows, 1.0);
    let exact = (pixels / (map_size(world) * smallest)).min_element();
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
