//! The model of the screen: the cells that the terminal shows, and their targets.

use std::cell;

use ratatui::backend::ClearType;
use ratatui::buffer::{Buffer, Cell, CellWidth};
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::packed_cell::{Form, GlyphTable, PackedCell, ascii_substitute};
use super::shift::CellHash;
use super::style::{PackedColor, Style};
use crate::color::Rgb;
use crate::tui::canvas::{Canvas, Mosaic, true_color};

/// A model of a terminal's screen: for each cell, its shown appearance and its target.
///
/// The screen is a canvas. [`CellWriter::draw_frame`](super::CellWriter::draw_frame) passes it to its closure, with
/// blank targets.
#[derive(Debug, Default)]
pub struct Screen {
    width: usize,
    /// Whether the targets are restricted to ASCII.
    is_ascii: bool,
    glyph_table: GlyphTable,
    shown: Vec<PackedCell>,
    /// The appearance that each cell should have.
    targets: Vec<PackedCell>,
    /// The landmarks of each row's targets when the row was last drawn.
    marks: Vec<CellHash>,
    /// The intricate targets, which packed cells do not describe in full. Empty until there is one.
    wanted: Vec<Cell>,
    rows: Vec<RowState>,
}

/// The state of a row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RowState {
    /// `true` if targets of the row have changed.
    changed: bool,
    /// `true` if the row has intricate cells, shown or as targets.
    pub(crate) intricate: bool,
    /// `true` if the row shows its targets exactly.
    pub(crate) exact: bool,
    /// The number of frames for which the row has not changed.
    pub(crate) rested: u8,
}

/// A row of the screen.
pub(crate) struct ScreenRow<'a> {
    pub(crate) y: u16,
    pub(crate) glyph_table: &'a GlyphTable,
    pub(crate) shown: &'a mut [PackedCell],
    pub(crate) targets: &'a [PackedCell],
    /// The landmarks of its targets in the last frame.
    pub(crate) marks: &'a mut [CellHash],
    pub(crate) wanted: &'a [Cell],
    pub(crate) state: &'a mut RowState,
}

// No call needs the content that an earlier call has left in this memory. Therefore each thread has it once, instead
// of each of the several hundred screens of a server.
thread_local! {
    /// The buffer into which widgets are drawn first.
    static SCRATCH: cell::Cell<Buffer> = cell::Cell::default();
    /// The memory of the targets before a frame.
    static BEFORE: cell::Cell<Vec<PackedCell>> = const { cell::Cell::new(Vec::new()) };
}

impl Screen {
    /// A blank screen.
    pub(crate) fn blank(size: Size) -> Self {
        let mut screen = Self::default();
        screen.resize(size);
        screen.clear(ClearType::All, Position::ORIGIN);
        screen.rows.iter_mut().for_each(|row| row.exact = true);
        screen
    }

    /// Changes the size and sets all targets blank. The shown cells are then unknown.
    pub(crate) fn resize(&mut self, size: Size) {
        let (width, height) = (usize::from(size.width), usize::from(size.height));
        self.width = width;
        for targets in [&mut self.shown, &mut self.targets] {
            targets.clear();
            targets.resize(width * height, PackedCell::BLANK);
        }
        self.marks.clear();
        self.marks.resize(width * height, CellHash::NONE);
        self.wanted = Vec::new();
        self.rows.clear();
        self.rows.resize(height, RowState::default());
        self.forget();
    }

    /// Sets whether targets are restricted to ASCII, from the next frame on.
    pub(crate) fn set_ascii(&mut self, is_ascii: bool) {
        self.is_ascii = is_ascii;
        self.redraw();
    }

    /// Forgets the shown cells, so that all rows are drawn again.
    pub(crate) fn redraw(&mut self) {
        self.forget();
        self.rows.iter_mut().for_each(|row| row.changed = true);
    }

    /// Forgets the shown cells.
    pub(crate) fn forget(&mut self) {
        self.shown.fill(PackedCell::UNKNOWN);
        self.rows.iter_mut().for_each(|row| row.exact = false);
    }

    /// Records that the terminal has erased `region`, row by row, with the cursor at `cursor`. The targets in the
    /// region become blank.
    pub(crate) fn clear(&mut self, region: ClearType, cursor: Position) {
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
        self.shown[cells.clone()].fill(PackedCell::BLANK);
        self.targets[cells.clone()].fill(PackedCell::BLANK);
        self.forget_cut(cells.start);
        self.forget_cut(cells.end);
    }

    /// Forgets the row at `place`, in which an erased region begins or ends, if it may show a wide character. Half
    /// of that character may have been erased.
    fn forget_cut(&mut self, place: usize) {
        let width = self.width.max(1);
        let y = place / width;
        if !place.is_multiple_of(width) && self.rows[y].intricate {
            self.shown[y * width..(y + 1) * width].fill(PackedCell::UNKNOWN);
            self.rows[y].exact = false;
        }
    }

    /// Sets the target of a cell. Does nothing if the cell is off the screen.
    #[inline]
    pub(crate) fn want(&mut self, x: u16, y: u16, cell: &Cell) {
        let (x, y) = (usize::from(x), usize::from(y));
        if x < self.width && y < self.rows.len() {
            self.set(y * self.width + x, cell);
            self.rows[y].changed = true;
        }
    }

    #[inline]
    fn set(&mut self, place: usize, cell: &Cell) {
        if self.is_ascii {
            return self.set_ascii_cell(place, cell.clone());
        }
        let target = PackedCell::of(cell, &mut self.glyph_table);
        self.targets[place] = target;
        if target.is_intricate() {
            self.want_intricate(place, cell);
        }
    }

    /// Sets a target to the ASCII substitute of `cell`.
    fn set_ascii_cell(&mut self, place: usize, mut cell: Cell) {
        let character = ascii_substitute(cell.symbol());
        cell.set_char(character);
        let style = Style::of(&cell);
        self.targets[place] = PackedCell::of_glyph(character, style, &mut self.glyph_table);
        if self.targets[place].is_intricate() {
            self.want_intricate(place, &cell);
        }
    }

    /// Sets an intricate target, and blanks the targets that it covers. Ratatui does not send a covered cell, and
    /// may not send it when it is uncovered.
    #[cold]
    fn want_intricate(&mut self, place: usize, cell: &Cell) {
        let y = place / self.width;
        let end = place + usize::from(cell.cell_width());
        if end > (y + 1) * self.width {
            self.targets[place] = PackedCell::blank(cell, &mut self.glyph_table);
            return;
        }
        self.targets[place + 1..end].fill(PackedCell::BLANK);
        self.rows[y].intricate = true;
        self.wanted.resize(self.targets.len(), Cell::EMPTY);
        if self.wanted[place] != *cell {
            self.wanted[place].clone_from(cell);
            self.rows[y].changed = true;
        }
    }

    /// Begins a whole frame, with blank targets. Returns the previous targets.
    pub(crate) fn begin_frame(&mut self) -> Vec<PackedCell> {
        let mut before = BEFORE.take();
        let (count, capacity) = (self.targets.len(), self.targets.capacity());
        if before.capacity() != capacity {
            before = Vec::with_capacity(capacity);
        }
        std::mem::swap(&mut self.targets, &mut before);
        self.targets.clear();
        self.targets.resize(count, PackedCell::BLANK);
        before
    }

    /// Ends a whole frame. Rows whose targets differ from `before` are marked as changed.
    pub(crate) fn end_frame(&mut self, before: Vec<PackedCell>) {
        let width = self.width.max(1);
        let rows = self.targets.chunks(width).zip(before.chunks(width));
        for (row, (targets, before)) in self.rows.iter_mut().zip(rows) {
            row.changed |= targets != before;
        }
        BEFORE.set(before);
    }

    /// Returns true if any target has changed since the rows were drawn.
    pub(crate) fn is_changed(&self) -> bool {
        self.rows.iter().any(|row| row.changed)
    }

    /// Returns true if every row shows its targets exactly. Rows without columns always do.
    pub(crate) fn is_exact(&self) -> bool {
        self.width == 0 || self.rows.iter().all(|row| row.exact)
    }

    /// The two colours of a shown cell. `None` if they are unknown or the cell is off the screen.
    pub(crate) fn shown_colors(&self, x: u16, y: u16) -> Option<[PackedColor; 2]> {
        let (x, y) = (usize::from(x), usize::from(y));
        let place = (x < self.width).then_some(y * self.width + x)?;
        let (_, colors) = self.shown.get(place)?.recolorable(&self.glyph_table)?;
        Some(colors)
    }

    /// The mosaic of a shown cell, if it is a block.
    pub(crate) fn shown_mosaic(&self, x: u16, y: u16) -> Option<Mosaic> {
        let place = usize::from(y) * self.width + usize::from(x);
        let (shape, _) = self.shown.get(place)?.block()?;
        Some(shape.mosaic())
    }

    /// The shown cells and the targets of each row.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (&[PackedCell], &[PackedCell])> {
        let width = self.width.max(1);
        self.shown.chunks(width).zip(self.targets.chunks(width))
    }

    /// The targets of all cells, row by row.
    pub(crate) fn targets(&self) -> impl Iterator<Item = &PackedCell> {
        self.targets.iter()
    }

    /// Replaces the colours of all targets.
    pub(crate) fn recolor_targets(&mut self, color: impl FnMut(PackedColor) -> PackedColor) {
        recolor(&mut self.targets, color);
    }

    /// Records that the terminal shows other colours than before. All rows must then be compared with their targets.
    pub(crate) fn recolor_shown(&mut self, color: impl FnMut(PackedColor) -> PackedColor) {
        recolor(&mut self.shown, color);
        self.rows.iter_mut().for_each(|row| row.changed = true);
    }

    /// The styles of the intricate targets.
    pub(crate) fn intricate_styles(&self) -> impl Iterator<Item = Style> {
        let rows = self.wanted.chunks(self.width.max(1)).zip(&self.rows);
        rows.filter(|(_, row)| row.intricate).flat_map(|(cells, _)| cells.iter().map(Style::of))
    }

    /// Returns the changed rows, from the top, and marks them as unchanged.
    pub(crate) fn changed_rows(&mut self) -> impl Iterator<Item = ScreenRow<'_>> {
        self.rows_where(|row| std::mem::take(&mut row.changed))
    }

    /// Counts a frame for the rows that have not changed.
    pub(crate) fn count_rest(&mut self) {
        for row in &mut self.rows {
            row.rested = if row.changed { 0 } else { row.rested.saturating_add(1) };
        }
    }

    /// The rows that do not show their targets exactly.
    pub(crate) fn inexact_rows(&mut self) -> impl Iterator<Item = ScreenRow<'_>> {
        self.rows_where(|row| !row.exact)
    }

    fn rows_where(
        &mut self,
        mut is_asked: impl FnMut(&mut RowState) -> bool,
    ) -> impl Iterator<Item = ScreenRow<'_>> {
        let width = self.width.max(1);
        let (glyph_table, wanted) = (&self.glyph_table, &self.wanted);
        let known = self.shown.chunks_mut(width).zip(self.marks.chunks_mut(width));
        let cells = known.zip(self.targets.chunks(width));
        let rows = (0..).zip(cells.zip(&mut self.rows));
        rows.filter_map(move |(y, (((shown, marks), targets), state))| {
            let place = usize::from(y) * width;
            let wanted = wanted.get(place..place + targets.len()).unwrap_or_default();
            is_asked(state).then_some(ScreenRow {
                y,
                glyph_table,
                shown,
                targets,
                marks,
                wanted,
                state,
            })
        })
    }
}

/// Replaces the colours of `cells`. A cell becomes unknown if one of its colours becomes [`PackedColor::NONE`].
fn recolor(cells: &mut [PackedCell], mut color: impl FnMut(PackedColor) -> PackedColor) {
    let mut last = [PackedCell::UNKNOWN; 2];
    for cell in cells {
        if *cell != last[0] {
            let colors = cell.colors().map(&mut color);
            let is_known = !colors.contains(&PackedColor::NONE);
            last = [*cell, if is_known { cell.recolored(colors) } else { PackedCell::UNKNOWN }];
        }
        *cell = last[1];
    }
}

impl ScreenRow<'_> {
    /// The number of cells in the row.
    pub(crate) fn width(&self) -> usize {
        self.targets.len()
    }

    /// Returns true if every cell differs from its target at most in its colours or, for blocks, in its shape.
    pub(crate) fn is_near(&self) -> bool {
        let form = |target: PackedCell| target.recolorable(self.glyph_table).map(|(form, _)| form);
        let mut targets = self.shown.iter().zip(self.targets);
        targets.all(|(&shown, &target)| {
            shown == target
                || match (form(shown), form(target)) {
                    (Some(Form::Block(_)), Some(Form::Block(_))) => true,
                    (shown, target) => target.is_some() && shown == target,
                }
        })
    }
}

impl Canvas for Screen {
    fn bounds(&self) -> Rect {
        Rect::new(0, 0, self.width as u16, self.rows.len() as u16)
    }

    #[inline]
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        if self.is_ascii {
            return self.draw_grounds(x, y, row);
        }
        for (target, halves) in self.targets_from(x, y).iter_mut().zip(row) {
            *target = PackedCell::of_colors(halves);
        }
    }

    #[inline]
    fn draw_pixels(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Rgb; 2]>) {
        if self.is_ascii {
            return self.draw_grounds(x, y, row.map(|halves| halves.map(true_color)));
        }
        for (target, pixels) in self.targets_from(x, y).iter_mut().zip(row) {
            *target = PackedCell::of_pixels(pixels);
        }
    }

    #[inline]
    fn draw_mosaics(&mut self, x: u16, y: u16, row: impl Iterator<Item = (Mosaic, [Color; 2])>) {
        if self.is_ascii {
            return self.draw_grounds(x, y, row.map(|(_, colors)| colors));
        }
        let start = usize::from(y) * self.width;
        let cells = start + usize::from(x).min(self.width)..start + self.width;
        let Some(targets) = self.targets.get_mut(cells) else { return };
        for (target, (mosaic, colors)) in targets.iter_mut().zip(row) {
            *target = PackedCell::of_mosaic(mosaic, colors, &mut self.glyph_table);
        }
    }

    fn draw_character(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]) {
        if self.is_ascii {
            return self.draw_ascii(x, y, character, colors);
        }
        let target = PackedCell::of_character(character, colors, &mut self.glyph_table);
        let Some(place) = self.targets_from(x, y).first_mut() else { return };
        *place = target;
        if target.is_intricate() {
            let mut cell = Cell::EMPTY;
            cell.set_char(character).set_fg(colors[0]).set_bg(colors[1]);
            self.want_intricate(usize::from(y) * self.width + usize::from(x), &cell);
        }
    }

    fn draw_widget(&mut self, widget: impl Widget, area: Rect) {
        let area = area.intersection(self.bounds());
        let mut scratch = SCRATCH.take();
        scratch.area = area;
        scratch.content.clear();
        scratch.content.resize(area.area() as usize, Cell::EMPTY);
        widget.render(area, &mut scratch);
        for (position, cell) in area.positions().zip(scratch.content()) {
            let place = usize::from(position.y) * self.width + usize::from(position.x);
            self.set(place, cell);
        }
        SCRATCH.set(scratch);
    }
}

impl Screen {
    /// The targets from `(x, y)` to the right. Empty off the screen.
    #[inline]
    fn targets_from(&mut self, x: u16, y: u16) -> &mut [PackedCell] {
        let row = usize::from(y) * self.width;
        let cells = row + usize::from(x).min(self.width)..row + self.width;
        self.targets.get_mut(cells).unwrap_or_default()
    }

    /// Draws the ASCII substitute of `character`.
    fn draw_ascii(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]) {
        if !self.targets_from(x, y).is_empty() {
            let mut cell = Cell::EMPTY;
            cell.set_char(character).set_fg(colors[0]).set_bg(colors[1]);
            self.set_ascii_cell(usize::from(y) * self.width + usize::from(x), cell);
        }
    }

    /// Draws cells of two colours as spaces in their lower colours.
    fn draw_grounds(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        for (x, colors) in (x..).zip(row) {
            self.draw_ascii(x, y, ' ', colors);
        }
    }
}
