//! Random numbers from a seed. The same seed yields the same numbers on every machine and in every
//! later version.
//!
//! The generator is [`SplitMix64`] (G. L. Steele Jr., D. Lea and C. H. Flood, "Fast Splittable
//! Pseudorandom Number Generators", 2014): a counter and a finalizer. The finalizer maps 64 bits
//! one to one, and each bit of its input changes half of the output bits on average.
//!
//! Rejected: a crate. The generator is ten lines that never change. Rejected: the standard
//! library's hasher, because it may change.

use serde::{Deserialize, Serialize};

/// A random number generator. The seed alone determines its output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "[u8; 8]", into = "[u8; 8]")]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// A generator with this seed.
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(INCREMENT);
        mixed(self.state)
    }

    /// A number in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number in [`low`, `high`): `low` plus a multiple of 2⁻⁵³ of the difference.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: i32, high: i32) -> f64 {
        let count = i64::from(high) - i64::from(low) + 1;
        let offset = self.bits() % count.max(1) as u64;
        (i64::from(low) + offset as i64) as f64
    }

    /// A finite double; all exponents are equally likely.
    pub fn double(&mut self) -> f64 {
        loop {
            let double = f64::from_bits(self.bits());
            if double.is_finite() {
                return double;
            }
        }
    }

    /// One of `choices`.
    pub fn pick<const N: usize>(&mut self, choices: [f64; N]) -> f64 {
        choices[(self.bits() % N.max(1) as u64) as usize]
    }

    /// A number below `count`, or 0 if `count` is 0. The probabilities differ by at most one part
    /// in 2³².
    pub fn below(&mut self, count: usize) -> usize {
        (((self.bits() >> 32) * count as u64) >> 32) as usize
    }

    /// `true` with a probability of one in `count`.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }
}

/// Restores a generator from the little-endian bytes of its state.
impl From<[u8; 8]> for SplitMix64 {
    fn from(state: [u8; 8]) -> Self {
        Self::new(u64::from_le_bytes(state))
    }
}

/// The state as little-endian bytes.
impl From<SplitMix64> for [u8; 8] {
    fn from(random: SplitMix64) -> Self {
        random.state.to_le_bytes()
    }
}

/// A pseudorandom number that depends only on `seed` and `words`.
pub fn hash(seed: u64, words: impl IntoIterator<Item = u64>) -> u64 {
    words.into_iter().fold(seed, |bits, word| mixed(bits.wrapping_add(INCREMENT) ^ mixed(word)))
}

/// 2^64 divided by the golden ratio, rounded to an odd number.
const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

/// David Stafford's finalizer "Mix13", which `SplitMix64` uses.
fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected numbers are the first three of the reference implementation for the seed
    /// 1234567.
    #[test]
    fn numbers_match_the_reference() {
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!(
            [(); 3].map(|()| random.bits()),
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn every_number_below_a_bound_is_equally_likely() {
        let mut random = SplitMix64::new(1);
        let mut counts = [0; 6];
        (0..6000).for_each(|_| counts[random.below(6)] += 1);
        assert!(counts.iter().all(|count| (900..1100).contains(count)), "{counts:?}");
    }
}
