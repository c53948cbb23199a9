//! Row shifts: the terminal moves cells that moved sideways, so that they are not sent again.
//!
//! When a picture turns, most cells move by a few columns. Deleting and inserting characters (DCH and ICH) moves a
//! stretch of a row for about twenty bytes. A single cell may take as many.
//!
//! A move is detected by landmarks: cells that differ from the one before them, identified by a mark of eight bits.
//! Each mark of a row is compared with all previous marks around it, in a few instructions for sixteen of them, and
//! votes for the moves that may have brought it there.
//!
//! Rejected: comparing the appearance of cells. It took longer than the rest of the encoder. Rejected: a table of
//! marks. It missed marks that occur several times. Rejected: scrolling whole regions sideways. Few terminals have left
//! and right margins.

use std::ops::Range;

use super::packed_cell::PackedCell;

/// A stretch of a row that moves by some columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Shift {
    /// The stretch. Cells that move out of it are lost, and cells that become free are unknown.
    pub(crate) columns: Range<usize>,
    /// The distance, in columns.
    pub(crate) by: usize,
    /// The direction.
    pub(crate) way: ShiftDirection,
}

/// A direction and a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Move {
    way: ShiftDirection,
    by: usize,
}

impl Move {
    /// The first cell that can move, and its destination.
    fn places(self) -> (usize, usize) {
        match self.way {
            ShiftDirection::Left => (self.by, 0),
            ShiftDirection::Right => (0, self.by),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShiftDirection {
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

/// Finds the shifts of a row, one after another. Keeps its memory between rows.
#[derive(Debug, Default)]
pub(crate) struct Shifts {
    landmarks: Landmarks,
    /// The current losses. The next two fields are the losses after a move and after the best move.
    pub(crate) losses: Vec<Loss>,
    moved: Vec<Loss>,
    moved_best: Vec<Loss>,
}

impl Shifts {
    /// Begins a row with these targets and the marks of the previous targets. `lose(from, to, losses)` adds the losses
    /// that the row would have if the cells from column `from` on moved to column `to`.
    pub(crate) fn begin(
        &mut self,
        targets: &[PackedCell],
        marks: &[CellHash],
        mut lose: impl FnMut(usize, usize, &mut Vec<Loss>),
    ) {
        self.landmarks.find(targets, marks);
        self.losses.clear();
        lose(0, 0, &mut self.losses);
    }

    /// The shift that saves the most, if it saves more than it costs.
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

    /// Ends the row. The marks of its current targets become the previous marks for the next frame.
    pub(crate) fn end(&self, marks: &mut [CellHash]) {
        marks.copy_from_slice(&self.landmarks.now);
    }
}

impl Shift {
    /// The best shift by a move, and its saving. `now` are the current losses, and `moved` are the losses if all cells
    /// moved.
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
            ShiftDirection::Left => end - self.by..end,
            ShiftDirection::Right => start..start + self.by,
        }
    }

    /// The cells that show the content of other cells after the shift.
    fn covered(&self) -> Range<usize> {
        let Range { start, end } = self.columns;
        match self.way {
            ShiftDirection::Left => start..end - self.by,
            ShiftDirection::Right => start + self.by..end,
        }
    }

    /// Moves the values in `row` as the terminal moves its cells. Uncovered cells become `unknown`.
    pub(crate) fn apply<T: Clone>(&self, row: &mut [T], unknown: T) {
        let stretch = &mut row[self.columns.clone()];
        match self.way {
            ShiftDirection::Left => stretch.rotate_left(self.by),
            ShiftDirection::Right => stretch.rotate_right(self.by),
        }
        row[self.uncovered()].fill(unknown);
    }
}

fn sum(losses: &[Loss]) -> i32 {
    losses.iter().map(|&loss| i32::from(loss)).sum()
}

/// The marks of a row's targets, now and before.
#[derive(Debug, Default)]
struct Landmarks {
    hashes: Vec<u32>,
    now: Vec<CellHash>,
    /// With [`FARTHEST`] empty marks on either side.
    before: Vec<CellHash>,
}

/// The farthest detected move. Content that moves faster has usually changed in other ways, too.
const FARTHEST: usize = 16;
/// The number of places at which a mark is searched: a cell's own place and the places around it.
const PLACES: usize = FARTHEST + 1 + FARTHEST;
/// The number of moves that are tried for a row. Twice as many would save half a byte in a hundred.
const MAX_TRIED: usize = 2;
/// The number of landmarks that may agree by chance.
const CHANCE: u16 = 2;

impl Landmarks {
    /// Finds the landmarks of a row with these targets and these previous marks.
    fn find(&mut self, targets: &[PackedCell], before: &[CellHash]) {
        self.hashes.clear();
        self.hashes.extend(targets.iter().map(|target| target.hash()));
        self.now.clear();
        self.now.extend(CellHash::all(&self.hashes));
        let nothing = CellHash::NONE.before();
        self.before.clear();
        self.before.resize(FARTHEST, nothing);
        self.before.extend(before.iter().map(|mark| mark.before()));
        self.before.resize(FARTHEST + before.len() + FARTHEST, nothing);
    }

    /// The moves with the most votes.
    fn likely_moves(&self) -> impl Iterator<Item = Move> {
        let votes = self.votes();
        let mut likely = [None; MAX_TRIED];
        let mut most = [CHANCE; MAX_TRIED];
        for by in 1..=FARTHEST {
            for (way, count) in
                [(ShiftDirection::Left, votes.left(by)), (ShiftDirection::Right, votes.right(by))]
            {
                if let Some(rank) = most.iter().position(|&most| count > most) {
                    likely[rank..].rotate_right(1);
                    most[rank..].rotate_right(1);
                    (likely[rank], most[rank]) = (Some(Move { way, by }), count);
                }
            }
        }
        likely.into_iter().flatten()
    }

    /// Counts, for each distance, the landmarks that have an equal previous mark at that distance.
    fn votes(&self) -> Votes {
        let mut votes = Votes([0; PLACES]);
        let around = self.before.windows(PLACES);
        let mut places =
            self.now.iter().copied().zip(around).filter(|&(now, _)| now != CellHash::NONE);
        for _ in 0..self.now.len().div_ceil(MAX_AT_ONCE) {
            votes.add(places.by_ref().take(MAX_AT_ONCE));
        }
        votes
    }

    /// Moves the previous marks, after a shift.
    fn shift(&mut self, shift: &Shift) {
        let row = &mut self.before[FARTHEST..][..self.now.len()];
        shift.apply(row, CellHash::NONE.before());
    }
}

/// The number of landmarks with an equal previous mark at each distance, from left to right. The middle entry is their
/// own place.
struct Votes([u16; PLACES]);

/// The number of votes that can be counted in eight bits.
const MAX_AT_ONCE: usize = u8::MAX as usize;

impl Votes {
    /// Adds the votes of at most [`MAX_AT_ONCE`] landmarks, each with the previous marks around
    /// it.
    fn add<'a>(&mut self, places: impl Iterator<Item = (CellHash, &'a [CellHash])>) {
        // One loop serves both sides. The compiler would unroll a shorter loop instead of counting sixteen places at
        // once.
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

/// Adds votes to sums. Not inlined: when it was, the compiler counted eight places at once instead of sixteen.
#[inline(never)]
fn widen(sums: &mut [u16; PLACES], votes: &[u8; PLACES]) {
    for (sum, &votes) in sums.iter_mut().zip(votes) {
        *sum += u16::from(votes);
    }
}

/// The mark of a landmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct CellHash(u8);

impl CellHash {
    /// The mark of a cell that is equal to the one before it.
    pub(crate) const NONE: Self = Self(0);

    /// This mark as a previous mark. There, `NONE` has another value, so that no mark is equal to it.
    fn before(self) -> Self {
        Self(self.0.max(1))
    }

    /// The marks of a row's cells, from the hashes of their packed cells.
    fn all(hashes: &[u32]) -> impl Iterator<Item = Self> {
        let pairs = hashes.iter().zip(hashes.iter().skip(1));
        let marks = pairs.map(|(&last, &hash)| {
            let pair = last.rotate_left(5).wrapping_add(hash);
            if last == hash { Self::NONE } else { Self(((pair >> 24) as u8).max(2)) }
        });
        // The cell before the first one is unknown, so the first cell is no landmark.
        hashes.first().map(|_| Self::NONE).into_iter().chain(marks)
    }
}

/// An approximation of the stretch with the largest saving. `now` are the current losses, and `moved` are the losses if
/// all cells moved.
///
/// The search finds blocks first, and then moves the ends by cells. Rejected: an exact search. It takes more time than
/// its better result saves.
fn best_stretch(now: &[Loss], moved: &[Loss]) -> Range<usize> {
    let width = now.len().min(moved.len());
    let (now, moved) = (&now[..width], &moved[..width]);
    let best = best_blocks(now, moved);
    let (first, last) = (best.start * BLOCK, best.end * BLOCK);
    let at_start = first.saturating_sub(BLOCK)..(first + BLOCK).min(width);
    let at_end = last.saturating_sub(BLOCK)..(last + BLOCK).min(width);
    let gains = |range: Range<usize>| {
        now[range.clone()].iter().zip(&moved[range]).map(|(now, moved)| now - moved)
    };
    let start = at_start.end - most_of(gains(at_start).rev());
    let end = at_end.start + most_of(gains(at_end));
    start..end.max(start)
}

/// The number of cells in a block.
const BLOCK: usize = 8;

/// The blocks with the largest saving.
fn best_blocks(now: &[Loss], moved: &[Loss]) -> Range<usize> {
    let ((now, rest_of_now), (moved, rest_of_moved)) =
        (now.as_chunks::<BLOCK>(), moved.as_chunks::<BLOCK>());
    let whole = now.iter().zip(moved).map(|(now, moved)| spared(now, moved));
    let last = spared(rest_of_now, rest_of_moved);
    let (mut start, mut sum) = (0, 0);
    let (mut best, mut most) = (0..0, 0);
    for (block, spared) in whole.chain([last]).enumerate() {
        if sum <= 0 {
            (start, sum) = (block, 0);
        }
        sum += i32::from(spared);
        if sum > most {
            (best, most) = (start..block + 1, sum);
        }
    }
    best
}

/// The saving of a move in a block.
#[inline]
fn spared(now: &[Loss], moved: &[Loss]) -> Loss {
    now.iter().zip(moved).map(|(now, moved)| now - moved).sum()
}

/// The length of the prefix of `gains` with the largest sum.
fn most_of(gains: impl Iterator<Item = Loss>) -> usize {
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
    use ratatui::style::{Color, Modifier};

    use super::*;
    use crate::terminal::cell_writer::packed_cell::{Glyph, GlyphTable, PackedCell};

    fn best(shown: &[PackedCell], wanted: &[PackedCell]) -> Option<Shift> {
        let mut shifts = Shifts::default();
        let lose = |from: usize, to: usize, losses: &mut Vec<Loss>| {
            let targets = shown[from..].iter().zip(&wanted[to..]);
            losses.extend(targets.map(|(shown, wanted)| CELL * Loss::from(shown != wanted)));
        };
        shifts.begin(wanted, &marks(shown), lose);
        shifts.next(lose)
    }

    fn marks(targets: &[PackedCell]) -> Vec<CellHash> {
        let hashes: Vec<_> = targets.iter().map(|target| target.hash()).collect();
        CellHash::all(&hashes).collect()
    }

    fn row(text: &str) -> Vec<PackedCell> {
        let mut glyph_table = GlyphTable::default();
        // This gives the letters the same ids in all texts.
        (' '..='~').for_each(|letter| _ = glyph_table.id(Glyph::new(letter, Modifier::empty())));
        let target = |letter| PackedCell::of_character(letter, [Color::Reset; 2], &mut glyph_table);
        text.chars().map(target).collect()
    }

    #[test]
    fn a_moved_row_is_detected() {
        let shown = row("abcdefghijklmnop");
        let shift = best(&shown, &row("defghijklmnopqrs")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 3, way: ShiftDirection::Left });
        let shift = best(&shown, &row("xxabcdefghijklmn")).unwrap();
        assert_eq!(shift, Shift { columns: 0..16, by: 2, way: ShiftDirection::Right });
    }

    #[test]
    fn still_cells_are_not_moved() {
        let shift = best(&row("abcdefghij|MAP|"), &row("bcdefghijk|MAP|")).unwrap();
        assert_eq!(shift, Shift { columns: 0..10, by: 1, way: ShiftDirection::Left });
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
        Shift { columns: 1..5, by: 2, way: ShiftDirection::Left }
            .apply(&mut shown, PackedCell::UNKNOWN);
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
