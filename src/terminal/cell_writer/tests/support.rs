//! A simulated terminal for tests, and pictures.

use std::cell::RefCell;
use std::io::{self, Write};
use std::num::NonZeroU16;
use std::rc::Rc;

use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::buffer::{Buffer, Cell, CellWidth};
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier};

use super::super::CellWriter;
use crate::tui::canvas::Mosaic;

/// A terminal's screen that counts the writes to it.
#[derive(Clone)]
pub(crate) struct Screen(pub(crate) Rc<RefCell<Received>>);

pub(crate) struct Received {
    pub(crate) parser: vt100::Parser,
    writes: usize,
    bytes: Vec<u8>,
}

impl Screen {
    pub(crate) fn new(size: Size) -> Self {
        let parser = vt100::Parser::new(length(size.height), length(size.width), 0);
        Self(Rc::new(RefCell::new(Received { parser, writes: 0, bytes: Vec::new() })))
    }

    pub(crate) fn resize(&self, size: Size) {
        self.0.borrow_mut().parser.set_size(length(size.height), length(size.width));
    }

    pub(crate) fn writes(&self) -> usize {
        self.0.borrow().writes
    }

    /// The text received since the last call.
    pub(crate) fn take_text(&self) -> String {
        String::from_utf8(std::mem::take(&mut self.0.borrow_mut().bytes)).unwrap()
    }
}

impl Write for Screen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut received = self.0.borrow_mut();
        received.parser.process(bytes);
        received.writes += 1;
        received.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

pub(crate) fn length(cells: u16) -> NonZeroU16 {
    NonZeroU16::new(cells).unwrap()
}

pub(crate) fn terminal(size: Size) -> (Terminal<CellWriter<Screen>>, Screen) {
    let screen = Screen::new(size);
    (Terminal::new(CellWriter::new(screen.clone(), size)).unwrap(), screen)
}

pub(crate) fn draw(terminal: &mut Terminal<CellWriter<Screen>>, content: &Buffer) {
    terminal.draw(|frame| frame.buffer_mut().merge(content)).unwrap();
}

/// The bytes that draw `cells` in a row.
pub(crate) fn bytes_of(cells: &[Cell]) -> String {
    let (mut terminal, screen) = terminal(Size::new(10, 1));
    let mut buffer = Buffer::empty(Rect::new(0, 0, cells.len() as u16, 1));
    buffer.content.clone_from_slice(cells);
    draw(&mut terminal, &buffer);
    screen.take_text()
}

/// The bytes that draw `cells`, one sequence per line.
pub(crate) fn readable(cells: &[Cell]) -> String {
    bytes_of(cells).replace('\x1b', "\nESC").trim_start().to_owned()
}

pub(crate) fn colored(symbol: &'static str, fg: Color, bg: Color) -> Cell {
    let mut cell = Cell::new(symbol);
    cell.set_fg(fg).set_bg(bg);
    cell
}

pub(crate) fn assert_shown(screen: &Screen, content: &Buffer) {
    let received = screen.0.borrow();
    for position in content.area.positions() {
        let expected = &content[position];
        let shown = received.parser.screen().cell(position.y, position.x).unwrap();
        if shown.is_wide_continuation() {
            continue;
        }
        let symbol = if shown.has_contents() { shown.contents() } else { " " };
        let shown_modifier = [
            (shown.bold(), Modifier::BOLD),
            (shown.dim(), Modifier::DIM),
            (shown.italic(), Modifier::ITALIC),
            (shown.underline(), Modifier::UNDERLINED),
            (shown.inverse(), Modifier::REVERSED),
        ]
        .into_iter()
        .filter_map(|(set, modifier)| set.then_some(modifier))
        .collect::<Modifier>();
        assert_eq!(
            Looks::new(symbol, shown.fgcolor(), shown.bgcolor(), shown_modifier),
            Looks::new(
                expected.symbol(),
                color(expected.fg),
                color(expected.bg),
                expected.modifier
            ),
            "at {position}"
        );
    }
}

/// The appearance of a cell. Of a mosaic and its inverse, this is the one without the last dot, with the
/// colours of its dots and of the rest.
#[derive(Debug, PartialEq)]
enum Looks {
    Mosaic(Mosaic, vt100::Color, vt100::Color),
    Text(String, vt100::Color, vt100::Color, Modifier),
}

impl Looks {
    fn new(symbol: &str, fg: vt100::Color, bg: vt100::Color, modifier: Modifier) -> Self {
        let text = || Self::Text(symbol.to_owned(), fg, bg, modifier);
        let Some(mosaic) = symbol.chars().next().and_then(Mosaic::of_character) else {
            return text();
        };
        let (has_dots, has_rest) = (mosaic != Mosaic::NONE, mosaic != Mosaic::ALL);
        let is_own = |color| color == vt100::Color::Default;
        if !modifier.is_empty() || has_dots && is_own(fg) || has_rest && is_own(bg) {
            return text();
        }
        let (mosaic, dots, rest) =
            if mosaic.has(1, 11) { (mosaic.inverse(), bg, fg) } else { (mosaic, fg, bg) };
        if dots == rest || mosaic == Mosaic::NONE {
            Self::Mosaic(Mosaic::NONE, rest, rest)
        } else {
            Self::Mosaic(mosaic, dots, rest)
        }
    }
}

pub(crate) fn color(color: Color) -> vt100::Color {
    match color {
        Color::Reset => vt100::Color::Default,
        Color::Rgb(red, green, blue) => vt100::Color::Rgb(red, green, blue),
        Color::Indexed(index) => vt100::Color::Idx(index),
        Color::Red => vt100::Color::Idx(1),
        Color::White => vt100::Color::Idx(15),
        other => panic!("{other} is not among the test's colours"),
    }
}

pub(crate) fn any_color() -> impl Strategy<Value = Color> {
    prop_oneof![
        Just(Color::Reset),
        Just(Color::Red),
        Just(Color::White),
        any::<u8>().prop_map(Color::Indexed),
        (0..3_u8, 0..2_u8, any::<bool>()).prop_map(|(red, green, blue)| Color::Rgb(
            red,
            green,
            if blue { 255 } else { 0 }
        )),
    ]
}

pub(crate) fn any_modifier() -> impl Strategy<Value = Modifier> {
    let intensity = prop::sample::select(vec![Modifier::empty(), Modifier::BOLD, Modifier::DIM]);
    let others = Modifier::ITALIC | Modifier::UNDERLINED | Modifier::REVERSED;
    (intensity, any::<u16>())
        .prop_map(move |(intensity, bits)| intensity | others & Modifier::from_bits_truncate(bits))
}

pub(crate) fn any_cell() -> impl Strategy<Value = Cell> {
    let symbol = prop::sample::select(vec![
        " ",
        "▀",
        "▄",
        "█",
        "▌",
        "🬂",
        "\u{1CD09}",
        "\u{1CDE5}",
        "#",
        "a",
        "é",
        "字",
    ]);
    (symbol, any_color(), any_color(), any_modifier()).prop_map(|(symbol, fg, bg, modifier)| {
        let mut cell = colored(symbol, fg, bg);
        cell.modifier = modifier;
        cell
    })
}

pub(crate) fn any_buffer(size: Size) -> impl Strategy<Value = Buffer> {
    let area = Rect::from(size);
    prop::collection::vec(any_cell(), usize::from(size.width) * usize::from(size.height)).prop_map(
        move |content| {
            let mut buffer = Buffer { area, content };
            tidy_wide_symbols(&mut buffer);
            buffer
        },
    )
}

/// Blanks the cell after each wide symbol, as ratatui's widgets do, and replaces wide symbols in
/// the last column.
pub(crate) fn tidy_wide_symbols(buffer: &mut Buffer) {
    for y in 0..buffer.area.height {
        for x in 0..buffer.area.width {
            if buffer[(x, y)].cell_width() > 1 {
                if x + 1 == buffer.area.width {
                    buffer[(x, y)].set_symbol("#");
                } else {
                    buffer[(x + 1, y)].reset();
                }
            }
        }
    }
}

pub(crate) fn any_size() -> impl Strategy<Value = Size> {
    (1..12_u16, 1..6_u16).prop_map(Size::from)
}

/// Pixels of few colours, so that there is often a choice of glyphs.
pub(crate) fn any_pixels(count: usize) -> impl Strategy<Value = Vec<Cell>> {
    let shade = || (0..3_u8).prop_map(|red| Color::Rgb(red, 7, 200));
    let symbol = prop::sample::select(vec![" ", "▀", "▄", "█", "▞", "▚", "🬂", "\u{1CD09}"]);
    let cell = (symbol, shade(), shade()).prop_map(|(symbol, fg, bg)| colored(symbol, fg, bg));
    prop::collection::vec(cell, count)
}
