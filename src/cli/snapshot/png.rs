//! A PNG of the cells with their glyphs, as in a terminal.

use std::io::{self, Write};

use font8x8::{BASIC_FONTS, BLOCK_FONTS, UnicodeFonts};
use png::{BitDepth, ColorType, Encoder, EncodingError, StreamWriter};
use ratatui::buffer::Cell;
use ratatui::layout::Size;

use super::rgb;
use crate::color::Rgb;
use crate::tui::CellAspect;
use crate::tui::canvas::Mosaic;

/// The width and height of a glyph in pixels, before it is scaled to the cell.
const GLYPH_SIDE: u32 = 8;
/// The largest number of pixels. For a larger picture, cells become smaller.
const MOST_PIXELS: u64 = 1 << 26;
/// The terminal's default colours, for cells without a colour.
const FOREGROUND: Rgb = Rgb::WHITE;
const BACKGROUND: Rgb = Rgb::BLACK;

/// Writes cells as pixels.
pub(crate) struct Png<W: Write + 'static> {
    stream: StreamWriter<'static, W>,
    cell_width: u32,
    cell_height: u32,
    line: Vec<u8>,
}

impl<W: Write + 'static> Png<W> {
    pub(crate) fn new(output: W, size: Size, aspect: CellAspect) -> io::Result<Self> {
        let (cell_width, cell_height) = cell_size(size, aspect);
        let width = u32::from(size.width) * cell_width;
        let height = u32::from(size.height) * cell_height;
        let mut encoder = Encoder::new(output, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        let writer = encoder.write_header().map_err(into_io)?;
        let stream = writer.into_stream_writer().map_err(into_io)?;
        Ok(Self { stream, cell_width, cell_height, line: Vec::new() })
    }
}

/// The width and height of a cell, in pixels.
fn cell_size(size: Size, aspect: CellAspect) -> (u32, u32) {
    let cells = u64::from(size.width) * u64::from(size.height);
    let sizes = [GLYPH_SIDE, 4, 2].map(|width| {
        (width, (f64::from(width) * aspect.height_over_width()).round().max(1.0) as u32)
    });
    let fits =
        |&(width, height): &(u32, u32)| cells * u64::from(width) * u64::from(height) <= MOST_PIXELS;
    sizes.into_iter().find(fits).unwrap_or((1, aspect.height_over_width().round().max(1.0) as u32))
}

impl<W: Write + 'static> super::Writer for Png<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        for y in 0..self.cell_height {
            self.line.clear();
            for cell in cells {
                let glyph = Glyph::of(cell.symbol());
                let foreground = rgb(cell.fg).unwrap_or(FOREGROUND).channels();
                let background = rgb(cell.bg).unwrap_or(BACKGROUND).channels();
                for x in 0..self.cell_width {
                    let is_set = glyph.covers([x, y], [self.cell_width, self.cell_height]);
                    self.line.extend(if is_set { foreground } else { background });
                }
            }
            self.stream.write_all(&self.line)?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.stream.finish().map_err(into_io)
    }
}

/// The picture of a character.
enum Glyph {
    /// Dots that fill the cell whatever its size, as terminals draw them.
    Mosaic(Mosaic),
    /// Rows from the top. The lowest bit of each is the leftmost dot.
    Bitmap([u8; GLYPH_SIDE as usize]),
}

impl Glyph {
    fn of(symbol: &str) -> Self {
        let character = symbol.chars().next().unwrap_or(' ');
        if let Some(mosaic) = Mosaic::of_character(character) {
            return Self::Mosaic(mosaic);
        }
        let bitmap = BLOCK_FONTS.get(character).or_else(|| BASIC_FONTS.get(character));
        Self::Bitmap(bitmap.unwrap_or_default())
    }

    /// Whether a pixel of a cell of this size has the text colour.
    fn covers(&self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> bool {
        match self {
            Self::Mosaic(mosaic) => mosaic.has(x * 2 / width, y * 12 / height),
            Self::Bitmap(rows) => {
                let row = rows[(y * GLYPH_SIDE / height) as usize];
                row >> (x * GLYPH_SIDE / width) & 1 == 1
            }
        }
    }
}

fn into_io(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
