//! Landmarks: what of a row can be found again where it has moved to.
//!
//! A landmark is a pair of unlike neighbours, told by a mark of eight bits. Each mark of a row is compared
//! with all that were around it before, which is a few instructions for sixteen of them, and so votes for
//! the moves that may have brought it there. To compare what cells look like took longer than all the rest
//! of the encoder, and to look each up in a table missed those that are there several times.

use super::super::packed_cell::PackedCell;
use super::{Move, Shift, Way};

/// The marks of a row's cells, as they are to be and as they were.
#[derive(Debug, Default)]
pub(super) struct Landmarks {
    hashes: Vec<u32>,
    now: Vec<Mark>,
    /// With as many on either side as are looked at from the first cell and from the last.
    before: Vec<Mark>,
}

/// The farthest that is looked for: what moves faster has changed in other ways too.
const FARTHEST: usize = 16;
/// So many moves of a row are tried. Twice as many spare half a byte in a hundred.
const MOST_TRIED: usize = 2;
/// So few landmarks may agree by chance.
const CHANCE: u16 = 2;

impl Landmarks {
    /// Finds those of a row that is to look like that, and had those marks before.
    pub(super) fn find(&mut self, targets: &[PackedCell], before: &[Mark]) {
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

    /// The moves that brought most of them to where they are.
    pub(super) fn likely_moves(&self) -> impl Iterator<Item = Move> {
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

    /// For how many landmarks there was a like one in each place around theirs.
    fn votes(&self) -> Votes {
        let mut votes = Votes::default();
        let around = self.before.windows(FARTHEST + 1 + FARTHEST);
        let mut places = self.now.iter().copied().zip(around).filter(|&(now, _)| now != Mark::NONE);
        for _ in 0..self.now.len().div_ceil(MOST_AT_ONCE) {
            votes.add(places.by_ref().take(MOST_AT_ONCE));
        }
        votes
    }

    /// The row has been moved.
    pub(super) fn shift(&mut self, shift: &Shift) {
        let row = &mut self.before[FARTHEST..][..self.now.len()];
        shift.apply(row, Mark::NONE.before());
    }

    /// The marks of the row as it is to be.
    pub(super) fn marks(&self) -> &[Mark] {
        &self.now
    }
}

/// How many landmarks were in each place around where they are now, from left to right.
#[derive(Default)]
struct Votes {
    on_the_left: [u16; FARTHEST],
    on_the_right: [u16; FARTHEST],
}

/// So many votes can be counted in eight bits.
const MOST_AT_ONCE: usize = u8::MAX as usize;

impl Votes {
    /// Adds the votes of no more landmarks than that, each with all that was around it before.
    fn add<'a>(&mut self, places: impl Iterator<Item = (Mark, &'a [Mark])>) {
        let (mut on_the_left, mut on_the_right) = ([0_u8; FARTHEST], [0_u8; FARTHEST]);
        for (now, around) in places {
            let sides = around.first_chunk().zip(around.last_chunk());
            let (left, right) = sides.expect("there is as much on either side of every cell");
            count(&mut on_the_left, left, now);
            count(&mut on_the_right, right, now);
        }
        widen(&mut self.on_the_left, &on_the_left);
        widen(&mut self.on_the_right, &on_the_right);
    }

    /// How many have moved to the left by so many cells.
    fn left(&self, by: usize) -> u16 {
        self.on_the_right[by - 1]
    }

    /// How many have moved to the right by so many cells.
    fn right(&self, by: usize) -> u16 {
        self.on_the_left[FARTHEST - by]
    }
}

/// Adds the votes for the places in which there was such a landmark.
#[inline]
fn count(votes: &mut [u8; FARTHEST], before: &[Mark; FARTHEST], now: Mark) {
    for (votes, &before) in votes.iter_mut().zip(before) {
        *votes += u8::from(before == now);
    }
}

/// Adds up votes. Inlined, it makes the compiler count eight places at once instead of sixteen.
#[inline(never)]
fn widen(sums: &mut [u16; FARTHEST], votes: &[u8; FARTHEST]) {
    for (sum, &votes) in sums.iter_mut().zip(votes) {
        *sum += u16::from(votes);
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

    /// The marks of a row's cells, whose packed cells have those hashes.
    pub(super) fn all(hashes: &[u32]) -> impl Iterator<Item = Self> {
        let pairs = hashes.iter().zip(hashes.iter().skip(1));
        let marks = pairs.map(|(&last, &hash)| {
            let pair = last.rotate_left(5).wrapping_add(hash);
            if last == hash { Self::NONE } else { Self(((pair >> 24) as u8).max(2)) }
        });
        // What the first one follows is unknown, and so it is no landmark.
        hashes.first().map(|_| Self::NONE).into_iter().chain(marks)
    }
}
