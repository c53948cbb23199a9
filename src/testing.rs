//! Snapshot tests of cells: for levels, and for any ratatui program.
//!
//! A [`CellGrid`] is cells with their colours and modifiers. [`assert_grid!`] compares a grid with a file beside the test:
//!
//! ```no_run
//! use cellcaster::testing::{CellGrid, assert_grid};
//! use ratatui::style::Stylize;
//!
//! // In a function with the attribute `#[test]`.
//! let grid = CellGrid::drawn(20, 3, |frame| frame.render_widget("Hello".red(), frame.area()));
//! assert_grid!(grid, "hello");
//! ```
//!
//! The file is `grids/hello.grid` in the folder of the test. It is written, and replaced after a change, when the
//! environment variable `CELLCASTER_UPDATE_GRIDS` is 1. If a test fails, its message lists the cells that differ, and
//! names three pictures in the target folder: what was wanted, what was drawn, and the difference.
//!
//! # The text of a grid
//!
//! The file is the grid's [`Display`](std::fmt::Display), which [`FromStr`](std::str::FromStr) reads:
//!
//! ```
//! # use cellcaster::testing::CellGrid;
//! let text = "\
//! cellcaster grid 1: 14x2
//!
//! glyphs
//!    0----+----1---
//! 0 |▀▀▀▀▀▀▀▀ Hello|
//! 1 |▀▀▀▀▀▀▀▀      |
//!
//! colours
//! .  default
//! r  red      Red
//! n  brown
//!
//! foreground
//!    0----+----1---
//! 0 |N   N   .r    | #804a20 #7b4a21
//! 1 |N       .     | #7b4a21
//!
//! background
//!    0----+----1---
//! 0 |N       .     | #6b4423
//! 1 |N       .     | #6b4423
//!
//! modifiers
//! 0  9-13 bold
//! ";
//! # assert_eq!(text.parse::<CellGrid>().unwrap().to_string(), text);
//! ```
//!
//! The letter of a colour's family marks the place where the colour begins. A small letter is the colour that the list
//! `colours` gives for it: the colour of most cells in the family. A capital is the next colour at the end of its row.
//! The file of a program with few colours has hardly any colours at the ends of rows. Sections in which everything is
//! default are absent.
//!
//! The format is made for diffs. The letter of a colour depends on nothing but the colour, and a row contains all that
//! differs from other rows. So a change alters the rows in which it is seen, and no others. The first line has a
//! version: later versions of this crate read all earlier ones.
//!
//! # Decisions
//!
//! - Files are compared by this module, and not by insta: insta compares texts, so it has no tolerance and no pictures,
//!   and each user would compile it. A grid's text works with `insta::assert_snapshot!`, too.
//! - Rejected: numbering colours in the order of their appearance, as other formats do. A new colour renames all later
//!   ones, and a picture of a level in 80×24 cells has up to 1,000 colours.
//! - Rejected: tags in the text, such as `{red}Hello{/}`. They move the columns apart.

mod assertion;
mod comparison;
mod json;
mod legend;
mod text;

#[cfg(test)]
mod tests;

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use ratatui::backend::TestBackend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::widgets::StatefulWidget;
use ratatui::{Frame, Terminal};

#[doc(inline)]
pub use crate::assert_grid;
use crate::color::Rgb;
use crate::render::Renderable;
use crate::tui::pixels::{CellSize, into_io, png_encoder};
use crate::tui::{CellAspect, FirstPerson, View};

pub use self::assertion::Tolerance;
#[doc(hidden)]
pub use self::assertion::{Golden, check};
pub use self::comparison::{CellDifference, Comparison};

/// Cells with their glyphs, colours and modifiers.
///
/// Underline colours and ratatui's options for drawing are not kept.
#[derive(Clone, PartialEq, Eq)]
pub struct CellGrid(Buffer);

/// The maximum number of cells in a file.
pub(crate) const MAX_CELLS: usize = 1 << 18;
/// The maximum size of a file, in bytes.
const MAX_BYTES: u64 = 16 << 20;

impl CellGrid {
    /// The cells of a picture with this size.
    ///
    /// ```
    /// use cellcaster::{map::builtin, testing::CellGrid, tui::FirstPerson, world::FieldOfView};
    ///
    /// let world = builtin::LEVELS[0].world()?;
    /// let camera = world.start_camera(FieldOfView::default());
    /// let grid = CellGrid::of(FirstPerson::new(&world, &camera), 80, 24);
    /// assert_eq!(grid.cell(0, 0).unwrap().symbol(), "▀");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of<S: Renderable>(picture: FirstPerson<'_, S>, columns: u16, rows: u16) -> Self
    where
        View<S>: Default,
    {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        picture.render(buffer.area, &mut buffer, &mut View::default());
        Self(buffer)
    }

    /// The cells that `draw` draws in a terminal of this size.
    pub fn drawn(columns: u16, rows: u16, draw: impl FnOnce(&mut Frame<'_>)) -> Self {
        let Ok(mut terminal) = Terminal::new(TestBackend::new(columns, rows));
        let Ok(_) = terminal.draw(draw);
        terminal.backend().buffer().into()
    }

    /// Reads a file with the text of a grid, or with the output of `cellcaster snapshot --format json`.
    ///
    /// # Errors
    /// If the file cannot be read, is larger than 16 MiB, or contains neither.
    pub fn read(path: &Path) -> Result<Self, GridError> {
        let is_file = fs::metadata(path).map_err(|error| GridError::unreadable(&error))?.is_file();
        if !is_file {
            return Err(GridError::new("is not a file"));
        }
        Self::read_from(File::open(path).map_err(|error| GridError::unreadable(&error))?)
    }

    /// Does the same as [`CellGrid::read`] with the contents of a file.
    ///
    /// # Errors
    /// As [`CellGrid::read`].
    pub fn read_from(input: impl Read) -> Result<Self, GridError> {
        let mut bytes = Vec::new();
        let read = input.take(MAX_BYTES + 1).read_to_end(&mut bytes);
        read.map_err(|error| GridError::unreadable(&error))?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(GridError::new("is larger than 16 MiB"));
        }
        let text = String::from_utf8(bytes).map_err(|_| GridError::new("is not UTF-8"))?;
        if text.starts_with('{') { Self::from_json(&text) } else { text.parse() }
    }

    /// The number of columns and rows.
    pub fn size(&self) -> Size {
        self.0.area.as_size()
    }

    /// The cell at this place, or `None` outside of the grid.
    pub fn cell(&self, column: u16, row: u16) -> Option<&Cell> {
        self.0.cell((column, row))
    }

    /// Writes a PNG that shows the cells as a terminal does.
    ///
    /// # Errors
    /// If `output` returns an error, or the grid has no cells.
    pub fn write_png(&self, output: impl Write) -> io::Result<()> {
        let cell = CellSize::of(self.size(), CellAspect::default());
        let mut pixels = Vec::new();
        for row in self.rows() {
            cell.draw_row(row, Rgb::channels, &mut pixels);
        }
        let mut writer = png_encoder(output, self.size(), cell).write_header().map_err(into_io)?;
        writer.write_image_data(&pixels).map_err(into_io)
    }

    /// A grid of blank cells, or an error if there are more than [`MAX_CELLS`].
    fn blank(columns: u16, rows: u16) -> Result<Self, GridError> {
        if usize::from(columns) * usize::from(rows) > MAX_CELLS {
            return Err(GridError::new(format!("has more than {MAX_CELLS} cells")));
        }
        Ok(Self(Buffer::empty(Rect::new(0, 0, columns, rows))))
    }

    fn rows(&self) -> impl Iterator<Item = &[Cell]> {
        let Size { width, height } = self.size();
        let (columns, rows) = (usize::from(width), usize::from(height));
        (0..rows).map(move |row| &self.0.content[row * columns..][..columns])
    }
}

impl From<&Buffer> for CellGrid {
    fn from(buffer: &Buffer) -> Self {
        let Size { width, height } = buffer.area.as_size();
        let mut grid = Buffer::empty(Rect::new(0, 0, width, height));
        for (cell, shown) in grid.content.iter_mut().zip(&buffer.content) {
            cell.set_symbol(shown.symbol()).set_fg(shown.fg).set_bg(shown.bg);
            cell.modifier = shown.modifier;
        }
        Self(grid)
    }
}

impl From<Buffer> for CellGrid {
    fn from(buffer: Buffer) -> Self {
        Self::from(&buffer)
    }
}

impl fmt::Debug for CellGrid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The error of a file that contains no grid: what is wrong with it, as the rest of a sentence about the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridError(String);

impl GridError {
    fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    fn unreadable(error: &io::Error) -> Self {
        Self::new(match error.kind() {
            io::ErrorKind::NotFound => "does not exist".to_owned(),
            kind => format!("cannot be read: {kind}"),
        })
    }
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for GridError {}
