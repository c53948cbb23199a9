//! The real terminal: what it can do, entering and leaving it, its bytes as events, cells as bytes.
//!
//! A [`Session`] takes the terminal and yields [`Event`]s; [`Session::draw`] shows a frame. Whatever
//! ends the session — a return, an error, a panic, a signal — the terminal is given back as it was
//! found.
//!
//! The bytes are read and cut by this module itself. Leaving that to an event library was refused:
//! those known swallow keys after an answer that they do not know, take half a sequence for
//! keys, or keep a reading thread that competes with the answers to queries.

mod cell_writer;
mod depth;
mod environment;
mod error;
mod event;
mod fidelity;
#[cfg_attr(not(unix), expect(dead_code, reason = "without a terminal, nothing is sent"))]
mod flow;
#[cfg_attr(not(unix), expect(dead_code, reason = "signals, of which there are none, use it"))]
mod guard;
mod input;
mod key;
mod mouse;
mod recorder;
mod sequence;
mod session;
mod size;
#[cfg(unix)]
mod unix;
#[cfg(not(unix))]
mod unsupported;

#[cfg(unix)]
use self::unix as platform;
#[cfg(not(unix))]
use self::unsupported as platform;

#[cfg(feature = "cli")]
pub(crate) use self::cell_writer::{Bytes, Style};
pub use self::cell_writer::{CellWriter, Screen};
pub use self::depth::{ColorSource, Detected, color_depth, color_source};
pub use self::environment::locale_without_utf8;
pub use self::error::Error;
pub use self::event::{Event, QuitReason};
pub use self::fidelity::{Fidelity, UnknownFidelity};
pub use self::key::{Key, KeyEvent, Modifiers, Phase, UnknownKey};
pub use self::mouse::{MouseButton, MouseEvent, MouseEventKind};
#[cfg(feature = "cli")]
pub(crate) use self::platform::{peak_memory, take_keys_from_terminal};
pub use self::recorder::Recorder;
pub use self::session::{Options, Session};
pub use self::size::WindowSize;
