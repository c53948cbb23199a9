//! Draws a row about as it is wanted, for fewer bytes.

use ratatui::layout::Position;

use super::alphabet::{Alphabet, Number};
use super::exact;
use super::ink::{Ink, Inks, Notation, Price};
use super::look::{Form, Look};
use super::pen::Pen;
use super::screen::Row;
use super::shift::{BYTE, CELL, Loss, Shifts};
use super::trellis::{Action, Store, Trellis, Wanted};
use crate::terminal::Fidelity;

/// Draws rows inexactly, and keeps the memory that it takes.
#[derive(Debug, Default)]
pub(super) struct Draughtsman {
    inks: Inks,
    /// The cells that a row is to show; `None` where they must be exact.
    parts: Vec<Option<Parts>>,
    /// Where these lie, and those that it shows.
    wanted: Colors,
    shown: Colors,
    cells: Vec<Wanted>,
    trellis: Trellis,
}

/// What a cell is, and its colours.
type Parts = (Form, [Ink; 2]);

/// Where the two colours of each cell lie in L\*a\*b\*, component by component, so that the distances of
/// several are computed at once.
///
/// Letters lie apart from blocks, and from other letters. What may only be shown exactly lies far from every colour
/// and from everything that does not look the same.
#[derive(Debug, Default)]
struct Colors([Vec<[f32; 2]>; 3]);

impl Draughtsman {
    /// Makes a row look as it is wanted, or so that it can't be told for that price.
    pub(super) fn draw_row(
        &mut self,
        pen: &mut Pen,
        shifts: &mut Shifts,
        mut row: Row,
        fidelity: Fidelity,
    ) {
        if *row.intricate {
            // Nobody knows how much of it a character covers.
            return exact::draw_row(pen, shifts, row);
        }
        self.mix_inks(&row);
        let price = Price::at(fidelity, self.notation(pen.palette().is_on()));
        self.shift(pen, shifts, &mut row, price);
        self.cells.clear();
        let errors = self.shown.distances(&self.wanted, 0, 0);
        self.cells.extend(self.parts.iter().zip(errors).zip(row.shown.iter().zip(row.looks)).map(
            |((parts, distances), (shown, look))| {
                let keep = distances.map(|distance| price.of_distance(distance)).iter().sum();
                match *parts {
                    Some((Form::Block, wanted)) => Wanted::Halves { wanted, keep },
                    Some((Form::Letter(number), wanted)) => {
                        let bytes = row.alphabet.letter(number).character().len_utf8() as u8;
                        Wanted::Letter { wanted, keep, bytes }
                    }
                    None => Wanted::Fixed { is_shown: shown == look },
                }
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
                    match self.parts[column] {
                        Some((Form::Letter(number), _)) => {
                            let letter = row.alphabet.letter(number).character();
                            pen.draw_text(position, letter.encode_utf8(&mut [0; 4]), style);
                            let colors = [style.foreground, style.background];
                            row.shown[column] = row.looks[column].recolored(colors);
                        }
                        _ => {
                            pen.draw_block(position, glyph, style);
                            row.shown[column] = Look::of_block(glyph, style);
                        }
                    }
                }
            }
            *row.exact &= row.shown[column] == row.looks[column];
        }
    }

    fn mix_inks(&mut self, row: &Row) {
        self.parts.clear();
        self.wanted.clear();
        self.shown.clear();
        for (&shown, &look) in row.shown.iter().zip(row.looks) {
            let wanted = parts(look, row.alphabet, &mut self.inks);
            self.parts.push(wanted);
            self.wanted.push(wanted, look);
            let is_shown = shown == look;
            let inks = if is_shown { wanted } else { parts(shown, row.alphabet, &mut self.inks) };
            self.shown.push(inks, shown);
        }
    }

    /// How the colours of the row's picture are written.
    fn notation(&self, has_palette: bool) -> Notation {
        let colors = self.parts.iter().flatten().flat_map(|(_, inks)| inks);
        let longest = colors.map(|ink| ink.shade.notation()).max().unwrap_or(Notation::Named);
        if has_palette { longest.min(Notation::Entry) } else { longest }
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

/// What `look` is and its colours, unless it may only be shown exactly.
#[inline]
fn parts(look: Look, alphabet: &Alphabet, inks: &mut Inks) -> Option<Parts> {
    let (form, colors) = look.recolorable(alphabet)?;
    Some((form, inks.of_both(colors)))
}

/// How far from blocks a letter lies: at a point of its own of a lattice whose points are farther apart than colours.
fn apart(number: Number) -> [f32; 3] {
    const SPACING: f32 = 1000.0;
    let number = number.get() + 1;
    [number & 15, number >> 4 & 15, number >> 8].map(|digit| SPACING * f32::from(digit))
}

/// Farther from every colour than any tolerance.
const FAR: f32 = 1e6;

impl Colors {
    fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }

    /// Adds those of a cell.
    #[inline]
    fn push(&mut self, parts: Option<Parts>, look: Look) {
        let colors = match parts {
            Some((Form::Block, [upper, lower])) => {
                [0, 1, 2].map(|index| [upper.lab[index], lower.lab[index]])
            }
            Some((Form::Letter(number), [text, ground])) => {
                let apart = apart(number);
                [0, 1, 2].map(|index| {
                    [text.lab[index], ground.lab[index]].map(|component| component + apart[index])
                })
            }
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
