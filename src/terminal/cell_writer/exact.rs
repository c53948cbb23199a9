//! Draws a row exactly as it is wanted.

use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use super::look::{self, Look};
use super::pen::Pen;
use super::screen::Row;
use super::shift::{CELL, Shifts};
use super::style::Style;

/// Makes a row look as it is wanted.
pub(super) fn draw_row(pen: &mut Pen, shifts: &mut Shifts, mut row: Row) {
    if row.can_move() {
        shift(pen, shifts, &mut row);
        let mut column = 0;
        while let Some(unchanged) = row.alike_from(column) {
            column += unchanged;
            draw_cell(pen, &mut row, column);
            column += 1;
        }
    } else {
        draw_intricate_row(pen, &mut row);
    }
    *row.exact = true;
}

/// The same of a row where characters may cover more than their cells.
fn draw_intricate_row(pen: &mut Pen, row: &mut Row) {
    let mut covered = 0;
    for column in 0..row.width() {
        if covered > 0 {
            // The second half of a wide character.
            covered -= 1;
            row.shown[column] = Look::UNKNOWN;
            continue;
        }
        if !row.shown[column].is(row.looks[column]) {
            draw_cell(pen, row, column);
        }
        if row.looks[column].is_intricate() {
            covered = row.wanted[column].cell_width().saturating_sub(1);
        }
    }
}

/// Draws one cell of a row.
pub(super) fn draw_cell(pen: &mut Pen, row: &mut Row, column: usize) {
    let position = Position { x: column as u16, y: row.y };
    if let Some(halves) = row.looks[column].halves() {
        let (glyph, style) = look::cheapest(halves, pen.style());
        pen.draw_block(position, glyph, style);
    } else {
        let mut character = [0; 4];
        let (text, style) = match row.looks[column].text() {
            Some((text, style)) => (&*text.encode_utf8(&mut character), style),
            None => (row.wanted[column].symbol(), Style::of(&row.wanted[column])),
        };
        pen.draw_text(position, text, style);
    }
    row.shown[column] = row.looks[column];
}

/// Moves the stretches of a row that have only moved.
fn shift(pen: &mut Pen, shifts: &mut Shifts, row: &mut Row) {
    shifts.begin(row);
    while let Some(shift) = shifts.next(row, |from, to, losses| {
        let looks = row.shown[from..].iter().zip(&row.looks[to..]);
        losses.extend(looks.map(|(shown, look)| if shown == look { 0 } else { CELL }));
    }) {
        pen.shift_row(&shift, row.y);
        row.shift(&shift);
    }
    shifts.end(row);
}
