//! The encoder: pictures, erased regions, changed sizes and settings, from bytes.
//!
//! Two emulators read the bytes that the writer writes. After every picture at exact fidelity, both
//! must match a model. At another fidelity, they must match it once the picture rests. Only
//! Alacritty reads repeat counts and a defined palette.

mod model;
mod screens;

use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::canvas::Canvas;
use ratatui::backend::{Backend, ClearType};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::widgets::Widget;

use crate::bytes::Bytes;
use model::{Model, Picture};
use screens::Screens;

/// The largest number of operations in an input.
const MAX_OPERATIONS: usize = 40;
/// The number of frames after which a picture at rest is exact.
const FRAMES_OF_REST: usize = 10;
const REGIONS: [ClearType; 5] = [
    ClearType::All,
    ClearType::AfterCursor,
    ClearType::BeforeCursor,
    ClearType::CurrentLine,
    ClearType::UntilNewLine,
];

/// Draws pictures, and checks the screens of the emulators.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let flags = choices.byte();
    let (palette, repeats) = (flags & 1 == 1, flags & 2 == 2);
    let mut drawing = Drawing::new(size(&mut choices), palette || repeats);
    drawing.writer.set_palette(palette);
    drawing.writer.set_repeats(repeats);
    for _ in 0..MAX_OPERATIONS {
        if choices.is_empty() {
            break;
        }
        drawing.change(&mut choices);
    }
    drawing.settle();
}

fn size(choices: &mut Bytes) -> Size {
    Size::new(1 + choices.below(20) as u16, 1 + choices.below(6) as u16)
}

/// A writer, the expected screen of its terminal, and the screens of two terminals.
struct Drawing {
    writer: CellWriter<Vec<u8>>,
    model: Model,
    screens: Screens,
    is_exact: bool,
}

impl Drawing {
    fn new(size: Size, only_alacritty: bool) -> Self {
        Self {
            writer: CellWriter::new(Vec::new(), size),
            model: Model::blank(size),
            screens: Screens::new(size, only_alacritty),
            is_exact: true,
        }
    }

    fn change(&mut self, choices: &mut Bytes) {
        match choices.below(16) {
            0..3 => self.draw_widget(choices),
            3..6 => self.draw_changes(choices),
            6..8 => self.draw_on_canvas(choices),
            8..10 => self.rotate(choices),
            10 => self.resize(choices),
            11 => self.erase(choices),
            12 => self.scribble(choices),
            13 => {
                let tolerance = choices.pick(&[0, 0, 10, 24, 255]);
                self.is_exact = tolerance == 0;
                self.writer.set_fidelity(Fidelity::new(tolerance));
                self.settle();
            }
            14 => self.move_cursor(choices),
            _ => self.settle(),
        }
    }

    /// Draws a whole picture as a widget on a blank screen.
    fn draw_widget(&mut self, choices: &mut Bytes) {
        let picture = Picture::new(self.model.size(), choices);
        self.writer.draw_frame(|screen| screen.draw_widget(Whole(&picture), screen.bounds()));
        self.model.show(&picture);
        self.check();
    }

    /// Sends the cells that differ from the previous picture, as ratatui does.
    fn draw_changes(&mut self, choices: &mut Bytes) {
        let picture = Picture::new(self.model.size(), choices);
        let before = self.model.clone();
        self.model.show(&picture);
        let changes: Vec<_> = picture
            .uncovered()
            .filter(|&(x, y, _)| !self.model.equals_at(&before, x, y) || choices.below(8) == 1)
            .collect();
        self.writer.draw(changes.into_iter()).expect("it is in memory");
        self.check();
    }

    /// Draws rows of pixels, and single characters.
    fn draw_on_canvas(&mut self, choices: &mut Bytes) {
        let Size { width, height } = self.model.size();
        let Self { writer, model, .. } = self;
        writer.draw_frame(|screen| {
            model.clear();
            for y in 0..height {
                let x = choices.below(usize::from(width)) as u16;
                let halves: Vec<_> = (0..choices.below(24))
                    .map(|_| [model::pixel(choices), model::pixel(choices)])
                    .collect();
                screen.draw_halves(x, y, halves.iter().copied());
                model.draw_halves(x, y, &halves);
            }
            for _ in 0..choices.below(4) {
                let (x, y) =
                    (choices.byte() as u16 % (width + 2), choices.byte() as u16 % (height + 1));
                let character = model::character(choices);
                let colors = [model::color(choices), model::color(choices)];
                if model.draw_character(x, y, character, colors) {
                    screen.draw_character(x, y, character, colors);
                }
            }
        });
        self.check();
    }

    /// Moves a part of a row sideways.
    fn rotate(&mut self, choices: &mut Bytes) {
        let picture = self.model.rotated(choices);
        self.writer.draw_frame(|screen| screen.draw_widget(Whole(&picture), screen.bounds()));
        self.model.show(&picture);
        self.check();
    }

    fn resize(&mut self, choices: &mut Bytes) {
        let size = size(choices);
        self.screens.resize(size);
        self.writer.set_size(size);
        self.writer.clear().expect("it is in memory");
        self.model = Model::blank(size);
        self.check();
    }

    fn erase(&mut self, choices: &mut Bytes) {
        let Size { width, height } = self.model.size();
        let at = Position::new(choices.byte() as u16 % width, choices.byte() as u16 % height);
        let region = choices.pick(&REGIONS);
        if region == ClearType::BeforeCursor && at.y == 1 {
            // Alacritty 0.26 leaves the row above unchanged.
            return;
        }
        self.writer.set_cursor_position(at).expect("it is in memory");
        self.writer.clear_region(region).expect("it is in memory");
        let cursor = if region == ClearType::All { Position::ORIGIN } else { at };
        self.model.erase(region, cursor);
        self.settle();
    }

    /// Writes to the terminal as another program would.
    fn scribble(&mut self, choices: &mut Bytes) {
        self.send();
        let text: String = (0..choices.below(30)).map(|_| model::character(choices)).collect();
        let text: String = text
            .chars()
            .filter(|&it| unicode_width::UnicodeWidthChar::width(it) == Some(1))
            .collect();
        self.screens
            .process(format!("\x1b[H\x1b[3{}m{text}\x1b[?25l", choices.below(8)).as_bytes());
        self.writer.forget();
        self.settle();
    }

    fn move_cursor(&mut self, choices: &mut Bytes) {
        let at = Position::new(choices.byte().into(), choices.byte().into());
        self.writer.set_cursor_position(at).expect("it is in memory");
        if choices.flag() {
            self.writer.show_cursor().expect("it is in memory");
        } else {
            self.writer.hide_cursor().expect("it is in memory");
        }
        self.send();
        let known = self.writer.get_cursor_position().expect("it is in memory");
        self.screens.check_cursor(known);
    }

    /// Lets the picture rest until it is exact, and checks it.
    fn settle(&mut self) {
        for _ in 0..FRAMES_OF_REST {
            self.writer.draw(std::iter::empty()).expect("it is in memory");
            self.send();
        }
        assert!(self.writer.is_settled(), "not exact after {FRAMES_OF_REST} frames of rest");
        self.screens.check(&self.model);
        self.writer.draw(std::iter::empty()).expect("it is in memory");
        self.writer.flush().expect("it is in memory");
        assert_eq!(self.writer.output_mut(), b"", "a frame without a change");
    }

    fn check(&mut self) {
        self.send();
        if self.is_exact {
            self.screens.check(&self.model);
        }
    }

    fn send(&mut self) {
        self.writer.flush().expect("it is in memory");
        let bytes = std::mem::take(self.writer.output_mut());
        self.screens.process(&bytes);
    }
}

/// A widget that is a whole picture.
struct Whole<'a>(&'a Picture);

impl Widget for Whole<'_> {
    fn render(self, _: Rect, buffer: &mut Buffer) {
        buffer.merge(self.0.buffer());
    }
}
