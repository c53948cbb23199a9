//! Draws a row exactly.

use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use super::packed_cell::{self, PackedCell};
use super::pen::Pen;
use super::screen::Row;
use super::shift::{CELL, Loss, Shifts};
use super::style::Style;

/// Makes a row look like its target.
pub(super) fn draw_row(pen: &mut Pen, shifts: &mut Shifts, mut row: Row) {
    if *row.intricate {
        draw_intricate_row(pen, &mut row);
    } else {
        shift(pen, shifts, &mut row);
        for (column, &loss) in shifts.losses().iter().enumerate() {
            if loss > 0 {
                draw_cell(pen, &mut row, column);
            }
        }
    }
    *row.exact = true;
}

/// Draws a row whose characters may cover more than their cells.
fn draw_intricate_row(pen: &mut Pen, row: &mut Row) {
    let mut covered = 0;
    for column in 0..row.width() {
        if covered > 0 {
            // The second half of a wide character.
            covered -= 1;
            row.shown[column] = PackedCell::UNKNOWN;
            continue;
        }
        if !row.shown[column].is(row.targets[column]) {
            draw_cell(pen, row, column);
        }
        if row.targets[column].is_intricate() {
            covered = row.wanted[column].cell_width().saturating_sub(1);
        }
    }
    *row.intricate = row.shown.iter().chain(row.targets).any(|target| target.is_intricate());
}

/// Draws one cell of a row.
pub(super) fn draw_cell(pen: &mut Pen, row: &mut Row, column: usize) {
    let position = Position { x: column as u16, y: row.y };
    if let Some(halves) = row.targets[column].halves() {
        let (element, style) = packed_cell::cheapest(halves, pen.style());
        pen.draw_block(position, element, style);
    } else {
        let mut character = [0; 4];
        let (text, style) = match row.targets[column].text(row.glyph_table) {
            Some((text, style)) => (&*text.encode_utf8(&mut character), style),
            None => (row.wanted[column].symbol(), Style::of(&row.wanted[column])),
        };
        pen.draw_text(position, text, style);
    }
    row.shown[column] = row.targets[column];
}

/// Moves the stretches of a row that have moved sideways.
fn shift(pen: &mut Pen, shifts: &mut Shifts, row: &mut Row) {
    let lose = |row: &Row, from: usize, to: usize, losses: &mut Vec<Loss>| {
        let targets = row.shown[from..].iter().zip(&row.targets[to..]);
        losses.extend(targets.map(|(shown, target)| if shown == target { 0 } else { CELL }));
    };
    shifts.begin(row, |from, to, losses| lose(row, from, to, losses));
    while let Some(shift) = shifts.next(|from, to, losses| lose(row, from, to, losses)) {
        pen.shift_row(&shift, row.y);
        row.shift(&shift);
    }
    shifts.end(row);
}
