//! The real terminal: its capabilities, sessions with it, bytes decoded to events, and cells encoded to bytes.
//!
//! A [`Session`] takes the terminal of the process and yields [`Event`]s; [`Session::draw`] shows a frame. At the end
//! of the session, the terminal is restored to its previous state, whether the session ends by a return, an error, a
//! panic or a signal. A [`Protocol`] does the same without a device and a clock, for any other reader and writer,
//! such as a channel of a server.
//!
//! This module reads the bytes and divides them into units itself.
//!
//! Rejected: an event library. Existing libraries swallow keys after an unknown answer, mistake half a sequence for
//! keys, or keep a reader thread that competes for the answers to queries.

mod cell_writer;
mod error;
mod event;
mod fidelity;
mod flow;
#[cfg_attr(not(unix), expect(dead_code, reason = "signals, of which there are none, use it"))]
mod guard;
mod input;
mod known;
mod protocol;
mod sequence;
mod session;
#[cfg(unix)]
mod signals;
mod tmux;
#[cfg(unix)]
mod unix;
#[cfg(not(unix))]
mod unsupported;

#[cfg(not(unix))]
use self::unsupported::{self as signals, self as unix};

#[cfg(feature = "cli")]
pub(crate) use self::cell_writer::{Bytes, Style};
pub use self::cell_writer::{CellWriter, Screen};
pub use self::error::Error;
pub use self::event::{
    Event, Key, KeyEvent, Modifiers, MouseButton, MouseEvent, MouseEventKind, Phase, QuitReason,
    UnknownKey, WindowSize,
};
pub use self::fidelity::{Effort, Fidelity, UnknownFidelity};
pub use self::guard::Recorder;
pub use self::known::{ColorSource, Detected, SessionOptions, locale_without_utf8};
pub use self::protocol::Protocol;
pub use self::session::Session;
pub use self::tmux::TmuxClient;
#[cfg(feature = "cli")]
pub(crate) use self::unix::{accepts_output, take_keys_from_terminal};
