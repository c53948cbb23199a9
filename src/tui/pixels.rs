//! Cells as pixels with their glyphs, as a terminal shows them, and PNGs of them.

use std::io::{self, Write};

use font8x8::{BASIC_FONTS, BLOCK_FONTS, BOX_FONTS, LATIN_FONTS, UnicodeFonts};
use png::{BitDepth, ColorType, Encoder, EncodingError};
use ratatui::buffer::Cell;
use ratatui::layout::Size;
use ratatui::style::{Color, Modifier};

use super::canvas::Mosaic;
use super::{CellAspect, rgb_of};
use crate::color::{Rgb, palette};

/// The side of a glyph in pixels, before the glyph is scaled to the cell.
const GLYPH_SIDE: u32 = 8;
/// The maximum number of pixels. Cells become smaller in a larger picture.
const MAX_PIXELS: u64 = 1 << 26;
/// The terminal's default colours, for cells that have none.
const FOREGROUND: Rgb = Rgb::WHITE;
const BACKGROUND: Rgb = Rgb::BLACK;

/// The width and height of a cell, in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellSize {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl CellSize {
    /// The size of the cells in a picture of `size` cells whose cells have this shape.
    pub(crate) fn of(size: Size, aspect: CellAspect) -> Self {
        let cells = u64::from(size.width) * u64::from(size.height);
        let scaled = |width: u32| {
            let height = f64::from(width) * aspect.height_over_width();
            Self { width, height: height.round().max(1.0) as u32 }
        };
        let sizes = [GLYPH_SIDE, 4, 2].map(scaled).into_iter();
        let fits = |it: &Self| cells * u64::from(it.width) * u64::from(it.height) <= MAX_PIXELS;
        { sizes }.find(fits).unwrap_or_else(|| scaled(1))
    }

    /// Appends the pixels of a row of cells to `pixels`, line by line. `bytes` returns the bytes of a pixel.
    pub(crate) fn draw_row<const BYTES: usize>(
        self,
        cells: &[Cell],
        bytes: impl Fn(Rgb) -> [u8; BYTES],
        pixels: &mut Vec<u8>,
    ) {
        for y in 0..self.height {
            for cell in cells {
                let glyph = GlyphPicture::of(cell.symbol());
                let colors = colors(cell).map(&bytes);
                for x in 0..self.width {
                    pixels.extend(colors[usize::from(glyph.covers([x, y], self))]);
                }
            }
        }
    }
}

/// The colours of a cell: of its background, and of its glyph.
pub(crate) fn colors(cell: &Cell) -> [Rgb; 2] {
    let mut colors = [shown(cell.bg).unwrap_or(BACKGROUND), shown(cell.fg).unwrap_or(FOREGROUND)];
    if cell.modifier.contains(Modifier::REVERSED) {
        colors.reverse();
    }
    colors
}

/// The colour that most terminals show. `None` for the terminal's default colours.
pub(crate) fn shown(color: Color) -> Option<Rgb> {
    const NAMED: [Color; 16] = [
        Color::Black,
        Color::Red,
        Color::Green,
        Color::Yellow,
        Color::Blue,
        Color::Magenta,
        Color::Cyan,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightGreen,
        Color::LightYellow,
        Color::LightBlue,
        Color::LightMagenta,
        Color::LightCyan,
        Color::White,
    ];
    let named = || NAMED.iter().position(|&named| named == color);
    rgb_of(color).or_else(|| Some(palette::of_256(named()? as u8)))
}

/// An encoder of a PNG of `size` cells.
pub(crate) fn png_encoder<'a, W: Write>(output: W, size: Size, cell: CellSize) -> Encoder<'a, W> {
    let width = u32::from(size.width) * cell.width;
    let height = u32::from(size.height) * cell.height;
    let mut encoder = Encoder::new(output, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder
}

/// The error of the output behind `error`, if there is one.
pub(crate) fn into_io(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// The picture of a character.
enum GlyphPicture {
    /// Dots that fill a cell of any size, as terminals draw them.
    Mosaic(Mosaic),
    /// Rows from the top. The lowest bit of a row is the leftmost dot.
    Bitmap([u8; GLYPH_SIDE as usize]),
}

impl GlyphPicture {
    fn of(symbol: &str) -> Self {
        let character = symbol.chars().next().unwrap_or(' ');
        if let Some(mosaic) = Mosaic::of_character(character) {
            return Self::Mosaic(mosaic);
        }
        let fonts: [&dyn UnicodeFonts; 4] = [&BLOCK_FONTS, &BASIC_FONTS, &LATIN_FONTS, &BOX_FONTS];
        Self::Bitmap(fonts.iter().find_map(|font| font.get(character)).unwrap_or_default())
    }

    /// Returns true if this pixel of a cell of this size has the text colour.
    fn covers(&self, [x, y]: [u32; 2], CellSize { width, height }: CellSize) -> bool {
        match self {
            Self::Mosaic(mosaic) => mosaic.has(x * 2 / width, y * 12 / height),
            Self::Bitmap(rows) => {
                let row = rows[(y * GLYPH_SIDE / height) as usize];
                row >> (x * GLYPH_SIDE / width) & 1 == 1
            }
        }
    }
}
