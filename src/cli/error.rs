//! The errors of commands.

use std::fmt;
use std::io::{self, Write};
use std::process::ExitCode;

use crate::fault::{Faults, printable, printable_lines};
use crate::terminal;

/// The error of a command: a sentence, or a report of several faults, and the exit status.
#[derive(Debug)]
pub struct Error {
    cause: Cause,
}

#[derive(Debug)]
enum Cause {
    /// An invalid request.
    Mistake(String),
    /// A file of the user with faults.
    Faults(Faults),
    /// The same of several files, as text of several lines.
    Report(String),
    /// A failure of the system.
    Machine(String),
    /// A mistake that has already been reported.
    Reported,
    /// What was asked for is not so, as the output says.
    Failed,
    /// The reader of the output has closed the pipe.
    ClosedPipe,
}

impl Error {
    /// An invalid request, described by `sentence`.
    pub fn mistake(sentence: impl Into<String>) -> Self {
        Self { cause: Cause::Mistake(sentence.into()) }
    }

    /// Faults of several files: `text` has a line with the place of each.
    pub fn report_of(text: String) -> Self {
        Self { cause: Cause::Report(text) }
    }

    /// A mistake that has already been reported.
    pub(crate) fn reported() -> Self {
        Self { cause: Cause::Reported }
    }

    /// What was asked for is not so, as the output says.
    pub(crate) fn failed() -> Self {
        Self { cause: Cause::Failed }
    }

    /// The error of writing to standard output.
    pub fn of_output(error: &io::Error) -> Self {
        let cause = match error.kind() {
            io::ErrorKind::BrokenPipe => Cause::ClosedPipe,
            _ => Cause::Machine(format!("standard output can't be written: {error}")),
        };
        Self { cause }
    }

    /// A failure of the system, described by `sentence`.
    pub fn machine(sentence: impl Into<String>) -> Self {
        Self { cause: Cause::Machine(sentence.into()) }
    }

    /// Prints the message of a command that continues.
    pub fn warn(&self) {
        self.print();
    }

    /// Prints the message, and returns the exit status.
    pub(crate) fn report(&self) -> ExitCode {
        match &self.cause {
            Cause::ClosedPipe => ExitCode::SUCCESS,
            Cause::Reported => ExitCode::from(2),
            Cause::Failed => ExitCode::FAILURE,
            Cause::Mistake(_) | Cause::Faults(_) | Cause::Report(_) => {
                self.print();
                ExitCode::from(2)
            }
            Cause::Machine(_) => {
                self.print();
                ExitCode::FAILURE
            }
        }
    }

    /// Writes to standard error. If that is closed, too, the message is lost.
    fn print(&self) {
        let _ = writeln!(io::stderr(), "{}", self.printable());
    }

    /// The message, without characters that a terminal obeys.
    fn printable(&self) -> String {
        let message = self.to_string();
        match self.cause {
            Cause::Faults(_) | Cause::Report(_) => printable_lines(&message),
            _ => printable(&message),
        }
    }
}

impl From<Faults> for Error {
    fn from(faults: Faults) -> Self {
        Self { cause: Cause::Faults(faults) }
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
        match &self.cause {
            Cause::Mistake(sentence) | Cause::Machine(sentence) => {
                write!(f, "cellcaster: {sentence}")
            }
            Cause::Faults(faults) => faults.fmt(f),
            Cause::Report(text) => f.write_str(text),
            Cause::Failed => f.write_str("cellcaster: not so"),
            Cause::Reported => f.write_str("cellcaster: already reported"),
            Cause::ClosedPipe => f.write_str("cellcaster: the output was closed"),
        }
    }
}

impl std::error::Error for Error {}
