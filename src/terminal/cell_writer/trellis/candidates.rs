//! The cheapest of all the ways that go past a cell.

use super::block::Told;
use super::{KEPT, StepKind, Ways};

/// The cheapest ways past a cell so far, no two of which lead to the same colours and the same place of
/// the cursor.
#[derive(Debug)]
pub(super) struct Candidates {
    pub(super) cost: [f32; KEPT],
    pub(super) turns: [Turn; KEPT],
    keys: [u64; KEPT],
    /// What costs no less than this is not kept.
    highest: f32,
    /// Which of them costs that.
    worst: usize,
}

/// What a way does about a cell, and in which of a block's colours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) kind: StepKind,
    pub(super) before: u8,
    pub(super) text: Told,
    pub(super) ground: Told,
}

impl Candidates {
    /// All that leave the cell as it is, for so many bytes.
    #[inline]
    pub(super) fn keeping(ways: &Ways, keep: f32) -> Self {
        let mut candidates = Self {
            cost: ways.cost.map(|cost| cost + keep),
            turns: std::array::from_fn(|way| Turn {
                kind: StepKind::Keep,
                before: way as u8,
                text: Told::None,
                ground: Told::None,
            }),
            keys: std::array::from_fn(|way| {
                key(ways.inks[way].map(|ink| ink.shade.in_bits()), ways.cursor[way])
            }),
            highest: 0.0,
            worst: 0,
        };
        candidates.find_worst();
        candidates
    }

    /// Whether a way of that cost would be kept.
    #[inline]
    pub(super) fn would_keep(&self, cost: f32) -> bool {
        cost < self.highest
    }

    /// Adds a way that is cheaper than the worst.
    #[inline]
    pub(super) fn add(&mut self, cost: f32, key: u64, turn: Turn) {
        let mut place = self.worst;
        for way in 0..KEPT {
            if self.keys[way] == key {
                place = way;
            }
        }
        if cost < self.cost[place] {
            self.cost[place] = cost;
            self.keys[place] = key;
            self.turns[place] = turn;
            self.find_worst();
        }
    }

    #[inline]
    fn find_worst(&mut self) {
        let worst = |one: usize, other: usize| {
            if self.cost[one] < self.cost[other] { other } else { one }
        };
        self.worst = worst(worst(0, 1), worst(2, 3));
        self.highest = self.cost[self.worst];
    }
}

/// What tells apart where ways have led to: the colours of text and ground, and the cursor.
#[inline]
pub(super) fn key([text, ground]: [u32; 2], cursor: u16) -> u64 {
    u64::from(text) << 38 | u64::from(ground) << 12 | u64::from(cursor & 0xFFF)
}
