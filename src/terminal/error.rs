//! Errors of sessions with a terminal.

use std::io;

/// The reason why a session with the terminal did not start or cannot continue.
///
/// Its message is a whole sentence for the user.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct Error(#[from] TerminalErrorKind);

/// The kinds of errors.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TerminalErrorKind {
    #[cfg(unix)]
    #[error(
        "playing needs a terminal, but {stream} is not one; `cellcaster snapshot` draws a frame without one"
    )]
    NotATerminal {
        /// The name of the stream, such as "standard input".
        stream: &'static str,
    },
    #[cfg(not(unix))]
    #[error(
        "playing needs a Unix terminal for now; `cellcaster snapshot` draws a frame on every platform"
    )]
    UnsupportedPlatform,
    /// The terminal cannot move its cursor, according to this value of `TERM`.
    #[error(
        "playing needs a terminal that can move its cursor, but TERM is {term:?}: set TERM to your \
         terminal's name, such as TERM=xterm-256color, or draw a frame with `cellcaster snapshot`"
    )]
    Teletype { term: &'static str },
    /// This process already has a session.
    #[error("this program already uses the terminal")]
    AlreadyTaken,
    /// A panic in another thread has ended the session.
    #[error("the terminal was restored when another part of the program failed")]
    GivenBack,
    /// An error occurred while `doing` something (such as "reading keys").
    #[error("{doing} failed: {source}")]
    Io { doing: &'static str, source: io::Error },
}

impl Error {
    /// Returns true if the user can avoid the error, with another terminal or platform.
    pub fn is_mistake(&self) -> bool {
        !matches!(
            self.0,
            TerminalErrorKind::AlreadyTaken
                | TerminalErrorKind::GivenBack
                | TerminalErrorKind::Io { .. }
        )
    }

    /// Wraps an error that occurred while `doing` something (such as "reading keys").
    pub(crate) fn while_doing(doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |source| Self(TerminalErrorKind::Io { doing, source })
    }
}
