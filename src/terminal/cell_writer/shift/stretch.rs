//! The search for the best stretch of a row to move.

use std::ops::Range;

use super::Loss;

/// The approximate stretch with the largest saving, from the losses `now` and the losses if all
/// cells had `moved`.
///
/// The search finds blocks first, and then moves the ends by cells. An exact search takes more time
/// than its better result saves.
pub(crate) fn best_stretch(now: &[Loss], moved: &[Loss]) -> Range<usize> {
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

/// The number of cells of a block.
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
