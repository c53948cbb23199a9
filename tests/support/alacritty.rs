//! Alacritty's emulator: cells, the palette, and its answers.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use std::collections::BTreeSet;
use std::sync::mpsc::{self, Receiver, Sender};

use alacritty_terminal::event::{Event, EventListener};
use alacritty_terminal::grid::Dimensions;
use alacritty_terminal::index::{Column, Line};
use alacritty_terminal::term::cell::Cell;
use alacritty_terminal::term::{Config, Term, TermMode};
use alacritty_terminal::vte::ansi::{Color, NamedColor, Processor, Rgb};

/// Alacritty without its window.
pub(crate) struct Alacritty {
    terminal: Term<Events>,
    parser: Processor,
    events: Receiver<Event>,
}

/// Passes on the emulator's requests to its window.
struct Events(Sender<Event>);

impl EventListener for Events {
    fn send_event(&self, event: Event) {
        self.0.send(event).unwrap();
    }
}

/// Columns and lines of a window.
struct Window(usize, usize);

impl Dimensions for Window {
    fn columns(&self) -> usize {
        self.0
    }

    fn screen_lines(&self) -> usize {
        self.1
    }

    fn total_lines(&self) -> usize {
        self.1
    }
}

impl Alacritty {
    pub(crate) fn new(columns: u16, rows: u16) -> Self {
        let (sender, events) = mpsc::channel();
        let config = Config { kitty_keyboard: true, ..Config::default() };
        let window = Window(columns.into(), rows.into());
        let terminal = Term::new(config, &window, Events(sender));
        Self { terminal, parser: Processor::new(), events }
    }

    /// Processes `bytes`, and returns the terminal's answers.
    pub(crate) fn process(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut answers = Vec::new();
        // Each byte is processed separately, so that a query is answered before the next sequence
        // changes its subject.
        for byte in bytes {
            self.parser.advance(&mut self.terminal, std::slice::from_ref(byte));
            for event in self.events.try_iter() {
                match event {
                    Event::PtyWrite(text) => answers.extend(text.bytes()),
                    Event::ColorRequest(entry, format) => {
                        let color = defined(&self.terminal, entry);
                        let [r, g, b] = color.unwrap_or_else(|| standard(entry as u8));
                        answers.extend(format(Rgb { r, g, b }).bytes());
                    }
                    _ => {}
                }
            }
        }
        answers
    }

    pub(crate) fn resize(&mut self, columns: u16, rows: u16) {
        self.terminal.resize(Window(columns.into(), rows.into()));
    }

    /// The modes that programs set.
    pub(crate) fn modes(&self) -> TermMode {
        *self.terminal.mode()
    }

    /// The text of the screen, row by row.
    pub(crate) fn text(&self) -> String {
        let row = |row| {
            let columns = 0..self.terminal.columns() as u16;
            let text: String = columns.map(|column| self.cell(column, row).c).collect();
            text.trim_end().to_owned() + "\n"
        };
        (0..self.terminal.screen_lines() as u16).map(row).collect()
    }

    /// The character in a cell.
    pub(crate) fn character(&self, column: u16, row: u16) -> char {
        self.cell(column, row).c
    }

    /// The colours of a cell's character and of its background, resolved through the palette.
    /// `None` for the terminal's own colours.
    pub(crate) fn colors(&self, column: u16, row: u16) -> [Option<[u8; 3]>; 2] {
        let cell = self.cell(column, row);
        [cell.fg, cell.bg].map(|color| match color {
            Color::Spec(Rgb { r, g, b }) => Some([r, g, b]),
            Color::Indexed(entry) => Some(self.entry(entry)),
            Color::Named(NamedColor::Foreground | NamedColor::Background) => None,
            Color::Named(name) => Some(self.entry(name as u8)),
        })
    }

    /// The colours of the upper and the lower half of a cell. `None` for characters other than
    /// blocks, and for the terminal's own colours.
    pub(crate) fn halves(&self, column: u16, row: u16) -> Option<[[u8; 3]; 2]> {
        let [text, ground] = self.colors(column, row);
        match self.character(column, row) {
            '▀' => Some([text?, ground?]),
            '▄' => Some([ground?, text?]),
            '█' => Some([text?; 2]),
            ' ' => Some([ground?; 2]),
            _ => None,
        }
    }

    /// The palette entries in which cells are shown, or in which the next character would be. A
    /// space does not show its text colour, and a full block does not show its background.
    pub(crate) fn entries_in_use(&self) -> BTreeSet<u8> {
        let rows = 0..self.terminal.screen_lines() as u16;
        let places = rows
            .flat_map(|row| (0..self.terminal.columns() as u16).map(move |column| (column, row)));
        let cells = places.map(|(column, row)| self.cell(column, row));
        let shown = cells.flat_map(|cell| match cell.c {
            ' ' => [cell.bg; 2],
            '█' => [cell.fg; 2],
            _ => [cell.fg, cell.bg],
        });
        let pen = &self.terminal.grid().cursor.template;
        let colors = shown.chain([pen.fg, pen.bg]);
        colors
            .filter_map(|color| match color {
                Color::Indexed(entry) => Some(entry),
                Color::Spec(_) | Color::Named(_) => None,
            })
            .collect()
    }

    /// The palette entries that are defined.
    pub(crate) fn entries_defined(&self) -> BTreeSet<u8> {
        let is_defined = |entry: &u8| defined(&self.terminal, usize::from(*entry)).is_some();
        (0..=u8::MAX).filter(is_defined).collect()
    }

    /// The colour of a palette entry.
    pub(crate) fn entry(&self, entry: u8) -> [u8; 3] {
        defined(&self.terminal, usize::from(entry)).unwrap_or_else(|| standard(entry))
    }

    fn cell(&self, column: u16, row: u16) -> &Cell {
        &self.terminal.grid()[Line(i32::from(row))][Column(usize::from(column))]
    }
}

fn defined(terminal: &Term<Events>, entry: usize) -> Option<[u8; 3]> {
    terminal.colors()[entry].map(|Rgb { r, g, b }| [r, g, b])
}

/// The colour of an entry of xterm's palette, from the sixteenth on. The entries below differ from
/// user to user, and are black here.
pub(crate) fn standard(entry: u8) -> [u8; 3] {
    match entry {
        0..16 => [0; 3],
        16..232 => {
            let step = |digit: u8| if digit == 0 { 0 } else { 55 + 40 * digit };
            let cube = entry - 16;
            [cube / 36, cube / 6 % 6, cube % 6].map(step)
        }
        232.. => [8 + 10 * (entry - 232); 3],
    }
}
