//! Stored games: the whole state of a game as bytes, and back.
//!
//! Only what changes is stored. A game at its start, of the same level and rules, gives the rest: the
//! map, the posts of guards, sprites and textures. What is computed from the stored state is not stored
//! either: the openings of doors and the states of moving tiles in the grid, and the light of lamps.
//!
//! The bytes may come from a network. Whatever they are, reading them ends, takes memory in proportion
//! to them and to the level, and gives a game in which every index points at something and every step
//! succeeds, or an error. Whether the game was ever played like that is not checked.
//!
//! The first line says who can read the rest:
//!
//! ```text
//! cellcaster-game 1 rules 2 version 0.1.0
//! ```
//!
//! The script so far was refused: playing it again takes a second for each minute. So was `serde` with
//! a compact format: the engine would depend on both, and derived code accepts any number where the
//! rules need one of a range.

mod codec;
mod lists;
mod macros;
mod numbers;
mod parts;
#[cfg(test)]
pub(crate) mod tests;
mod whole;

use std::fmt;

pub use self::codec::{Reader, Stored, StoredPart, Writer, check, check_on_map};
pub use self::numbers::MOST_COUNT;
#[doc(hidden)]
pub use crate::stored;

/// The version of the rules. It grows with every change after which the same intents may give another
/// game.
pub const RULES_VERSION: u32 = 2;

/// The most bytes that are read.
pub const MOST_BYTES: usize = 1 << 20;

/// Why bytes give no game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unrestorable {
    /// They are of no stored game, or of one of another version of the format, the rules or the crate.
    OtherVersion,
    /// They are of another level, or of other rules.
    OtherLevel,
    /// They end too early.
    Cut,
    /// They go on after the end.
    Longer,
    /// They are more than the 2²⁰ bytes that are read.
    TooLong,
    /// This part is out of its range.
    Damaged(&'static str),
}

impl fmt::Display for Unrestorable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherVersion => write!(
                f,
                "the state is not one of version {} of Cellcaster with version {RULES_VERSION} of the rules",
                env!("CARGO_PKG_VERSION")
            ),
            Self::OtherLevel => f.write_str("the state is one of another level or other rules"),
            Self::Cut => f.write_str("the state ends too early"),
            Self::Longer => f.write_str("the state goes on after its end"),
            Self::TooLong => write!(f, "the state is longer than {MOST_BYTES} bytes"),
            Self::Damaged(what) => write!(f, "the state is damaged: {what} is out of its range"),
        }
    }
}

impl std::error::Error for Unrestorable {}

/// The first line of what is stored as `kind`.
pub fn first_line(kind: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("cellcaster-{kind} 1 rules {RULES_VERSION} version {version}\n")
}

/// What follows the first line of what is stored as `kind`.
pub fn after_first_line<'a>(kind: &str, bytes: &'a [u8]) -> Result<&'a [u8], Unrestorable> {
    if bytes.len() > MOST_BYTES {
        return Err(Unrestorable::TooLong);
    }
    bytes.strip_prefix(first_line(kind).as_bytes()).ok_or(Unrestorable::OtherVersion)
}
