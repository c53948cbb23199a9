//! Row shifts: what moved sideways is moved by the terminal, not sent again.
//!
//! A picture that turns is much the same picture a few columns further on. Deleting and inserting
//! characters (DCH and ICH) move a stretch of a row for some twenty bytes, where every cell of it may
//! take as many. Scrolling whole regions sideways was refused: few terminals have margins on the left
//! and right.

mod landmarks;
mod stretch;

use std::ops::Range;

use self::landmarks::Landmarks;
pub(super) use self::landmarks::Mark;
use self::stretch::best_stretch;
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

/// How bad it is that a cell shows what it does: about how many bytes it would take to draw it anew, in parts
/// of [`BYTE`].
pub(super) type Loss = i16;

/// The loss of one byte.
pub(super) const BYTE: Loss = 16;
/// The loss of a cell that is not as it should be at all.
pub(super) const CELL: Loss = 12 * BYTE;
/// About how many bytes a shift takes: two motions, a deletion and an insertion.
const SHIFT: i32 = 20 * BYTE as i32;

/// Finds the shifts of a row, one after another, and has the memory that it takes.
#[derive(Debug, Default)]
pub(super) struct Shifts {
    landmarks: Landmarks,
    /// What is lost now, and what would be lost after a move, and after the best of them.
    losses: Vec<Loss>,
    moved: Vec<Loss>,
    moved_best: Vec<Loss>,
}

impl Shifts {
    /// Begins with a row. `lose` adds what is lost where the cells that are now at the first place and
    /// after it are shown at the second and after it.
    pub(super) fn begin(&mut self, row: &Row, mut lose: impl FnMut(usize, usize, &mut Vec<Loss>)) {
        self.landmarks.find(row.targets, row.marks);
        self.losses.clear();
        lose(0, 0, &mut self.losses);
    }

    /// The shift after which least is lost, if it spares more than it takes.
    pub(super) fn next(
        &mut self,
        mut lose: impl FnMut(usize, usize, &mut Vec<Loss>),
    ) -> Option<Shift> {
        if sum(&self.losses) <= SHIFT {
            return None;
        }
        let mut best: Option<(Shift, i32)> = None;
        for by in self.landmarks.likely_moves() {
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
        self.landmarks.shift(shift);
        let moved = shift.columns.start..shift.columns.end - shift.by;
        self.losses[shift.covered()].copy_from_slice(&self.moved_best[moved]);
        self.losses[shift.uncovered()].fill(CELL);
    }

    /// What is lost in each cell of the row.
    pub(super) fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Is done with the row: what it is to show now is what was wanted before the next frame.
    pub(super) fn end(&self, row: &mut Row) {
        row.marks.copy_from_slice(self.landmarks.marks());
    }
}

impl Shift {
    /// The best shift by that move, and what it spares, where that much is lost now, and that much
    /// after all that can move has moved.
    fn best(by: Move, now: &[Loss], moved: &[Loss]) -> (Self, i32) {
        let (_, first) = by.places();
        let stretch = best_stretch(&now[first..], moved);
        let spared = sum(&now[first..][stretch.clone()]) - sum(&moved[stretch.clone()]);
        let Move { way, by } = by;
        let shift = Self { columns: stretch.start..stretch.end + by, by, way };
        // What is uncovered must be sent, even where it was right before.
        let lost = shift.by as i32 * i32::from(CELL) - sum(&now[shift.uncovered()]);
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

/// What is lost in all of those cells.
fn sum(losses: &[Loss]) -> i32 {
    losses.iter().map(|&loss| i32::from(loss)).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use ratatui::style::{Color, Modifier};

    use super::super::glyph_table::{Glyph, GlyphTable};
    use super::super::packed_cell::PackedCell;
    use super::*;

    fn best(shown: &[PackedCell], wanted: &[PackedCell]) -> Option<Shift> {
        let row = Row {
            y: 0,
            glyph_table: &GlyphTable::default(),
            shown: &mut shown.to_vec(),
            targets: wanted,
            marks: &mut marks(shown),
            wanted: &[],
            intricate: &mut false,
            exact: &mut false,
            rested: 0,
        };
        let mut shifts = Shifts::default();
        let lose = |from: usize, to: usize, losses: &mut Vec<Loss>| {
            let targets = shown[from..].iter().zip(&wanted[to..]);
            losses.extend(targets.map(|(shown, wanted)| CELL * Loss::from(shown != wanted)));
        };
        shifts.begin(&row, lose);
        shifts.next(lose)
    }

    fn marks(targets: &[PackedCell]) -> Vec<Mark> {
        let hashes: Vec<_> = targets.iter().map(|target| target.hash()).collect();
        Mark::all(&hashes).collect()
    }

    fn row(text: &str) -> Vec<PackedCell> {
        let mut glyph_table = GlyphTable::default();
        // In any text, the same letters have the same ids then.
        (' '..='~').for_each(|letter| _ = glyph_table.id(Glyph::new(letter, Modifier::empty())));
        let target = |letter| PackedCell::of_character(letter, [Color::Reset; 2], &mut glyph_table);
        text.chars().map(target).collect()
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
        Shift { columns: 1..5, by: 2, way: Way::Left }.apply(&mut shown, PackedCell::UNKNOWN);
        assert_eq!(shown[..3], row("ade"));
        assert_eq!((shown[3], shown[4]), (PackedCell::UNKNOWN, PackedCell::UNKNOWN));
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
            let to_send = |shown: &[PackedCell]| shown.iter().zip(wanted).filter(|(a, b)| a != b).count();
            let before = to_send(&shown);
            if let Some(shift) = best(&shown, wanted) {
                shift.apply(&mut shown, PackedCell::UNKNOWN);
                prop_assert!(to_send(&shown) < before);
            }
        }
    }
}
