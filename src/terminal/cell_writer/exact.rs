//! Draws a row exactly.

use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use super::block_element;
use super::packed_cell::PackedCell;
use super::pen::Pen;
use super::screen::Row;
use super::shift::{CELL, Loss, Shifts};
use super::style::Style;

/// Makes a row look like its target.
pub(crate) fn draw_row(pen: &mut Pen, shifts: &mut Shifts, mut row: Row) {
    if *row.intricate {
        draw_intricate_row(pen, &mut row);
    } else {
        shift(pen, shifts, &mut row);
        let cells = row.targets.iter().copied().enumerate().zip(shifts.losses());
        let wrong = cells.filter(|&(_, &loss)| loss > 0).map(|(cell, _)| cell);
        pen.draw_pixels(row.y, wrong, |pen, column, target| draw_target(pen, &row, column, target));
        row.shown.copy_from_slice(row.targets);
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
#[inline(never)]
pub(crate) fn draw_cell(pen: &mut Pen, row: &mut Row, column: usize) {
    let target = row.targets[column];
    draw_target(pen, row, column, target);
    row.shown[column] = target;
}

/// Draws the target of a cell of a row.
#[inline(never)]
fn draw_target(pen: &mut Pen, row: &Row, column: usize, target: PackedCell) {
    let position = Position { x: column as u16, y: row.y };
    if let Some((shape, colors)) = target.block() {
        let (element, style) = block_element::cheapest(colors, pen.style());
        pen.draw_block(position, (shape, element), style);
    } else {
        draw_text(pen, row, position, target);
    }
}

/// Draws a cell that is not a block.
#[inline(never)]
fn draw_text(pen: &mut Pen, row: &Row, position: Position, target: PackedCell) {
    let mut character = [0; 4];
    let (text, style) = if let Some((text, style)) = target.text(row.glyph_table) {
        (&*text.encode_utf8(&mut character), style)
    } else {
        let cell = &row.wanted[usize::from(position.x)];
        (cell.symbol(), Style::of(cell))
    };
    pen.draw_text(position, text, style);
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
