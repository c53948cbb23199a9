//! The cells in which two grids differ, and how far.

use std::fmt;
use std::io::{self, Write};

use ratatui::buffer::Cell;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier};

use super::CellGrid;
use crate::color::Rgb;
use crate::color::lab::Lab;
use crate::tui::canvas::{Mosaic, true_color};
use crate::tui::pixels::colors;
use crate::tui::rgb_of;

/// The differences between two grids.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The number of cells that are compared. If the grids differ in size, the cells that only one of them has are
    /// differences.
    pub cells: usize,
    /// The cells that differ by more than the tolerance, row by row.
    pub differences: Vec<CellDifference>,
}

/// A cell that differs in two grids.
#[derive(Clone, Debug, PartialEq)]
pub struct CellDifference {
    /// The column of the cell, from 0.
    pub column: u16,
    /// The row of the cell, from 0.
    pub row: u16,
    /// The greatest CIE76 difference ΔE within the cell. `None` if other text or modifiers are shown, or a colour is
    /// one of the terminal's own: such cells differ by more than any tolerance.
    pub delta_e: Option<f64>,
    wanted: Option<Cell>,
    got: Option<Cell>,
}

impl CellGrid {
    /// The cells that differ in `got` by more than ΔE `tolerance`. If the tolerance is 0, equal looks are not enough:
    /// the characters and the colours must be equal, too.
    ///
    /// Two cells of blocks are compared by the dots that they show. So ▀ in red and blue and ▄ in blue and red differ by
    /// 0.
    #[must_use]
    pub fn compare(&self, got: &Self, tolerance: f64) -> Comparison {
        let (own, other) = (self.0.area, got.0.area);
        let only_other = other.positions().filter(|&position| !own.contains(position));
        let differences = own.positions().chain(only_other).filter_map(|position| {
            let (wanted, got) = (self.0.cell(position), got.0.cell(position));
            if wanted == got {
                return None;
            }
            let delta_e = wanted.zip(got).and_then(|(wanted, got)| delta_e(wanted, got));
            let is_permitted = tolerance > 0.0 && delta_e.is_some_and(|it| it <= tolerance);
            let Position { x: column, y: row } = position;
            let difference = || CellDifference {
                column,
                row,
                delta_e,
                wanted: wanted.cloned(),
                got: got.cloned(),
            };
            (!is_permitted).then(difference)
        });
        let cells = own.area() + other.area() - own.intersection(other).area();
        Comparison { cells: cells as usize, differences: differences.collect() }
    }

    /// Writes a PNG of the grid in a quarter of its brightness. The cells in `comparison` are yellow to red, the redder
    /// the farther off.
    ///
    /// # Errors
    /// If `output` returns an error, or the grid has no cells.
    pub fn write_difference_png(
        &self,
        comparison: &Comparison,
        output: impl Write,
    ) -> io::Result<()> {
        /// A difference that looks like another colour altogether.
        const FAR: f64 = 50.0;
        let mut picture = self.clone();
        for cell in &mut picture.0.content {
            let [ground, text] = colors(cell).map(|color| true_color(color.halved().halved()));
            cell.set_fg(text).set_bg(ground);
            cell.modifier = Modifier::empty();
        }
        for difference in &comparison.differences {
            if let Some(cell) = picture.0.cell_mut((difference.column, difference.row)) {
                let far = (difference.delta_e.unwrap_or(FAR) / FAR).min(1.0);
                let green = (224.0 * (1.0 - far)).round() as u8;
                cell.set_char(' ').set_bg(true_color(Rgb::new(255, green.max(32), 32)));
            }
        }
        picture.write_png(output)
    }
}

/// The greatest ΔE between two cells, or `None` if they cannot be compared by colour.
fn delta_e(wanted: &Cell, got: &Cell) -> Option<f64> {
    /// The parts of a cell in which mosaics have dots of their own.
    const PARTS: [u32; 2] = [2, 12];
    if wanted.modifier != got.modifier {
        return None;
    }
    let worst = |pairs: &[(Color, Color)]| {
        pairs.iter().try_fold(0.0, |worst: f64, &(one, other)| {
            Some(worst.max(color_difference(one, other)?))
        })
    };
    let Some(mosaics) = mosaic(wanted).zip(mosaic(got)) else {
        let is_same = wanted.symbol() == got.symbol();
        return worst(&[(wanted.fg, got.fg), (wanted.bg, got.bg)]).filter(|_| is_same);
    };
    let mut pairs = Vec::new();
    for (x, y) in (0..PARTS[0]).flat_map(|x| (0..PARTS[1]).map(move |y| (x, y))) {
        let shown = |mosaic: Mosaic, cell: &Cell| if mosaic.has(x, y) { cell.fg } else { cell.bg };
        let pair = (shown(mosaics.0, wanted), shown(mosaics.1, got));
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    worst(&pairs)
}

fn mosaic(cell: &Cell) -> Option<Mosaic> {
    let mut characters = cell.symbol().chars();
    let mosaic = Mosaic::of_character(characters.next()?)?;
    characters.next().is_none().then_some(mosaic)
}

/// The ΔE of two colours. `None` if they differ and the terminal chooses one of them.
fn color_difference(one: Color, other: Color) -> Option<f64> {
    if one == other {
        return Some(0.0);
    }
    let (one, other) = (rgb_of(one)?, rgb_of(other)?);
    Some(Lab::from(one).distance(other.into()))
}

impl Comparison {
    /// The difference that is farthest off.
    pub fn worst(&self) -> Option<&CellDifference> {
        let far = |difference: &CellDifference| difference.delta_e.unwrap_or(f64::INFINITY);
        let farther = |worst, it| if far(it) > far(worst) { it } else { worst };
        self.differences.iter().reduce(farther)
    }
}

/// Writes how many cells differ, where, and the cell that differs most, in two lines without a line break at the end.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(worst) = self.worst() else {
            return write!(f, "all {} cells match", self.cells);
        };
        let places = self.differences.iter().map(|it| Rect::new(it.column, it.row, 1, 1));
        let area = places.reduce(Rect::union).unwrap_or_default();
        let count = self.differences.len();
        let verb = if count == 1 { "differs" } else { "differ" };
        writeln!(
            f,
            "{count} of {} cells {verb}, in {} and {}",
            self.cells,
            range("column", area.left(), area.right()),
            range("row", area.top(), area.bottom()),
        )?;
        write!(f, "the largest difference: {worst}")
    }
}

/// The columns or rows from `first` to before `end`.
fn range(name: &str, first: u16, end: u16) -> String {
    match end.saturating_sub(1) {
        last if last == first => format!("{name} {first}"),
        last => format!("{name}s {first}-{last}"),
    }
}

impl fmt::Display for CellDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { column, row, delta_e, wanted, got } = self;
        write!(
            f,
            "column {column}, row {row}: {} in place of {}",
            CellInWords(got),
            CellInWords(wanted)
        )?;
        match delta_e {
            Some(delta_e) => write!(f, ", ΔE {delta_e:.1}"),
            None => Ok(()),
        }
    }
}

/// A cell in a sentence.
struct CellInWords<'a>(&'a Option<Cell>);

impl fmt::Display for CellInWords<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(cell) = self.0 else { return f.write_str("no cell") };
        let [fg, bg] = [cell.fg, cell.bg].map(super::legend::color_text);
        write!(f, "{:?} {fg} on {bg}", cell.symbol())?;
        for (name, _) in cell.modifier.iter_names() {
            write!(f, " {}", name.to_lowercase())?;
        }
        Ok(())
    }
}
