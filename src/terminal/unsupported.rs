//! The interfaces of `unix` and `signals` on platforms on which no terminal can be opened.
//!
//! A device cannot exist here, so functions with a device are never called.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use super::error::TerminalErrorKind;
use super::guard::TerminalGuard;
use super::{Error, QuitReason, WindowSize};

/// A device. None can exist on this platform.
#[derive(Debug)]
pub(crate) enum Device {}

/// The signals of a session. None can exist on this platform.
#[derive(Debug)]
pub(crate) enum Signals {}

/// The results of a wait.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ready {
    pub(crate) input: bool,
    pub(crate) signals: bool,
    pub(crate) output: bool,
}

/// The meaning of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(dead_code, reason = "there are no signals here")]
pub(crate) enum Signal {
    Resized,
    Suspend,
    Continued,
    Quit(QuitReason),
}

/// Fails: there is no terminal to read keys from.
#[cfg(feature = "cli")]
pub(crate) fn take_keys_from_terminal() -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Returns true: output is not a terminal that was taken.
#[cfg(feature = "cli")]
pub(crate) fn accepts_output<T>(_: &T) -> bool {
    true
}

impl Device {
    pub(crate) fn open() -> Result<Self, Error> {
        Err(TerminalErrorKind::UnsupportedPlatform.into())
    }

    pub(crate) fn make_raw(&self) -> io::Result<()> {
        match *self {}
    }

    pub(crate) fn size(&self) -> WindowSize {
        match *self {}
    }

    pub(crate) fn write_some(&self, _: &[u8]) -> io::Result<usize> {
        match *self {}
    }

    pub(crate) fn write(&self, _: &[u8], _: impl Fn() -> bool) -> io::Result<usize> {
        match *self {}
    }

    pub(crate) fn give_back(&self) {
        match *self {}
    }

    pub(crate) fn discard_output(&self) -> io::Result<()> {
        match *self {}
    }

    pub(crate) fn read(&self, _: &mut [u8]) -> io::Result<Option<usize>> {
        match *self {}
    }

    pub(crate) fn wait_for_input(&self, _: Duration) -> io::Result<bool> {
        match *self {}
    }

    pub(crate) fn wait(&self, _: &Signals, _: bool, _: Option<Duration>) -> io::Result<Ready> {
        match *self {}
    }
}

impl Signals {
    pub(crate) fn listen(guard: &Arc<TerminalGuard>) -> io::Result<Self> {
        match guard.device {}
    }

    pub(crate) fn take(&mut self) -> Vec<Signal> {
        match *self {}
    }

    pub(crate) fn stop_until_continued(&mut self) -> io::Result<()> {
        match *self {}
    }
}
