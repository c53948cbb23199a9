//! Draws a row within a tolerance, for fewer bytes.
//!
//! Two cells are compared by the distance of their two colours in L\*a\*b\*, if they are both
//! blocks or both the same character without modifiers. All other cells are drawn exactly. Another
//! character in place of the wanted one, such as its neighbour on a ramp of brightness, was
//! refused: in ascii mode the character also identifies the surface, and most of the bytes are
//! colours.

use std::cell::Cell;

use ratatui::layout::Position;

use super::block_element::BlockElement;
use super::exact;
use super::glyph_table::{GlyphId, GlyphTable};
use super::ink::{Ink, Inks, Notation, Price};
use super::packed_cell::{Form, PackedCell};
use super::pen::Pen;
use super::screen::Row;
use super::shift::{BYTE, CELL, Loss, Shifts};
use super::style::Style;
use super::trellis::{Action, Store, Terms, Trellis, Wanted};
use crate::terminal::{Fidelity, thread_memory};

/// Draws rows inexactly; keeps its memory between rows, one for each thread.
#[derive(Debug, Default)]
pub(super) struct RowEncoder {
    inks: Inks,
    /// The colours of the row's targets, and of the cells on the screen.
    wanted: Colors,
    shown: Colors,
    /// The cost of keeping the two colours of each cell.
    keep: Vec<[f32; 2]>,
    /// The cost if the cells had moved.
    moved: Vec<[f32; 2]>,
    trellis: Trellis,
}

/// The two colours of each cell in L\*a\*b\*, component by component, so that several distances are
/// computed at once.
///
/// Characters are far from blocks and from other characters. A cell that may only be shown exactly
/// is far from every colour and from every cell that looks different.
#[derive(Debug, Default)]
struct Colors([Vec<[f32; 2]>; 3]);

thread_local! {
    static ENCODER: Cell<Option<Box<RowEncoder>>> = const { Cell::new(None) };
}

impl RowEncoder {
    /// Makes rows look like their targets within `fidelity`.
    pub(super) fn draw_rows<'a>(
        pen: &mut Pen,
        shifts: &mut Shifts,
        rows: impl Iterator<Item = Row<'a>>,
        fidelity: Fidelity,
    ) {
        let mut encoder = thread_memory::take(&ENCODER).unwrap_or_default();
        rows.for_each(|row| encoder.draw_row(pen, shifts, row, fidelity));
        thread_memory::put_back(&ENCODER, Some(encoder));
    }

    /// Makes a row look like its target within `fidelity`.
    fn draw_row(&mut self, pen: &mut Pen, shifts: &mut Shifts, mut row: Row, fidelity: Fidelity) {
        if *row.intricate {
            // The extent of an intricate character is unknown.
            return exact::draw_row(pen, shifts, row);
        }
        let notation = Notation::of(row.targets, pen.palette().is_on());
        let price = Price::at(fidelity, notation);
        self.wanted.fill(row.targets, row.glyph_table, &mut self.inks);
        self.shown.fill(row.shown, row.glyph_table, &mut self.inks);
        self.shift(pen, shifts, &mut row, price);
        self.shown.costs(&self.wanted, [0, 0], price, &mut self.keep);
        let terms = Terms { price, style: pen.style(), repeats: pen.repeats() };
        let mut store = Store { inks: &mut self.inks, palette: pen.palette() };
        let wanted =
            |column: usize, inks: &mut Inks| wanted(row.targets[column], row.glyph_table, inks);
        let actions = self.trellis.search(&self.keep, wanted, terms, &mut store);
        for &(column, action) in actions {
            match action {
                Action::DrawExactly => exact::draw_cell(pen, &mut row, usize::from(column)),
                Action::Draw(element, style) => draw_cell(pen, &mut row, column, element, style),
            }
        }
        *row.exact = row.shown == row.targets;
    }

    /// Moves the stretches of a row that have moved sideways, at least approximately.
    fn shift(&mut self, pen: &mut Pen, shifts: &mut Shifts, row: &mut Row, price: Price) {
        let (wanted, moved) = (&self.wanted, &mut self.moved);
        let mut lose = |shown: &Colors, places: [usize; 2], losses: &mut Vec<Loss>| {
            shown.costs(wanted, places, price, moved);
            losses.extend(moved.iter().map(|[one, other]| loss(one + other)));
        };
        shifts.begin(row, |from, to, losses| lose(&self.shown, [from, to], losses));
        while let Some(shift) =
            shifts.next(|from, to, losses| lose(&self.shown, [from, to], losses))
        {
            pen.shift_row(&shift, row.y);
            row.shift(&shift);
            for components in &mut self.shown.0 {
                shift.apply(components, [-FAR; 2]);
            }
        }
        shifts.end(row);
    }
}

/// The loss of this number of bytes, at most that of a cell.
#[inline]
fn loss(bytes: f32) -> Loss {
    /// The sum of this and a small number has the rounded number in its lowest bits.
    const INTEGER: f32 = 8_388_608.0;
    let (loss, most) = (bytes * f32::from(BYTE), f32::from(CELL));
    ((if loss < most { loss } else { most }) + INTEGER).to_bits() as Loss
}

/// The L*, a* and b* of two colours.
#[inline]
fn components([one, other]: [Ink; 2]) -> [[f32; 2]; 3] {
    [0, 1, 2].map(|index| [one.lab[index], other.lab[index]])
}

/// The colours of a cell that is not a block.
#[inline(never)]
fn of_character(target: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> [[f32; 2]; 3] {
    match target.recolorable(glyph_table) {
        Some((Form::Glyph(id), colors)) => {
            let (apart, components) = (apart(id), components(inks.of_both(colors)));
            [0, 1, 2].map(|index| components[index].map(|component| component + apart[index]))
        }
        // Cells that look different are far from each other.
        _ => target.hashes().map(|hash| [FAR * (1.0 + f32::from(hash)); 2]),
    }
}

/// The target of a cell for the search; `None` if it may only be drawn exactly.
#[inline]
fn wanted(target: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> Option<Wanted> {
    let (form, colors) = target.recolorable(glyph_table)?;
    let character = match form {
        Form::Block => None,
        Form::Glyph(id) => Some(glyph_table.glyph(id).character().len_utf8() as u8),
    };
    Some(Wanted { inks: inks.of_both(colors), character })
}

/// Draws a cell in these colours, as a block or as its own character.
#[inline]
fn draw_cell(pen: &mut Pen, row: &mut Row, column: u16, element: BlockElement, style: Style) {
    let position = Position { x: column, y: row.y };
    let column = usize::from(column);
    let target = row.targets[column];
    row.shown[column] = match target.text(row.glyph_table) {
        None => {
            pen.draw_block(position, element, style);
            PackedCell::of_block(element, style)
        }
        Some((character, _)) => {
            pen.draw_text(position, character.encode_utf8(&mut [0; 4]), style);
            target.recolored([style.foreground, style.background])
        }
    };
}

/// The displacement of a glyph from blocks: a point of its own in a lattice whose points are
/// farther apart than colours.
fn apart(id: GlyphId) -> [f32; 3] {
    const SPACING: f32 = 1000.0;
    let id = id.get() + 1;
    [id & 15, id >> 4 & 15, id >> 8].map(|digit| SPACING * f32::from(digit))
}

/// A distance from every colour that is larger than any tolerance.
const FAR: f32 = 1e6;

impl Colors {
    /// Computes the colours of cells.
    fn fill(&mut self, targets: &[PackedCell], glyph_table: &GlyphTable, inks: &mut Inks) {
        for components in &mut self.0 {
            components.resize(targets.len(), [0.0; 2]);
        }
        let [ls, as_, bs] = &mut self.0;
        let places = ls.iter_mut().zip(as_).zip(bs);
        let mut last = (PackedCell::UNKNOWN, [[FAR; 2]; 3]);
        for (&target, ((l, a), b)) in targets.iter().zip(places) {
            if target != last.0 {
                last.0 = target;
                last.1 = match target.halves() {
                    Some(halves) => components(inks.of_both(halves)),
                    None => of_character(target, glyph_table, inks),
                };
            }
            [*l, *a, *b] = last.1;
        }
    }

    /// The cost of showing the cells of this row from `from` on in place of those of `others` from
    /// `to` on, cell by cell.
    fn costs(
        &self,
        others: &Self,
        [from, to]: [usize; 2],
        price: Price,
        costs: &mut Vec<[f32; 2]>,
    ) {
        let count = others.0[0].len() - from.max(to);
        costs.resize(count, [0.0; 2]);
        let [ls, as_, bs] = self.0.each_ref().map(|shown| shown[from..][..count].as_flattened());
        let wanted = others.0.each_ref().map(|wanted| wanted[to..][..count].as_flattened());
        let shown = ls.iter().zip(as_).zip(bs);
        let wanted = wanted[0].iter().zip(wanted[1]).zip(wanted[2]);
        for (cost, (((l, a), b), ((l2, a2), b2))) in
            costs.as_flattened_mut().iter_mut().zip(shown.zip(wanted))
        {
            let [l, a, b] = [l - l2, a - a2, b - b2];
            *cost = price.of_distance((l * l + a * a + b * b).sqrt());
        }
    }
}
