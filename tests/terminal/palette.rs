//! The terminal's palette and repeated characters, in an emulator that supports both (Alacritty's).
//! Its cells, in the colours of its palette, match the writer's record of the screen. No cell ever
//! changes colour because its palette entry was defined again.

use std::collections::HashMap;

use cellcaster::game::{Game, Script};
use cellcaster::map::builtin;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::canvas::Canvas;
use cellcaster::world::{FieldOfView, World};
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

/// A sequence of pictures of one size.
#[derive(Clone, Debug)]
struct History {
    size: Size,
    frames: Vec<Vec<Cell>>,
}

/// A writer and its terminal.
struct Screen {
    writer: CellWriter<Vec<u8>>,
    terminal: Alacritty,
    size: Size,
    /// `true` if all colours are palette entries, so a definition may change the colour of a cell.
    is_own: bool,
}

impl Screen {
    fn new(size: Size, fidelity: Fidelity) -> Self {
        let mut writer = CellWriter::new(Vec::new(), size);
        writer.set_fidelity(fidelity);
        writer.set_repeats(true);
        writer.set_palette(true);
        Self { writer, terminal: Alacritty::new(size.width, size.height), size, is_own: false }
    }

    /// A terminal that shows all colours as palette entries.
    fn with_own_palette(size: Size, fidelity: Fidelity) -> Self {
        let mut screen = Self::new(size, fidelity);
        screen.writer.set_own_palette();
        screen.is_own = true;
        screen
    }

    /// Draws a frame, and returns the bytes that it took.
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
        // Alacritty buffers everything between these marks, and processes it at the second one.
        let text = bytes.replace("\x1b[?2026h", "").replace("\x1b[?2026l", "");
        if self.is_own {
            assert!(!text.contains("8;2;"), "a colour was sent in 24 bits");
            self.terminal.process(text.as_bytes());
        } else {
            self.show(&text);
        }
        bytes
    }

    /// Sends `text` to the terminal. Fails if a definition changes an entry that is in use.
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

    /// Fails if the terminal differs from the writer's record, or, if `is_exact`, from `frame`.
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

/// A 24-bit colour, or an entry as xterm defines it.
fn rgb(color: Color) -> Rgb {
    match color {
        Color::Rgb(red, green, blue) => [red, green, blue],
        Color::Indexed(entry) => standard(entry),
        other => panic!("{other:?} is in no frame"),
    }
}

/// Colours of which some are similar, some are entries that a program requests, and many have no
/// entry left.
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

/// Frames of runs of cells, in colours that come and go, so that entries are defined, used and
/// defined again.
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
    fn the_terminal_shows_what_the_writer_reports(
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

proptest! {
    #[test]
    fn a_redefined_palette_shows_what_the_writer_reports(
        history in any_history(),
        tolerance in prop_oneof![Just(0_u8), 1..60_u8, any::<u8>()],
    ) {
        let mut screen = Screen::with_own_palette(history.size, Fidelity::new(tolerance));
        for frame in &history.frames {
            screen.draw(frame);
            screen.check(frame, false);
        }
        while !screen.writer.is_settled() {
            screen.draw(history.frames.last().unwrap());
        }
        screen.check(history.frames.last().unwrap(), false);
        prop_assert!(screen.terminal.entries_defined().iter().all(|&entry| entry >= 24));
    }
}

const TOUR: &str = "[tour]\n1 s forward\n1 s turn-left\n0.5 s forward turn-right\n1 s turn-right aim\n\
    0.5 s strafe-left\n";

/// A colour in Oklab, by the formula of its inventor.
fn oklab(color: Rgb) -> [f64; 3] {
    let [r, g, b] = color.map(|channel| {
        let signal = f64::from(channel) / 255.0;
        if signal <= 0.04045 { signal / 12.92 } else { ((signal + 0.055) / 1.055).powf(2.4) }
    });
    let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
    let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
    let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

/// The mean error over a tour, the error of its first frame, and the bytes of a frame relative to
/// its bytes in 24 bits.
fn tour(world: World) -> [f64; 3] {
    let size = Size::new(80, 24);
    let script = Script::parse(TOUR, "tour").unwrap();
    let mut game = Game::new(world);
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    let mut writers = [(); 2].map(|()| CellWriter::new(Vec::new(), size));
    writers[1].set_own_palette();
    let (mut bytes, mut errors) = ([0; 2], Vec::new());
    for (step, (_, intents)) in script.iter().enumerate() {
        if step % 2 == 0 {
            let camera = game.camera(FieldOfView::default());
            renderer.render(game.world(), &camera, &mut frame);
            let pixels: Vec<Rgb> = frame.rows().flatten().map(|pixel| pixel.channels()).collect();
            for (writer, bytes) in writers.iter_mut().zip(&mut bytes) {
                writer.draw_frame(|screen| {
                    for (y, rows) in (0..).zip(pixels.chunks_exact(160)) {
                        let halves = (0..80).map(|x| {
                            [rows[x], rows[80 + x]]
                                .map(|[red, green, blue]| Color::Rgb(red, green, blue))
                        });
                        screen.draw_halves(0, y, halves);
                    }
                });
                writer.flush().unwrap();
                *bytes += writer.output_mut().drain(..).len();
            }
            let (mut error, mut known) = (0.0, HashMap::new());
            for (place, &wanted) in pixels.iter().enumerate() {
                let shown = writers[1].shown_colors((place % 80) as u16, (place / 160) as u16);
                let shown = rgb(shown.unwrap()[place / 80 % 2]);
                error += *known.entry((wanted, shown)).or_insert_with(|| {
                    let squares = oklab(wanted).into_iter().zip(oklab(shown));
                    squares.map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
                });
            }
            errors.push(error / pixels.len() as f64);
        }
        game.step(intents);
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    [mean, errors[0], f64::from(bytes[1] as u32) / f64::from(bytes[0] as u32)]
}

#[test]
fn a_redefined_palette_is_near_true_colour_in_every_level() {
    let mut bytes = Vec::new();
    for level in builtin::LEVELS {
        let [mean, first, ratio] = tour(level.world().unwrap());
        println!("{:12} error {mean:.4}, at the start {first:.4}, bytes {ratio:.2}", level.name);
        assert!(mean <= 0.010 && first <= 0.010, "{}: {mean} {first}", level.name);
        bytes.push(ratio);
    }
    let mean = bytes.iter().sum::<f64>() / bytes.len() as f64;
    println!("bytes {mean:.3}");
    assert!(mean <= 0.8, "{bytes:?}");
}

/// There are more colours than palette entries, frame after frame.
#[test]
fn palette_entries_are_reused_for_other_colours() {
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
