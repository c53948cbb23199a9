//! Generated levels: mazes, caves and offices, made while the player walks, without an end or of
//! any size.
//!
//! A [`Terrain`] is a function from the position of a [`Chunk`] to its cells; it knows the
//! neighbours of the chunk by their positions only. A [`Level`] is a terrain with an extent. A
//! [`Window`] keeps the chunks around the player as an ordinary [`World`](crate::world::World), so
//! that casting, drawing and collision work as on any map, at the same cost.
//!
//! Positions are never large: the player has a position in the window, and the window one among the
//! chunks. At a million cells the picture is as stable as at the start. Rejected: a
//! world with 64-bit columns, since every ray on every map would pay for it.
//!
//! A [descent] makes whole worlds of levels with an end, one for each floor, with guards and treasure.
//!
//! Random numbers are hashes of the seed, a purpose and a position, in integers. The same seed is
//! the same level on every machine.

mod cave;
mod chunk;
mod descent;
mod level;
mod maze;
mod office;
mod purpose;
mod tileset;
mod window;

pub use chunk::{CHUNK_SIDE, Chunk, ChunkArea, ChunkIndex, Extent, Site, Terrain};
pub use descent::{daily_seed, descent, floors_below};
pub use level::{Generator, Level};
pub(crate) use window::Shift;
pub use window::Window;
