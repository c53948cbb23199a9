//! Input: bytes from the terminal to keys and answers to queries.
//!
//! The stream is divided into complete units first, and only whole units are interpreted. So an
//! answer never becomes typed text, however the bytes arrive, and an unknown unit is dropped at its
//! end. Dividing by a parser of keys was refused: the known ones keep a buffer for ever after a
//! complete report that they do not know.

mod answer;
mod key;
mod mouse;
mod unit;

use std::time::Duration;

pub(crate) use answer::Answer;
use unit::{Cutter, Kind, Rest};

use super::key::KeyEvent;
use super::mouse::MouseReport;

/// An input from the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Input {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons pressed or released.
    Mouse(MouseReport),
    /// The window has received the focus, or lost it.
    Focus(bool),
    /// The terminal has answered a query.
    Answer(Answer),
}

/// A decoder of a stream of bytes.
#[derive(Debug, Default)]
pub(crate) struct Decoder {
    cutter: Cutter,
}

impl Decoder {
    /// Decodes the next `bytes` of the stream, and calls `take` with each complete input.
    pub(crate) fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(Input)) {
        for byte in bytes {
            self.cutter
                .push(*byte, &mut |kind, unit| meaning(kind, unit).into_iter().for_each(&mut take));
        }
    }

    /// The time to wait for more bytes after the last one; `None` if no unit is incomplete.
    pub(crate) fn patience(&self) -> Option<Duration> {
        /// Longer than the gaps within a sequence, shorter than a noticeable delay.
        const KEY: Duration = Duration::from_millis(50);
        /// This is certainly a sequence, but the link may be slow.
        const SEQUENCE: Duration = Duration::from_secs(1);
        match self.cutter.rest() {
            Rest::Nothing => None,
            Rest::PerhapsKey => Some(KEY),
            Rest::Sequence => Some(SEQUENCE),
        }
    }

    /// Ends the wait: an escape without more bytes is the Escape key.
    pub(crate) fn give_up(&mut self, mut take: impl FnMut(Input)) {
        self.cutter.give_up(&mut |kind, unit| meaning(kind, unit).into_iter().for_each(&mut take));
    }
}

fn meaning(kind: Kind, unit: &[u8]) -> Option<Input> {
    match kind {
        Kind::ControlSequence if unit.starts_with(b"\x1b[<") => {
            mouse::parse(unit).map(Input::Mouse)
        }
        Kind::MouseBytes => mouse::parse_bytes(unit).map(Input::Mouse),
        Kind::ControlSequence if matches!(unit, b"\x1b[I" | b"\x1b[O") => {
            Some(Input::Focus(unit.ends_with(b"I")))
        }
        Kind::ControlSequence if answer::is_report(unit) => {
            answer::parse_report(unit).map(Input::Answer)
        }
        Kind::Key | Kind::ControlSequence => key::parse(unit).map(Input::Key),
        Kind::DeviceControl => answer::parse_device_control(unit).map(Input::Answer),
        Kind::OtherString => answer::parse_string(unit).map(Input::Answer),
    }
}

#[cfg(test)]
mod tests;
