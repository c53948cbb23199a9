//! The formats of a snapshot: text, ANSI, JSON, a grid and PNG. Each receives the cells row by row.

use std::io::{self, BufWriter, Write};

use clap::ValueEnum;
use png::StreamWriter;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use serde::Serialize;

use crate::color::Rgb;
use crate::terminal::{Bytes, Style};
use crate::testing::CellGrid;
use crate::tui::pixels::{CellSize, into_io, png_encoder};
use crate::tui::{CellAspect, rgb_of};

/// The format of a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SnapshotFormat {
    #[default]
    Text,
    Ansi,
    Json,
    Grid,
    Png,
}

/// Writes cells row by row, from the top.
pub(crate) trait Writer {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()>;

    /// Writes the end of the output, after the last row.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

impl SnapshotFormat {
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
            Self::Grid => {
                let area = Rect::new(0, 0, size.width, size.height);
                let cells = Buffer { area, content: Vec::new() };
                Box::new(TextGrid { output: BufWriter::new(output), cells })
            }
            // PNG has its own buffer, and would not report an error from a second buffer behind it.
            Self::Png => Box::new(Png::new(output, size, aspect)?),
        })
    }
}

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
    cell: CellSize,
    pixels: Vec<u8>,
}

impl<W: Write + 'static> Png<W> {
    fn new(output: W, size: Size, aspect: CellAspect) -> io::Result<Self> {
        let cell = CellSize::of(size, aspect);
        let writer = png_encoder(output, size, cell).write_header().map_err(into_io)?;
        let stream = writer.into_stream_writer().map_err(into_io)?;
        Ok(Self { stream, cell, pixels: Vec::new() })
    }
}

impl<W: Write + 'static> Writer for Png<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.pixels.clear();
        self.cell.draw_row(cells, Rgb::channels, &mut self.pixels);
        self.stream.write_all(&self.pixels)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.stream.finish().map_err(into_io)
    }
}

/// Collects cells, and writes the text of their grid at the end.
struct TextGrid<W> {
    output: W,
    cells: Buffer,
}

impl<W: Write> Writer for TextGrid<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.cells.content.extend_from_slice(cells);
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        write!(self.output, "{}", CellGrid::from(self.cells))?;
        self.output.flush()
    }
}
