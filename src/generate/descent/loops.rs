//! Loops in a maze: a player who meets a guard in a passage needs another way.

use super::super::tileset::Tileset;
use crate::rng::SplitMix64;

/// One of this many walls between two passages is opened.
const OPENED: usize = 7;

/// Opens walls between the passages of a maze.
pub(crate) fn open(cells: &mut [Vec<u8>], tileset: &Tileset, random: &mut SplitMix64) {
    for row in 1..cells.len().saturating_sub(1) {
        for column in 1..cells[row].len().saturating_sub(1) {
            let bare = |column: usize, row: usize| tileset.is_bare(cells[row][column]);
            let walkable = |column: usize, row: usize| tileset.is_walkable(cells[row][column]);
            let across = (walkable(column - 1, row), walkable(column + 1, row));
            let down = (walkable(column, row - 1), walkable(column, row + 1));
            let floor = match (across, down) {
                _ if walkable(column, row) => None,
                ((true, true), (false, false)) if bare(column - 1, row) => {
                    cells[row].get(column - 1)
                }
                ((false, false), (true, true)) if bare(column, row - 1) => {
                    cells[row - 1].get(column)
                }
                _ => None,
            };
            let floor = floor.copied().filter(|_| random.one_in(OPENED));
            if let Some(floor) = floor {
                cells[row][column] = floor;
            }
        }
    }
}
