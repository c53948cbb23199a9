//! Distances over the cells of a grid from one cell, in order of distance.
//!
//! A straight step to a neighbour costs [`STRAIGHT`] and a diagonal step [`DIAGONAL`], both in half
//! cells: at most 6 % off the true length of a diagonal. Distances are whole numbers, so cells are
//! sorted into one bucket for each distance (R. B. Dial, "Algorithm 360: Shortest-Path Forest with
//! Topological Ordering", 1969). The search can stop after any number of cells and continue later.
//! Rejected: a binary heap. It costs a logarithm for each cell, and produces the same order.
//!
//! Each distance is stored with the number of the search that found it, so a new search need not
//! clear the distances of the previous one.

use std::array;
use std::iter::successors;

use serde::ser::SerializeSeq;
use serde::{Deserialize, Serialize, Serializer};

use crate::world::Cell;

/// The cost of a step to the north, east, south or west, in half cells.
pub(crate) const STRAIGHT: u16 = 2;
/// The cost of a step to a diagonal neighbour, in half cells.
pub(crate) const DIAGONAL: u16 = 3;
/// The largest cost of one step.
const MAX_COST: u16 = 15;

/// One bucket for each distance that may still be open.
const BUCKETS: usize = MAX_COST as usize + 1;
/// The number of columns and rows that a search covers on each side of its start.
const REACH: u32 = 160;

/// The offsets in columns and rows from a cell to its neighbours, clockwise from the north.
/// Straight neighbours have even indices.
const NEIGHBORS: [(i32, i32); 8] =
    [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1)];

/// The costs of steps in a search.
pub(crate) trait Costs {
    /// Data shared by all steps found from one cell.
    type Origin;

    /// The data shared by the steps found from `cell`.
    fn origin(&self, cell: Cell) -> Self::Origin;

    /// The cost of a straight step between neighbours, found from `from` to `to`, at most
    /// [`MAX_COST`]; `None` if the step is impossible.
    fn straight(&self, from: &Self::Origin, to: Cell) -> Option<u16>;

    /// Whether there is a diagonal step between `from` and `to`. `beside` tells for each of the two
    /// cells that it passes whether a straight step leads there from `from`.
    fn has_diagonal(&self, from: &Self::Origin, to: Cell, beside: [bool; 2]) -> bool;
}

/// A search. Two searches are equal if they have found the same distances and continue in the same
/// way. Data left over from previous searches does not count.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(try_from = "StoredDistances")]
pub(crate) struct Distances {
    /// The north-west cell, and the columns and rows.
    first: (u32, u32),
    size: (u32, u32),
    /// The number of the search in the upper half, the distance in the lower half.
    cells: Vec<u32>,
    search: u16,
    buckets: Buckets<BUCKETS>,
    /// All cells nearer than this have their final distance.
    distance: u16,
}

impl Distances {
    /// Begins a search from `start`, in a map with `map` columns and rows.
    pub(crate) fn begin(&mut self, start: Cell, map: (u32, u32)) {
        (self.first, self.size) = window(start, map);
        let count = self.size.0 as usize * self.size.1 as usize;
        self.search = self.search.wrapping_add(1);
        if self.search == 0 || self.cells.len() != count {
            self.cells.clear();
            self.cells.resize(count, 0);
            self.search = 1;
        }
        self.buckets.clear();
        self.distance = 0;
        self.offer(start, 0);
    }

    /// Whether the search is around `start`, in a map with `map` columns and rows.
    pub(crate) fn is_around(&self, start: Cell, map: (u32, u32)) -> bool {
        (self.first, self.size) == window(start, map)
    }

    /// Whether the search has found all reachable cells.
    pub(crate) fn is_over(&self) -> bool {
        self.buckets.is_empty()
    }

    /// All cells nearer than this have been found.
    pub(crate) fn radius(&self) -> u16 {
        if self.is_over() { u16::MAX } else { self.distance }
    }

    /// The distance of `cell` from the start, in half cells; `None` if it has not been found yet.
    pub(crate) fn distance(&self, cell: Cell) -> Option<u16> {
        self.known(cell).filter(|&distance| distance < self.radius())
    }

    /// Continues the search by one cell. Returns whether there was one.
    pub(crate) fn advance(&mut self, costs: &impl Costs) -> bool {
        while !self.buckets.is_empty() {
            let Some(cell) = self.buckets.pop(usize::from(self.distance) % BUCKETS) else {
                self.distance += 1;
                continue;
            };
            if self.known(cell) == Some(self.distance) {
                self.spread(cell, costs);
                return true;
            }
        }
        false
    }

    /// Offers the neighbours of `cell` their distances.
    fn spread(&mut self, cell: Cell, costs: &impl Costs) {
        let origin = costs.origin(cell);
        let mut is_open = [false; 4];
        for (side, open) in is_open.iter_mut().enumerate() {
            let Some(to) = self.neighbor(cell, side * 2) else { continue };
            if let Some(cost) = costs.straight(&origin, to) {
                *open = true;
                self.offer(to, self.distance.saturating_add(cost.min(MAX_COST)));
            }
        }
        for side in 0..4 {
            let beside = [is_open[side], is_open[(side + 1) % 4]];
            let Some(to) = self.neighbor(cell, side * 2 + 1) else { continue };
            let distance = self.distance.saturating_add(DIAGONAL);
            let is_farther = self.known(to).is_some_and(|known| known <= distance);
            if !is_farther && costs.has_diagonal(&origin, to, beside) {
                self.offer(to, distance);
            }
        }
    }

    fn offer(&mut self, cell: Cell, distance: u16) {
        let is_farther = self.known(cell).is_some_and(|known| known <= distance);
        let Some(place) = self.place(cell).filter(|_| !is_farther && distance < u16::MAX) else {
            return;
        };
        self.cells[place] = u32::from(self.search) << 16 | u32::from(distance);
        self.buckets.push(usize::from(distance) % BUCKETS, cell);
    }

    fn known(&self, cell: Cell) -> Option<u16> {
        self.known_at(self.place(cell)?)
    }

    /// The distance of the cell at an index of the list, if it has been found.
    fn known_at(&self, place: usize) -> Option<u16> {
        self.distance_in(self.cells[place])
    }

    fn distance_in(&self, entry: u32) -> Option<u16> {
        (entry >> 16 == u32::from(self.search)).then_some(entry as u16)
    }

    fn neighbor(&self, cell: Cell, side: usize) -> Option<Cell> {
        neighbor(cell, side).filter(|&cell| self.place(cell).is_some())
    }

    fn place(&self, cell: Cell) -> Option<usize> {
        let column = cell.column.wrapping_sub(self.first.0);
        let row = cell.row.wrapping_sub(self.first.1);
        let is_inside = column < self.size.0 && row < self.size.1;
        is_inside.then(|| row as usize * self.size.0 as usize + column as usize)
    }
}

impl PartialEq for Distances {
    fn eq(&self, other: &Self) -> bool {
        let knows_the_same = || {
            let mut places = 0..self.cells.len();
            places.all(|place| self.known_at(place) == other.known_at(place))
        };
        (self.first, self.size, self.distance) == (other.first, other.size, other.distance)
            && self.buckets == other.buckets
            && self.cells.len() == other.cells.len()
            && ((self.search, &self.cells) == (other.search, &other.cells) || knows_the_same())
    }
}

/// A search in stored form.
#[derive(Deserialize)]
struct StoredDistances {
    first: (u32, u32),
    size: (u32, u32),
    distance: u16,
    /// Run lengths and differences, row by row. An even number is twice the count of adjacent cells
    /// without a distance. An odd number is twice the difference to the last known distance, plus
    /// 1, with the difference mapped to 0, −1, 1, −2, ….
    changes: Vec<u32>,
    /// The cells in each bucket, in the order in which they are taken out.
    waiting: [Vec<Cell>; BUCKETS],
}

impl Serialize for Distances {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self { first, size, cells, search: _, buckets, distance } = self;
        let are_unknown = |&one: &u32, &next: &u32| {
            self.distance_in(one).is_none() && self.distance_in(next).is_none()
        };
        let changes = cells.chunk_by(are_unknown).scan(0, |last, cells| {
            let Some(known) = self.distance_in(cells[0]) else {
                return Some((cells.len() as u32) << 1);
            };
            let change = i32::from(known) - *last;
            *last = known.into();
            Some(((change << 1 ^ change >> 31) as u32) << 1 | 1)
        });
        let waiting: [_; BUCKETS] = array::from_fn(|bucket| List(buckets.cells(bucket)));
        (first, size, distance, List(changes), waiting).serialize(to)
    }
}

impl TryFrom<StoredDistances> for Distances {
    type Error = &'static str;

    fn try_from(stored: StoredDistances) -> Result<Self, &'static str> {
        let StoredDistances { first, size, distance, changes, waiting } = stored;
        let most = u64::from(2 * REACH + 1).pow(2);
        let count = u64::from(size.0).checked_mul(size.1.into()).filter(|&count| count <= most);
        let count = count.ok_or("the size of a search")? as usize;
        let mut cells = Vec::with_capacity(count);
        let mut last = 0;
        for change in changes {
            let (is_known, change) = (change & 1 == 1, change >> 1);
            if !is_known && change as usize <= count - cells.len() {
                cells.resize(cells.len() + change as usize, 0);
                continue;
            }
            last += (change >> 1) as i32 ^ -((change & 1) as i32);
            let is_possible = is_known && (0..i32::from(u16::MAX)).contains(&last);
            if !is_possible || cells.len() == count {
                return Err("a distance of a search");
            }
            cells.push(1 << 16 | last as u32);
        }
        if cells.len() != count {
            return Err("the cells of a search");
        }
        let mut search =
            Self { first, size, cells, search: 1, buckets: Buckets::default(), distance };
        search.buckets.clear();
        let next = usize::from(distance);
        for (bucket, waiting) in waiting.into_iter().enumerate() {
            let distance = next + (bucket + BUCKETS - next % BUCKETS) % BUCKETS;
            let is_possible = waiting.is_empty() || distance < usize::from(u16::MAX);
            if !is_possible || !waiting.iter().all(|&cell| search.place(cell).is_some()) {
                return Err("a cell of a search");
            }
            waiting.into_iter().rev().for_each(|cell| search.buckets.push(bucket, cell));
        }
        Ok(search)
    }
}

/// Values that are serialized as a list.
struct List<I>(I);

impl<I: Iterator<Item: Serialize> + Clone> Serialize for List<I> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut list = to.serialize_seq(Some(self.0.clone().count()))?;
        self.0.clone().try_for_each(|value| list.serialize_element(&value))?;
        list.end()
    }
}

/// The first cell of a search from `start` in a map with these numbers of columns and rows, and the
/// columns and rows that the search covers.
fn window(start: Cell, (columns, rows): (u32, u32)) -> ((u32, u32), (u32, u32)) {
    let along = |place: u32, count: u32| {
        let first = place.saturating_sub(REACH);
        (first, (place + REACH + 1).min(count).saturating_sub(first))
    };
    let (left, width) = along(start.column, columns);
    let (top, height) = along(start.row, rows);
    ((left, top), (width, height))
}

/// The neighbour of `cell` at that index of [`NEIGHBORS`]; `None` if a coordinate is negative.
pub(crate) fn neighbor(cell: Cell, side: usize) -> Option<Cell> {
    let (columns, rows) = NEIGHBORS[side];
    let column = cell.column.checked_add_signed(columns)?;
    Some(Cell { column, row: cell.row.checked_add_signed(rows)? })
}

/// The number of cells for which a search reserves memory when it first begins.
const RESERVED: usize = 512;
/// The end of a list.
const NONE: u32 = u32::MAX;

/// `COUNT` buckets of cells. Each bucket is a stack: the last cell put in is the first taken out.
/// Buckets are equal if they contain the same cells in the same order.
///
/// All buckets are linked lists in one vector, which grows to the largest number of cells that ever
/// waited at once. Rejected: a vector for each bucket. Each would grow separately, and guards who
/// had walked for a minute still allocated memory.
#[derive(Clone, Debug)]
struct Buckets<const COUNT: usize> {
    entries: Vec<BucketEntry>,
    /// The last entry of each bucket.
    tops: [u32; COUNT],
    /// The first of the entries that are in no bucket.
    free: u32,
    /// The number of cells in all buckets.
    count: usize,
}

#[derive(Clone, Copy, Debug)]
struct BucketEntry {
    cell: Cell,
    /// The entry below this one in its bucket.
    below: u32,
}

impl<const COUNT: usize> Buckets<COUNT> {
    /// Removes all cells.
    fn clear(&mut self) {
        self.entries.clear();
        self.entries.reserve(RESERVED);
        (self.tops, self.free, self.count) = ([NONE; COUNT], NONE, 0);
    }

    /// Whether all buckets are empty.
    fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The cells in a bucket, in the order in which they are taken out.
    fn cells(&self, bucket: usize) -> impl Iterator<Item = Cell> + Clone {
        let entry = |place: u32| self.entries.get(place as usize);
        let entries = successors(entry(self.tops[bucket]), move |above| entry(above.below));
        entries.map(|entry| entry.cell)
    }

    /// Puts a cell into a bucket.
    fn push(&mut self, bucket: usize, cell: Cell) {
        let entry = BucketEntry { cell, below: self.tops[bucket] };
        let place = if let Some(free) = self.entries.get_mut(self.free as usize) {
            let place = self.free;
            self.free = free.below;
            *free = entry;
            place
        } else {
            self.entries.push(entry);
            self.entries.len() as u32 - 1
        };
        self.tops[bucket] = place;
        self.count += 1;
    }

    /// Takes a cell out of a bucket.
    fn pop(&mut self, bucket: usize) -> Option<Cell> {
        let top = self.tops[bucket];
        let entry = self.entries.get_mut(top as usize)?;
        self.tops[bucket] = entry.below;
        (entry.below, self.free) = (self.free, top);
        self.count -= 1;
        Some(entry.cell)
    }
}

impl<const COUNT: usize> PartialEq for Buckets<COUNT> {
    fn eq(&self, other: &Self) -> bool {
        self.count == other.count
            && (0..COUNT).all(|bucket| self.cells(bucket).eq(other.cells(bucket)))
    }
}

impl<const COUNT: usize> Default for Buckets<COUNT> {
    fn default() -> Self {
        Self { entries: Vec::new(), tops: [NONE; COUNT], free: NONE, count: 0 }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SIDE: u32 = 9;

    /// A grid in which some cells are open, all at the same cost.
    struct Open(Vec<bool>);

    impl Open {
        fn at(&self, cell: Cell) -> bool {
            cell.column < SIDE
                && cell.row < SIDE
                && self.0[(cell.row * SIDE + cell.column) as usize]
        }
    }

    impl Costs for Open {
        type Origin = ();

        fn origin(&self, _: Cell) {}

        fn straight(&self, (): &(), to: Cell) -> Option<u16> {
            self.at(to).then_some(STRAIGHT)
        }

        fn has_diagonal(&self, (): &(), to: Cell, beside: [bool; 2]) -> bool {
            self.at(to) && beside == [true, true]
        }
    }

    /// The distances, computed by relaxing all cells until nothing changes.
    fn by_relaxation(open: &Open, start: Cell) -> Vec<Option<u16>> {
        let cells = || (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| Cell { column, row }));
        let place = |cell: Cell| (cell.row * SIDE + cell.column) as usize;
        let mut found = vec![None; (SIDE * SIDE) as usize];
        found[place(start)] = Some(0);
        loop {
            let before = found.clone();
            for (cell, side) in cells().flat_map(|cell| (0..8).map(move |side| (cell, side))) {
                let Some(to) = neighbor(cell, side).filter(|&to| open.at(to)) else { continue };
                let Some(distance) = found[place(cell)] else { continue };
                let is_beside =
                    |side: usize| neighbor(cell, side % 8).is_some_and(|beside| open.at(beside));
                let is_straight = side.is_multiple_of(2);
                let is_passable = is_straight || is_beside(side + 7) && is_beside(side + 1);
                if !is_passable {
                    continue;
                }
                let next = distance + if is_straight { STRAIGHT } else { DIAGONAL };
                let known: &mut Option<u16> = &mut found[place(to)];
                *known = Some(known.map_or(next, |known| known.min(next)));
            }
            if found == before {
                return found;
            }
        }
    }

    proptest! {
        #[test]
        fn distances_are_shortest_however_often_the_search_stops(
            open in prop::collection::vec(prop::bool::weighted(0.7), (SIDE * SIDE) as usize),
            starts in prop::collection::vec((0..SIDE, 0..SIDE), 1..4),
        ) {
            let open = Open(open);
            let mut search = Distances::default();
            for (column, row) in starts {
                let start = Cell { column, row };
                let expected = by_relaxation(&open, start);
                search.begin(start, (SIDE, SIDE));
                loop {
                    for (place, &expected) in expected.iter().enumerate() {
                        let (row, column) = (place as u32 / SIDE, place as u32 % SIDE);
                        let found = search.distance(Cell { column, row });
                        let is_near = expected.is_some_and(|it| it < search.radius());
                        prop_assert_eq!(found, expected.filter(|_| is_near));
                    }
                    if !search.advance(&open) {
                        break;
                    }
                }
                prop_assert!(search.is_over());
            }
        }
    }

    proptest! {
        #[test]
        fn each_bucket_is_a_stack(changes: Vec<(bool, bool, u32)>) {
            let mut buckets = Buckets::<2>::default();
            let mut stacks = [Vec::new(), Vec::new()];
            for (puts, second, column) in changes {
                let (bucket, cell) = (usize::from(second), Cell { column, row: 0 });
                if puts {
                    buckets.push(bucket, cell);
                    stacks[bucket].push(cell);
                } else {
                    prop_assert_eq!(buckets.pop(bucket), stacks[bucket].pop());
                }
                prop_assert_eq!(buckets.is_empty(), stacks.iter().all(Vec::is_empty));
            }
        }
    }
}
