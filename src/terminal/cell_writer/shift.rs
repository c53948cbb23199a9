//! Row shifts: what moved sideways is moved by the terminal, not sent again.
//!
//! A picture that turns is much the same picture a few columns further on. Deleting and inserting
//! characters (DCH and ICH) move a stretch of a row for some twenty bytes, where every cell of it may
//! take as many. Scrolling whole regions sideways was refused: few terminals have margins on the left
//! and right.

use std::ops::Range;

use super::look::Look;

/// A stretch of a row whose cells move by some columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shift {
    /// The stretch. What moves out of it is lost, and what moves into it is unknown.
    pub(super) columns: Range<usize>,
    /// How far it moves.
    pub(super) by: usize,
    /// Which way.
    pub(super) way: Way,
}

/// Which way, and how far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Move {
    way: Way,
    by: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Left,
    Right,
}

/// The farthest that is looked for: what moves faster has changed in other ways too.
const FARTHEST: usize = 16;
/// So many moves of a row are tried.
const MOST_TRIED: usize = 4;
/// A loss of one byte.
pub(super) const BYTE: i32 = 16;
/// The loss of a cell that is not as it should be at all: about how many bytes it takes.
pub(super) const CELL: i32 = 12 * BYTE;
/// About how many bytes a shift takes: two motions, a deletion and an insertion.
const SHIFT: i32 = 20 * BYTE;

impl Shift {
    /// The shift by one of these moves after which least is lost in a row of so many cells, if it
    /// spares more than it takes. `loss` is what is lost where the cell that is now at the first
    /// place is shown at the second.
    pub(super) fn best(
        width: usize,
        moves: &Moves,
        loss: impl Fn(usize, usize) -> i32,
    ) -> Option<Self> {
        let shifts = moves.likely().filter_map(|by| Self::best_of(width, by, &loss));
        let (shift, spared) = shifts.max_by_key(|&(_, spared)| spared)?;
        (spared > SHIFT).then_some(shift)
    }

    /// Whether a row that has so much to lose may be worth a shift.
    pub(super) fn may_spare(loss: i32) -> bool {
        loss > SHIFT
    }

    /// The best shift by that move, and what it spares.
    fn best_of(
        width: usize,
        Move { by, way }: Move,
        loss: &impl Fn(usize, usize) -> i32,
    ) -> Option<(Self, i32)> {
        let last = width.checked_sub(by)?;
        // Places that a cell can move to, and what is spared where it does.
        let spared = |index: usize| {
            let (from, to) = match way {
                Way::Left => (index + by, index),
                Way::Right => (index, index + by),
            };
            loss(to, to) - loss(from, to)
        };
        let (moved, spared) = best_stretch((0..last).map(spared))?;
        // What is uncovered must be sent, even where it was right before.
        let (columns, uncovered) = match way {
            Way::Left => (moved.start..moved.end + by, moved.end..moved.end + by),
            Way::Right => (moved.start..moved.end + by, moved.start..moved.start + by),
        };
        let lost: i32 = uncovered.map(|index| CELL - loss(index, index)).sum();
        Some((Self { columns, by, way }, spared - lost))
    }

    /// Does to `row` what the terminal does; what is uncovered becomes `unknown`.
    pub(super) fn apply<T: Clone>(&self, row: &mut [T], unknown: T) {
        let stretch = &mut row[self.columns.clone()];
        let uncovered = match self.way {
            Way::Left => {
                stretch.rotate_left(self.by);
                stretch.len() - self.by..stretch.len()
            }
            Way::Right => {
                stretch.rotate_right(self.by);
                0..self.by
            }
        };
        stretch[uncovered].fill(unknown);
    }
}

/// The moves that brought most landmarks of a row to where they are.
///
/// A landmark is a pair of unlike neighbours. Where each was before is looked up in a table by a hash
/// of the pair; to compare every landmark with every place it may have come from took longer than all
/// the rest of the encoder.
#[derive(Debug)]
pub(super) struct Moves([Option<Move>; MOST_TRIED]);

impl Moves {
    /// From what was wanted of the row in the last frame to what is wanted now.
    pub(super) fn between(before: &[Look], now: &[Look]) -> Self {
        let mut places = [0_u16; 256];
        for (place, pair) in (1..).zip(before.windows(2)) {
            if pair[0] != pair[1] {
                places[usize::from(Look::hash_pair(pair))] = place;
            }
        }
        let mut votes = [[0_u16; FARTHEST + 1]; 2];
        for (place, pair) in (1_usize..).zip(now.windows(2)) {
            if pair[0] == pair[1] {
                continue;
            }
            let from = usize::from(places[usize::from(Look::hash_pair(pair))]);
            let by = from.abs_diff(place);
            if from > 0 && (1..=FARTHEST).contains(&by) && before[from - 1..=from] == *pair {
                let way = if from > place { Way::Left } else { Way::Right };
                votes[way as usize][by] += 1;
            }
        }
        Self::elect(&votes)
    }

    fn elect(votes: &[[u16; FARTHEST + 1]; 2]) -> Self {
        let mut elected = [None; MOST_TRIED];
        let mut fewest = [1; MOST_TRIED];
        for way in [Way::Left, Way::Right] {
            for (by, &votes) in votes[way as usize].iter().enumerate() {
                if let Some(rank) = fewest.iter().position(|&fewest| votes > fewest) {
                    elected[rank..].rotate_right(1);
                    fewest[rank..].rotate_right(1);
                    (elected[rank], fewest[rank]) = (Some(Move { way, by }), votes);
                }
            }
        }
        Self(elected)
    }

    fn likely(&self) -> impl Iterator<Item = Move> {
        self.0.iter().copied().flatten()
    }
}

/// The stretch of `gains` with the largest sum, and that sum.
fn best_stretch(gains: impl Iterator<Item = i32>) -> Option<(Range<usize>, i32)> {
    let mut best = None;
    let (mut start, mut sum) = (0, 0);
    for (index, gain) in gains.enumerate() {
        if sum <= 0 {
            (start, sum) = (index, 0);
        }
        sum += gain;
        if best.as_ref().is_none_or(|&(_, most)| sum > most) {
            best = Some((start..index + 1, sum));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn best(shown: &[Look], wanted: &[Look]) -> Option<Shift> {
        let loss = |from: usize, to: usize| if shown[from] == wanted[to] { 0 } else { CELL };
        Shift::best(shown.len(), &Moves::between(shown, wanted), loss)
    }

    fn row(text: &str) -> Vec<Look> {
        text.chars().map(Look::of_character).collect()
    }

    #[test]
    fn a_row_that_moved_is_found_out() {
        let shown = row("abcdefghijklmnop");
        let shift = best(&shown, &row("defghijklmnopqrs")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 3, way: Way::Left });
        let shift = best(&shown, &row("xxabcdefghijklmn")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 2, way: Way::Right });
    }

    #[test]
    fn what_stands_still_beside_it_is_left_alone() {
        let shift = best(&row("abcdefghij|MAP|"), &row("bcdefghijk|MAP|")).unwrap();
        assert_eq!(shift, Shift { columns: 0..10, by: 1, way: Way::Left });
    }

    #[test]
    fn a_row_that_did_not_move_is_not_shifted() {
        let shown = row("abcdefghijklmnop");
        for wanted in ["abcdefghijklmnop", "abcdeFghijklmnop", "0123456789ABCDEF"] {
            assert_eq!(best(&shown, &row(wanted)), None, "{wanted}");
        }
        assert_eq!(best(&row("a"), &row("b")), None);
        assert_eq!(best(&[], &[]), None);
    }

    #[test]
    fn a_shift_uncovers_what_nobody_knows() {
        let mut shown = row("abcdef");
        Shift { columns: 1..5, by: 2, way: Way::Left }.apply(&mut shown, Look::UNKNOWN);
        assert_eq!(shown[..3], row("ade"));
        assert_eq!((shown[3], shown[4]), (Look::UNKNOWN, Look::UNKNOWN));
        assert_eq!(shown[5..], row("f"));
    }

    proptest! {
        #[test]
        fn a_shift_leaves_less_to_send(
            shown in "[abc]{1,40}",
            wanted in "[abc]{40}",
        ) {
            let (mut shown, wanted) = (row(&shown), row(&wanted));
            let wanted = &wanted[..shown.len()];
            let to_send = |shown: &[Look]| shown.iter().zip(wanted).filter(|(a, b)| a != b).count();
            let before = to_send(&shown);
            if let Some(shift) = best(&shown, wanted) {
                shift.apply(&mut shown, Look::UNKNOWN);
                prop_assert!(to_send(&shown) < before);
            }
        }
    }
}
