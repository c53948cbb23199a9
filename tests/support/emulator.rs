//! A terminal emulator: its screen, its modes, and its answers.
#![allow(dead_code, reason = "every test file uses its own share of this")]

#[path = "alacritty.rs"]
pub(crate) mod alacritty;

use std::num::NonZeroU16;

use vt100::{Callbacks, Color, MouseProtocolEncoding, MouseProtocolMode, Parser, Screen};

pub(crate) use self::alacritty::Alacritty;

/// The queries that a terminal answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Speaks {
    /// Nothing.
    Nothing,
    /// Queries for the device's identity.
    Plain,
    /// Also status requests, the kitty keyboard protocol, and the queries for 24-bit colours and
    /// for mouse positions in pixels. A key release arrives whenever the program switches the
    /// protocol off.
    Kitty,
    /// The same queries as Alacritty, whose palette can be defined, and which repeats characters.
    /// The screen is [its own](Emulator::alacritty).
    Alacritty,
}

/// The modes that a program sets and should reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each mode is set or not, by itself")]
pub(crate) struct Modes {
    pub(crate) alternate_screen: bool,
    pub(crate) cursor_hidden: bool,
    pub(crate) wrap: bool,
    pub(crate) synchronized: bool,
    /// `true` if changes of the focus are reported.
    pub(crate) focus: bool,
    /// The reported events of the mouse, and their encoding.
    pub(crate) mouse: (MouseProtocolMode, MouseProtocolEncoding),
    /// `true` if the position of the mouse is reported in pixels.
    pub(crate) mouse_pixels: bool,
    /// The number of keyboard flag sets on the stacks of the main and of the alternate screen.
    pub(crate) key_flags: [i32; 2],
}

impl Default for Modes {
    /// The modes of a new terminal.
    fn default() -> Self {
        Self {
            alternate_screen: false,
            cursor_hidden: false,
            wrap: true,
            synchronized: false,
            focus: false,
            mouse: (MouseProtocolMode::None, MouseProtocolEncoding::Default),
            mouse_pixels: false,
            key_flags: [0, 0],
        }
    }
}

/// A terminal emulator.
pub(crate) struct Emulator {
    parser: Parser<Extensions>,
    alacritty: Option<Box<Alacritty>>,
    bytes: Vec<u8>,
    answered_about_colors: bool,
}

/// The parts that the parser does not handle.
struct Extensions {
    speaks: Speaks,
    modes: Modes,
    title: String,
    answers: Vec<u8>,
    statuses: Statuses,
}

/// The requests for the terminal's status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Statuses {
    /// `true` if answers are lost.
    pub(crate) lost: bool,
    /// The number of unanswered requests.
    pub(crate) unanswered: usize,
}

impl Emulator {
    pub(crate) fn new(columns: u16, rows: u16, speaks: Speaks) -> Self {
        let extensions = Extensions {
            speaks,
            modes: Modes::default(),
            title: String::new(),
            answers: Vec::new(),
            statuses: Statuses::default(),
        };
        let parser = Parser::new_with_callbacks(length(rows), length(columns), 0, extensions);
        let alacritty =
            (speaks == Speaks::Alacritty).then(|| Box::new(Alacritty::new(columns, rows)));
        Self { parser, alacritty, bytes: Vec::new(), answered_about_colors: false }
    }

    /// Processes `bytes` and returns the terminal's answers.
    pub(crate) fn process(&mut self, bytes: &[u8]) -> Vec<u8> {
        let before = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.parser.process(bytes);
        if let Some(alacritty) = &mut self.alacritty {
            return alacritty.process(bytes);
        }
        let answers = std::mem::take(&mut self.parser.callbacks_mut().answers);
        [last_motion(bytes), &self.answer_about_colors(before), &answers].concat()
    }

    /// Answers the query for 24-bit colours, which is in a kind of string that the parser ignores.
    /// The query must end after the first `before` bytes.
    fn answer_about_colors(&mut self, before: usize) -> Vec<u8> {
        const QUERY: &[u8] = b"\x1bP+q524742\x1b\\";
        const ANSWER: &[u8] = b"\x1bP1+r524742=38\x1b\\";
        let speaks = self.parser.callbacks().speaks;
        let recent = &self.bytes[before.saturating_sub(QUERY.len())..];
        if self.answered_about_colors
            || speaks != Speaks::Kitty
            || !recent.windows(QUERY.len()).any(|window| window == QUERY)
        {
            return Vec::new();
        }
        self.answered_about_colors = true;
        ANSWER.to_vec()
    }

    pub(crate) fn resize(&mut self, columns: u16, rows: u16) {
        self.parser.set_size(length(rows), length(columns));
        if let Some(alacritty) = &mut self.alacritty {
            alacritty.resize(columns, rows);
        }
    }

    pub(crate) fn screen(&self) -> &Screen {
        self.parser.screen()
    }

    /// The colours of the upper and the lower half of a cell. `None` for characters other than
    /// blocks, and for the terminal's own colours.
    pub(crate) fn halves(&self, column: u16, row: u16) -> Option<[[u8; 3]; 2]> {
        if let Some(alacritty) = &self.alacritty {
            return alacritty.halves(column, row);
        }
        let cell = self.screen().cell(row, column)?;
        let [text, ground] = [cell.fgcolor(), cell.bgcolor()].map(|color| match color {
            Color::Rgb(red, green, blue) => Some([red, green, blue]),
            Color::Idx(_) | Color::Default => None,
        });
        match cell.contents() {
            "▀" => Some([text?, ground?]),
            "▄" => Some([ground?, text?]),
            "█" => Some([text?; 2]),
            " " | "" => Some([ground?; 2]),
            _ => None,
        }
    }

    /// The emulator of a terminal that speaks like Alacritty.
    pub(crate) fn alacritty(&self) -> &Alacritty {
        self.alacritty.as_ref().unwrap()
    }

    pub(crate) fn text(&self) -> String {
        match &self.alacritty {
            Some(alacritty) => alacritty.text(),
            None => self.screen().contents(),
        }
    }

    pub(crate) fn title(&self) -> &str {
        &self.parser.callbacks().title
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    pub(crate) fn statuses(&mut self) -> &mut Statuses {
        &mut self.parser.callbacks_mut().statuses
    }

    pub(crate) fn modes(&self) -> Modes {
        Modes {
            alternate_screen: self.screen().alternate_screen(),
            cursor_hidden: self.screen().hide_cursor(),
            mouse: (self.screen().mouse_protocol_mode(), self.screen().mouse_protocol_encoding()),
            ..self.parser.callbacks().modes
        }
    }
}

impl Callbacks for Extensions {
    fn set_window_title(&mut self, _: &mut Screen, title: &[u8]) {
        self.title = String::from_utf8_lossy(title).into_owned();
    }

    fn unhandled_csi(
        &mut self,
        screen: &mut Screen,
        prefix: Option<u8>,
        intermediate: Option<u8>,
        parameters: &[&[u16]],
        last: char,
    ) {
        let key_flags = &mut self.modes.key_flags[usize::from(screen.alternate_screen())];
        match (prefix, parameters, last) {
            (Some(b'?'), [[7]], 'h' | 'l') => self.modes.wrap = last == 'h',
            (Some(b'?'), [[1004]], 'h' | 'l') => self.modes.focus = last == 'h',
            (Some(b'?'), [[1016]], 'h' | 'l') => self.modes.mouse_pixels = last == 'h',
            (Some(b'?'), [[1016]], 'p')
                if intermediate == Some(b'$') && self.speaks == Speaks::Kitty =>
            {
                self.answers.extend(b"\x1b[?1016;2$y");
            }
            (Some(b'?'), [[2026]], 'h' | 'l') => self.modes.synchronized = last == 'h',
            (Some(b'>'), _, 'q') if self.speaks == Speaks::Kitty => {
                self.answers.extend(b"\x1bP>|XTerm(400)\x1b\\");
            }
            (Some(b'>'), _, 'u') => *key_flags += 1,
            (Some(b'<'), _, 'u') => {
                *key_flags -= 1;
                self.answers.extend(b"\x1b[119;1:3u");
            }
            (Some(b'?'), _, 'u') if self.speaks == Speaks::Kitty => {
                self.answers.extend(b"\x1b[?0u");
            }
            (None, [[5]], 'n') if self.statuses.lost => self.statuses.unanswered += 1,
            (None, [[5]], 'n') if self.speaks == Speaks::Kitty => self.answers.extend(b"\x1b[0n"),
            (None, _, 'c') if self.speaks != Speaks::Nothing => {
                self.answers.extend(b"\x1b[?62;22c");
            }
            _ => {}
        }
    }
}

/// A motion of the mouse, which is always on its way when a program disables mouse reports.
fn last_motion(bytes: &[u8]) -> &'static [u8] {
    const DISABLE: &[u8] = b"\x1b[?1003l";
    let is_disabled = bytes.windows(DISABLE.len()).any(|window| window == DISABLE);
    if is_disabled { b"\x1b[<35;300;200M" } else { b"" }
}

fn length(cells: u16) -> NonZeroU16 {
    NonZeroU16::new(cells).unwrap()
}
