//! Row shifts: the terminal moves cells that moved sideways, so that they are not sent again.
//!
//! In a picture that turns, most cells move by a few columns. Deleting and inserting characters
//! (DCH and ICH) moves a stretch of a row for about twenty bytes, which a single cell may take too.
//! Scrolling whole regions sideways was refused: few terminals have left and right margins.

mod landmarks;
mod stretch;

use std::ops::Range;

use self::landmarks::Landmarks;
pub(crate) use self::landmarks::Mark;
use self::stretch::best_stretch;
use super::screen::Row;

/// A stretch of a row that moves by some columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Shift {
    /// The stretch. Cells that move out of it are lost, and cells that become free are unknown.
    pub(crate) columns: Range<usize>,
    /// The distance, in columns.
    pub(crate) by: usize,
    /// The direction.
    pub(crate) way: Way,
}

/// A direction and a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Move {
    way: Way,
    by: usize,
}

impl Move {
    /// The first cell that can move, and its destination.
    fn places(self) -> (usize, usize) {
        match self.way {
            Way::Left => (self.by, 0),
            Way::Right => (0, self.by),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Left,
    Right,
}

/// The approximate cost of sending a cell that shows the wrong content, in units of 1 / [`BYTE`]
/// bytes.
pub(crate) type Loss = i16;

/// The loss of one byte.
pub(crate) const BYTE: Loss = 16;
/// The loss of a completely wrong cell.
pub(crate) const CELL: Loss = 12 * BYTE;
/// The approximate cost of a shift: two motions, a deletion and an insertion.
const SHIFT: i32 = 20 * BYTE as i32;

/// Finds the shifts of a row, one after another; keeps its memory between rows.
#[derive(Debug, Default)]
pub(crate) struct Shifts {
    landmarks: Landmarks,
    /// The present losses, the losses after a move, and the losses after the best move.
    losses: Vec<Loss>,
    moved: Vec<Loss>,
    moved_best: Vec<Loss>,
}

impl Shifts {
    /// Begins a row. `lose` adds the losses of showing the cells that are now at the first column
    /// and after it, at the second column and after it.
    pub(crate) fn begin(&mut self, row: &Row, mut lose: impl FnMut(usize, usize, &mut Vec<Loss>)) {
        self.landmarks.find(row.targets, row.marks);
        self.losses.clear();
        lose(0, 0, &mut self.losses);
    }

    /// The shift with the smallest loss after it, if it saves more than its cost.
    pub(crate) fn next(
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

    /// Updates the losses and landmarks after a shift.
    fn take(&mut self, shift: &Shift) {
        self.landmarks.shift(shift);
        let moved = shift.columns.start..shift.columns.end - shift.by;
        self.losses[shift.covered()].copy_from_slice(&self.moved_best[moved]);
        self.losses[shift.uncovered()].fill(CELL);
    }

    /// The loss of each cell of the row.
    pub(crate) fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Ends the row: its present targets are the previous ones of the next frame.
    pub(crate) fn end(&self, row: &mut Row) {
        row.marks.copy_from_slice(self.landmarks.marks());
    }
}

impl Shift {
    /// The best shift by a move, and its saving, from the losses `now` and the losses if all cells
    /// had `moved`.
    fn best(by: Move, now: &[Loss], moved: &[Loss]) -> (Self, i32) {
        let (_, first) = by.places();
        let stretch = best_stretch(&now[first..], moved);
        let losses = now[first..][stretch.clone()].iter().zip(&moved[stretch.clone()]);
        let spared: i32 = losses.map(|(&now, &moved)| i32::from(now - moved)).sum();
        let Move { way, by } = by;
        let shift = Self { columns: stretch.start..stretch.end + by, by, way };
        // Uncovered cells must be sent, even if they were right before.
        let lost = shift.by as i32 * i32::from(CELL) - sum(&now[shift.uncovered()]);
        (shift, spared - lost)
    }

    /// The cells whose content is unknown after the shift.
    fn uncovered(&self) -> Range<usize> {
        let Range { start, end } = self.columns;
        match self.way {
            Way::Left => end - self.by..end,
            Way::Right => start..start + self.by,
        }
    }

    /// The cells that show the content of other cells after the shift.
    fn covered(&self) -> Range<usize> {
        let Range { start, end } = self.columns;
        match self.way {
            Way::Left => start..end - self.by,
            Way::Right => start + self.by..end,
        }
    }

    /// Moves the values in `row` as the terminal moves its cells; uncovered ones become `unknown`.
    pub(crate) fn apply<T: Clone>(&self, row: &mut [T], unknown: T) {
        let stretch = &mut row[self.columns.clone()];
        match self.way {
            Way::Left => stretch.rotate_left(self.by),
            Way::Right => stretch.rotate_right(self.by),
        }
        row[self.uncovered()].fill(unknown);
    }
}

/// The sum of these losses.
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
        // Letters then have the same ids in all texts.
        (' '..='~').for_each(|letter| _ = glyph_table.id(Glyph::new(letter, Modifier::empty())));
        let target = |letter| PackedCell::of_character(letter, [Color::Reset; 2], &mut glyph_table);
        text.chars().map(target).collect()
    }

    #[test]
    fn a_moved_row_is_detected() {
        let shown = row("abcdefghijklmnop");
        let shift = best(&shown, &row("defghijklmnopqrs")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 3, way: Way::Left });
        let shift = best(&shown, &row("xxabcdefghijklmn")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 2, way: Way::Right });
    }

    #[test]
    fn cells_that_stand_still_are_not_moved() {
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
    fn a_shift_uncovers_unknown_cells() {
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
