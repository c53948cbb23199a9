//! The expected screen of a terminal.

use ratatui::backend::ClearType;
use ratatui::buffer::{Buffer, Cell, CellWidth};
use ratatui::layout::{Position, Size};
use ratatui::style::{Color, Modifier};

use crate::bytes::Bytes;

/// Texts of cells: texts of zero, one and two cells, and texts that a terminal would obey.
const SYMBOLS: [&str; 24] = [
    " ", "▀", "▄", "█", "a", "#", "é", "字", "語", "😀", "한", "e\u{301}", "", "\u{301}",
    "\u{200b}", "\t", "\x1b", "\u{9b}", "\x1b[31m", "\n", "▒", "─", "z", "~",
];
const CHARACTERS: [char; 16] = [
    ' ', '▀', '▄', '█', 'a', '#', 'é', '字', '語', '\u{301}', '\t', '\x1b', '\u{9b}', '▒', 'z', '|',
];
const NAMED: [Color; 17] = [
    Color::Reset,
    Color::Black,
    Color::Red,
    Color::Green,
    Color::Yellow,
    Color::Blue,
    Color::Magenta,
    Color::Cyan,
    Color::Gray,
    Color::DarkGray,
    Color::LightRed,
    Color::LightGreen,
    Color::LightYellow,
    Color::LightBlue,
    Color::LightMagenta,
    Color::LightCyan,
    Color::White,
];
/// The modifiers that are written.
const MODIFIERS: [Modifier; 5] =
    [Modifier::BOLD, Modifier::DIM, Modifier::ITALIC, Modifier::UNDERLINED, Modifier::REVERSED];

/// A picture of cells. The cells behind a wide one are blank.
pub(crate) struct Picture(Buffer);

impl Picture {
    pub(crate) fn new(size: Size, choices: &mut Bytes) -> Self {
        let mut buffer = Buffer::empty(size.into());
        let repeat = choices.below(4);
        let mut left = 0;
        let mut cell = Cell::EMPTY;
        for at in &mut buffer.content {
            if left == 0 {
                cell = any_cell(choices);
                left = if repeat == 0 { 1 } else { 1 + choices.below(4 * repeat) };
            }
            left -= 1;
            at.clone_from(&cell);
        }
        Self(buffer).tidy()
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.0
    }

    /// The cells that no wide character covers.
    pub(crate) fn uncovered(&self) -> impl Iterator<Item = (u16, u16, &Cell)> {
        let mut covered = 0;
        self.0.area.positions().zip(&self.0.content).filter_map(move |(at, cell)| {
            if at.x == 0 {
                covered = 0;
            }
            if covered > 0 {
                covered -= 1;
                return None;
            }
            covered = width(cell).saturating_sub(1);
            Some((at.x, at.y, cell))
        })
    }

    /// Blanks the cells that wide characters cover, as ratatui's widgets do.
    fn tidy(mut self) -> Self {
        let columns = self.0.area.width;
        for y in 0..self.0.area.height {
            for x in 0..columns {
                let covers = width(&self.0[(x, y)]);
                for covered in x + 1..(x + covers).min(columns) {
                    self.0[(covered, y)].reset();
                }
            }
        }
        self
    }
}

/// The cells that a terminal should show.
#[derive(Clone)]
pub(crate) struct Model {
    size: Size,
    cells: Vec<Cell>,
}

impl Model {
    pub(crate) fn blank(size: Size) -> Self {
        Self { size, cells: vec![Cell::EMPTY; usize::from(size.width) * usize::from(size.height)] }
    }

    pub(crate) fn size(&self) -> Size {
        self.size
    }

    pub(crate) fn clear(&mut self) {
        self.cells.fill(Cell::EMPTY);
    }

    /// A cell, whose text can be shown.
    pub(crate) fn at(&self, x: u16, y: u16) -> &Cell {
        &self.cells[self.place(x, y)]
    }

    pub(crate) fn equals_at(&self, other: &Self, x: u16, y: u16) -> bool {
        self.at(x, y) == other.at(x, y)
    }

    pub(crate) fn show(&mut self, picture: &Picture) {
        self.clear();
        for (x, y, cell) in picture.uncovered() {
            self.set(x, y, cell.clone());
        }
    }

    pub(crate) fn draw_halves(&mut self, x: u16, y: u16, halves: &[[Color; 2]]) {
        for (x, &[top, bottom]) in (x..self.size.width).zip(halves) {
            let mut cell = Cell::new("▀");
            cell.set_fg(top).set_bg(bottom);
            if top == bottom {
                cell.set_symbol(" ");
            }
            self.set(x, y, cell);
        }
    }

    /// Draws one character. Returns `false` if it would cover half of another one.
    pub(crate) fn draw_character(
        &mut self,
        x: u16,
        y: u16,
        character: char,
        [fg, bg]: [Color; 2],
    ) -> bool {
        if x >= self.size.width || y >= self.size.height {
            return true;
        }
        let mut cell = Cell::EMPTY;
        cell.set_char(character).set_fg(fg).set_bg(bg);
        let covers = width(&cell).max(1);
        let is_covered = |x: u16| x > 0 && width(self.at(x - 1, y)) > 1;
        let is_wide_there = |x: u16| x < self.size.width && width(self.at(x, y)) > 1;
        if is_covered(x) || (x + 1..x + covers).any(is_wide_there) {
            return false;
        }
        self.set(x, y, cell);
        true
    }

    pub(crate) fn erase(&mut self, region: ClearType, cursor: Position) {
        let columns = usize::from(self.size.width);
        let at = self.place(cursor.x, cursor.y);
        let line = at - usize::from(cursor.x);
        let end = self.cells.len();
        let erased = match region {
            ClearType::All => 0..end,
            ClearType::AfterCursor => at..end,
            ClearType::BeforeCursor => 0..at + 1,
            ClearType::CurrentLine => line..line + columns,
            ClearType::UntilNewLine => at..line + columns,
        };
        self.cells[erased].fill(Cell::EMPTY);
    }

    /// The picture with a part of a row moved sideways.
    pub(crate) fn rotated(&self, choices: &mut Bytes) -> Picture {
        let columns = usize::from(self.size.width);
        let mut cells = self.cells.clone();
        for _ in 0..1 + choices.below(3) {
            let row = choices.below(usize::from(self.size.height)) * columns;
            let (one, other) = (choices.below(columns), choices.below(columns));
            let part = &mut cells[row + one.min(other)..=row + one.max(other)];
            let count = part.len();
            part.rotate_left(choices.below(count));
        }
        Picture(Buffer { area: self.size.into(), content: cells }).tidy()
    }

    fn place(&self, x: u16, y: u16) -> usize {
        usize::from(y) * usize::from(self.size.width) + usize::from(x)
    }

    fn set(&mut self, x: u16, y: u16, mut cell: Cell) {
        let covers = width(&cell);
        if covers == 0 || x + covers > self.size.width {
            cell.set_symbol(" ");
        }
        let place = self.place(x, y);
        let end = place + usize::from(width(&cell));
        self.cells[place..end].fill(Cell::EMPTY);
        self.cells[place] = cell;
    }
}

/// The number of columns that a cell's text takes; 0 if the text cannot be shown.
pub(crate) fn width(cell: &Cell) -> u16 {
    if cell.symbol().contains(char::is_control) { 0 } else { cell.cell_width() }
}

fn any_cell(choices: &mut Bytes) -> Cell {
    let mut cell = Cell::EMPTY;
    let kind = choices.byte();
    match kind % 8 {
        0 => return cell,
        1 => cell.set_char(any_character(choices)),
        _ => cell.set_symbol(choices.pick(&SYMBOLS)),
    };
    cell.set_fg(color(choices)).set_bg(color(choices));
    if kind >> 5 == 1 {
        let bits = choices.byte();
        for (modifier, bit) in MODIFIERS.into_iter().zip(0..) {
            let excluded = modifier == Modifier::DIM && bits & 1 == 1;
            if bits >> bit & 1 == 1 && !excluded {
                cell.modifier |= modifier;
            }
        }
    }
    cell
}

/// Any character of one column.
fn any_character(choices: &mut Bytes) -> char {
    let any = char::from_u32(u32::from(choices.word()));
    any.filter(|&it| unicode_width::UnicodeWidthChar::width(it) == Some(1) && it < '\u{2000}')
        .unwrap_or('?')
}

pub(crate) fn character(choices: &mut Bytes) -> char {
    choices.pick(&CHARACTERS)
}

/// A colour for half a cell, which is never the terminal's own.
pub(crate) fn pixel(choices: &mut Bytes) -> Color {
    match color(choices) {
        Color::Reset => Color::Rgb(1, 2, 3),
        other => other,
    }
}

/// A colour, often the same one.
pub(crate) fn color(choices: &mut Bytes) -> Color {
    let byte = choices.byte();
    match byte >> 6 {
        0 => NAMED[usize::from(byte & 0x3f) % NAMED.len()],
        1 => Color::Rgb(byte & 3, 7, 200),
        2 => Color::Rgb((byte & 7) * 36, (byte >> 3 & 7) * 36, choices.byte()),
        _ => Color::Indexed(byte << 2),
    }
}
