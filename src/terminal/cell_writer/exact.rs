//! Draws a row exactly as it is wanted.

use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use super::look::{self, Look};
use super::pen::Pen;
use super::screen::Row;
use super::shift::{CELL, Moves, Shift};
use super::style::Style;

/// Makes a row look as it is wanted.
pub(super) fn draw_row(pen: &mut Pen, mut row: Row) {
    if row.can_move() {
        shift(pen, &mut row);
    }
    let mut covered = 0;
    for column in 0..row.width() {
        if covered > 0 {
            // The second half of a wide character.
            covered -= 1;
            row.shown[column] = Look::UNKNOWN;
            continue;
        }
        if !row.shown[column].is(row.looks[column]) {
            draw_cell(pen, &mut row, column);
        }
        if row.looks[column].is_intricate() {
            covered = row.wanted[column].cell_width().saturating_sub(1);
        }
    }
    *row.exact = true;
    row.finish();
}

/// Draws one cell of a row.
pub(super) fn draw_cell(pen: &mut Pen, row: &mut Row, column: usize) {
    let position = Position { x: column as u16, y: row.y };
    if let Some(halves) = row.looks[column].halves() {
        let (glyph, style) = look::cheapest(halves, pen.style());
        pen.draw(position, glyph.symbol(), style);
    } else {
        let cell = &row.wanted[column];
        pen.draw_text(position, cell.symbol(), Style::of(cell));
    }
    row.shown[column] = row.looks[column];
}

/// Moves the stretches of a row that have only moved.
fn shift(pen: &mut Pen, row: &mut Row) {
    let wrong = row.shown.iter().zip(row.looks).filter(|(shown, look)| shown != look).count();
    if !Shift::may_spare(wrong as i32 * CELL) {
        return;
    }
    let moves = Moves::between(row.before, row.looks);
    let width = row.width();
    loop {
        let (shown, looks) = (&*row.shown, row.looks);
        let loss = |from: usize, to: usize| if shown[from] == looks[to] { 0 } else { CELL };
        let Some(shift) = Shift::best(width, &moves, loss) else { break };
        pen.shift_row(&shift, row.y);
        shift.apply(row.shown, Look::UNKNOWN);
    }
}
