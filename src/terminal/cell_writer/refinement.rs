//! Refinement: a picture that does not change becomes exact, in a few frames of similar size.
//!
//! Each row that has not changed for some frames is refined even while others change, since a
//! blinking cell or a clock changes in every picture. The worst cells come first.
//!
//! Rejected: reducing the tolerance step by step. Cells were sent twice, and the last frame had most of the bytes.

use std::cell;

use super::block::Shape;
use super::ink::Inks;
use super::packed_cell::GlyphTable;
use super::packed_cell::{Form, PackedCell};
use super::pen::Pen;
use super::row::{draw_cell, draw_row};
use super::screen::{Row, Screen};
use super::shift::Shifts;

/// The progress of refinement.
#[derive(Debug)]
pub(crate) struct Refinement {
    /// The number of frames until the picture is exact.
    frames: usize,
}

/// The inexact cells.
#[derive(Debug, Default)]
struct Inexact {
    /// Their errors and positions, row by row.
    cells: Vec<Cell>,
    inks: Inks,
}

/// The error and the position of a cell.
#[derive(Clone, Copy, Debug)]
struct Cell {
    error: f32,
    y: u16,
    column: u16,
}

/// The number of frames in which a still picture becomes exact.
const FRAMES: usize = 10;

/// The number of frames without a change after which a row is refined while others change. Cells
/// that soon move on would be drawn in vain.
const PATIENCE: usize = 10;

thread_local! {
    static INEXACT: cell::Cell<Option<Box<Inexact>>> = const { cell::Cell::new(None) };
}

impl Refinement {
    pub(crate) fn new() -> Self {
        Self { frames: FRAMES }
    }

    /// Starts again after a motion.
    pub(crate) fn disturb(&mut self) {
        self.frames = FRAMES;
    }

    /// Draws the next refinement frame of the whole screen.
    pub(crate) fn draw(&mut self, pen: &mut Pen, shifts: &mut Shifts, screen: &mut Screen) {
        if screen.is_exact() {
            return;
        }
        let mut inexact = INEXACT.take().unwrap_or_default();
        inexact.cells.clear();
        for row in screen.inexact_rows() {
            if row.is_near() {
                inexact.add(&row);
            } else {
                draw_row(pen, shifts, row);
            }
        }
        inexact.choose_worst(self.frames);
        self.frames = (self.frames - 1).max(1);
        let mut chosen = inexact.cells.iter().peekable();
        for mut row in screen.inexact_rows() {
            while let Some(cell) = chosen.next_if(|cell| cell.y == row.y) {
                draw_cell(pen, &mut row, usize::from(cell.column));
            }
            *row.exact = row.shown == row.targets;
        }
        INEXACT.set(Some(inexact));
    }

    /// Draws the next refinement frame of the rows that rest while others change.
    pub(crate) fn draw_resting(pen: &mut Pen, shifts: &mut Shifts, screen: &mut Screen) {
        if screen.is_exact() {
            return;
        }
        let mut inexact = INEXACT.take().unwrap_or_default();
        for mut row in screen.inexact_rows() {
            let Some(drawn) = usize::from(row.rested).checked_sub(PATIENCE) else { continue };
            if !row.is_near() {
                draw_row(pen, shifts, row);
                continue;
            }
            inexact.cells.clear();
            inexact.add(&row);
            inexact.choose_worst(FRAMES.saturating_sub(drawn).max(1));
            for cell in &inexact.cells {
                draw_cell(pen, &mut row, usize::from(cell.column));
            }
            *row.exact = row.shown == row.targets;
        }
        INEXACT.set(Some(inexact));
    }
}

impl Inexact {
    /// Adds the inexact cells of a row.
    fn add(&mut self, row: &Row) {
        self.cells.extend(errors(row, &mut self.inks));
    }

    /// Keeps the worst cells, a share for one of `frames` frames, in the order of the screen.
    fn choose_worst(&mut self, frames: usize) {
        let share = self.cells.len().div_ceil(frames);
        if share < self.cells.len() {
            self.cells
                .select_nth_unstable_by(share, |one, other| other.error.total_cmp(&one.error));
            self.cells.truncate(share);
        }
        self.cells.sort_unstable_by_key(|cell| (cell.y, cell.column));
    }
}

/// The errors of the inexact cells of a row.
fn errors<'a>(row: &'a Row, inks: &'a mut Inks) -> impl Iterator<Item = Cell> + 'a {
    let targets = row.shown.iter().zip(row.targets);
    (0..).zip(targets).filter(|(_, (shown, target))| shown != target).map(
        |(column, (&shown, &target))| {
            let error = error(shown, target, row.glyph_table, inks);
            Cell { error, y: row.y, column }
        },
    )
}

/// The largest distance of two colours in the same place; infinite if the cells cannot be compared.
fn error(shown: PackedCell, wanted: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> f32 {
    let parts = shown.recolorable(glyph_table).zip(wanted.recolorable(glyph_table));
    let Some(((shown_form, shown), (form, wanted))) = parts else { return f32::INFINITY };
    let pairs = match (shown_form, form) {
        (Form::Block(one), Form::Block(other)) => one.overlap(other).pairs(),
        _ if shown_form == form => Shape::HALF.overlap(Shape::HALF).pairs(),
        _ => return f32::INFINITY,
    };
    let distances = pairs.into_iter().filter(|&(_, parts)| parts > 0);
    distances
        .map(|([one, other], _)| inks.of(shown[one]).distance(inks.of(wanted[other])))
        .fold(0.0, f32::max)
}
