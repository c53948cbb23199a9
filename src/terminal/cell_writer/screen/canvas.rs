//! The canvas: draws the targets of a screen.

use std::cell;

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::super::packed_cell::PackedCell;
use super::Screen;
use crate::color::Rgb;
use crate::terminal::thread_memory;
use crate::tui::canvas::{Canvas, Mosaic};

thread_local! {
    /// The buffer into which widgets are drawn first.
    static SCRATCH: cell::Cell<Buffer> = cell::Cell::default();
}

impl Canvas for Screen {
    fn bounds(&self) -> Rect {
        Rect::new(0, 0, self.width as u16, self.changed.len() as u16)
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
            let rgb = |color: Rgb| Color::Rgb(color.red(), color.green(), color.blue());
            return self.draw_grounds(x, y, row.map(|halves| halves.map(rgb)));
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
        let mut scratch = thread_memory::take(&SCRATCH);
        scratch.area = area;
        scratch.content.clear();
        scratch.content.resize(area.area() as usize, Cell::EMPTY);
        widget.render(area, &mut scratch);
        for (position, cell) in area.positions().zip(scratch.content()) {
            let place = usize::from(position.y) * self.width + usize::from(position.x);
            self.set(place, cell);
        }
        thread_memory::put_back(&SCRATCH, scratch);
    }
}

impl Screen {
    /// The targets from `(x, y)` to the right; empty off the screen.
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

    /// Draws cells of two colours without a block element, in their lower colours.
    fn draw_grounds(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        for (x, colors) in (x..).zip(row) {
            self.draw_ascii(x, y, ' ', colors);
        }
    }
}
