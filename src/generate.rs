//! Levels that nobody drew: mazes, caves and offices, dug as one walks, without an end or of any size.
//!
//! A [`Terrain`] is a function from the place of a [`Chunk`] to its cells, and knows the chunk's
//! neighbours by their places alone. A [`Level`] is a terrain and its extent; a [`Window`] keeps the
//! chunks around the player as an ordinary [`World`](crate::world::World), so that casting, drawing
//! and colliding are what they are on any map, and cost the same.
//!
//! Positions are never large. The player is at a position in the window, and the window is at a chunk:
//! a million cells from home the picture is as steady as there. A world of 64-bit columns was
//! refused: every ray of every map would have paid for it.
//!
//! What is random is hashed from the seed, what it decides and where, in integers: see
//! `hash`. The same seed is the same level on every machine.

mod cave;
mod chunk;
mod kit;
mod level;
mod maze;
mod office;
mod purpose;
mod window;

use std::fmt;
use std::sync::Arc;

pub use chunk::{CHUNK_SIDE, Chunk, ChunkIndex, Extent, Plot, Site};
pub use level::Level;
pub(crate) use window::Shift;
pub use window::Window;

/// What a level consists of, as a function of the place.
///
/// The same plot always has the same chunk, whatever was dug before.
pub trait Terrain: fmt::Debug + Send + Sync {
    /// Where random begins, for what is not the terrain's to decide, such as where the way out is.
    fn seed(&self) -> u64;

    /// A map file that gives the characters of its chunks their meaning: every one of them is drawn
    /// in its grid. It has no keys, its walls include `#`, and it has an exit. A pattern of a floor or
    /// a ceiling, of a scale that is a power of two up to 16, is the same in every chunk; others would
    /// jump as the window moves.
    fn legend(&self) -> String;

    /// What is in the cells of a chunk. What is outside `plot` does not matter: it will be wall.
    ///
    /// Doors stand between solid cells, open floor before and behind them. All chunks whose plots
    /// have a [hub](Terrain::hub) are connected with their neighbours that have one.
    fn chunk(&self, plot: &Plot) -> Chunk;

    /// An open cell of the chunk from which one gets to the neighbours; `None` where the plot is too
    /// small to have any.
    fn hub(&self, plot: &Plot) -> Option<(usize, usize)>;

    /// The cell of the chunk in which one starts who wants to start nowhere in particular: its corner,
    /// unless a terrain knows a better one. If one cannot get away from there, the hub is used.
    fn start(&self, _plot: &Plot) -> (usize, usize) {
        (0, 0)
    }
}

/// A built-in way to make levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Generator {
    /// Passages a cell wide, and a hall here and there.
    Maze,
    /// What water would have left, and tunnels.
    Cave,
    /// Rooms, doors, glass and corridors.
    Office,
}

impl Generator {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Maze, Self::Cave, Self::Office];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maze => "maze",
            Self::Cave => "cave",
            Self::Office => "office",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|generator| generator.name() == name)
    }

    /// The terrain that it makes of a seed.
    pub fn terrain(self, seed: u64) -> Arc<dyn Terrain> {
        match self {
            Self::Maze => Arc::new(maze::Maze { seed }),
            Self::Cave => Arc::new(cave::Cave { seed }),
            Self::Office => Arc::new(office::Office { seed }),
        }
    }
}
