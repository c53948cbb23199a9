//! The stretch of a row that is best moved.

use std::ops::Range;

/// About the stretch with the most spared, where that much is lost now, and that much after it has moved.
///
/// It is found block by block, and then its ends to the cell: the best one to the cell takes longer than
/// all that it finds is worth.
pub(super) fn best_stretch(now: &[i32], moved: &[i32]) -> Range<usize> {
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
