//! Searches as bytes: the distances row by row as differences, and the cells that wait.

use super::{BUCKETS, Flood};
use crate::game::stored::{Reader, Stored, Unrestorable, Writer, check};
use crate::world::Cell;

impl Flood {
    /// Appends a search that has begun.
    pub(crate) fn write(&self, out: &mut Writer) {
        let Self { first: _, size: _, cells, search: _, buckets, distance } = self;
        distance.write(out);
        let (mut last, mut unknown) = (0, 0);
        let leave_out = |count: &mut u64, out: &mut Writer| {
            if *count > 0 {
                out.number(*count << 1);
            }
            *count = 0;
        };
        for place in 0..cells.len() {
            if let Some(known) = self.known_at(place) {
                leave_out(&mut unknown, out);
                let change = i32::from(known) - i32::from(last);
                out.number(u64::from((change << 1 ^ change >> 31) as u32) << 1 | 1);
                last = known;
            } else {
                unknown += 1;
            }
        }
        leave_out(&mut unknown, out);
        for bucket in 0..BUCKETS {
            let waiting = buckets.cells(bucket);
            waiting.write(out);
        }
    }

    /// Reads a search from `start`.
    pub(crate) fn read(start: Cell, input: &mut Reader) -> Result<Self, Unrestorable> {
        let mut flood = Self::default();
        flood.begin(start, input.size());
        flood.buckets.clear();
        flood.distance = Stored::read(input)?;
        flood.read_distances(input)?;
        let next = usize::from(flood.distance);
        for bucket in 0..BUCKETS {
            let waiting: Vec<Cell> = Stored::read(input)?;
            let distance = next + (bucket + BUCKETS - next % BUCKETS) % BUCKETS;
            let is_possible = waiting.is_empty() || distance < usize::from(u16::MAX);
            let is_inside = waiting.iter().all(|&cell| flood.place(cell).is_some());
            check(is_possible && is_inside, "a cell of a search")?;
            for cell in waiting {
                flood.buckets.push(bucket, cell);
            }
        }
        Ok(flood)
    }

    fn read_distances(&mut self, input: &mut Reader) -> Result<(), Unrestorable> {
        const WHAT: &str = "a distance of a search";
        self.cells.fill(0);
        let (mut place, mut last) = (0, 0_i64);
        while place < self.cells.len() {
            let number = input.number()?;
            if number & 1 == 0 {
                let left = (self.cells.len() - place) as u64;
                check((1..=left).contains(&(number >> 1)), WHAT)?;
                place += (number >> 1) as usize;
                continue;
            }
            let change = number >> 1;
            check(change <= u64::from(u16::MAX) << 1, WHAT)?;
            last += (change >> 1) as i64 ^ -((change & 1) as i64);
            check((0..i64::from(u16::MAX)).contains(&last), WHAT)?;
            self.cells[place] = u32::from(self.search) << 16 | last as u32;
            place += 1;
        }
        Ok(())
    }

    /// What is known of the cell at a place of the list.
    pub(crate) fn known_at(&self, place: usize) -> Option<u16> {
        let entry = self.cells[place];
        (entry >> 16 == u32::from(self.search)).then_some(entry as u16)
    }
}

impl PartialEq for Flood {
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
