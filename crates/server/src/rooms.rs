//! Rooms: multiplayer games as deterministic state machines.

pub(crate) mod cast;
pub mod directory;
pub mod ghost;
pub mod invitation;
pub mod maps;
pub mod replayed;
pub mod room;
pub mod sequencer;
pub mod summary;
