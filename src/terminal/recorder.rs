//! Recording of the bytes that are sent to a terminal.

use std::fmt;

use ratatui::layout::Size;

/// A recorder of all bytes that a [`Session`](super::Session) sends.
pub trait Recorder: Send {
    /// The window has this `size`. Called once before any bytes, and after each change.
    fn resized(&mut self, size: Size);

    /// These `bytes` are sent to the terminal. They are whole characters and whole sequences.
    fn sent(&mut self, bytes: &[u8]);
}

/// A recorder, if there is one.
#[derive(Default)]
pub(crate) struct Recording(Option<Box<dyn Recorder>>);

impl Recording {
    pub(crate) fn by(recorder: Option<Box<dyn Recorder>>) -> Self {
        Self(recorder)
    }

    /// Whether there is a recorder.
    pub(crate) fn is_on(&self) -> bool {
        self.0.is_some()
    }

    pub(crate) fn resized(&mut self, size: Size) {
        if let Some(recorder) = &mut self.0 {
            recorder.resized(size);
        }
    }

    pub(crate) fn sent(&mut self, bytes: &[u8]) {
        if let Some(recorder) = &mut self.0 {
            recorder.sent(bytes);
        }
    }
}

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Recording").field(&self.is_on()).finish()
    }
}
