//! Row shifts: what moved sideways is moved by the terminal, not sent again.
//!
//! A picture that turns is much the same picture a few columns further on. Deleting and inserting
//! characters (DCH and ICH) move a stretch of a row for some twenty bytes, where every cell of it may
//! take as many. Scrolling whole regions sideways was refused: few terminals have margins on the left
//! and right.

use std::ops::Range;

use super::look::Look;
use super::screen::Row;

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

impl Move {
    /// The first cell that can move, and where it moves to.
    fn places(self) -> (usize, usize) {
        match self.way {
            Way::Left => (self.by, 0),
            Way::Right => (0, self.by),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Left,
    Right,
}

/// The farthest that is looked for: what moves faster has changed in other ways too.
const FARTHEST: usize = 16;
/// So many moves of a row are tried. Twice as many spare half a byte in a hundred.
const MOST_TRIED: usize = 2;
/// A loss of one byte.
pub(super) const BYTE: i32 = 16;
/// The loss of a cell that is not as it should be at all: about how many bytes it takes.
pub(super) const CELL: i32 = 12 * BYTE;
/// About how many bytes a shift takes: two motions, a deletion and an insertion.
const SHIFT: i32 = 20 * BYTE;

/// Finds the shifts of a row, one after another, and has the memory that it takes.
#[derive(Debug, Default)]
pub(super) struct Shifts {
    /// The row's landmarks, padded, as they are to be, and as they were.
    marks: Vec<Mark>,
    marks_before: Vec<Mark>,
    /// What is lost now, and what would be lost after a move, and after the best of them.
    losses: Vec<i32>,
    moved: Vec<i32>,
    moved_best: Vec<i32>,
}

impl Shifts {
    /// Begins with a row. `lose` adds what is lost where the cells that are now at the first place and
    /// after it are shown at the second and after it.
    pub(super) fn begin(&mut self, row: &Row, lose: impl Fn(usize, usize, &mut Vec<i32>)) {
        self.marks.clear();
        self.marks.extend(Mark::all(row.looks));
        pad(&mut self.marks, Mark::NONE);
        self.marks_before.clear();
        self.marks_before.extend(row.marks.iter().map(|&mark| mark.before()));
        pad(&mut self.marks_before, Mark::NONE.before());
        self.losses.clear();
        lose(0, 0, &mut self.losses);
    }

    /// The shift after which least is lost, if it spares more than it takes.
    pub(super) fn next(&mut self, lose: impl Fn(usize, usize, &mut Vec<i32>)) -> Option<Shift> {
        if self.losses.iter().sum::<i32>() <= SHIFT {
            return None;
        }
        let mut best: Option<(Shift, i32)> = None;
        let moves = likely_moves(&self.marks_before, &self.marks, self.losses.len());
        for by in moves.into_iter().flatten() {
            let (from, to) = by.places();
            self.moved.clear();
            lose(from, to, &mut self.moved);
            let (shift, spared) = Shift::best(by, &self.losses, &self.moved);
            if best.as_ref().is_none_or(|&(_, most)| spared > most) {
                best = Some((shift, spared));
                std::mem::swap(&mut self.moved, &mut self.moved_best);
            }
        }
        let (shift, _) = best.filter(|&(_, spared)| spared > SHIFT)?;
        self.take(&shift);
        Some(shift)
    }

    /// The row has been moved.
    fn take(&mut self, shift: &Shift) {
        shift.apply(&mut self.marks_before, Mark::NONE.before());
        let moved = shift.columns.start..shift.columns.end - shift.by;
        self.losses[shift.covered()].copy_from_slice(&self.moved_best[moved]);
        self.losses[shift.uncovered()].fill(CELL);
    }

    /// What is lost in each cell of the row.
    pub(super) fn losses(&self) -> &[i32] {
        &self.losses
    }

    /// Is done with the row: what it is to show now is what was wanted before the next frame.
    pub(super) fn end(&self, row: &mut Row) {
        row.marks.copy_from_slice(&self.marks[..row.width()]);
    }
}

impl Shift {
    /// The best shift by that move, and what it spares, where that much is lost now, and that much
    /// after all that can move has moved.
    fn best(by: Move, now: &[i32], moved: &[i32]) -> (Self, i32) {
        let (_, first) = by.places();
        let stretch = best_stretch(&now[first..], moved);
        let covered = now[first..][stretch.clone()].iter().sum::<i32>();
        let spared = covered - moved[stretch.clone()].iter().sum::<i32>();
        let Move { way, by } = by;
        let shift = Self { columns: stretch.start..stretch.end + by, by, way };
        // What is uncovered must be sent, even where it was right before.
        let lost: i32 = now[shift.uncovered()].iter().map(|loss| CELL - loss).sum();
        (shift, spared - lost)
    }

    /// The cells of which nobody knows what they show when it has been made.
    fn uncovered(&self) -> Range<usize> {
        let Range { start, end } = self.columns;
        match self.way {
            Way::Left => end - self.by..end,
            Way::Right => start..start + self.by,
        }
    }

    /// The cells that show what others showed before.
    fn covered(&self) -> Range<usize> {
        let Range { start, end } = self.columns;
        match self.way {
            Way::Left => start..end - self.by,
            Way::Right => start + self.by..end,
        }
    }

    /// Does to `row` what the terminal does; what is uncovered becomes `unknown`.
    pub(super) fn apply<T: Clone>(&self, row: &mut [T], unknown: T) {
        let stretch = &mut row[self.columns.clone()];
        match self.way {
            Way::Left => stretch.rotate_left(self.by),
            Way::Right => stretch.rotate_right(self.by),
        }
        row[self.uncovered()].fill(unknown);
    }
}

/// The moves that brought most landmarks of a row to where they are.
///
/// A landmark is a pair of unlike neighbours, told by a mark of eight bits. All marks of a row are
/// compared with all from before, move by move, which is a few instructions for sixteen of them. To
/// compare what they look like took longer than all the rest of the encoder, and to look each up in
/// a table missed those that are there several times.
fn likely_moves(before: &[Mark], now: &[Mark], width: usize) -> [Option<Move>; MOST_TRIED] {
    let mut likely = [None; MOST_TRIED];
    let mut votes = [CHANCE; MOST_TRIED];
    for by in 1..=FARTHEST.min(width.saturating_sub(1)) {
        let left = count_alike(&before[by..], now);
        let right = count_alike(before, &now[by..]);
        for (way, count) in [(Way::Left, left), (Way::Right, right)] {
            if let Some(rank) = votes.iter().position(|&votes| count > votes) {
                likely[rank..].rotate_right(1);
                votes[rank..].rotate_right(1);
                (likely[rank], votes[rank]) = (Some(Move { way, by }), count);
            }
        }
    }
    likely
}

/// Marks are padded so that they can be compared so many at a time, however far they moved.
fn pad(marks: &mut Vec<Mark>, padding: Mark) {
    let whole = marks.len().next_multiple_of(LANES);
    marks.resize(whole + LANES, padding);
}

/// So many marks are compared at a time: no fewer than they move by.
const LANES: usize = 32;
const _: () = assert!(FARTHEST <= LANES);

/// So few landmarks may agree by chance.
const CHANCE: u32 = 2;

/// What a landmark is told by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Mark(u8);

impl Mark {
    /// Of a cell that is like the one before it.
    pub(super) const NONE: Self = Self(0);

    /// The mark in a row from before, where that of no landmark is another, so that none is alike.
    fn before(self) -> Self {
        Self(self.0.max(1))
    }

    /// The marks of a row's cells.
    fn all(row: &[Look]) -> impl Iterator<Item = Self> {
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

/// About the stretch with the most spared, where that much is lost now, and that much after it has moved.
///
/// It is found block by block, and then its ends to the cell: the best one to the cell takes longer than
/// all that it finds is worth.
fn best_stretch(now: &[i32], moved: &[i32]) -> Range<usize> {
    let blocks = now.chunks(BLOCK).zip(moved.chunks(BLOCK));
    let spared = blocks.map(|(now, moved)| now.iter().sum::<i32>() - moved.iter().sum::<i32>());
    let (mut start, mut sum) = (0, 0);
    let (mut best, mut most) = (0..0, 0);
    for (block, spared) in spared.enumerate() {
        if sum <= 0 {
            (start, sum) = (block, 0);
        }
        sum += spared;
        if sum > most {
            (best, most) = (start..block + 1, sum);
        }
    }
    let width = now.len().min(moved.len());
    let spared = |column: usize| now[column] - moved[column];
    let (first, last) = (best.start * BLOCK, best.end * BLOCK);
    let at_start = first.saturating_sub(BLOCK)..(first + BLOCK).min(width);
    let start = at_start.end - most_of(at_start.rev().map(spared));
    let at_end = last.saturating_sub(BLOCK)..(last + BLOCK).min(width);
    let end = at_end.start + most_of(at_end.map(spared));
    start..end.max(start)
}

/// So many cells are one block.
const BLOCK: usize = 8;

/// How many of the first of `gains` have the largest sum.
fn most_of(gains: impl Iterator<Item = i32>) -> usize {
    let (mut sum, mut most, mut best) = (0, 0, 0);
    for (count, gain) in (1..).zip(gains) {
        sum += gain;
        if sum > most {
            (most, best) = (sum, count);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use ratatui::style::Color;

    use super::*;

    fn best(shown: &[Look], wanted: &[Look]) -> Option<Shift> {
        let row = Row {
            y: 0,
            shown: &mut shown.to_vec(),
            looks: wanted,
            marks: &mut Mark::all(shown).collect::<Vec<_>>(),
            wanted: &[],
            intricate: &mut false,
            exact: &mut false,
        };
        let mut shifts = Shifts::default();
        let lose = |from: usize, to: usize, losses: &mut Vec<i32>| {
            let looks = shown[from..].iter().zip(&wanted[to..]);
            losses.extend(looks.map(|(shown, wanted)| CELL * i32::from(shown != wanted)));
        };
        shifts.begin(&row, lose);
        shifts.next(lose)
    }

    fn row(text: &str) -> Vec<Look> {
        text.chars().map(|drawn| Look::of_character(drawn, [Color::Reset; 2])).collect()
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
