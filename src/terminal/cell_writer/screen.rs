//! What the terminal shows, and what it is to show.

use ratatui::backend::ClearType;
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

use super::look::Look;

/// What the terminal shows, and what it is to show, cell by cell.
#[derive(Debug)]
pub(super) struct Screen {
    width: usize,
    shown: Vec<Look>,
    /// What it is to look like.
    looks: Vec<Look>,
    /// The cells that are to be shown, where their looks do not say all.
    wanted: Vec<Cell>,
    /// Whether anything in a row is to be changed.
    changed: Vec<bool>,
    /// Whether a row shows exactly what it is to show.
    exact: Vec<bool>,
}

/// A row of it.
pub(super) struct Row<'a> {
    pub(super) y: u16,
    pub(super) shown: &'a mut [Look],
    pub(super) looks: &'a [Look],
    pub(super) wanted: &'a [Cell],
    pub(super) exact: &'a mut bool,
}

impl Screen {
    /// A blank screen.
    pub(super) fn blank(size: Size) -> Self {
        let mut screen = Self::none();
        screen.resize(size);
        screen.clear(ClearType::All, Position::ORIGIN);
        screen
    }

    /// No screen at all.
    pub(super) fn none() -> Self {
        Self {
            width: 0,
            shown: Vec::new(),
            looks: Vec::new(),
            wanted: Vec::new(),
            changed: Vec::new(),
            exact: Vec::new(),
        }
    }

    /// Takes another size; what it shows is unknown then.
    pub(super) fn resize(&mut self, size: Size) {
        let (width, height) = (usize::from(size.width), usize::from(size.height));
        self.width = width;
        self.shown.resize(width * height, Look::UNKNOWN);
        self.looks.resize(width * height, Look::of(&Cell::EMPTY));
        self.wanted.resize(width * height, Cell::EMPTY);
        self.changed.resize(height, false);
        self.exact.resize(height, true);
        self.forget();
    }

    /// Nothing is known of what it shows.
    pub(super) fn forget(&mut self) {
        self.shown.fill(Look::UNKNOWN);
    }

    /// A part of it, row by row, has been erased with the cursor at `cursor`, and is to stay so.
    pub(super) fn clear(&mut self, region: ClearType, cursor: Position) {
        let row = usize::from(cursor.y) * self.width;
        let at = row + usize::from(cursor.x);
        let end = self.shown.len();
        let cells = match region {
            ClearType::All => 0..end,
            ClearType::AfterCursor => at..end,
            ClearType::BeforeCursor => 0..at + 1,
            ClearType::CurrentLine => row..row + self.width,
            ClearType::UntilNewLine => at..row + self.width,
        };
        let cells = cells.start.min(end)..cells.end.min(end);
        self.shown[cells.clone()].fill(Look::of(&Cell::EMPTY));
        self.looks[cells.clone()].fill(Look::of(&Cell::EMPTY));
        self.wanted[cells].fill(Cell::EMPTY);
    }

    /// It is to show `cell` there; what is off the screen is nowhere.
    pub(super) fn want(&mut self, x: u16, y: u16, cell: &Cell) {
        let (x, y) = (usize::from(x), usize::from(y));
        if x < self.width && y < self.changed.len() {
            let (place, look) = (y * self.width + x, Look::of(cell));
            self.looks[place] = look;
            if look.halves().is_none() {
                self.wanted[place].clone_from(cell);
            }
            self.changed[y] = true;
        }
    }

    /// Whether anything was wanted since the rows to change were taken.
    pub(super) fn is_changed(&self) -> bool {
        self.changed.contains(&true)
    }

    /// Whether every row that was drawn shows exactly what it is to show.
    pub(super) fn is_exact(&self) -> bool {
        !self.exact.contains(&false)
    }

    /// The rows that are not exact yet are to be drawn again.
    pub(super) fn redraw_inexact(&mut self) {
        for (changed, exact) in self.changed.iter_mut().zip(&self.exact) {
            *changed |= !exact;
        }
    }

    /// What is shown there; `None` off the screen.
    pub(super) fn shown(&self, x: u16, y: u16) -> Option<Look> {
        let (x, y) = (usize::from(x), usize::from(y));
        (x < self.width).then(|| self.shown.get(y * self.width + x).copied()).flatten()
    }

    /// The rows to change, from the top; they count as changed no longer.
    pub(super) fn take_changed(&mut self) -> impl Iterator<Item = Row<'_>> {
        let width = self.width.max(1);
        let wanted = self.looks.chunks(width).zip(self.wanted.chunks(width));
        let rows = self.shown.chunks_mut(width).zip(wanted);
        let states = self.changed.iter_mut().zip(&mut self.exact);
        (0..).zip(rows.zip(states)).filter_map(
            |(y, ((shown, (looks, wanted)), (changed, exact)))| {
                std::mem::take(changed).then_some(Row { y, shown, looks, wanted, exact })
            },
        )
    }
}
