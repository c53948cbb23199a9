//! The formats of a snapshot: text, ANSI, JSON and PNG. Each receives the cells row by row.

use std::io::{self, BufWriter, Write};

use clap::ValueEnum;
use font8x8::{BASIC_FONTS, BLOCK_FONTS, UnicodeFonts};
use png::{BitDepth, ColorType, Encoder, EncodingError, StreamWriter};
use ratatui::buffer::Cell;
use ratatui::layout::Size;
use serde::Serialize;

use crate::color::Rgb;
use crate::terminal::{Bytes, Style};
use crate::tui::canvas::Mosaic;
use crate::tui::{CellAspect, rgb_of};

/// The format of a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    Ansi,
    Json,
    Png,
}

/// Writes cells row by row, from the top.
pub(crate) trait Writer {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()>;

    /// Writes the end of the output, after the last row.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

impl Format {
    /// A writer for a picture of `size` whose cells have this shape.
    pub(crate) fn writer(
        self,
        size: Size,
        aspect: CellAspect,
        output: impl Write + 'static,
    ) -> io::Result<Box<dyn Writer>> {
        Ok(match self {
            Self::Text => Box::new(Text { output: BufWriter::new(output) }),
            Self::Ansi => Box::new(Ansi { output: BufWriter::new(output), line: Bytes::default() }),
            Self::Json => Box::new(Json::new(BufWriter::new(output), size)?),
            // PNG has its own buffer, and would not report an error from a second buffer behind it.
            Self::Png => Box::new(Png::new(output, size, aspect)?),
        })
    }
}

/// The side of a glyph in pixels, before the glyph is scaled to the cell.
const GLYPH_SIDE: u32 = 8;
/// The maximum number of pixels. Cells become smaller in a larger picture.
const MOST_PIXELS: u64 = 1 << 26;
/// The terminal's default colours, for cells that have none.
const FOREGROUND: Rgb = Rgb::WHITE;
const BACKGROUND: Rgb = Rgb::BLACK;

/// Writes the characters of cells, without colours.
struct Text<W> {
    output: W,
}

impl<W: Write> Writer for Text<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        for cell in cells {
            self.output.write_all(cell.symbol().as_bytes())?;
        }
        self.output.write_all(b"\n")
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.output.flush()
    }
}

/// Writes cells as text with escape sequences for their colours. Every line ends in the terminal's
/// default colours, so pagers and scrolling can cut between lines.
struct Ansi<W> {
    output: W,
    line: Bytes,
}

impl<W: Write> Writer for Ansi<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.line.clear();
        let mut style = Style::RESET;
        for cell in cells {
            let next = Style::of(cell);
            if next != style {
                next.write_from(Some(style), &mut self.line);
                style = next;
            }
            self.line.push_text(cell.symbol().as_bytes());
        }
        if style != Style::RESET {
            Style::RESET.write_from(Some(style), &mut self.line);
        }
        self.line.push_text(b"\n");
        self.output.write_all(self.line.as_slice())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.output.flush()
    }
}

/// Writes cells as one JSON object:
/// `{"cols": 80, "rows": 24, "cells": [[{"ch": "▀", "fg": "#rrggbb", "bg": "#rrggbb"}, …], …]}`.
struct Json<W> {
    output: W,
    is_first: bool,
}

#[derive(Serialize)]
struct JsonCell<'a> {
    ch: &'a str,
    fg: Option<String>,
    bg: Option<String>,
}

impl<W: Write> Json<W> {
    fn new(mut output: W, size: Size) -> io::Result<Self> {
        write!(output, "{{\"cols\":{},\"rows\":{},\"cells\":[", size.width, size.height)?;
        Ok(Self { output, is_first: true })
    }
}

impl<W: Write> Writer for Json<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.output.write_all(if self.is_first { b"\n" } else { b",\n" })?;
        self.is_first = false;
        let cells: Vec<JsonCell> = cells
            .iter()
            .map(|cell| JsonCell {
                ch: cell.symbol(),
                fg: rgb_of(cell.fg).map(|color| color.to_string()),
                bg: rgb_of(cell.bg).map(|color| color.to_string()),
            })
            .collect();
        Ok(serde_json::to_writer(&mut self.output, &cells)?)
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.output.write_all(b"\n]}\n")?;
        self.output.flush()
    }
}

/// Writes cells as pixels with their glyphs, as a terminal shows them.
struct Png<W: Write + 'static> {
    stream: StreamWriter<'static, W>,
    cell_width: u32,
    cell_height: u32,
    line: Vec<u8>,
}

impl<W: Write + 'static> Png<W> {
    fn new(output: W, size: Size, aspect: CellAspect) -> io::Result<Self> {
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

impl<W: Write + 'static> Writer for Png<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        for y in 0..self.cell_height {
            self.line.clear();
            for cell in cells {
                let glyph = Glyph::of(cell.symbol());
                let foreground = rgb_of(cell.fg).unwrap_or(FOREGROUND).channels();
                let background = rgb_of(cell.bg).unwrap_or(BACKGROUND).channels();
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
    /// Dots that fill a cell of any size, as terminals draw them.
    Mosaic(Mosaic),
    /// Rows from the top. The lowest bit of a row is the leftmost dot.
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

    /// Returns true if this pixel of a cell of this size has the text colour.
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
