//! Why a command ended early.

use std::fmt;
use std::io;
use std::process::ExitCode;

use crate::fault::Faults;
use crate::terminal;

/// Why a command ended early: a whole sentence, or a report of several, and the status to end with.
#[derive(Debug)]
pub struct Error {
    cause: Cause,
}

#[derive(Debug)]
enum Cause {
    /// The user asked for something that can't be done.
    Mistake(String),
    /// A file that the user wrote is wrong.
    Faults(Faults),
    /// The machine refused something.
    Machine(String),
    /// A mistake that has been told of.
    Told,
    /// Nobody reads what is written any more.
    ClosedPipe,
}

impl Error {
    /// The user asked for something that can't be done, as `sentence` says.
    pub(super) fn mistake(sentence: impl Into<String>) -> Self {
        Self { cause: Cause::Mistake(sentence.into()) }
    }

    /// A mistake that has been told of already.
    pub(super) fn told() -> Self {
        Self { cause: Cause::Told }
    }

    /// Standard output took no more.
    pub(super) fn of_output(error: &io::Error) -> Self {
        let cause = match error.kind() {
            io::ErrorKind::BrokenPipe => Cause::ClosedPipe,
            _ => Cause::Machine(format!("standard output can't be written: {error}")),
        };
        Self { cause }
    }

    /// The machine refused something, as `sentence` says.
    pub(super) fn machine(sentence: impl Into<String>) -> Self {
        Self { cause: Cause::Machine(sentence.into()) }
    }

    /// Prints what there is to say, for a command that goes on.
    pub(super) fn warn(&self) {
        print(self);
    }

    /// Prints what there is to say, and tells the status to end with.
    pub(super) fn report(&self) -> ExitCode {
        match &self.cause {
            Cause::ClosedPipe => ExitCode::SUCCESS,
            Cause::Told => ExitCode::from(2),
            Cause::Mistake(_) | Cause::Faults(_) => {
                print(self);
                ExitCode::from(2)
            }
            Cause::Machine(_) => {
                print(self);
                ExitCode::FAILURE
            }
        }
    }
}

/// Writes to standard error; where even that is closed, nobody is there to be told.
fn print(error: &Error) {
    use io::Write;
    let _ = writeln!(io::stderr(), "{error}");
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
            Cause::Told => f.write_str("cellcaster: told already"),
            Cause::ClosedPipe => f.write_str("cellcaster: the output was closed"),
        }
    }
}

impl std::error::Error for Error {}
