//! The real terminal: what it can do, entering and leaving it, its bytes as events, cells as bytes.
//!
//! The bytes are read and cut by this module itself. Leaving that to an event library was refused:
//! those known swallow keys after an answer that they do not know, take half a sequence for
//! keys, or keep a reading thread that competes with the answers to queries.

mod cell_writer;
mod depth;
mod input;
mod key;
mod sequence;

pub use self::cell_writer::CellWriter;
pub use self::depth::{ColorDepth, Detected, color_depth};
pub use self::key::{Key, KeyEvent, Modifiers, Phase, UnknownKey};
