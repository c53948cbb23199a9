//! Generated levels: mazes, caves and offices, either endless or of any size. They are created
//! while the player walks.
//!
//! A [`Terrain`] is a function from the position of a [`Chunk`] to its cells. It depends on
//! neighbouring chunks only through their positions. A [`GeneratedLevel`] is a terrain with an extent. A
//! [`Window`] keeps the chunks around the player as an ordinary [`World`](crate::world::World), so
//! casting, drawing and collision work as on any map, and at the same cost.
//!
//! Coordinates are never large: the player has a position in the window, and the window has a
//! position among the chunks. The picture is as stable at a distance of a million cells as at the
//! start. Rejected: a world with 64-bit columns. Every ray on every map would pay for it.
//!
//! A [descent] creates a complete world for each floor, with an edge, guards and treasure.
//!
//! Random numbers are integer hashes of the seed, a purpose and a position. The same seed produces
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
pub use level::{GeneratedLevel, Generator};
pub use window::Window;
pub(crate) use window::WindowShift;
