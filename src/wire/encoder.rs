//! Encoders of frames, alike from outside.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::Cell;
use ratatui::layout::Size;
use ratatui::style::Color;

use crate::palette::ColorDepth;
use crate::terminal::{CellWriter, Fidelity};

/// Cells that are not what they were, as ratatui's backends get them.
pub(super) type Changes<'a> = [(u16, u16, &'a Cell)];

/// What makes bytes of a frame.
pub(super) trait Encoder {
    /// The bytes that a frame takes, added to `bytes`: what ratatui's `Terminal` has its backend do.
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>);

    /// The colours that the upper and the lower half of a cell show; `None` where they are what was
    /// asked for.
    fn shown(&self, column: u16, row: u16) -> Option<[Color; 2]>;
}

/// Where a backend writes to.
#[derive(Clone, Debug, Default)]
pub(super) struct Sink(Rc<RefCell<Vec<u8>>>);

impl Sink {
    /// How many bytes have been written since the last time.
    pub(super) fn drain(&self) -> usize {
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

/// One frame, as ratatui sends it where no cursor shows. A sink takes everything, so nothing fails.
fn send<B: Backend>(backend: &mut B, changes: &Changes) {
    _ = backend.draw(changes.iter().copied());
    _ = backend.hide_cursor();
    _ = Backend::flush(backend);
}

/// Ratatui's own backend for crossterm.
pub(super) struct Stock {
    sink: Sink,
    backend: CrosstermBackend<Sink>,
}

impl Stock {
    pub(super) fn new() -> Self {
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

    fn shown(&self, _: u16, _: u16) -> Option<[Color; 2]> {
        None
    }
}

/// Whether the terminal repeats characters and, in true colour, has its palette defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Brevity {
    None,
    Tried,
}

impl Brevity {
    /// What our encoder is called at `fidelity`.
    pub(super) fn name(self, fidelity: Fidelity) -> String {
        match self {
            Self::None => fidelity.to_string(),
            Self::Tried => format!("{fidelity}+"),
        }
    }
}

/// Ours.
pub(super) struct Writer {
    sink: Sink,
    backend: CellWriter<Sink>,
}

impl Writer {
    pub(super) fn new(size: Size, depth: ColorDepth, fidelity: Fidelity, brevity: Brevity) -> Self {
        let sink = Sink::default();
        let mut backend = CellWriter::new(sink.clone(), size);
        backend.set_fidelity(fidelity);
        backend.set_repeats(brevity == Brevity::Tried);
        backend.set_palette(brevity == Brevity::Tried && depth == ColorDepth::True);
        Self { sink, backend }
    }
}

impl Encoder for Writer {
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        send(&mut self.backend, changes);
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    fn shown(&self, column: u16, row: u16) -> Option<[Color; 2]> {
        self.backend.shown_colors(column, row)
    }
}
