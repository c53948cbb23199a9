//! Landmarks: recognizable cells, by which a move of a row is detected.
//!
//! A landmark is a cell that differs from the one before it, identified by a mark of eight bits.
//! Each mark of a row is compared with all previous marks around it, in a few instructions for
//! sixteen of them, and votes for the moves that may have brought it there. Comparing the
//! appearance of cells took longer than the rest of the encoder; a table of marks missed those that
//! occur several times.

use super::super::packed_cell::PackedCell;
use super::{Move, Shift, Way};

/// The marks of a row's targets, now and before.
#[derive(Debug, Default)]
pub(crate) struct Landmarks {
    hashes: Vec<u32>,
    now: Vec<Mark>,
    /// With [`FARTHEST`] empty marks on either side.
    before: Vec<Mark>,
}

/// The farthest detected move: content that moves faster has usually changed in other ways too.
const FARTHEST: usize = 16;
/// The number of places around a cell, with its own, at which a mark is looked for.
const PLACES: usize = FARTHEST + 1 + FARTHEST;
/// The number of moves that are tried for a row. Twice as many save half a byte in a hundred.
const MOST_TRIED: usize = 2;
/// This number of landmarks may agree by chance.
const CHANCE: u16 = 2;

impl Landmarks {
    /// Finds the landmarks of a row with these targets and these previous marks.
    pub(crate) fn find(&mut self, targets: &[PackedCell], before: &[Mark]) {
        self.hashes.clear();
        self.hashes.extend(targets.iter().map(|target| target.hash()));
        self.now.clear();
        self.now.extend(Mark::all(&self.hashes));
        let nothing = Mark::NONE.before();
        self.before.clear();
        self.before.resize(FARTHEST, nothing);
        self.before.extend(before.iter().map(|mark| mark.before()));
        self.before.resize(FARTHEST + before.len() + FARTHEST, nothing);
    }

    /// The moves with the most votes.
    pub(crate) fn likely_moves(&self) -> impl Iterator<Item = Move> {
        let votes = self.votes();
        let mut likely = [None; MOST_TRIED];
        let mut most = [CHANCE; MOST_TRIED];
        for by in 1..=FARTHEST {
            for (way, count) in [(Way::Left, votes.left(by)), (Way::Right, votes.right(by))] {
                if let Some(rank) = most.iter().position(|&most| count > most) {
                    likely[rank..].rotate_right(1);
                    most[rank..].rotate_right(1);
                    (likely[rank], most[rank]) = (Some(Move { way, by }), count);
                }
            }
        }
        likely.into_iter().flatten()
    }

    /// Counts, for each distance, the landmarks that have an equal previous mark there.
    fn votes(&self) -> Votes {
        let mut votes = Votes([0; PLACES]);
        let around = self.before.windows(PLACES);
        let mut places = self.now.iter().copied().zip(around).filter(|&(now, _)| now != Mark::NONE);
        for _ in 0..self.now.len().div_ceil(MOST_AT_ONCE) {
            votes.add(places.by_ref().take(MOST_AT_ONCE));
        }
        votes
    }

    /// Moves the previous marks, after a shift.
    pub(crate) fn shift(&mut self, shift: &Shift) {
        let row = &mut self.before[FARTHEST..][..self.now.len()];
        shift.apply(row, Mark::NONE.before());
    }

    /// The marks of the row's targets.
    pub(crate) fn marks(&self) -> &[Mark] {
        &self.now
    }
}

/// The number of landmarks with an equal previous mark at each distance, from left to right. The one in the
/// middle is their own place.
struct Votes([u16; PLACES]);

/// The number of votes that can be counted in eight bits.
const MOST_AT_ONCE: usize = u8::MAX as usize;

impl Votes {
    /// Adds the votes of at most [`MOST_AT_ONCE`] landmarks, each with the previous marks around
    /// it.
    fn add<'a>(&mut self, places: impl Iterator<Item = (Mark, &'a [Mark])>) {
        // One loop for both sides: the compiler would unroll a shorter one instead of counting sixteen
        // places at once.
        let mut votes = [0_u8; PLACES];
        for (now, around) in places {
            let around = around.first_chunk::<PLACES>();
            let around = around.expect("there is as much on either side of every cell");
            for (votes, &before) in votes.iter_mut().zip(around) {
                *votes += u8::from(before == now);
            }
        }
        widen(&mut self.0, &votes);
    }

    /// The number of landmarks that have moved to the left by this number of cells.
    fn left(&self, by: usize) -> u16 {
        self.0[FARTHEST + by]
    }

    /// The number of landmarks that have moved to the right by this number of cells.
    fn right(&self, by: usize) -> u16 {
        self.0[FARTHEST - by]
    }
}

/// Adds votes to sums. When this was inlined, the compiler counted eight places at once instead of
/// sixteen.
#[inline(never)]
fn widen(sums: &mut [u16; PLACES], votes: &[u8; PLACES]) {
    for (sum, &votes) in sums.iter_mut().zip(votes) {
        *sum += u16::from(votes);
    }
}

/// The mark of a landmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Mark(u8);

impl Mark {
    /// The mark of a cell that is equal to the one before it.
    pub(crate) const NONE: Self = Self(0);

    /// The same as a previous mark. `NONE` has another value there, so that no mark is equal to it.
    fn before(self) -> Self {
        Self(self.0.max(1))
    }

    /// The marks of a row's cells, from the hashes of their packed cells.
    pub(crate) fn all(hashes: &[u32]) -> impl Iterator<Item = Self> {
        let pairs = hashes.iter().zip(hashes.iter().skip(1));
        let marks = pairs.map(|(&last, &hash)| {
            let pair = last.rotate_left(5).wrapping_add(hash);
            if last == hash { Self::NONE } else { Self(((pair >> 24) as u8).max(2)) }
        });
        // The cell before the first one is unknown, so that the first one is no landmark.
        hashes.first().map(|_| Self::NONE).into_iter().chain(marks)
    }
}
