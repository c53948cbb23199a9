//! Characters and colours, a line for each row, as a terminal takes them.

use std::io::{self, Write};

use ratatui::buffer::Cell;

use crate::terminal::Style;

/// Writes cells as text with the sequences that colour it. Every line ends in the terminal's own
/// colours, so that pagers and scrolling can cut between lines.
pub(super) struct Ansi<W> {
    output: W,
    line: Vec<u8>,
}

impl<W: Write> Ansi<W> {
    pub(super) fn new(output: W) -> Self {
        Self { output, line: Vec::new() }
    }
}

impl<W: Write> super::Writer for Ansi<W> {
    fn write_row(&mut self, cells: &[Cell]) -> io::Result<()> {
        self.line.clear();
        let mut style = Style::RESET;
        for cell in cells {
            let next = Style::of(cell);
            if next != style {
                next.write_from(Some(style), &mut self.line);
                style = next;
            }
            self.line.extend_from_slice(cell.symbol().as_bytes());
        }
        if style != Style::RESET {
            Style::RESET.write_from(Some(style), &mut self.line);
        }
        self.line.push(b'\n');
        self.output.write_all(&self.line)
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.output.flush()
    }
}
