//! A level: a terrain, how much of it there is, and the way out.

use std::sync::Arc;

use super::chunk::{CHUNK_SIDE, Chunk, ChunkIndex, Extent, Site};
use super::hash::{Chance, Purpose};
use super::kit::{Kit, ROCK};
use super::{Generator, Terrain};
use crate::fault::Faults;

/// A level that is dug where somebody is.
#[derive(Clone, Debug)]
pub struct Level {
    terrain: Arc<dyn Terrain>,
    kit: Arc<Kit>,
    extent: Extent,
    exit: Option<Site>,
}

impl Level {
    /// The level that `terrain` makes of `extent`. One with an end has an exit.
    ///
    /// # Errors
    /// Everything that is wrong with the terrain's legend.
    pub fn new(terrain: Arc<dyn Terrain>, extent: Extent) -> Result<Self, Faults> {
        let kit = Arc::new(Kit::of(&terrain.legend())?);
        let endless = Self { terrain, kit, extent, exit: None };
        let exit = endless.place_for_exit();
        Ok(Self { exit, ..endless })
    }

    /// How large it is.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// Where one starts, in the chunk at home. `None` where a terrain has made nowhere to stand there.
    pub fn start(&self) -> Option<Site> {
        self.start_near(Site::default())
    }

    /// Where one starts who wants to start at `site`: there, if one can get away from it, or else at
    /// the hub of its chunk. `None` where that has none, as outside the level.
    pub fn start_near(&self, site: Site) -> Option<Site> {
        let (index, place) = site.chunk();
        let hub = self.terrain.hub(&self.extent.plot(index))?;
        let chunk = self.chunk(index);
        let is_connected = self.walk(&chunk, hub).contains(&place);
        let (column, row) = if is_connected { place } else { hub };
        Some(index.site(column as i64, row as i64))
    }

    /// Where the way out is; `None` of a level without an end.
    pub fn exit(&self) -> Option<Site> {
        self.exit
    }

    /// A chunk of it.
    pub fn chunk(&self, index: ChunkIndex) -> Chunk {
        let mut chunk = self.without_exit(index);
        if let Some((chunk_of_exit, (column, row))) = self.exit.map(Site::chunk)
            && chunk_of_exit == index
            && let Some(exit) = self.kit.exit_on(chunk.get(column, row))
        {
            chunk.set(column, row, exit);
        }
        chunk
    }

    pub(super) fn kit(&self) -> &Kit {
        &self.kit
    }

    fn without_exit(&self, index: ChunkIndex) -> Chunk {
        let plot = self.extent.plot(index);
        if plot.is_empty() {
            return Chunk::full_of(ROCK);
        }
        let mut chunk = self.terrain.chunk(&plot);
        chunk.clip(&plot, ROCK);
        chunk
    }

    /// The cells of a chunk that one gets to from `start` without leaving it, the nearest first.
    fn walk(&self, chunk: &Chunk, start: (usize, usize)) -> Vec<(usize, usize)> {
        chunk.reachable(start, |character| self.kit.is_walkable(character))
    }

    /// A cell far from home, and as far from the hub of its chunk as one can be in that.
    fn place_for_exit(&self) -> Option<Site> {
        let index = self.chunk_for_exit()?;
        let hub = self.terrain.hub(&self.extent.plot(index))?;
        let chunk = self.without_exit(index);
        let is_free = |&&(column, row): &&(usize, usize)| {
            (column, row) != hub && self.kit.is_bare(chunk.get(column, row))
        };
        let reachable = self.walk(&chunk, hub);
        let &(column, row) = reachable.iter().rev().find(is_free)?;
        Some(index.site(column as i64, row as i64))
    }

    /// A chunk with a hub at the eastern or the southern end.
    fn chunk_for_exit(&self) -> Option<ChunkIndex> {
        let Extent::Cells { columns, rows } = self.extent else { return None };
        let mut chance = Chance::of(self.terrain.seed(), Purpose::Exit, 0, 0);
        let chunks = |side: u32| (side as usize).div_ceil(CHUNK_SIDE);
        let (columns, rows) = (chunks(columns), chunks(rows));
        let (across, down) = (chance.below(columns), chance.below(rows));
        let is_in_the_east = chance.one_in(2);
        // The outermost chunks may be too narrow to have one.
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
        places.map(index).find(|&index| self.terrain.hub(&self.extent.plot(index)).is_some())
    }
}

impl Generator {
    /// The level of that extent that it makes of a seed.
    ///
    /// # Errors
    /// None: the tests read the legend of every generator.
    pub fn level(self, seed: u64, extent: Extent) -> Result<Level, Faults> {
        Level::new(self.terrain(seed), extent)
    }
}

/// Two levels are equal that come from one call of [`Level::new`].
impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.kit, &other.kit)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeSet, VecDeque};

    use proptest::prelude::*;

    use super::*;

    fn generator() -> impl Strategy<Value = Generator> {
        prop::sample::select(&Generator::ALL)
    }

    /// A square of chunks, as one drawing.
    struct Drawing {
        level: Level,
        chunks: Vec<Chunk>,
        side: usize,
    }

    impl Drawing {
        fn of(level: Level, first: ChunkIndex, side: usize) -> Self {
            let places = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
            let chunks = places
                .map(|(column, row)| level.chunk(first.offset(column as i64, row as i64)))
                .collect();
            Self { level, chunks, side }
        }

        fn get(&self, column: usize, row: usize) -> Option<u8> {
            let is_inside = column.max(row) < self.side * CHUNK_SIDE;
            let index = row / CHUNK_SIDE * self.side + column / CHUNK_SIDE;
            is_inside.then(|| self.chunks[index].get(column % CHUNK_SIDE, row % CHUNK_SIDE))
        }

        fn is_walkable(&self, column: usize, row: usize) -> bool {
            self.get(column, row).is_some_and(|character| self.level.kit.is_walkable(character))
        }

        fn reachable(&self, start: (usize, usize)) -> BTreeSet<(usize, usize)> {
            let mut seen = BTreeSet::from([start]);
            let mut queue = VecDeque::from([start]);
            while let Some((column, row)) = queue.pop_front() {
                for (across, down) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
                    let place = (column.wrapping_add_signed(across), row.wrapping_add_signed(down));
                    if self.is_walkable(place.0, place.1) && seen.insert(place) {
                        queue.push_back(place);
                    }
                }
            }
            seen
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn there_is_a_way_out(
            generator in generator(),
            seed: u64,
            columns in prop_oneof![8_u32..40, 60_u32..100],
            rows in prop_oneof![8_u32..40, 60_u32..100],
        ) {
            let level = generator.level(seed, Extent::new(columns, rows).unwrap()).unwrap();
            let start = level.start().unwrap();
            let exit = level.exit().unwrap();
            let drawing = Drawing::of(level.clone(), ChunkIndex::default(), 4);
            let cell = |site: Site| (site.column as usize, site.row as usize);
            prop_assert!(drawing.reachable(cell(start)).contains(&cell(exit)));
            prop_assert_ne!(start, exit);
            let exits = drawing.chunks.iter().flat_map(|chunk| (0..CHUNK_SIDE).map(|row| chunk.row(row)));
            let exits = exits.flatten().filter(|&&character| level.kit.is_exit(character)).count();
            prop_assert_eq!(exits, 1);
            for along in 0..4 * CHUNK_SIDE {
                for (column, row) in [
                    (0, along),
                    (along, 0),
                    (columns as usize - 1, along),
                    (along, rows as usize - 1),
                ] {
                    prop_assert!(!drawing.is_walkable(column, row), "{column}, {row}");
                }
            }
        }

        #[test]
        fn all_hubs_are_connected_with_their_neighbours(
            generator in generator(),
            seed: u64,
            column in prop_oneof![-5_i64..5, Just(31_250_000_i64), Just(i64::MAX >> 5), any::<i64>()],
            row in prop_oneof![-5_i64..5, Just(-31_250_000_i64), Just(i64::MIN >> 5), any::<i64>()],
        ) {
            let first = Site { column, row }.chunk().0;
            let level = generator.level(seed, Extent::Endless).unwrap();
            let hub = |column: usize, row: usize| {
                let index = first.offset(column as i64, row as i64);
                let (x, y) = level.terrain.hub(&level.extent.plot(index)).unwrap();
                (column * CHUNK_SIDE + x, row * CHUNK_SIDE + y)
            };
            let drawing = Drawing::of(level.clone(), first, 2);
            let reachable = drawing.reachable(hub(0, 0));
            for (column, row) in [(1, 0), (0, 1), (1, 1)] {
                prop_assert!(reachable.contains(&hub(column, row)), "{column}, {row}");
            }
        }

        #[test]
        fn doors_stand_between_walls_and_open_floor(
            generator in generator(),
            seed: u64,
            extent in prop_oneof![
                Just(Extent::Endless),
                (8_u32..90, 8_u32..90)
                    .prop_map(|(columns, rows)| Extent::new(columns, rows).unwrap()),
            ],
        ) {
            let level = generator.level(seed, extent).unwrap();
            let drawing = Drawing::of(level, ChunkIndex::default(), 3);
            let inside = 1..3 * CHUNK_SIDE - 1;
            let cells = inside.clone().flat_map(|row| inside.clone().map(move |column| (column, row)));
            let is_door = |(column, row): &(usize, usize)| {
                matches!(drawing.get(*column, *row), Some(b'+' | b'='))
            };
            for (column, row) in cells.filter(is_door) {
                let is_open = |column, row| drawing.is_walkable(column, row);
                let across = [is_open(column - 1, row), is_open(column + 1, row)];
                let down = [is_open(column, row - 1), is_open(column, row + 1)];
                let stands = across != down && across[0] == across[1] && down[0] == down[1];
                prop_assert!(stands, "the door at {column}, {row}");
            }
        }
    }

    #[test]
    fn every_legend_is_a_map_with_an_exit() {
        for generator in Generator::ALL {
            let kit = Kit::of(&generator.terrain(7).legend()).unwrap();
            assert!(kit.exit_on(b'.').is_some_and(|exit| kit.is_walkable(exit)));
            assert!(!kit.is_walkable(ROCK) && kit.is_walkable(b'.'));
        }
    }

    #[test]
    fn every_character_of_a_chunk_is_in_the_legend() {
        for generator in Generator::ALL {
            let legend = generator.terrain(7).legend();
            let level = generator.level(7, Extent::Endless).unwrap();
            let known: BTreeSet<u8> =
                crate::map::rows_of_grid(&legend).iter().flat_map(|row| row.bytes()).collect();
            let drawing = Drawing::of(level, ChunkIndex::default(), 6);
            let rows =
                drawing.chunks.iter().flat_map(|chunk| (0..CHUNK_SIDE).map(|row| chunk.row(row)));
            let drawn: BTreeSet<u8> = rows.flatten().copied().collect();
            assert!(drawn.is_subset(&known), "{generator:?}: {drawn:?} of {known:?}");
        }
    }
}
