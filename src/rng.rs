//! Seeded chance: the same seed, the same rays, on every machine.
//!
//! The generator is splitmix64 (Steele, Lea and Flood, 2014). A crate for it was refused: these are
//! ten lines, and they never change.

/// A sequence of numbers that only its seed determines.
#[derive(Clone, Debug)]
pub struct Chance {
    state: u64,
}

impl Chance {
    /// The sequence of `seed`.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number from `low` up to `high`, a multiple of 2⁻⁵³ of their distance.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * share
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: i32, high: i32) -> f64 {
        let count = i64::from(high) - i64::from(low) + 1;
        let offset = self.bits() % count.max(1) as u64;
        (i64::from(low) + offset as i64) as f64
    }

    /// Any finite double, all exponents alike.
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
}
