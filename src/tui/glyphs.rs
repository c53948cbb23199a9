//! Glyph sets and the shape of cells, which determine how pixels become characters.

use ratatui::style::Color;
use serde::{Deserialize, Serialize};

use crate::color::Rgb;
use crate::color::palette::{self, ColorDepth};
use crate::render::PixelAspect;
use crate::tui::canvas::true_color;

/// A set of characters with which pixels are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum GlyphSet {
    /// Two pixels per cell, one above the other: `▀`, `▄`, `█` and space.
    #[default]
    Half,
    /// Two by two pixels per cell: also `▘`, `▚`, `▙` and the like. In this set and the finer sets, each cell
    /// shows the two colours and the dots with the least error.
    Quadrant,
    /// Two by three pixels per cell: the sextants of Unicode 13.
    Sextant,
    /// Two by four pixels per cell: the octants of Unicode 16, which few fonts and terminals support.
    Octant,
    /// One pixel per cell. The shape of the character shows the surface. This set is for terminals and fonts
    /// without block characters, and for use without colour.
    Ascii,
    /// One pixel per cell, as one of sixteen characters for its brightness.
    Ramp,
}

impl GlyphSet {
    /// The numbers of columns and rows of pixels in a cell.
    pub const fn pixels_per_cell(self) -> [u32; 2] {
        match self {
            Self::Half => [1, 2],
            Self::Quadrant => [2, 2],
            Self::Sextant => [2, 3],
            Self::Octant => [2, 4],
            Self::Ascii | Self::Ramp => [1, 1],
        }
    }

    /// A wedge that falls from left to right, eight cells long. It looks broken in a terminal without the
    /// glyphs of this set, which no query of a terminal can detect.
    #[cfg(feature = "terminal")]
    pub(crate) fn wedge(self) -> String {
        const CELLS: u32 = 8;
        let [columns, rows] = self.pixels_per_cell();
        let cell = |cell: u32| {
            let dots = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
            // True if the middle of a dot is below the line.
            let dots = dots.map(|(column, row)| {
                let across = cell * columns + column;
                (2 * across + 1) * rows < (2 * row + 1) * CELLS * columns
            });
            super::blocks::lit(self, dots).character()
        };
        (0..CELLS).map(cell).collect()
    }

    /// Returns true if pixels are parts of a cell and not characters.
    pub const fn has_blocks(self) -> bool {
        !matches!(self, Self::Ascii | Self::Ramp)
    }
}

/// The ratio of a cell's height to its width, from 0.1 to 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellAspect(f64);

impl CellAspect {
    /// A ratio from 0.1 to 10, or `None` for any other number.
    pub fn new(height_over_width: f64) -> Option<Self> {
        (0.1..=10.0).contains(&height_over_width).then_some(Self(height_over_width))
    }

    /// The height of a cell divided by its width.
    pub fn height_over_width(self) -> f64 {
        self.0
    }

    /// The shape of the pixels into which `glyphs` divides a cell of this shape.
    pub fn of_pixels(self, glyphs: GlyphSet) -> PixelAspect {
        let [columns, rows] = glyphs.pixels_per_cell().map(f64::from);
        PixelAspect::new(self.0 * columns / rows).unwrap_or(PixelAspect::SQUARE)
    }
}

impl Default for CellAspect {
    /// Twice as high as wide, as in most fonts.
    fn default() -> Self {
        Self(2.0)
    }
}

/// The colour that represents `color` outside a terminal. `None` for the terminal's own colours.
pub fn rgb_of(color: Color) -> Option<Rgb> {
    match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        Color::Indexed(index) => Some(palette::of_256(index)),
        _ => None,
    }
}

/// `color` in the form in which a terminal of this depth shows it best.
#[inline]
pub fn color_at(depth: ColorDepth, color: Rgb) -> Color {
    match depth {
        ColorDepth::True => true_color(color),
        ColorDepth::Indexed256 => Color::Indexed(palette::nearest_of_256(color)),
        ColorDepth::Indexed16 => Color::Indexed(palette::nearest_of_16(color)),
        ColorDepth::Mono => Color::Reset,
    }
}
