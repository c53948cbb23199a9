//! Drawing on the screen that is to be shown.

use ratatui::buffer::Cell;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::super::ascii;
use super::super::look::Look;
use super::super::style::Style;
use super::Screen;
use crate::tui::Canvas;
use crate::world::Rgb;

impl Canvas for Screen {
    fn bounds(&self) -> Rect {
        Rect::new(0, 0, self.width as u16, self.changed.len() as u16)
    }

    #[inline]
    fn draw_halves(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        if self.is_ascii {
            return self.draw_grounds(x, y, row);
        }
        for (look, halves) in self.looks_from(x, y).iter_mut().zip(row) {
            *look = Look::of_colors(halves);
        }
    }

    #[inline]
    fn draw_pixels(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Rgb; 2]>) {
        if self.is_ascii {
            let rgb = |color: Rgb| Color::Rgb(color.red(), color.green(), color.blue());
            return self.draw_grounds(x, y, row.map(|halves| halves.map(rgb)));
        }
        for (look, pixels) in self.looks_from(x, y).iter_mut().zip(row) {
            *look = Look::of_pixels(pixels);
        }
    }

    fn draw_character(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]) {
        if self.is_ascii {
            return self.draw_ascii(x, y, character, colors);
        }
        let look = Look::of_character(character, colors, &mut self.alphabet);
        let Some(place) = self.looks_from(x, y).first_mut() else { return };
        *place = look;
        if look.is_intricate() {
            let mut cell = Cell::EMPTY;
            cell.set_char(character).set_fg(colors[0]).set_bg(colors[1]);
            self.want_intricate(usize::from(y) * self.width + usize::from(x), &cell);
        }
    }

    fn draw_widget(&mut self, widget: impl Widget, area: Rect) {
        let area = area.intersection(self.bounds());
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.area = area;
        scratch.content.clear();
        scratch.content.resize(area.area() as usize, Cell::EMPTY);
        widget.render(area, &mut scratch);
        for (position, cell) in area.positions().zip(scratch.content()) {
            let place = usize::from(position.y) * self.width + usize::from(position.x);
            self.set(place, cell);
        }
        self.scratch = scratch;
    }
}

impl Screen {
    /// The cells from `(x, y)` to the right; none off the screen.
    #[inline]
    fn looks_from(&mut self, x: u16, y: u16) -> &mut [Look] {
        let row = usize::from(y) * self.width;
        let cells = row + usize::from(x).min(self.width)..row + self.width;
        self.looks.get_mut(cells).unwrap_or_default()
    }

    /// Shows what stands for `character`.
    fn draw_ascii(&mut self, x: u16, y: u16, character: char, colors: [Color; 2]) {
        let character = ascii::substitute(character.encode_utf8(&mut [0; 4]));
        let look = Look::of_letter(character, Style::in_colors(colors), &mut self.alphabet);
        if let Some(place) = self.looks_from(x, y).first_mut() {
            *place = look;
        }
    }

    /// Shows cells of two colours without a block: in the lower one.
    fn draw_grounds(&mut self, x: u16, y: u16, row: impl Iterator<Item = [Color; 2]>) {
        for (x, colors) in (x..).zip(row) {
            self.draw_ascii(x, y, ' ', colors);
        }
    }
}
