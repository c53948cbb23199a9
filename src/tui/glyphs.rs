//! How pixels become the characters of cells.

use ratatui::style::Color;

use crate::canvas::true_color;
use crate::color::Rgb;
use crate::color::palette::{self, ColorDepth};
use crate::render::PixelAspect;

/// Which characters stand for pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum GlyphMode {
    /// Two pixels a cell, one above the other: `▀`, `▄`, `█` and space.
    #[default]
    Half,
    /// One pixel a cell, as a character that tells by its shape what it shows, for terminals and
    /// fonts without block characters and for readers without colour.
    Ascii,
    /// One pixel a cell, as one of sixteen characters that tell how bright it is and no more.
    Ramp,
}

impl GlyphMode {
    /// How many pixels a cell holds, one above the other.
    pub const fn pixels_per_cell(self) -> u32 {
        match self {
            Self::Half => 2,
            Self::Ascii | Self::Ramp => 1,
        }
    }
}

/// The height of a terminal's cell over its width, from 0.1 to 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellAspect(f64);

impl CellAspect {
    /// A ratio from 0.1 to 10. `None` for anything else.
    pub fn new(height_over_width: f64) -> Option<Self> {
        (0.1..=10.0).contains(&height_over_width).then_some(Self(height_over_width))
    }

    /// The height of a cell over its width.
    pub fn height_over_width(self) -> f64 {
        self.0
    }

    /// The shape of the pixels that `glyphs` divide such a cell into.
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

/// `color`, as nearly as a terminal of that depth can show it.
#[inline]
pub(super) fn color_at(depth: ColorDepth, color: Rgb) -> Color {
    match depth {
        ColorDepth::True => true_color(color),
        ColorDepth::Indexed256 => Color::Indexed(palette::nearest_of_256(color)),
        ColorDepth::Indexed16 => Color::Indexed(palette::nearest_of_16(color)),
        ColorDepth::Mono => Color::Reset,
    }
}
