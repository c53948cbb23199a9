//! The errors of commands.

use std::fmt;
use std::io::{self, Write};
use std::process::ExitCode;

use crate::fault::{Faults, printable, printable_lines};
use crate::terminal;

/// A command's error: a message without control characters, and the exit status.
#[derive(Debug)]
pub struct Error {
    /// The message; empty if there is nothing more to say.
    message: String,
    status: u8,
}

/// The exit status after a system failure, and after a user error.
const FAILURE: u8 = 1;
const MISTAKE: u8 = 2;

impl Error {
    /// A user error, described by `sentence`.
    pub fn mistake(sentence: impl Into<String>) -> Self {
        Self::sentence(&sentence.into(), MISTAKE)
    }

    /// A system failure, described by `sentence`.
    pub fn machine(sentence: impl Into<String>) -> Self {
        Self::sentence(&sentence.into(), FAILURE)
    }

    fn sentence(sentence: &str, status: u8) -> Self {
        Self { message: printable(&format!("cellcaster: {sentence}")), status }
    }

    /// Faults in several files. `text` has one line for each, with its place.
    pub fn report_of(text: &str) -> Self {
        Self { message: printable_lines(text), status: MISTAKE }
    }

    /// A user error that has already been reported.
    pub(crate) fn reported() -> Self {
        Self { message: String::new(), status: MISTAKE }
    }

    /// A negative result that the output already shows.
    pub(crate) fn failed() -> Self {
        Self { message: String::new(), status: FAILURE }
    }

    /// An error while writing to standard output. If the reader closed the pipe, the program ends
    /// silently.
    pub fn of_output(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self { message: String::new(), status: 0 },
            _ => Self::machine(format!("standard output can't be written: {error}")),
        }
    }

    /// Prints the message of a command that continues. The message is lost if standard error is
    /// closed.
    pub fn warn(&self) {
        let _ = writeln!(io::stderr(), "{self}");
    }

    /// Prints the message, and returns the exit status.
    pub(crate) fn report(&self) -> ExitCode {
        if !self.message.is_empty() {
            self.warn();
        }
        ExitCode::from(self.status)
    }
}

impl From<Faults> for Error {
    fn from(faults: Faults) -> Self {
        Self::report_of(&faults.to_string())
    }
}

impl From<terminal::Error> for Error {
    fn from(error: terminal::Error) -> Self {
        if error.is_mistake() {
            Self::mistake(error.to_string())
        } else {
            Self::machine(error.to_string())
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}
