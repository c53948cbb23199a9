//! Bytes from the terminal to events: keys, and answers to what it was asked.
//!
//! The stream is cut into complete units first, and only a whole unit is given a meaning: an
//! answer is never typed as text, however the bytes arrive, and what means nothing is dropped
//! where it ends. Leaving the cutting to a parser of keys was refused: those known keep a buffer for
//! ever when they meet a finished report that they do not know.

mod answer;
mod key;
mod mouse;
mod unit;

use std::time::Duration;

pub(super) use answer::Answer;
use unit::{Cutter, Kind, Rest};

use super::key::KeyEvent;
use super::mouse::MouseReport;

/// What the terminal sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Input {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons pressed or released.
    Mouse(MouseReport),
    /// The window has been given the focus, or has lost it.
    Focus(bool),
    /// The terminal answers a query.
    Answer(Answer),
}

/// A decoder of a stream of bytes.
#[derive(Debug, Default)]
pub(super) struct Decoder {
    cutter: Cutter,
}

impl Decoder {
    /// Decodes `bytes`, the next ones of the stream, and hands what they complete to `take`.
    pub(super) fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(Input)) {
        for byte in bytes {
            self.cutter
                .push(*byte, &mut |kind, unit| meaning(kind, unit).into_iter().for_each(&mut take));
        }
    }

    /// How long after the last byte to stop waiting for more; `None` where nothing is incomplete.
    pub(super) fn patience(&self) -> Option<Duration> {
        /// Longer than the gaps inside one sequence, shorter than a player notices.
        const KEY: Duration = Duration::from_millis(50);
        /// A sequence has begun for certain; the link may be slow.
        const SEQUENCE: Duration = Duration::from_secs(1);
        match self.cutter.rest() {
            Rest::Nothing => None,
            Rest::PerhapsKey => Some(KEY),
            Rest::Sequence => Some(SEQUENCE),
        }
    }

    /// Stops waiting: an escape that nothing followed is the Escape key.
    pub(super) fn give_up(&mut self, mut take: impl FnMut(Input)) {
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
