//! Generated levels: mazes, caves and offices, made while the player walks, without an end or of
//! any size.
//!
//! A [`Terrain`] is a function from the position of a [`Chunk`] to its cells; it knows the
//! neighbours of the chunk by their positions only. A [`Level`] is a terrain with an extent. A
//! [`Window`] keeps the chunks around the player as an ordinary [`World`](crate::world::World), so
//! that casting, drawing and collision work as on any map, at the same cost.
//!
//! Positions are never large: the player has a position in the window, and the window one among the
//! chunks. At a million cells the picture is as stable as at the start. A world with 64-bit columns
//! was refused, since every ray on every map would pay for it.
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

use std::fmt;
use std::sync::Arc;

pub use chunk::{CHUNK_SIDE, Chunk, ChunkArea, ChunkIndex, Extent, Site};
pub use descent::{daily_seed, descent, floors_below};
pub use level::Level;
pub(crate) use window::Shift;
pub use window::Window;

/// The contents of a level, as a function of the position.
///
/// The same area always has the same chunk, whatever was generated before.
pub trait Terrain: fmt::Debug + Send + Sync {
    /// The seed for decisions outside the terrain, such as the place of the exit.
    fn seed(&self) -> u64;

    /// A map file that defines the characters of the chunks: its grid has each of them at least
    /// once. It has no keys; its walls include `#`; it has an exit. Patterns of floors and ceilings
    /// must have a scale that is a power of two up to 16: others would jump when the window moves.
    fn legend(&self) -> String;

    /// The cells of a chunk. Cells outside `area` do not matter: they become wall.
    ///
    /// Doors stand between solid cells, with open floor before and behind them. Chunks whose areas
    /// have a [hub](Terrain::hub) are connected with their neighbours that have one.
    fn chunk(&self, area: &ChunkArea) -> Chunk;

    /// An open cell of the chunk from which the player can reach the neighbours; `None` if the area
    /// is too small to have one.
    fn hub(&self, area: &ChunkArea) -> Option<(usize, usize)>;

    /// The cell of the chunk at which the player starts by default: its corner, unless the terrain
    /// knows a better one. If there is no way out of that cell, the hub is used.
    fn start(&self, _plot: &ChunkArea) -> (usize, usize) {
        (0, 0)
    }
}

/// A built-in generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Generator {
    /// Passages one cell wide, and some halls.
    Maze,
    /// Caverns and tunnels.
    Cave,
    /// Rooms, doors, glass and corridors.
    Office,
}

impl Generator {
    /// All generators.
    pub const ALL: [Self; 3] = [Self::Maze, Self::Cave, Self::Office];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maze => "maze",
            Self::Cave => "cave",
            Self::Office => "office",
        }
    }

    /// The generator with that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|generator| generator.name() == name)
    }

    /// The terrain of a seed.
    pub fn terrain(self, seed: u64) -> Arc<dyn Terrain> {
        match self {
            Self::Maze => Arc::new(maze::Maze { seed }),
            Self::Cave => Arc::new(cave::Cave { seed }),
            Self::Office => Arc::new(office::Office { seed }),
        }
    }
}
