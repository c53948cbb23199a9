//! The text of a grid, written and read. [`testing`](super) describes it.
//!
//! Symbols that a row of text cannot contain, such as control characters and halves of wide characters, are shown as �,
//! and listed by their code points at the end of the row.

use std::fmt::{self, Write as _};
use std::str::{FromStr, Lines};

use ratatui::buffer::{Buffer, Cell, CellWidth};
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier, Style};

use super::legend::ColorLegend;
use super::{CellGrid, GridError};

/// A colour of a cell.
type ColorOf = fn(&Cell) -> Color;

const TITLE: &str = "cellcaster grid ";
const VERSION: &str = "1";
/// The character in place of a symbol at the end of the row.
const LISTED: char = '\u{FFFD}';
/// Stands for a symbol without characters.
const EMPTY: &str = "empty";

impl fmt::Display for CellGrid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.size();
        writeln!(f, "{TITLE}{VERSION}: {}x{}", size.width, size.height)?;
        self.write_plane(f, "glyphs", glyphs)?;
        let planes: [(&str, ColorOf); 2] =
            [("foreground", |cell| cell.fg), ("background", |cell| cell.bg)];
        let is_shown =
            |of_cell: ColorOf| self.0.content.iter().any(|cell| of_cell(cell) != Color::Reset);
        if planes.iter().any(|&(_, of_cell)| is_shown(of_cell)) {
            let legend = ColorLegend::of(self);
            write!(f, "\ncolours\n{legend}")?;
            for (heading, of_cell) in planes.into_iter().filter(|&(_, of_cell)| is_shown(of_cell)) {
                self.write_plane(f, heading, |row| legend.plane_row(row.iter().map(of_cell)))?;
            }
        }
        self.write_modifiers(f)
    }
}

impl CellGrid {
    /// Writes a plane. `of_row` returns a row's character for each column, and what is listed at its end.
    fn write_plane(
        &self,
        f: &mut fmt::Formatter<'_>,
        heading: &str,
        of_row: impl Fn(&[Cell]) -> (String, Vec<String>),
    ) -> fmt::Result {
        let digits = self.label_digits();
        let ruler = (0..self.size().width).map(|column| match column % 10 {
            0 => char::from(b'0' + (column / 10 % 10) as u8),
            5 => '+',
            _ => '-',
        });
        writeln!(f, "\n{heading}\n{:digits$}  {}", "", ruler.collect::<String>())?;
        for (number, row) in self.rows().enumerate() {
            let (columns, listed) = of_row(row);
            write!(f, "{number:digits$} |{columns}|")?;
            for item in listed {
                write!(f, " {item}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }

    /// Writes the runs of cells with modifiers, if there are any.
    fn write_modifiers(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.content.iter().all(|cell| cell.modifier.is_empty()) {
            return Ok(());
        }
        let digits = self.label_digits();
        writeln!(f, "\nmodifiers")?;
        for (number, row) in self.rows().enumerate() {
            let mut first = 0;
            for run in row.chunk_by(|one, other| one.modifier == other.modifier) {
                let last = first + run.len() - 1;
                if !run[0].modifier.is_empty() {
                    write!(f, "{number:digits$}  {first}-{last}")?;
                    for (name, _) in run[0].modifier.iter_names() {
                        write!(f, " {}", name.to_lowercase())?;
                    }
                    writeln!(f)?;
                }
                first = last + 1;
            }
        }
        Ok(())
    }

    /// The number of digits of the greatest number of a row.
    fn label_digits(&self) -> usize {
        self.size().height.saturating_sub(1).to_string().len()
    }
}

/// The glyphs of a row, and the symbols that are listed.
fn glyphs(row: &[Cell]) -> (String, Vec<String>) {
    let (mut text, mut listed) = written(row, |symbol| !symbol.contains(char::is_control));
    // Neighbours can join, as the two letters of a flag do.
    if read(&text, row.len(), &listed).is_none_or(|read| !same_symbols(&read, row)) {
        (text, listed) = written(row, |symbol| matches!(symbol.as_bytes(), [b' '..=b'~']));
    }
    (text, listed)
}

/// A row in which symbols stand that are `plain`. A wide symbol takes the place of the blank cells that it covers.
fn written(row: &[Cell], plain: impl Fn(&str) -> bool) -> (String, Vec<String>) {
    let (mut text, mut listed) = (String::new(), Vec::new());
    let mut rest = row;
    while let [cell, after @ ..] = rest {
        let symbol = cell.symbol();
        let is_plain = plain(symbol) && !symbol.contains(LISTED);
        let width = if is_plain { symbol.cell_width() } else { 0 };
        let covered = width.checked_sub(1).and_then(|cells| after.get(..cells.into()));
        let covered = covered.filter(|cells| cells.iter().all(|it| it.symbol() == " "));
        if covered.is_some() {
            text.push_str(symbol);
        } else {
            text.push(LISTED);
            listed.push(code_points(symbol));
        }
        rest = &after[covered.map_or(0, <[Cell]>::len)..];
    }
    (text, listed)
}

fn code_points(symbol: &str) -> String {
    let points: Vec<String> =
        symbol.chars().map(|character| format!("{:x}", u32::from(character))).collect();
    if points.is_empty() { EMPTY.to_owned() } else { points.join("+") }
}

fn symbol_of(code_points: &str) -> Option<String> {
    if code_points == EMPTY {
        return Some(String::new());
    }
    let character = |point| u32::from_str_radix(point, 16).ok().and_then(char::from_u32);
    code_points.split('+').map(character).collect()
}

/// The cells of a row of glyphs. `None` if `text` does not have exactly this number of columns, or `listed` is not what
/// it lacks.
fn read(text: &str, columns: usize, listed: &[impl AsRef<str>]) -> Option<Vec<Cell>> {
    if text.contains(char::is_control) {
        return None;
    }
    // In the columns to the right, text that is too long ends, which may be a wide character.
    let mut row = Buffer::empty(Rect::new(0, 0, (columns as u16).saturating_add(2), 1));
    let (end, _) = row.set_stringn(0, 0, text, usize::MAX, Style::new());
    if usize::from(end) != columns {
        return None;
    }
    row.content.truncate(columns);
    let mut listed = listed.iter();
    let mut placeholder = [0; 4];
    let placeholder = LISTED.encode_utf8(&mut placeholder);
    for cell in row.content.iter_mut().filter(|cell| cell.symbol() == placeholder) {
        cell.set_symbol(&symbol_of(listed.next()?.as_ref())?);
    }
    listed.next().is_none().then_some(row.content)
}

fn same_symbols(one: &[Cell], other: &[Cell]) -> bool {
    one.iter().map(Cell::symbol).eq(other.iter().map(Cell::symbol))
}

impl FromStr for CellGrid {
    type Err = GridError;

    fn from_str(text: &str) -> Result<Self, GridError> {
        LineReader { lines: text.lines(), number: 0 }.grid()
    }
}

/// Reads a text line by line.
struct LineReader<'a> {
    lines: Lines<'a>,
    /// The number of the last line that was read, from 1.
    number: usize,
}

impl<'a> LineReader<'a> {
    fn grid(mut self) -> Result<CellGrid, GridError> {
        let mut grid = self.title()?;
        if self.line() != Some("glyphs") {
            return Err(self.fault("should be \"glyphs\""));
        }
        self.glyphs(&mut grid)?;
        let mut legend = ColorLegend::default();
        while let Some(heading) = self.line() {
            match heading {
                "colours" => legend = self.legend()?,
                "foreground" => self.plane(&mut grid, &legend, |cell| &mut cell.fg)?,
                "background" => self.plane(&mut grid, &legend, |cell| &mut cell.bg)?,
                "modifiers" => self.modifiers(&mut grid)?,
                _ => return Err(self.fault("should be the name of a section")),
            }
        }
        Ok(grid)
    }

    /// A blank grid of the size in the first line.
    fn title(&mut self) -> Result<CellGrid, GridError> {
        let title = self.lines.next().and_then(|line| line.strip_prefix(TITLE));
        self.number = 1;
        let title = title.ok_or_else(|| GridError::new("is neither a grid nor a JSON object"))?;
        let (version, size) = title.split_once(": ").ok_or_else(|| self.fault("has no size"))?;
        if version != VERSION {
            return Err(GridError::new(format!(
                "has version {version} of the format, and this version of Cellcaster reads {VERSION}"
            )));
        }
        let size = size
            .split_once('x')
            .and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
        let (columns, rows) = size.ok_or_else(|| self.fault("has no size such as 80x24"))?;
        CellGrid::blank(columns, rows)
    }

    /// The next line that is not empty.
    fn line(&mut self) -> Option<&'a str> {
        loop {
            let line = self.lines.next()?;
            self.number += 1;
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    /// The next line of a section, which ends with an empty line.
    fn line_of_section(&mut self) -> Option<&'a str> {
        self.number += 1;
        self.lines.next().filter(|line| !line.is_empty())
    }

    fn glyphs(&mut self, grid: &mut CellGrid) -> Result<(), GridError> {
        let Size { width, height } = grid.size();
        self.ruler()?;
        for number in 0..usize::from(height) {
            let (text, listed) = self.row(number)?;
            let cells = read(text, width.into(), &listed)
                .ok_or_else(|| self.fault(format!("does not have {width} columns of text")))?;
            grid.row_mut(number).clone_from_slice(&cells);
        }
        Ok(())
    }

    fn ruler(&mut self) -> Result<(), GridError> {
        let found = self.line().is_some_and(|line| line.starts_with(' '));
        found.then_some(()).ok_or_else(|| self.fault("should be a ruler"))
    }

    /// The text between the bars of the row with this number, and the list after them.
    fn row(&mut self, number: usize) -> Result<(&'a str, Vec<&'a str>), GridError> {
        let parts = self.line().and_then(|line| {
            let (label, rest) = line.split_once('|')?;
            let (columns, listed) = rest.rsplit_once('|')?;
            (label.trim().parse() == Ok(number))
                .then(|| (columns, listed.split_whitespace().collect()))
        });
        parts.ok_or_else(|| self.fault(format!("should be row {number}, between bars")))
    }

    fn legend(&mut self) -> Result<ColorLegend, GridError> {
        let mut legend = ColorLegend::default();
        while let Some(line) = self.line_of_section() {
            let read = legend.read(line);
            read.ok_or_else(|| self.fault("should be a letter, a name and a colour"))?;
        }
        Ok(legend)
    }

    /// Reads a plane into the colours that `of_cell` returns.
    fn plane(
        &mut self,
        grid: &mut CellGrid,
        legend: &ColorLegend,
        of_cell: fn(&mut Cell) -> &mut Color,
    ) -> Result<(), GridError> {
        let Size { width, height } = grid.size();
        self.ruler()?;
        for number in 0..usize::from(height) {
            let (letters, listed) = self.row(number)?;
            let colors =
                legend.read_row(letters, &listed).map_err(|message| self.fault(message))?;
            if colors.len() != usize::from(width) {
                return Err(self.fault(format!("has {} columns, not {width}", colors.len())));
            }
            for (cell, color) in grid.row_mut(number).iter_mut().zip(colors) {
                *of_cell(cell) = color;
            }
        }
        Ok(())
    }

    fn modifiers(&mut self, grid: &mut CellGrid) -> Result<(), GridError> {
        while let Some(line) = self.line_of_section() {
            let mut words = line.split_whitespace();
            let run = words.next().zip(words.next()).and_then(|(row, columns)| {
                let (first, last) = columns.split_once('-')?;
                let (row, first, last): (usize, usize, usize) =
                    (row.parse().ok()?, first.parse().ok()?, last.parse().ok()?);
                let is_inside = row < usize::from(grid.size().height);
                if is_inside { grid.row_mut(row).get_mut(first..=last) } else { None }
            });
            let modifiers = words.map(|word| Modifier::from_name(&word.to_uppercase()));
            let modifiers: Option<Vec<Modifier>> = modifiers.collect();
            let (run, modifiers) = run
                .zip(modifiers)
                .ok_or_else(|| self.fault("should be a row, columns and modifiers"))?;
            for cell in run {
                cell.modifier = modifiers.iter().copied().collect();
            }
        }
        Ok(())
    }

    fn fault(&self, message: impl fmt::Display) -> GridError {
        let mut text = String::new();
        _ = write!(text, "has a fault: line {} {message}", self.number);
        GridError(text)
    }
}

impl CellGrid {
    fn row_mut(&mut self, number: usize) -> &mut [Cell] {
        let columns = usize::from(self.size().width);
        &mut self.0.content[number * columns..][..columns]
    }
}
