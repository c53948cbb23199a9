//! The part of the map that shows in an area, and how large.

use glam::DVec2;
use ratatui::layout::{Rect, Size};

use crate::tui::GlyphMode;
use crate::world::World;

/// How many pixels a cell of the map gets, from level to level of the zoom; below 1, pixels show several cells.
const SCALES: [f64; 10] = [0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0];

/// The part of the map that shows in an area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Pixels of the area from left to right and from top to bottom.
    size: DVec2,
    /// Pixels for a cell of the map.
    scale: DVec2,
    /// Where the area's top left corner is, in pixels from the map's.
    corner: DVec2,
    pixels_per_cell: u32,
}

impl Window {
    /// All of the map where it fits, or as much as does around `center`, by so many levels larger or smaller.
    pub(super) fn new(
        area: Rect,
        glyphs: GlyphMode,
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
        Self { size, scale, corner, pixels_per_cell }
    }

    /// How many cells of the map a pixel is wide.
    pub(super) fn pixel(&self) -> f64 {
        1.0 / self.scale.x
    }

    /// How many cells of the map a pixel shows, from left to right and from top to bottom.
    pub(super) fn cells_per_pixel(&self) -> [u32; 2] {
        [self.scale.x, self.scale.y].map(|scale| (1.0 / scale).ceil() as u32)
    }

    /// The point of the map that the centre of a pixel shows.
    pub(super) fn point(&self, x: u32, y: u32) -> DVec2 {
        (DVec2::new(f64::from(x), f64::from(y)) + 0.5 + self.corner) / self.scale
    }

    /// The cell of the area that shows `point`.
    pub(super) fn cell(&self, point: DVec2) -> Option<(u16, u16)> {
        let pixel = (point * self.scale - self.corner).floor();
        let shows = pixel.cmpge(DVec2::ZERO).all() && pixel.cmplt(self.size).all();
        shows.then(|| (pixel.x as u16, (pixel.y as u32 / self.pixels_per_cell) as u16))
    }

    /// How many cells of the map show from left to right and from top to bottom.
    #[cfg(feature = "terminal")]
    pub(super) fn extent(&self) -> DVec2 {
        self.size / self.scale
    }
}

/// How many cells of `room` show something of the map; the rest would be blank.
#[cfg(feature = "terminal")]
pub(super) fn size_within(room: Size, glyphs: GlyphMode, world: &World, zoom: i32) -> Size {
    let pixels = pixels_within(room, glyphs);
    let needed = map_size(world) * scale(world, pixels, glyphs, zoom);
    let needed = needed.ceil().min(pixels);
    let rows = needed.y / f64::from(glyphs.pixels_per_cell());
    Size::new(needed.x as u16, rows.ceil() as u16)
}

/// Cells of the map from left to right and from top to bottom.
pub(super) fn map_size(world: &World) -> DVec2 {
    DVec2::new(f64::from(world.grid().width()), f64::from(world.grid().height()))
}

fn pixels_within(cells: Size, glyphs: GlyphMode) -> DVec2 {
    let height = u32::from(cells.height) * glyphs.pixels_per_cell();
    DVec2::new(f64::from(cells.width), f64::from(height))
}

/// How many of `pixels` a cell of the map gets: as many whole ones as let all of the map be seen, at least one,
/// and so many levels of the zoom more or less. It is not zoomed out further than to see all of the map.
fn scale(world: &World, pixels: DVec2, glyphs: GlyphMode, zoom: i32) -> DVec2 {
    // A pixel of half blocks is about square; a whole cell is about twice as high as wide.
    let smallest = match glyphs {
        GlyphMode::Half => DVec2::new(1.0, 1.0),
        GlyphMode::Ascii | GlyphMode::Ramp => DVec2::new(2.0, 1.0),
    };
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
