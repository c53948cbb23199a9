//! Encoders of frames behind one trait.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::Cell;
use ratatui::layout::Size;
use ratatui::style::Color;

use cellcaster::color::palette::ColorDepth;
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::canvas::Mosaic;

/// The changed cells of a frame, in the form of ratatui's backends.
pub(crate) type Changes<'a> = [(u16, u16, &'a Cell)];

/// An encoder from cells to bytes.
pub(crate) trait Encoder {
    /// Appends the bytes of a frame to `bytes`, with the calls that ratatui's `Terminal` makes to
    /// its backend.
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>);

    /// The colours shown by the dots of a cell's mosaic and by the rest, or by its text and its background;
    /// `None` if they are the requested ones.
    fn shown(&self, column: u16, row: u16) -> Option<(Option<Mosaic>, [Color; 2])>;
}

/// A writer shared with a backend.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sink(Rc<RefCell<Vec<u8>>>);

impl Sink {
    /// The number of bytes written since the last call.
    pub(crate) fn drain(&self) -> usize {
        self.0.borrow_mut().drain(..).len()
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Sends one frame as ratatui does without a cursor. A sink accepts everything, so nothing fails.
fn send<B: Backend>(backend: &mut B, changes: &Changes) {
    _ = backend.draw(changes.iter().copied());
    _ = backend.hide_cursor();
    _ = Backend::flush(backend);
}

/// Ratatui's own backend for crossterm.
pub(crate) struct Stock {
    sink: Sink,
    backend: CrosstermBackend<Sink>,
}

impl Stock {
    pub(crate) fn new() -> Self {
        let sink = Sink::default();
        let backend = CrosstermBackend::new(sink.clone());
        Self { sink, backend }
    }
}

impl Encoder for Stock {
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        send(&mut self.backend, changes);
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    fn shown(&self, _: u16, _: u16) -> Option<(Option<Mosaic>, [Color; 2])> {
        None
    }
}

/// Whether the terminal repeats characters and, in true colour, has its palette defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extensions {
    Off,
    On,
}

impl Extensions {
    /// The name of Cellcaster's encoder at `fidelity`.
    pub(crate) fn name(self, fidelity: Fidelity) -> String {
        match self {
            Self::Off => fidelity.to_string(),
            Self::On => format!("{fidelity}+"),
        }
    }
}

/// Cellcaster's encoder.
pub(crate) struct Writer {
    sink: Sink,
    backend: CellWriter<Sink>,
}

impl Writer {
    pub(crate) fn new(
        size: Size,
        depth: ColorDepth,
        fidelity: Fidelity,
        extensions: Extensions,
    ) -> Self {
        let sink = Sink::default();
        let mut backend = CellWriter::new(sink.clone(), size);
        backend.set_fidelity(fidelity);
        backend.set_repeats(extensions == Extensions::On);
        backend.set_palette(extensions == Extensions::On && depth == ColorDepth::True);
        Self { sink, backend }
    }
}

impl Encoder for Writer {
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        send(&mut self.backend, changes);
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    fn shown(&self, column: u16, row: u16) -> Option<(Option<Mosaic>, [Color; 2])> {
        let colors = self.backend.shown_colors(column, row)?;
        Some((self.backend.shown_mosaic(column, row), colors))
    }
}
