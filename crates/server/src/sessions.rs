//! Visitors: a session draws snapshots of a room and returns requests, and its driver has the connection, the clock and
//! the room.

pub mod driver;
pub mod governor;
pub mod line;
pub mod load;
pub mod session;
pub mod visitors;
