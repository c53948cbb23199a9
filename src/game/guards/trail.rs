//! The trail of a player: the cells where they were, which hounds smell.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::game::stored::{RestoreError, check};
use crate::world::{Cell, TileEffect, World};

/// The number of steps for which a cell smells: 20 seconds.
const SMELL_STEPS: u64 = 1200;
/// The maximum number of cells that are remembered.
const MAX: usize = 128;

/// The cells that a player has visited, oldest first. Water keeps no smell.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Trail {
    marks: VecDeque<TrailCell>,
    /// The number of the oldest mark. Marks are numbered from the start of the game.
    pub(crate) first: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct TrailCell {
    cell: Cell,
    left_at: u64,
}

impl Trail {
    /// Records the cell of a player in the step `now`.
    pub(crate) fn record(&mut self, world: &World, cell: Cell, now: u64) {
        self.fade(now);
        match self.marks.back_mut() {
            Some(mark) if mark.cell == cell => mark.left_at = now,
            _ if world.effect_in(cell) == Some(TileEffect::Water) => {}
            _ => self.marks.push_back(TrailCell { cell, left_at: now }),
        }
    }

    /// Records that a player has stayed in their cell from the step `before` to the step `now`.
    pub(crate) fn wait(&mut self, before: u64, now: u64) {
        if let Some(mark) = self.marks.back_mut().filter(|mark| mark.left_at == before) {
            mark.left_at = now;
        }
        self.fade(now);
    }

    /// Removes the cells that no longer smell.
    fn fade(&mut self, now: u64) {
        let is_stale = |mark: &TrailCell| now - mark.left_at > SMELL_STEPS;
        while self.marks.front().is_some_and(is_stale) || self.marks.len() >= MAX {
            self.marks.pop_front();
            self.first += 1;
        }
    }

    /// The number of the newest mark whose cell `smells`.
    pub(crate) fn newest(&self, smells: impl Fn(Cell) -> bool) -> Option<u64> {
        let place = self.marks.iter().rposition(|mark| smells(mark.cell))?;
        Some(self.first + place as u64)
    }

    /// The cell of the mark with this number.
    pub(crate) fn cell(&self, number: u64) -> Option<Cell> {
        let place = usize::try_from(number.checked_sub(self.first)?).ok()?;
        self.marks.get(place).map(|mark| mark.cell)
    }

    /// Returns an error if there are too many marks, or marks later than the step `now`.
    pub(crate) fn check(&self, now: u64) -> Result<(), RestoreError> {
        let are_past = self.marks.iter().all(|mark| mark.left_at <= now);
        check(are_past && self.marks.len() <= MAX, "a trail")
    }

    /// Forgets all cells, for example when the whole map has changed.
    pub(crate) fn forget(&mut self) {
        self.first += self.marks.len() as u64;
        self.marks.clear();
    }
}
