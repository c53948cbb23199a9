//! A level: a terrain, its extent and its exit.

use std::num::NonZeroU32;
use std::sync::Arc;

use super::cave::Cave;
use super::chunk::{CHUNK_SIDE, Chunk, ChunkIndex, Extent, Site, Terrain};
use super::maze::Maze;
use super::office::Office;
use super::purpose::{Purpose, generator};
use super::tileset::{ROCK, Tileset};
use crate::fault::Faults;

/// A generated level.
///
/// ```
/// use cellcaster::game::Game;
/// use cellcaster::generate::{Extent, GeneratedLevel, Generator};
///
/// let level = GeneratedLevel::new(Generator::Maze.terrain(7), Extent::Endless)?;
/// let start = level.start().unwrap();
/// let game = Game::in_level(level, start).unwrap();
/// assert_eq!(game.site(), Some(start));
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug)]
pub struct GeneratedLevel {
    terrain: Arc<dyn Terrain>,
    tileset: Arc<Tileset>,
    extent: Extent,
    exit: Option<Site>,
}

impl GeneratedLevel {
    /// The level that `terrain` fills within `extent`. A level that is not endless has an exit.
    ///
    /// # Errors
    /// All faults in the terrain's legend.
    pub fn new(terrain: Arc<dyn Terrain>, extent: Extent) -> Result<Self, Faults> {
        let legend = terrain.legend();
        Self::with_legend(terrain, &legend, extent)
    }

    /// As [`GeneratedLevel::new`], with another legend than the terrain's own.
    pub(crate) fn with_legend(
        terrain: Arc<dyn Terrain>,
        legend: &str,
        extent: Extent,
    ) -> Result<Self, Faults> {
        let tileset = Arc::new(Tileset::of(legend)?);
        let endless = Self { terrain, tileset, extent, exit: None };
        let exit = endless.place_for_exit();
        Ok(Self { exit, ..endless })
    }

    /// The size of the level.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// The default start, in the first chunk; `None` if there is no place to stand in that chunk.
    pub fn start(&self) -> Option<Site> {
        let home = ChunkIndex::default();
        let (column, row) = self.terrain.start(&self.extent.area(home));
        self.start_near(home.site(column as i64, row as i64))
    }

    /// The start for a player who wants to begin at `site`. This is `site` if there is a way out of
    /// it, and the hub of its chunk otherwise. `None` if the chunk has no hub, which is the case
    /// outside the level.
    pub fn start_near(&self, site: Site) -> Option<Site> {
        let (index, place) = site.chunk();
        let hub = self.terrain.hub(&self.extent.area(index))?;
        let chunk = self.chunk(index);
        // Doors are closed at the start.
        let is_connected = self.tileset.is_floor(chunk.get(place.0, place.1))
            && self.walk(&chunk, hub).contains(&place);
        let (column, row) = if is_connected { place } else { hub };
        Some(index.site(column as i64, row as i64))
    }

    /// The cell of the exit; `None` for an endless level.
    pub fn exit(&self) -> Option<Site> {
        self.exit
    }

    /// A chunk of the level.
    pub fn chunk(&self, index: ChunkIndex) -> Chunk {
        let mut chunk = self.without_exit(index);
        if let Some((chunk_of_exit, (column, row))) = self.exit.map(Site::chunk)
            && chunk_of_exit == index
            && let Some(exit) = self.tileset.exit_on(chunk.get(column, row))
        {
            chunk.set(column, row, exit);
        }
        chunk
    }

    pub(crate) fn tileset(&self) -> &Tileset {
        &self.tileset
    }

    /// The characters of a level that is not endless, row by row, without its exit.
    pub(crate) fn rows_without_exit(&self, columns: NonZeroU32, rows: NonZeroU32) -> Vec<Vec<u8>> {
        let (columns, rows) = (columns.get() as usize, rows.get() as usize);
        let mut cells = vec![vec![ROCK; columns]; rows];
        for first_row in (0..rows).step_by(CHUNK_SIDE) {
            for first in (0..columns).step_by(CHUNK_SIDE) {
                let (column, row) = (first / CHUNK_SIDE, first_row / CHUNK_SIDE);
                let index = ChunkIndex { column: column as i64, row: row as i64 };
                let chunk = self.without_exit(index);
                for (to, row) in cells[first_row..].iter_mut().zip(0..CHUNK_SIDE) {
                    let to = &mut to[first..columns.min(first + CHUNK_SIDE)];
                    to.copy_from_slice(&chunk.row(row)[..to.len()]);
                }
            }
        }
        cells
    }

    fn without_exit(&self, index: ChunkIndex) -> Chunk {
        let area = self.extent.area(index);
        if area.is_empty() {
            return Chunk::full_of(ROCK);
        }
        let mut chunk = self.terrain.chunk(&area);
        chunk.clip(&area, ROCK);
        chunk
    }

    /// The cells of a chunk that can be reached from `start` inside the chunk, nearest first.
    fn walk(&self, chunk: &Chunk, start: (usize, usize)) -> Vec<(usize, usize)> {
        chunk.reachable(start, |character| self.tileset.is_walkable(character))
    }

    /// A cell far from the start, and as far as possible from the hub of its own chunk.
    fn place_for_exit(&self) -> Option<Site> {
        let index = self.chunk_for_exit()?;
        let hub = self.terrain.hub(&self.extent.area(index))?;
        let chunk = self.without_exit(index);
        let is_free = |&&(column, row): &&(usize, usize)| {
            (column, row) != hub && self.tileset.is_bare(chunk.get(column, row))
        };
        let reachable = self.walk(&chunk, hub);
        let &(column, row) = reachable.iter().rev().find(is_free)?;
        Some(index.site(column as i64, row as i64))
    }

    /// A chunk with a hub near the eastern or southern edge of the level.
    fn chunk_for_exit(&self) -> Option<ChunkIndex> {
        let Extent::Cells { columns, rows } = self.extent else { return None };
        let mut random = generator(self.terrain.seed(), Purpose::Exit, 0, 0);
        let chunks = |side: u32| (side as usize).div_ceil(CHUNK_SIDE);
        let (columns, rows) = (chunks(columns), chunks(rows));
        let (across, down) = (random.below(columns), random.below(rows));
        let is_in_the_east = random.one_in(2);
        let places = (1..=columns.min(2)).flat_map(|from_east| {
            (1..=rows.min(2)).flat_map(move |from_south| {
                let (last_column, last_row) = (columns - from_east, rows - from_south);
                let on_edge = if is_in_the_east {
                    (last_column, down.min(last_row))
                } else {
                    (across.min(last_column), last_row)
                };
                [on_edge, (last_column, last_row)]
            })
        });
        let index = |(column, row)| ChunkIndex { column: column as i64, row: row as i64 };
        places.map(index).find(|&index| self.terrain.hub(&self.extent.area(index)).is_some())
    }
}

/// Two levels are equal if they come from the same call of [`GeneratedLevel::new`].
impl PartialEq for GeneratedLevel {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.tileset, &other.tileset)
    }
}

/// A built-in generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Generator {
    /// Passages one cell wide, with some halls.
    Maze,
    /// Caverns and tunnels.
    Cave,
    /// Rooms, doors, glass and corridors.
    Office,
}

impl Generator {
    /// All generators.
    pub const ALL: [Self; 3] = [Self::Maze, Self::Cave, Self::Office];

    /// The name of the generator on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maze => "maze",
            Self::Cave => "cave",
            Self::Office => "office",
        }
    }

    /// The generator called `name`.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|generator| generator.name() == name)
    }

    /// The generator's terrain for a seed.
    pub fn terrain(self, seed: u64) -> Arc<dyn Terrain> {
        match self {
            Self::Maze => Arc::new(Maze { seed }),
            Self::Cave => Arc::new(Cave { seed }),
            Self::Office => Arc::new(Office { seed }),
        }
    }

    /// The generator's level with this seed and extent.
    ///
    /// # Errors
    /// None in practice: the tests read the legend of every generator.
    pub fn level(self, seed: u64, extent: Extent) -> Result<GeneratedLevel, Faults> {
        GeneratedLevel::new(self.terrain(seed), extent)
    }
}

#[cfg(test)]
mod tests;
