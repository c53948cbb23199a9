//! One JSON object: `{"cols": 80, "rows": 24, "cells": [[{"ch": "▀", "fg": "#rrggbb", "bg": "#rrggbb"}, …], …]}`.

use std::io::{self, Write};

use ratatui::buffer::Cell;
use ratatui::layout::Size;
use serde::Serialize;

use super::rgb;

/// Writes cells as JSON, one line for each row.
pub(crate) struct Json<W> {
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
    pub(crate) fn new(mut output: W, size: Size) -> io::Result<Self> {
        write!(output, "{{\"cols\":{},\"rows\":{},\"cells\":[", size.width, size.height)?;
        Ok(Self { output, is_first: true })
    }
}

impl<W: Write> super::Writer for Json<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.output.write_all(if self.is_first { b"\n" } else { b",\n" })?;
        self.is_first = false;
        let cells: Vec<JsonCell> = cells
            .iter()
            .map(|cell| JsonCell {
                ch: cell.symbol(),
                fg: rgb(cell.fg).map(|color| color.to_string()),
                bg: rgb(cell.bg).map(|color| color.to_string()),
            })
            .collect();
        Ok(serde_json::to_writer(&mut self.output, &cells)?)
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.output.write_all(b"\n]}\n")?;
        self.output.flush()
    }
}
