//! Chance that is the same every time: a function of a seed, of what it decides, and of a place.
//!
//! It is all integers: a finalizer of shifts and odd multiplications, which maps 64 bits one to one and
//! lets each bit of the input change half of the output, over a counter. What has been dug is
//! therefore the same on every machine, and in every later version: the numbers are held by tests.
//! The standard hasher was refused, as it promises neither.

/// What is being decided. Each has numbers of its own, so that no decision tells about another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// How a chunk is dug.
    Plan = 1,
    /// Where one passes to the chunk in the north.
    NorthPassage = 2,
    /// Where one passes to the chunk in the west.
    WestPassage = 3,
    /// How a district looks.
    District = 4,
    /// Whether there is rock in a cell at first.
    Rock = 5,
    /// What stands around.
    Furniture = 6,
    /// Where the middle of a chunk is.
    Hub = 7,
    /// Whether a cell is dry at first.
    Dry = 9,
    /// Where the way out is.
    Exit = 8,
    /// Where one starts.
    Start = 10,
}

/// A number that looks random, of a seed, a purpose and a place.
pub(super) fn hash(seed: u64, purpose: Purpose, column: i64, row: i64) -> u64 {
    [purpose as u64, column as u64, row as u64]
        .into_iter()
        .fold(seed, |bits, word| mixed(bits.wrapping_add(INCREMENT) ^ mixed(word)))
}

/// A series of numbers that look random.
#[derive(Clone, Debug)]
pub(super) struct Chance {
    state: u64,
}

impl Chance {
    /// The series of a seed, a purpose and a place.
    pub(super) fn of(seed: u64, purpose: Purpose, column: i64, row: i64) -> Self {
        Self { state: hash(seed, purpose, column, row) }
    }

    /// A number below `count`, which is not 0; all are equally likely, but for one part in 2^32.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((u64::from(self.next()) * count as u64) >> 32) as usize
    }

    /// Whether the one of `count` possible things happens.
    pub(super) fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn next(&mut self) -> u32 {
        self.state = self.state.wrapping_add(INCREMENT);
        (mixed(self.state) >> 32) as u32
    }
}

/// Odd, and without a pattern in its bits: 2^64 over the golden ratio.
const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_same_everywhere() {
        let numbers = [
            hash(0, Purpose::Plan, 0, 0),
            hash(7, Purpose::Rock, 1_000_000_000, -1_000_000_000),
            hash(u64::MAX, Purpose::Hub, i64::MIN, i64::MAX),
        ];
        insta::assert_snapshot!(numbers.map(|number| format!("{number:016x}")).join(" "), @"b2db672e8f70d7ff 30a9b53430236bf9 4ba6d1388998120a");
        let mut chance = Chance::of(7, Purpose::Plan, -3, 5);
        assert_eq!([(); 8].map(|()| chance.below(100)), [35, 57, 88, 99, 17, 48, 0, 67]);
    }

    #[test]
    fn a_neighbour_a_purpose_and_a_seed_tell_nothing_of_each_other() {
        let ones = |one: u64, other: u64| (one ^ other).count_ones();
        let mean = |pairs: &dyn Fn(i64) -> (u64, u64)| {
            (0..1000).map(pairs).map(|(one, other)| ones(one, other)).sum::<u32>() / 1000
        };
        let at = |column, row| hash(7, Purpose::Rock, column, row);
        for mean in [
            mean(&|index| (at(index, 0), at(index + 1, 0))),
            mean(&|index| (at(index, 9), at(9, index))),
            mean(&|index| (at(0, index), hash(8, Purpose::Rock, 0, index))),
            mean(&|index| (at(0, index), hash(7, Purpose::Plan, 0, index))),
        ] {
            assert!((30..=33).contains(&mean), "{mean} of 64 bits differ");
        }
    }

    #[test]
    fn chance_is_fair() {
        let mut chance = Chance::of(1, Purpose::Plan, 0, 0);
        let mut counts = [0; 6];
        (0..6000).for_each(|_| counts[chance.below(6)] += 1);
        assert!(counts.iter().all(|count| (900..1100).contains(count)), "{counts:?}");
    }
}
