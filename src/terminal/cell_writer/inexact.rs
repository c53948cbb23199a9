//! Draws a row about as it is wanted, for fewer bytes.

use ratatui::layout::Position;

use super::exact;
use super::ink::{Halves, Inks, Price};
use super::look::Look;
use super::pen::Pen;
use super::screen::Row;
use super::shift::{BYTE, CELL, Loss, Shifts};
use super::trellis::{Action, Store, Trellis, Wanted};

/// Draws rows inexactly, and keeps the memory that it takes.
#[derive(Debug, Default)]
pub(super) struct Draughtsman {
    inks: Inks,
    /// The colours that a row is to show; `None` where they must be exact.
    halves: Vec<Option<Halves>>,
    /// Where these lie, and those that it shows.
    wanted: Colors,
    shown: Colors,
    cells: Vec<Wanted>,
    trellis: Trellis,
}

/// Where the two colours of each cell lie in L\*a\*b\*, component by component, so that the distances of
/// several are computed at once.
///
/// What is no block, or unknown, lies far from every colour and from everything that does not look the same.
#[derive(Debug, Default)]
struct Colors([Vec<[f32; 2]>; 3]);

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
        let errors = self.shown.distances(&self.wanted, 0, 0);
        self.cells.extend(self.halves.iter().zip(errors).zip(row.shown.iter().zip(row.looks)).map(
            |((halves, distances), (shown, look))| match *halves {
                Some(wanted) => {
                    let [upper, lower] = distances.map(|distance| price.of_distance(distance));
                    Wanted::Halves { wanted, keep: upper + lower }
                }
                None => Wanted::Fixed { is_shown: shown == look },
            },
        ));
        let (style, repeats) = (pen.style(), pen.repeats());
        let mut store = Store { inks: &mut self.inks, palette: pen.palette() };
        let actions = self.trellis.search(&self.cells, style, price, repeats, &mut store);
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
        self.halves.clear();
        self.wanted.clear();
        self.shown.clear();
        for (&shown, &look) in row.shown.iter().zip(row.looks) {
            let wanted = look.halves().and_then(|halves| self.inks.of_halves(halves));
            self.halves.push(wanted);
            self.wanted.push(wanted, look);
            let is_shown = shown == look;
            let inks = if is_shown {
                wanted
            } else {
                shown.halves().and_then(|halves| self.inks.of_halves(halves))
            };
            self.shown.push(inks, shown);
        }
    }

    /// Moves the stretches of a row that have only moved, or about.
    fn shift(&mut self, pen: &mut Pen, shifts: &mut Shifts, row: &mut Row, price: Price) {
        let wanted = &self.wanted;
        let lose = |shown: &Colors, [from, to]: [usize; 2], losses: &mut Vec<Loss>| {
            losses.extend(shown.distances(wanted, from, to).map(|distances| {
                let [upper, lower] = distances.map(|distance| price.of_distance(distance));
                let loss = (upper + lower) * f32::from(BYTE);
                loss.min(f32::from(CELL)) as Loss
            }));
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

/// Farther from every colour than any tolerance.
const FAR: f32 = 1e6;

impl Colors {
    fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }

    /// Adds those of a cell, whose colours are `inks` if it is a block.
    #[inline]
    fn push(&mut self, inks: Option<Halves>, look: Look) {
        let colors = match inks {
            Some([upper, lower]) => [0, 1, 2].map(|index| [upper.lab[index], lower.lab[index]]),
            // Those that do not look the same are far from each other.
            None => look.hashes().map(|hash| [FAR * (1.0 + f32::from(hash)); 2]),
        };
        for (components, component) in self.0.iter_mut().zip(colors) {
            components.push(component);
        }
    }

    /// How far the colours of the cells from the place `from` on are from those of `others` from `to` on.
    #[inline]
    fn distances<'a>(
        &'a self,
        others: &'a Self,
        from: usize,
        to: usize,
    ) -> impl ExactSizeIterator<Item = [f32; 2]> + 'a {
        let pairs = |index: usize| self.0[index][from..].iter().zip(&others.0[index][to..]);
        pairs(0).zip(pairs(1)).zip(pairs(2)).map(|((l, a), b)| {
            std::array::from_fn(|half| {
                let [l, a, b] = [l, a, b].map(|(one, other)| one[half] - other[half]);
                (l * l + a * a + b * b).sqrt()
            })
        })
    }
}
