//! Row shifts: what moved sideways is moved by the terminal, not sent again.
//!
//! A picture that turns is much the same picture a few columns further on. Deleting and inserting
//! characters (DCH and ICH) move a stretch of a row for some twenty bytes, where every cell of it may
//! take as many. Scrolling whole regions sideways was refused: few terminals have margins on the left
//! and right.

use std::ops::Range;

use super::look::Look;
use super::tolerance::Tolerance;

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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Left,
    Right,
}

/// The farthest that is looked for: what moves faster has changed in other ways too.
const FARTHEST: usize = 16;
/// As many landmarks are asked where they come from.
const MOST_LANDMARKS: usize = 32;
/// About how many bytes a cell takes.
const CELL: i32 = 12;
/// About how many bytes a shift takes: two motions, a deletion and an insertion.
const SHIFT: i32 = 20;

impl Shift {
    /// The shift of a row that shows `shown` that brings it nearest to `wanted`, if one spares more
    /// bytes than it takes. What is within `tolerance` is as good as what is wanted.
    ///
    /// Only the two distances are looked into that most landmarks have moved by. To look into all of
    /// them took three times as long as everything else together, and spared no more.
    pub(super) fn best(shown: &[Look], wanted: &[Look], tolerance: Tolerance) -> Option<Self> {
        let row = Rows { shown, wanted, tolerance };
        if row.count_wrong() * CELL <= SHIFT {
            return None;
        }
        let candidates = row.likely_moves().into_iter().flatten();
        let shifts = candidates.filter_map(|(by, way)| row.best_of(by, way));
        let (shift, spared) = shifts.max_by_key(|&(_, spared)| spared)?;
        (spared > SHIFT).then_some(shift)
    }

    /// Does to `row` what the terminal does.
    pub(super) fn apply(&self, row: &mut [Look]) {
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
        stretch[uncovered].fill(Look::UNKNOWN);
    }
}

/// A row as it is and as it is to be.
#[derive(Clone, Copy)]
struct Rows<'a> {
    shown: &'a [Look],
    wanted: &'a [Look],
    tolerance: Tolerance,
}

impl Rows<'_> {
    /// Whether the cell that is now at `from` is good at `to`.
    fn is_good(self, from: usize, to: usize) -> bool {
        self.shown[from].is_near(self.wanted[to], self.tolerance)
    }

    fn count_wrong(self) -> i32 {
        (0..self.shown.len()).filter(|&index| !self.is_good(index, index)).count() as i32
    }

    /// The two moves that bring most landmarks, which are pairs of unlike neighbours that are wrong
    /// where they are, to where they are wanted.
    fn likely_moves(self) -> [Option<(usize, Way)>; 2] {
        let is_landmark = |&index: &usize| {
            self.wanted[index - 1] != self.wanted[index]
                && !(self.is_good(index, index) && self.is_good(index - 1, index - 1))
        };
        let places = 1..self.wanted.len();
        let apart = (self.wanted.len() / MOST_LANDMARKS).max(1);
        let mut votes = [[0_u8; 2]; FARTHEST + 1];
        let mut next = 0;
        for place in places.filter(is_landmark) {
            if place < next {
                continue;
            }
            next = place + apart;
            for (by, votes) in votes.iter_mut().enumerate().skip(1) {
                let comes_from = |from: usize| {
                    from < self.shown.len()
                        && self.is_good(from, place)
                        && self.is_good(from - 1, place - 1)
                };
                votes[Way::Left as usize] += u8::from(comes_from(place + by));
                votes[Way::Right as usize] += u8::from(place > by && comes_from(place - by));
            }
        }
        [Way::Left, Way::Right].map(|way| {
            let votes = votes.iter().map(|votes| votes[way as usize]).enumerate();
            let (by, votes) = votes.max_by_key(|&(_, votes)| votes)?;
            (votes > 1).then_some((by, way))
        })
    }

    /// The best shift by that far that way, and how many bytes it spares.
    fn best_of(self, by: usize, way: Way) -> Option<(Shift, i32)> {
        let last = self.shown.len().checked_sub(by)?;
        let is_wrong = |from: usize, to: usize| i32::from(!self.is_good(from, to));
        // Places that a cell can move to, and what is spared where it does.
        let spared = |index: usize| {
            let (from, to) = match way {
                Way::Left => (index + by, index),
                Way::Right => (index, index + by),
            };
            CELL * (is_wrong(to, to) - is_wrong(from, to))
        };
        let (moved, spared) = best_stretch((0..last).map(spared))?;
        // What is uncovered must be sent, even where it was right before.
        let (columns, uncovered) = match way {
            Way::Left => (moved.start..moved.end + by, moved.end..moved.end + by),
            Way::Right => (moved.start..moved.end + by, moved.start..moved.start + by),
        };
        let lost = uncovered.filter(|&index| self.is_good(index, index)).count() as i32;
        Some((Shift { columns, by, way }, spared - CELL * lost))
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

    use super::super::super::Fidelity;
    use super::*;

    fn best(shown: &[Look], wanted: &[Look]) -> Option<Shift> {
        Shift::best(shown, wanted, Tolerance::of(Fidelity::EXACT))
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
        Shift { columns: 1..5, by: 2, way: Way::Left }.apply(&mut shown);
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
                shift.apply(&mut shown);
                prop_assert!(to_send(&shown) < before);
            }
        }
    }
}
