//! Landmarks: what of a row can be found again where it has moved to.
//!
//! A landmark is a pair of unlike neighbours, told by a mark of eight bits. All marks of a row are
//! compared with all from before, move by move, which is a few instructions for sixteen of them. To
//! compare what they look like took longer than all the rest of the encoder, and to look each up in
//! a table missed those that are there several times.

use super::super::look::Look;
use super::{Move, Shift, Way};

/// The marks of a row's cells, padded, as they are to be and as they were.
#[derive(Debug, Default)]
pub(super) struct Landmarks {
    now: Vec<Mark>,
    before: Vec<Mark>,
    width: usize,
}

/// The farthest that is looked for: what moves faster has changed in other ways too.
const FARTHEST: usize = 16;
/// So many moves of a row are tried. Twice as many spare half a byte in a hundred.
const MOST_TRIED: usize = 2;
/// So few landmarks may agree by chance.
const CHANCE: u32 = 2;
/// So many marks are compared at a time: no fewer than they move by.
const LANES: usize = 32;
const _: () = assert!(FARTHEST <= LANES);

impl Landmarks {
    /// Finds those of a row that is to look like that, and had those marks before.
    pub(super) fn find(&mut self, looks: &[Look], before: &[Mark]) {
        self.width = looks.len();
        self.now.clear();
        self.now.extend(Mark::all(looks));
        pad(&mut self.now, Mark::NONE);
        self.before.clear();
        self.before.extend(before.iter().map(|&mark| mark.before()));
        pad(&mut self.before, Mark::NONE.before());
    }

    /// The moves that brought most of them to where they are.
    pub(super) fn likely_moves(&self) -> impl Iterator<Item = Move> {
        let mut likely = [None; MOST_TRIED];
        let mut votes = [CHANCE; MOST_TRIED];
        for by in 1..=FARTHEST.min(self.width.saturating_sub(1)) {
            let left = count_alike(&self.before[by..], &self.now);
            let right = count_alike(&self.before, &self.now[by..]);
            for (way, count) in [(Way::Left, left), (Way::Right, right)] {
                if let Some(rank) = votes.iter().position(|&votes| count > votes) {
                    likely[rank..].rotate_right(1);
                    votes[rank..].rotate_right(1);
                    (likely[rank], votes[rank]) = (Some(Move { way, by }), count);
                }
            }
        }
        likely.into_iter().flatten()
    }

    /// The row has been moved.
    pub(super) fn shift(&mut self, shift: &Shift) {
        shift.apply(&mut self.before, Mark::NONE.before());
    }

    /// The marks of the row as it is to be.
    pub(super) fn marks(&self) -> &[Mark] {
        &self.now[..self.width]
    }
}

/// What a landmark is told by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(in super::super) struct Mark(u8);

impl Mark {
    /// Of a cell that is like the one before it.
    pub(in super::super) const NONE: Self = Self(0);

    /// The mark in a row from before, where that of no landmark is another, so that none is alike.
    fn before(self) -> Self {
        Self(self.0.max(1))
    }

    /// The marks of a row's cells.
    pub(super) fn all(row: &[Look]) -> impl Iterator<Item = Self> {
        let mut before = (Look::UNKNOWN, 0);
        row.iter().map(move |&look| {
            let (last, last_hash) = before;
            let hash = look.hash();
            before = (look, hash);
            let pair = u64::rotate_left(last_hash, 5).wrapping_add(hash);
            if last == look { Self::NONE } else { Self(((pair >> 56) as u8).max(2)) }
        })
    }
}

/// Marks are padded so that they can be compared so many at a time, however far they moved.
fn pad(marks: &mut Vec<Mark>, padding: Mark) {
    let whole = marks.len().next_multiple_of(LANES);
    marks.resize(whole + LANES, padding);
}

/// At how many places both have the same mark.
#[inline]
fn count_alike(one: &[Mark], other: &[Mark]) -> u32 {
    // Lane by lane, so that the compiler compares all lanes at once.
    let mut counts = [0_u8; LANES];
    for (one, other) in one.chunks_exact(LANES).zip(other.chunks_exact(LANES)) {
        for ((count, one), other) in counts.iter_mut().zip(one).zip(other) {
            *count = count.saturating_add(u8::from(one == other));
        }
    }
    counts.into_iter().map(u32::from).sum()
}
