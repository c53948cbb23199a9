//! Characters only, one line for each row.

use std::io::{self, Write};

use ratatui::buffer::Cell;

/// Writes the characters of cells.
pub(crate) struct Text<W> {
    output: W,
}

impl<W: Write> Text<W> {
    pub(crate) fn new(output: W) -> Self {
        Self { output }
    }
}

impl<W: Write> super::Writer for Text<W> {
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
