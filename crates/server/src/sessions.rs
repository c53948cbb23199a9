//! Visitors: a session draws snapshots of a room and returns requests, and its driver has the connection, the clock and
//! the room.

pub mod driver;
pub mod session;
