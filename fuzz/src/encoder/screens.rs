//! Two emulators, and their screens.

use std::num::NonZeroU16;

use alacritty_terminal::Term;
use alacritty_terminal::event::VoidListener;
use alacritty_terminal::grid::Dimensions;
use alacritty_terminal::index::{Column, Line};
use alacritty_terminal::term::Config;
use alacritty_terminal::term::cell::Flags;
use alacritty_terminal::vte::ansi::{Color as AnsiColor, NamedColor, Processor, Rgb};
use ratatui::layout::{Position, Size};
use ratatui::style::{Color, Modifier};

use super::model::{Model, width};

/// The emulators that read all bytes.
pub(crate) struct Screens {
    vt100: Option<vt100::Parser>,
    alacritty: Term<VoidListener>,
    parser: Processor,
}

/// A colour as a cell stores it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shade {
    /// The terminal's own colour: of text if `true`, of the background otherwise.
    Own(bool),
    /// One of the sixteen colours that users define.
    Named(u8),
    Rgb([u8; 3]),
}

/// The visible content of a cell.
#[derive(Debug, PartialEq)]
enum Look {
    /// An upper and a lower half.
    Halves([Shade; 2]),
    Text(String, [Shade; 2], Modifier),
}

impl Screens {
    pub(crate) fn new(size: Size, only_alacritty: bool) -> Self {
        let vt100 = (!only_alacritty)
            .then(|| vt100::Parser::new(length(size.height), length(size.width), 0));
        let config = Config { scrolling_history: 0, ..Config::default() };
        let alacritty = Term::new(config, &Window(size), VoidListener);
        let mut screens = Self { vt100, alacritty, parser: Processor::new() };
        // The main screen would wrap its lines again at another size.
        screens.process(b"\x1b[?1049h");
        screens
    }

    pub(crate) fn process(&mut self, bytes: &[u8]) {
        if let Some(vt100) = &mut self.vt100 {
            vt100.process(bytes);
        }
        self.parser.advance(&mut self.alacritty, bytes);
    }

    pub(crate) fn resize(&mut self, size: Size) {
        if let Some(vt100) = &mut self.vt100 {
            vt100.screen_mut().set_size(length(size.height), length(size.width));
        }
        self.alacritty.resize(Window(size));
    }

    /// Checks that both emulators match the model.
    pub(crate) fn check(&self, model: &Model) {
        let Size { width: columns, height } = model.size();
        for y in 0..height {
            let mut covered = 0;
            for x in 0..columns {
                if covered > 0 {
                    covered -= 1;
                    continue;
                }
                let cell = model.at(x, y);
                covered = width(cell).saturating_sub(1);
                let modifiers = cell.modifier & written();
                let expected = Look::new(
                    cell.symbol(),
                    [shade(cell.fg, true), shade(cell.bg, false)],
                    modifiers,
                );
                assert_eq!(self.alacritty_look(x, y), expected, "at {x}, {y} in Alacritty");
                if let Some(vt100) = &self.vt100 {
                    assert_eq!(vt100_look(vt100, x, y), expected, "at {x}, {y} in vt100");
                }
            }
        }
    }

    /// Checks that both cursors are at the writer's position.
    pub(crate) fn check_cursor(&self, expected: Position) {
        let point = self.alacritty.grid().cursor.point;
        let at = Position::new(point.column.0 as u16, point.line.0 as u16);
        assert_eq!(at, expected, "the cursor of Alacritty");
        if let Some(vt100) = &self.vt100 {
            let (y, x) = vt100.screen().cursor_position();
            assert_eq!(Position::new(x, y), expected, "the cursor of vt100");
        }
    }

    fn alacritty_look(&self, x: u16, y: u16) -> Look {
        let cell = &self.alacritty.grid()[Line(i32::from(y))][Column(usize::from(x))];
        let mut symbol = String::from(cell.c);
        symbol.extend(cell.zerowidth().unwrap_or_default());
        let flags = [
            (Flags::BOLD, Modifier::BOLD),
            (Flags::DIM, Modifier::DIM),
            (Flags::ITALIC, Modifier::ITALIC),
            (Flags::UNDERLINE, Modifier::UNDERLINED),
            (Flags::INVERSE, Modifier::REVERSED),
        ];
        let modifiers = flags.into_iter().filter(|(flag, _)| cell.flags.contains(*flag));
        let colors = [self.ansi_shade(cell.fg, true), self.ansi_shade(cell.bg, false)];
        Look::new(&symbol, colors, modifiers.map(|(_, modifier)| modifier).collect())
    }

    fn ansi_shade(&self, color: AnsiColor, is_text: bool) -> Shade {
        let entry = |entry: u8| match self.alacritty.colors()[usize::from(entry)] {
            Some(Rgb { r, g, b }) => Shade::Rgb([r, g, b]),
            None => entry_shade(entry),
        };
        match color {
            AnsiColor::Spec(Rgb { r, g, b }) => Shade::Rgb([r, g, b]),
            AnsiColor::Indexed(index) => entry(index),
            AnsiColor::Named(NamedColor::Foreground | NamedColor::Background) => {
                Shade::Own(is_text)
            }
            AnsiColor::Named(name) => entry(name as u8),
        }
    }
}

impl Look {
    fn new(symbol: &str, [text, ground]: [Shade; 2], modifiers: Modifier) -> Self {
        let halves = match symbol {
            "▀" => [text, ground],
            "▄" => [ground, text],
            "█" => [text; 2],
            " " | "" => [ground; 2],
            _ => return Self::Text(symbol.to_owned(), [text, ground], modifiers),
        };
        if modifiers.is_empty() {
            Self::Halves(halves)
        } else {
            Self::Text(symbol.to_owned(), [text, ground], modifiers)
        }
    }
}

fn vt100_look(vt100: &vt100::Parser, x: u16, y: u16) -> Look {
    let cell = vt100.screen().cell(y, x).expect("it is on the screen");
    let modifiers = [
        (cell.bold(), Modifier::BOLD),
        (cell.dim(), Modifier::DIM),
        (cell.italic(), Modifier::ITALIC),
        (cell.underline(), Modifier::UNDERLINED),
        (cell.inverse(), Modifier::REVERSED),
    ];
    let modifiers =
        modifiers.into_iter().filter_map(|(is_set, modifier)| is_set.then_some(modifier));
    let symbol = if cell.has_contents() { cell.contents() } else { " " };
    let shade = |color, is_text| match color {
        vt100::Color::Default => Shade::Own(is_text),
        vt100::Color::Idx(index) => entry_shade(index),
        vt100::Color::Rgb(red, green, blue) => Shade::Rgb([red, green, blue]),
    };
    Look::new(
        symbol,
        [shade(cell.fgcolor(), true), shade(cell.bgcolor(), false)],
        modifiers.collect(),
    )
}

fn shade(color: Color, is_text: bool) -> Shade {
    match color {
        Color::Reset => Shade::Own(is_text),
        Color::Rgb(red, green, blue) => Shade::Rgb([red, green, blue]),
        Color::Indexed(index) => entry_shade(index),
        Color::Black => Shade::Named(0),
        Color::Red => Shade::Named(1),
        Color::Green => Shade::Named(2),
        Color::Yellow => Shade::Named(3),
        Color::Blue => Shade::Named(4),
        Color::Magenta => Shade::Named(5),
        Color::Cyan => Shade::Named(6),
        Color::Gray => Shade::Named(7),
        Color::DarkGray => Shade::Named(8),
        Color::LightRed => Shade::Named(9),
        Color::LightGreen => Shade::Named(10),
        Color::LightYellow => Shade::Named(11),
        Color::LightBlue => Shade::Named(12),
        Color::LightMagenta => Shade::Named(13),
        Color::LightCyan => Shade::Named(14),
        Color::White => Shade::Named(15),
    }
}

fn entry_shade(entry: u8) -> Shade {
    if entry < 16 { Shade::Named(entry) } else { Shade::Rgb(crate::alacritty::standard(entry)) }
}

fn written() -> Modifier {
    Modifier::BOLD | Modifier::DIM | Modifier::ITALIC | Modifier::UNDERLINED | Modifier::REVERSED
}

fn length(cells: u16) -> NonZeroU16 {
    NonZeroU16::new(cells).unwrap_or(NonZeroU16::MIN)
}

/// The columns and lines of a window.
struct Window(Size);

impl Dimensions for Window {
    fn columns(&self) -> usize {
        self.0.width.into()
    }

    fn screen_lines(&self) -> usize {
        self.0.height.into()
    }

    fn total_lines(&self) -> usize {
        self.0.height.into()
    }
}
