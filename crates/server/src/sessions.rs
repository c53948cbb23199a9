//! Visitors' sessions. A session draws snapshots of a room and returns requests. Its driver owns the
//! connection, the clock and the place in the room.

pub mod driver;
pub(crate) mod home;
pub mod session;
