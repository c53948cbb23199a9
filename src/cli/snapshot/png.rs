//! A picture of the cells, glyphs and all, as a terminal shows them.

use std::io::{self, Write};

use font8x8::{BASIC_FONTS, BLOCK_FONTS, UnicodeFonts};
use png::{BitDepth, ColorType, Encoder, EncodingError, StreamWriter};
use ratatui::buffer::Cell;
use ratatui::layout::Size;

use super::rgb;
use crate::color::Rgb;
use crate::tui::CellAspect;

/// Pixels of a glyph in either direction, before it is stretched to the cell.
const GLYPH_SIDE: u32 = 8;
/// The most pixels of a picture: cells of one that would be larger become smaller.
const MOST_PIXELS: u64 = 1 << 26;
/// What a terminal writes with, and on, where a cell names no colour.
const INK: Rgb = Rgb::WHITE;
const PAPER: Rgb = Rgb::BLACK;

/// Writes cells as pixels.
pub(super) struct Png<W: Write + 'static> {
    stream: StreamWriter<'static, W>,
    cell_width: u32,
    cell_height: u32,
    line: Vec<u8>,
}

impl<W: Write + 'static> Png<W> {
    pub(super) fn new(output: W, size: Size, aspect: CellAspect) -> io::Result<Self> {
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

/// Pixels of a cell from left to right and from top to bottom.
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
            let glyph_row = (y * GLYPH_SIDE / self.cell_height) as usize;
            self.line.clear();
            for cell in cells {
                let dots = glyph(cell.symbol())[glyph_row];
                let ink = rgb(cell.fg).unwrap_or(INK).channels();
                let paper = rgb(cell.bg).unwrap_or(PAPER).channels();
                for x in 0..self.cell_width {
                    let is_ink = dots >> (x * GLYPH_SIDE / self.cell_width) & 1 == 1;
                    self.line.extend(if is_ink { ink } else { paper });
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

/// The rows of a glyph from the top, each with its leftmost dot in the lowest bit.
fn glyph(symbol: &str) -> [u8; GLYPH_SIDE as usize] {
    let character = symbol.chars().next().unwrap_or(' ');
    BLOCK_FONTS.get(character).or_else(|| BASIC_FONTS.get(character)).unwrap_or_default()
}

fn into_io(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
