//! Draws a row about as it is wanted, for fewer bytes.

use ratatui::layout::Position;

use super::exact;
use super::ink::{Halves, Ink, Price};
use super::look::Look;
use super::pen::Pen;
use super::screen::Row;
use super::shift::{BYTE, CELL, Loss, Shifts};
use super::trellis::{Action, Trellis, Wanted};

/// Draws rows inexactly, and keeps the memory that it takes.
#[derive(Debug, Default)]
pub(super) struct Draughtsman {
    /// The colours that a row is to show, and those that it shows; `None` where they must be exact.
    wanted: Vec<Option<Halves>>,
    shown: Vec<Option<Halves>>,
    cells: Vec<Wanted>,
    trellis: Trellis,
}

impl Draughtsman {
    /// Makes a row look as it is wanted, or so that it can't be told for that price.
    pub(super) fn draw_row(
        &mut self,
        pen: &mut Pen,
        shifts: &mut Shifts,
        mut row: Row,
        price: Price,
    ) {
        if *row.intricate {
            // Nobody knows how much of it a character covers.
            return exact::draw_row(pen, shifts, row);
        }
        self.mix_inks(&row);
        self.shift(pen, shifts, &mut row, price);
        self.cells.clear();
        let inks = self.wanted.iter().zip(&self.shown);
        let looks = row.shown.iter().zip(row.looks);
        self.cells.extend(inks.zip(looks).map(|((wanted, shown), looks)| match *wanted {
            Some(wanted) => Wanted::Halves { wanted, shown: *shown },
            None => Wanted::Fixed { is_shown: looks.0 == looks.1 },
        }));
        let actions = self.trellis.search(&self.cells, row.y, pen.style(), price);
        *row.exact = true;
        for (column, &action) in actions.iter().enumerate() {
            match action {
                Action::Keep => {}
                Action::DrawExactly => exact::draw_cell(pen, &mut row, column),
                Action::Draw(glyph, style) => {
                    let position = Position { x: column as u16, y: row.y };
                    pen.draw_block(position, glyph, style);
                    row.shown[column] = Look::of_block(glyph, style);
                }
            }
            *row.exact &= row.shown[column] == row.looks[column];
        }
    }

    fn mix_inks(&mut self, row: &Row) {
        self.wanted.clear();
        self.wanted.extend(row.looks.iter().map(|&look| inks(look)));
        self.shown.clear();
        let shown = row.shown.iter().zip(row.looks).zip(&self.wanted);
        self.shown
            .extend(shown.map(
                |((&shown, &look), wanted)| if shown == look { *wanted } else { inks(shown) },
            ));
    }

    /// Moves the stretches of a row that have only moved, or about.
    fn shift(&mut self, pen: &mut Pen, shifts: &mut Shifts, row: &mut Row, price: Price) {
        let lose = |shown: &[Option<Halves>],
                    row: &Row,
                    [from, to]: [usize; 2],
                    losses: &mut Vec<Loss>| {
            let inks = shown[from..].iter().zip(&self.wanted[to..]);
            let looks = row.shown[from..].iter().zip(&row.looks[to..]);
            losses.extend(inks.zip(looks).map(|(inks, (shown, look))| match inks {
                _ if shown == look => 0,
                (Some(shown), Some(wanted)) => {
                    ((price.of_halves(*shown, *wanted) * f32::from(BYTE)) as Loss).min(CELL)
                }
                _ => CELL,
            }));
        };
        shifts.begin(row, |from, to, losses| lose(&self.shown, row, [from, to], losses));
        while let Some(shift) =
            shifts.next(|from, to, losses| lose(&self.shown, row, [from, to], losses))
        {
            pen.shift_row(&shift, row.y);
            row.shift(&shift);
            shift.apply(&mut self.shown, None);
        }
        shifts.end(row);
    }
}

fn inks(look: Look) -> Option<Halves> {
    let [upper, lower] = look.halves()?;
    Some([Ink::of(upper)?, Ink::of(lower)?])
}
