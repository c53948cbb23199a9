//! Random decisions about a level. Each is a function of the seed, the purpose of the decision, and
//! a position.
//!
//! Everything is computed with integers, so a generated level is the same on every machine and in
//! every later version. Tests pin the numbers.

use crate::rng::{self, SplitMix64};

/// The purpose of a decision. Each purpose has its own random numbers, so decisions are independent
/// of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The layout of a chunk.
    Plan = 1,
    /// The passage to the chunk in the north.
    NorthPassage = 2,
    /// The passage to the chunk in the west.
    WestPassage = 3,
    /// The look of a district.
    District = 4,
    /// The initial rock in a cell.
    Rock = 5,
    /// The furniture.
    Furniture = 6,
    /// The hub of a chunk.
    Hub = 7,
    /// The initial dry ground in a cell.
    Dry = 9,
    /// The position of the exit.
    Exit = 8,
    /// The position of the start.
    Start = 10,
    /// The level of a descent's floor.
    Floor = 11,
    /// The guards and items of a descent's floor.
    Population = 12,
}

/// A hash that looks random, determined by a seed, a purpose and a position.
pub(crate) fn hash(seed: u64, purpose: Purpose, column: i64, row: i64) -> u64 {
    rng::hash(seed, [purpose as u64, column as u64, row as u64])
}

/// A random number generator, determined by a seed, a purpose and a position.
pub(crate) fn generator(seed: u64, purpose: Purpose, column: i64, row: i64) -> SplitMix64 {
    SplitMix64::new(hash(seed, purpose, column, row))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_same_on_every_machine() {
        let numbers = [
            hash(0, Purpose::Plan, 0, 0),
            hash(7, Purpose::Rock, 1_000_000_000, -1_000_000_000),
            hash(u64::MAX, Purpose::Hub, i64::MIN, i64::MAX),
        ];
        insta::assert_snapshot!(numbers.map(|number| format!("{number:016x}")).join(" "), @"b2db672e8f70d7ff 30a9b53430236bf9 4ba6d1388998120a");
        let mut random = generator(7, Purpose::Plan, -3, 5);
        assert_eq!([(); 8].map(|()| random.below(100)), [35, 57, 88, 99, 17, 48, 0, 67]);
    }

    #[test]
    fn neighbours_purposes_and_seeds_give_unrelated_hashes() {
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
}
