//! Characters with colour sequences, one line for each row.

use std::io::{self, Write};

use ratatui::buffer::Cell;

use crate::terminal::{Bytes, Style};

/// Writes cells as text with the escape sequences of their colours. Every line ends in the
/// terminal's default colours, so that pagers and scrolling can cut between lines.
pub(crate) struct Ansi<W> {
    output: W,
    line: Bytes,
}

impl<W: Write> Ansi<W> {
    pub(crate) fn new(output: W) -> Self {
        Self { output, line: Bytes::default() }
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
