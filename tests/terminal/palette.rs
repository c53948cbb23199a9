//! The terminal's palette and repeated characters, in an emulator that has both (Alacritty's): its cells, in
//! the colours of its palette, are those that the writer says are on the screen, and no cell ever changes
//! colour because its entry was defined anew.

use cellcaster::canvas::Canvas;
use cellcaster::terminal::{CellWriter, Fidelity};
use proptest::prelude::*;
use ratatui::backend::Backend;
use ratatui::layout::Size;
use ratatui::style::Color;

use crate::emulator::alacritty::{Alacritty, standard};

type Rgb = [u8; 3];

/// A cell of a frame.
#[derive(Clone, Copy, Debug)]
enum Cell {
    Halves([Color; 2]),
    Text(char, [Color; 2]),
}

/// Pictures of one size, one after the other.
#[derive(Clone, Debug)]
struct History {
    size: Size,
    frames: Vec<Vec<Cell>>,
}

/// A writer, and the terminal at its end.
struct Screen {
    writer: CellWriter<Vec<u8>>,
    terminal: Alacritty,
    size: Size,
}

impl Screen {
    fn new(size: Size, fidelity: Fidelity) -> Self {
        let mut writer = CellWriter::new(Vec::new(), size);
        writer.set_fidelity(fidelity);
        writer.set_repeats(true);
        writer.set_palette(true);
        Self { writer, terminal: Alacritty::new(size.width, size.height), size }
    }

    /// Draws a frame, and returns what it took.
    fn draw(&mut self, frame: &[Cell]) -> String {
        let width = usize::from(self.size.width);
        self.writer.draw_frame(|screen| {
            for (index, cell) in frame.iter().enumerate() {
                let (x, y) = ((index % width) as u16, (index / width) as u16);
                match *cell {
                    Cell::Halves(halves) => screen.draw_halves(x, y, std::iter::once(halves)),
                    Cell::Text(character, colors) => screen.draw_character(x, y, character, colors),
                }
            }
        });
        self.writer.flush().unwrap();
        let bytes = String::from_utf8(std::mem::take(self.writer.output_mut())).unwrap();
        // Alacritty keeps what is between these marks, and takes it all at the second one.
        let text = bytes.replace("\x1b[?2026h", "").replace("\x1b[?2026l", "");
        self.show(&text);
        bytes
    }

    /// Hands `text` to the terminal, and fails where a definition changes an entry that is in use.
    fn show(&mut self, text: &str) {
        const DEFINE: &str = "\x1b]4;";
        let (first, definitions) = text.split_once(DEFINE).unwrap_or((text, ""));
        self.terminal.process(first.as_bytes());
        for part in definitions.split(DEFINE).filter(|part| !part.is_empty()) {
            let (definition, rest) = part.split_once('\x07').unwrap();
            let in_use = self.terminal.entries_in_use();
            let colors = |terminal: &Alacritty| -> Vec<Rgb> {
                in_use.iter().map(|&entry| terminal.entry(entry)).collect()
            };
            let before = colors(&self.terminal);
            self.terminal.process(format!("{DEFINE}{definition}\x07").as_bytes());
            assert_eq!(colors(&self.terminal), before, "{definition} redefines one of {in_use:?}");
            self.terminal.process(rest.as_bytes());
        }
    }

    /// Fails where the terminal shows something else than the writer says, or, where `is_exact`, than
    /// `frame`.
    fn check(&self, frame: &[Cell], is_exact: bool) {
        let width = usize::from(self.size.width);
        for (index, cell) in frame.iter().enumerate() {
            let (x, y) = ((index % width) as u16, (index / width) as u16);
            match *cell {
                Cell::Halves(wanted) => {
                    let said = self.writer.shown_colors(x, y).map(|halves| halves.map(rgb));
                    assert_eq!(self.terminal.halves(x, y), said, "at {x}, {y}");
                    assert!(!is_exact || said == Some(wanted.map(rgb)), "at {x}, {y}");
                }
                Cell::Text(character, colors) => {
                    assert_eq!(self.terminal.character(x, y), character, "at {x}, {y}");
                    let said = self.writer.shown_colors(x, y).map(|colors| colors.map(rgb));
                    assert_eq!(
                        Some(self.terminal.colors(x, y)),
                        said.map(|colors| colors.map(Some))
                    );
                    assert!(!is_exact || said == Some(colors.map(rgb)), "at {x}, {y}");
                }
            }
        }
    }
}

/// A colour of 24 bits, or an entry as xterm has it.
fn rgb(color: Color) -> Rgb {
    match color {
        Color::Rgb(red, green, blue) => [red, green, blue],
        Color::Indexed(entry) => standard(entry),
        other => panic!("{other:?} is in no frame"),
    }
}

/// Colours of which some are alike, some are entries that a program asks for, and many have no entry left.
fn any_color() -> impl Strategy<Value = Color> {
    prop_oneof![
        8 => (0..30_u8).prop_map(|step| Color::Rgb(90 + 4 * step, 60 + step, 40)),
        6 => any::<Rgb>().prop_map(|[red, green, blue]| Color::Rgb(red, green, blue)),
        1 => (16..=u8::MAX).prop_map(Color::Indexed),
    ]
}

fn any_cell() -> impl Strategy<Value = Cell> {
    let text = prop::sample::select(vec!['a', '#', 'é']);
    prop_oneof![
        9 => [any_color(), any_color()].prop_map(Cell::Halves),
        1 => (text, [any_color(), any_color()]).prop_map(|(text, colors)| Cell::Text(text, colors)),
    ]
}

/// Frames of runs of cells, in colours that come and go, so that entries are defined, used and defined
/// anew.
fn any_history() -> impl Strategy<Value = History> {
    let size = (1..60_u16, 1..13_u16).prop_map(Size::from);
    size.prop_flat_map(|size| {
        let cells = usize::from(size.width) * usize::from(size.height);
        let runs = prop::collection::vec((any_cell(), 1..4_usize), cells);
        let frame = runs.prop_map(move |runs| {
            let repeated =
                runs.into_iter().flat_map(|(cell, times)| std::iter::repeat_n(cell, times));
            repeated.take(cells).collect()
        });
        (Just(size), prop::collection::vec(frame, 1..8))
    })
    .prop_map(|(size, frames)| History { size, frames })
}

proptest! {
    #[test]
    fn the_terminal_shows_what_the_writer_says(
        history in any_history(),
        tolerance in prop_oneof![Just(0_u8), 1..60_u8, any::<u8>()],
    ) {
        let fidelity = Fidelity::new(tolerance);
        let mut screen = Screen::new(history.size, fidelity);
        for frame in &history.frames {
            screen.draw(frame);
            screen.check(frame, fidelity == Fidelity::EXACT);
        }
        let last = history.frames.last().unwrap();
        while !screen.writer.is_settled() {
            screen.draw(last);
        }
        screen.check(last, true);
    }
}

/// More colours than the palette has entries, frame after frame.
#[test]
fn entries_are_used_again_for_other_colours() {
    let size = Size::new(60, 20);
    for fidelity in [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW] {
        let mut screen = Screen::new(size, fidelity);
        let mut bytes = String::new();
        for number in 0..12_u16 {
            let cells = 0..size.width * size.height;
            let frame: Vec<Cell> = cells
                .map(|index| {
                    let step = u32::from(index / 4 % 60 + 40 * number) * 2_654_435;
                    let [_, red, green, blue] = step.to_be_bytes();
                    Cell::Halves([Color::Rgb(red, green, blue), Color::Rgb(blue, red, green)])
                })
                .collect();
            bytes += &screen.draw(&frame);
            screen.check(&frame, fidelity == Fidelity::EXACT);
        }
        assert!(bytes.contains("\x1b]4;"), "no entry was defined");
        assert!(bytes.contains("38;5;"), "no entry was used");
        let definitions = bytes.matches('#').count();
        let entries = screen.terminal.entries_defined();
        assert!(definitions > entries.len(), "{definitions} definitions of {entries:?}");
        assert!(entries.iter().all(|&entry| entry >= 24));
    }
}
