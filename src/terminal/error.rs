//! Errors of sessions with a terminal.

use std::{fmt, io};

/// The reason why a session with the terminal did not start or cannot continue.
///
/// Its message is a whole sentence for the user.
#[derive(Debug)]
pub struct Error(Kind);

/// The kinds of errors.
#[derive(Debug)]
pub(crate) enum Kind {
    /// `stream` (such as "standard input") is not a terminal.
    #[cfg(unix)]
    NotATerminal { stream: &'static str },
    /// The game cannot run on this platform yet.
    #[cfg(not(unix))]
    UnsupportedPlatform,
    /// The terminal cannot move its cursor, according to this value of `TERM`.
    Teletype { term: &'static str },
    /// This process has a session already.
    AlreadyTaken,
    /// A panic in another thread has ended the session.
    GivenBack,
    /// An error occurred while `doing` something (such as "reading keys").
    Io { doing: &'static str, source: io::Error },
}

impl From<Kind> for Error {
    fn from(kind: Kind) -> Self {
        Self(kind)
    }
}

impl Error {
    /// Whether the user can avoid it, with a terminal or another platform.
    pub fn is_mistake(&self) -> bool {
        match self.0 {
            Kind::NotATerminal { .. } | Kind::Teletype { .. } => true,
            #[cfg(not(unix))]
            Kind::UnsupportedPlatform => true,
            Kind::AlreadyTaken | Kind::GivenBack | Kind::Io { .. } => false,
        }
    }

    /// Wraps an error that occurred while `doing` something (such as "reading keys").
    pub(crate) fn while_doing(doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |source| Self(Kind::Io { doing, source })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            #[cfg(unix)]
            Kind::NotATerminal { stream } => write!(
                f,
                "{stream} is not a terminal, which playing needs; \
                 `cellcaster snapshot` draws a frame without one"
            ),
            #[cfg(not(unix))]
            Kind::UnsupportedPlatform => f.write_str(
                "playing needs a Unix terminal for now; \
                 `cellcaster snapshot` draws a frame on every platform",
            ),
            Kind::Teletype { term } => write!(
                f,
                "TERM is {term:?}, a terminal that cannot move its cursor, which playing needs; set it \
                 to what you have, such as TERM=xterm-256color, or draw a frame with \
                 `cellcaster snapshot`"
            ),
            Kind::AlreadyTaken => {
                f.write_str("this program has taken the terminal already, and has not left it yet")
            }
            Kind::GivenBack => {
                f.write_str("the terminal was given back when another part of the program failed")
            }
            Kind::Io { doing, source } => {
                write!(f, "{doing} failed: {source}")
            }
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.0 {
            Kind::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}
