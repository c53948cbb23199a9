//! The stretch of a row that is best moved.

use std::ops::Range;

use super::Loss;

/// About the stretch with the most spared, where that much is lost now, and that much after it has moved.
///
/// It is found block by block, and then its ends to the cell: the best one to the cell takes longer than
/// all that it finds is worth.
pub(super) fn best_stretch(now: &[Loss], moved: &[Loss]) -> Range<usize> {
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

/// So many cells are one block.
const BLOCK: usize = 8;

/// The blocks with the most spared.
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

/// How much more is lost now in a block than after.
#[inline]
fn spared(now: &[Loss], moved: &[Loss]) -> Loss {
    now.iter().zip(moved).map(|(now, moved)| now - moved).sum()
}

/// How many of the first of `gains` have the largest sum.
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
