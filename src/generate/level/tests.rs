//! Properties of every level: exits, connections and doors.

use std::collections::{BTreeSet, VecDeque};

use proptest::prelude::*;

use super::*;

fn generator() -> impl Strategy<Value = Generator> {
    prop::sample::select(&Generator::ALL)
}

/// A square of chunks, seen as one grid of cells.
struct Drawing {
    level: GeneratedLevel,
    chunks: Vec<Chunk>,
    side: usize,
}

impl Drawing {
    fn of(level: GeneratedLevel, first: ChunkIndex, side: usize) -> Self {
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
        self.get(column, row).is_some_and(|character| self.level.tileset.is_walkable(character))
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
    fn every_level_has_a_reachable_exit(
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
        let exits = exits.flatten().filter(|&&character| level.tileset.is_exit(character)).count();
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
    fn all_hubs_connect_to_their_neighbours(
        generator in generator(),
        seed: u64,
        column in prop_oneof![-5_i64..5, Just(31_250_000_i64), Just(i64::MAX >> 5), any::<i64>()],
        row in prop_oneof![-5_i64..5, Just(-31_250_000_i64), Just(i64::MIN >> 5), any::<i64>()],
    ) {
        let first = Site { column, row }.chunk().0;
        let level = generator.level(seed, Extent::Endless).unwrap();
        let hub = |column: usize, row: usize| {
            let index = first.offset(column as i64, row as i64);
            let (x, y) = level.terrain.hub(&level.extent.area(index)).unwrap();
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
        let tileset = Tileset::of(&generator.terrain(7).legend()).unwrap();
        assert!(tileset.exit_on(b'.').is_some_and(|exit| tileset.is_walkable(exit)));
        assert!(!tileset.is_walkable(ROCK) && tileset.is_walkable(b'.'));
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
