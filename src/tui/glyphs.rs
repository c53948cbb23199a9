//! Glyph modes and the shape of cells: how pixels become characters.

use ratatui::style::Color;

use crate::canvas::true_color;
use crate::color::Rgb;
use crate::color::palette::{self, ColorDepth};
use crate::render::PixelAspect;

/// The characters that pixels are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum GlyphMode {
    /// Two pixels per cell, one above the other: `▀`, `▄`, `█` and space.
    #[default]
    Half,
    /// One pixel per cell. The shape of the character shows which surface it is: for terminals and
    /// fonts without block characters, and for readers without colour.
    Ascii,
    /// One pixel per cell, as one of sixteen characters for its brightness.
    Ramp,
}

impl GlyphMode {
    /// The number of pixels in a cell, one above the other.
    pub const fn pixels_per_cell(self) -> u32 {
        match self {
            Self::Half => 2,
            Self::Ascii | Self::Ramp => 1,
        }
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

    /// The shape of the pixels into which `glyphs` divides such a cell.
    pub fn of_pixels(self, glyphs: GlyphMode) -> PixelAspect {
        PixelAspect::new(self.0 / f64::from(glyphs.pixels_per_cell()))
            .unwrap_or(PixelAspect::SQUARE)
    }
}

impl Default for CellAspect {
    /// Twice as high as wide, as in most fonts.
    fn default() -> Self {
        Self(2.0)
    }
}

/// `color` as a terminal of that depth shows it best.
#[inline]
pub(crate) fn color_at(depth: ColorDepth, color: Rgb) -> Color {
    match depth {
        ColorDepth::True => true_color(color),
        ColorDepth::Indexed256 => Color::Indexed(palette::nearest_of_256(color)),
        ColorDepth::Indexed16 => Color::Indexed(palette::nearest_of_16(color)),
        ColorDepth::Mono => Color::Reset,
    }
}
