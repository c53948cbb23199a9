//! The encoder's bytes, read by two independent emulators. At exact fidelity they show the picture
//! itself, otherwise a picture within the tolerance. The encoder uses only sequences that every
//! terminal understands.
#![cfg(feature = "terminal")]

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use cellcaster::color::Rgb as Pixel;
use cellcaster::color::palette::{ColorDepth, of_256};
use cellcaster::terminal::{CellWriter, Effort, Fidelity};
use cellcaster::tui::GlyphSet;
use cellcaster::tui::canvas::{Canvas, Mosaic};
use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::Widget;

type Rgb = [u8; 3];

/// A colour that a terminal shows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shade {
    /// The terminal's own colour.
    Own,
    /// One of the sixteen colours that users redefine.
    Named(u8),
    Rgb(Rgb),
}

impl Shade {
    fn of(color: Color) -> Self {
        match color {
            Color::Rgb(red, green, blue) => Self::Rgb([red, green, blue]),
            Color::Indexed(index) => Self::of_index(index, &Palette::default()),
            Color::Reset => Self::Own,
            other => panic!("{other} is not among the test's colours"),
        }
    }

    fn of_index(index: u8, palette: &Palette) -> Self {
        match index {
            0..16 => Self::Named(index),
            _ => Self::Rgb(palette.0.get(&index).copied().unwrap_or(of_256(index).channels())),
        }
    }

    fn distance(self, wanted: Self) -> f64 {
        match (self, wanted) {
            (Self::Named(shown), Self::Named(wanted)) => {
                delta(of_256(shown).channels(), of_256(wanted).channels())
            }
            (Self::Rgb(shown), Self::Rgb(wanted)) => delta(shown, wanted),
            _ if self == wanted => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// The content of a cell: the colours of its parts, two by twelve, or a character in two colours.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shown {
    Parts([Shade; 24]),
    Character(char, [Shade; 2]),
}

impl Shown {
    fn new(character: char, [text, ground]: [Shade; 2]) -> Self {
        match PARTS
            .get(&character)
            .map(|parts| parts.map(|is_text| if is_text { text } else { ground }))
        {
            Some(parts) if !parts.contains(&Shade::Own) => Self::Parts(parts),
            _ => Self::Character(character, [text, ground]),
        }
    }

    fn of(cell: &Cell) -> Self {
        Self::new(cell.symbol().chars().next().unwrap(), [cell.fg, cell.bg].map(Shade::of))
    }

    /// The largest ΔE between its colours and the wanted ones.
    fn distance(self, wanted: Self) -> f64 {
        let (shown, wanted) = match (&self, &wanted) {
            (Self::Parts(shown), Self::Parts(wanted)) => (&shown[..], &wanted[..]),
            (Self::Character(one, shown), Self::Character(other, wanted)) if one == other => {
                (&shown[..], &wanted[..])
            }
            _ => return f64::INFINITY,
        };
        let distances = shown.iter().zip(wanted).map(|(one, other)| one.distance(*other));
        distances.fold(0.0, f64::max)
    }
}

/// For each mosaic, the parts of a cell that it shows in the text's colour, row by row.
static PARTS: LazyLock<BTreeMap<char, [bool; 24]>> = LazyLock::new(|| {
    let parts = |mask: u8, rows: usize| {
        std::array::from_fn(|part| mask >> (part / 2 / (12 / rows) * 2 + part % 2) & 1 == 1)
    };
    let octants = (0..=u8::MAX).map(|mask| (Mosaic::octants(mask).character(), parts(mask, 4)));
    let sextants = (0..64).map(|mask| (Mosaic::sextants(mask).character(), parts(mask, 3)));
    octants.chain(sextants).collect()
});

/// CIE76's ΔE, by the formulas of the standard (CIE 15).
fn delta(one: Rgb, other: Rgb) -> f64 {
    let (one, other) = (lab(one), lab(other));
    one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
}

fn lab(color: Rgb) -> [f64; 3] {
    let [r, g, b] = color.map(|channel| {
        let signal = f64::from(channel) / 255.0;
        if signal <= 0.04045 { signal / 12.92 } else { ((signal + 0.055) / 1.055).powf(2.4) }
    });
    let answer = |light: f64| {
        if light > 0.008_856_451_679 { light.cbrt() } else { 7.787_037_037 * light + 4.0 / 29.0 }
    };
    let x = answer((0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b) / 0.950_47);
    let y = answer(0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b);
    let z = answer((0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b) / 1.088_83);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The error of the encoder's integers compared with the formulas.
const ROUNDING: f64 = 0.1;

/// The ways to pass pictures to the encoder.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// As changed cells from ratatui.
    Backend,
    /// As whole pictures, drawn on the encoder's own cells.
    Canvas,
}

/// Both emulators, and ratatui with this crate's backend, which writes to them.
struct Screens {
    way: Way,
    terminal: Terminal<CellWriter<Vec<u8>>>,
    one: vt100::Parser<Palette>,
    other: avt::Terminal,
    /// The kinds of all sequences that have been sent.
    sequences: BTreeSet<String>,
}

/// The defined entries of a terminal's palette.
#[derive(Debug, Default)]
struct Palette(BTreeMap<u8, Rgb>);

impl vt100::Callbacks for Palette {
    /// Handles `4;n;#rrggbb;…`. Not all terminals accept more than sixteen parameters.
    fn unhandled_osc(&mut self, _: &mut vt100::Screen, parameters: &[&[u8]]) {
        assert!(parameters.len() <= 16 && parameters[0] == b"4", "{parameters:?}");
        let (definitions, rest) = parameters[1..].as_chunks();
        assert!(rest.is_empty());
        for [entry, color] in
            definitions.iter().map(|pair| pair.map(|text| str::from_utf8(text).unwrap()))
        {
            let color = u32::from_str_radix(color.strip_prefix('#').unwrap(), 16).unwrap();
            let [_, color @ ..] = color.to_be_bytes();
            let entry = entry.parse().unwrap();
            assert!(entry >= 24, "{entry} is not ours to define");
            self.0.insert(entry, color);
        }
    }
}

/// `text` with its repetitions (REP) expanded, for an emulator that does not support them.
fn written_out(text: &str) -> String {
    let mut parts = text.split("\x1b[");
    let mut whole = parts.next().unwrap().to_owned();
    for part in parts {
        let digits = part.bytes().take_while(u8::is_ascii_digit).count();
        match part[digits..].strip_prefix('b') {
            Some(rest) => {
                let last = whole.chars().next_back().unwrap();
                let count = if digits == 0 { 1 } else { part[..digits].parse().unwrap() };
                whole.extend(std::iter::repeat_n(last, count));
                whole.push_str(rest);
            }
            None => whole.extend(["\x1b[", part]),
        }
    }
    whole
}

impl Screens {
    fn new(way: Way, size: Size, fidelity: Fidelity) -> Self {
        Self::shorter(way, size, fidelity, false)
    }

    /// Uses repetitions and a palette if `is_shorter`.
    fn shorter(way: Way, size: Size, fidelity: Fidelity, is_shorter: bool) -> Self {
        let mut writer = CellWriter::new(Vec::new(), size);
        writer.set_fidelity(fidelity);
        writer.set_repeats(is_shorter);
        writer.set_palette(is_shorter);
        let [rows, columns] = [size.height, size.width].map(|side| side.try_into().unwrap());
        Self {
            way,
            terminal: Terminal::new(writer).unwrap(),
            one: vt100::Parser::new_with_callbacks(rows, columns, 0, Palette::default()),
            other: avt::Terminal::new(size.width.into(), size.height.into()).unwrap(),
            sequences: BTreeSet::new(),
        }
    }

    fn draw(&mut self, picture: &Buffer) {
        match self.way {
            Way::Backend => {
                self.terminal.draw(|frame| frame.buffer_mut().merge(picture)).unwrap();
            }
            Way::Canvas => {
                let writer = self.terminal.backend_mut();
                writer.draw_frame(|screen| paint(picture, screen));
                writer.flush().unwrap();
            }
        }
        let bytes = std::mem::take(self.terminal.backend_mut().output_mut());
        let text = String::from_utf8(bytes).unwrap();
        self.one.process(written_out(&text).as_bytes());
        self.other.feed(text.as_str());
        self.sequences.extend(kinds(&text));
    }

    /// The content of a cell in both emulators.
    fn shown(&self, x: u16, y: u16) -> [Shown; 2] {
        let palette = self.one.callbacks();
        let cell = self.one.screen().cell(y, x).unwrap();
        let shade = |color| match color {
            vt100::Color::Rgb(red, green, blue) => Shade::Rgb([red, green, blue]),
            vt100::Color::Idx(index) => Shade::of_index(index, palette),
            vt100::Color::Default => Shade::Own,
        };
        let character = cell.contents().chars().next().unwrap_or(' ');
        let one = Shown::new(character, [cell.fgcolor(), cell.bgcolor()].map(shade));
        let cell = &self.other.screen().line(y.into()).unwrap().cells()[usize::from(x)];
        let shade = |color| match color {
            Some(avt::Color::RGB(rgb)) => Shade::Rgb([rgb.r, rgb.g, rgb.b]),
            Some(avt::Color::Indexed(index)) => Shade::of_index(index, palette),
            None => Shade::Own,
        };
        let pen = cell.pen();
        let other = Shown::new(cell.char(), [pen.foreground(), pen.background()].map(shade));
        [one, other]
    }

    /// The largest error of all cells. Both emulators must agree on each cell.
    fn largest_distance(&self, picture: &Buffer) -> f64 {
        let distances = picture.area.positions().map(|position| {
            let [one, other] = self.shown(position.x, position.y);
            assert_eq!(one, other, "at {position}");
            one.distance(Shown::of(&picture[position]))
        });
        distances.fold(0.0, f64::max)
    }
}

/// Draws `picture` row by row, with every method of a canvas.
fn paint(picture: &Buffer, canvas: &mut impl Canvas) {
    for y in picture.area.rows().map(|row| row.y) {
        let cells = picture.area.positions().filter(|place| place.y == y);
        for (x, cell) in cells.map(|place| (place.x, &picture[place])) {
            match (y % 4, cell.symbol(), cell.fg, cell.bg) {
                (0, ..) => canvas.draw_widget(One(cell), Rect::new(x, y, 1, 1)),
                (1, "▀", upper, lower) => {
                    canvas.draw_halves(x, y, std::iter::once([upper, lower]));
                }
                (2, "▀", Color::Rgb(r, g, b), Color::Rgb(red, green, blue)) => {
                    let pixels = [Pixel::new(r, g, b), Pixel::new(red, green, blue)];
                    canvas.draw_pixels(x, y, std::iter::once(pixels));
                }
                _ => {
                    let character = cell.symbol().chars().next().unwrap();
                    canvas.draw_character(x, y, character, [cell.fg, cell.bg]);
                }
            }
        }
    }
}

/// A widget with one cell.
struct One<'a>(&'a Cell);

impl Widget for One<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        buffer[area.as_position()] = self.0.clone();
    }
}

/// The private mark and the last byte of each control sequence in `text`, and each other control
/// character.
fn kinds(text: &str) -> Vec<String> {
    let mut kinds = Vec::new();
    let mut characters = text.chars();
    while let Some(character) = characters.next() {
        if character == '\x1b' {
            let start = characters.next();
            if start == Some(']') {
                let string: String =
                    characters.by_ref().take_while(|&next| next != '\x07').collect();
                kinds.push(format!("]{}", string.split(';').next().unwrap()));
                continue;
            }
            assert_eq!(start, Some('['), "an escape that starts no control sequence");
            let mut parameters = String::new();
            let last = loop {
                match characters.next().unwrap() {
                    last @ '@'..='~' => break last,
                    parameter => parameters.push(parameter),
                }
            };
            let is_private = parameters.starts_with('?');
            kinds.push(if is_private { format!("{parameters}{last}") } else { last.to_string() });
        } else if character.is_control() {
            kinds.push(format!("{character:?}"));
        }
    }
    kinds
}

/// The sequences that every terminal understands: moving the cursor to a position, within a row and
/// to the next row, erasing, deleting and inserting characters, colours, synchronized output, and
/// the cursor's visibility.
const SAFE: [&str; 15] = [
    "H", "C", "D", "'\\r'", "'\\n'", "'\\u{8}'", "J", "K", "P", "@", "m", "?2026h", "?2026l",
    "?25h", "?25l",
];

/// A colour of this depth, either from a smooth range or from noise.
fn any_color(depth: ColorDepth) -> BoxedStrategy<Color> {
    match depth {
        ColorDepth::True => prop_oneof![
            2 => (0..12_u8).prop_map(|level| Color::Rgb(90 + 4 * level, 60, 40 + level)),
            1 => any::<Rgb>().prop_map(|[red, green, blue]| Color::Rgb(red, green, blue)),
        ]
        .boxed(),
        ColorDepth::Indexed256 => {
            prop_oneof![2 => 232..=255_u8, 1 => 16..=255_u8].prop_map(Color::Indexed).boxed()
        }
        ColorDepth::Indexed16 => (0..16_u8).prop_map(Color::Indexed).boxed(),
        ColorDepth::Mono => Just(Color::Reset).boxed(),
    }
}

/// A mosaic of this glyph set.
fn any_mosaic(glyphs: GlyphSet) -> BoxedStrategy<char> {
    let mosaic = match glyphs {
        GlyphSet::Octant => Mosaic::octants,
        GlyphSet::Sextant => Mosaic::sextants,
        GlyphSet::Quadrant => Mosaic::quadrants,
        _ => return Just('▀').boxed(),
    };
    // There are only a few shapes, so that they coincide in places.
    prop::sample::select(vec![1, 3, 5, 6, 15, 21, 28, 63, 90, 128, 254])
        .prop_map(move |mask| mosaic(mask).character())
        .boxed()
}

/// A picture of blocks and some text, or of text alone.
fn any_picture(
    size: Size,
    depth: ColorDepth,
    glyphs: GlyphSet,
    is_text: bool,
) -> impl Strategy<Value = Buffer> {
    let symbol = prop_oneof![
        if is_text { 0 } else { 9 } => any_mosaic(glyphs),
        1 => prop::sample::select(vec![' ', '.', 'a', '#', 'é']),
    ];
    let ground = match (is_text, depth) {
        (false, _) | (_, ColorDepth::Mono) => any_color(depth),
        (_, ColorDepth::True) => Just(Color::Rgb(0, 0, 0)).boxed(),
        (_, ColorDepth::Indexed256) => Just(Color::Indexed(16)).boxed(),
        (_, ColorDepth::Indexed16) => Just(Color::Indexed(0)).boxed(),
    };
    let cell = (symbol, any_color(depth), ground).prop_map(|(symbol, text, ground)| {
        let mut cell = Cell::EMPTY;
        cell.set_char(symbol).set_fg(text).set_bg(ground);
        cell
    });
    prop::collection::vec(cell, usize::from(size.width) * usize::from(size.height))
        .prop_map(move |content| Buffer { area: Rect::from(size), content })
}

fn block([r, g, b]: Rgb, lower: Rgb) -> Cell {
    let mut cell = Cell::new("▀");
    cell.set_fg(Color::Rgb(r, g, b)).set_bg(Color::Rgb(lower[0], lower[1], lower[2]));
    cell
}

/// A picture whose rows move from frame to frame.
fn any_history() -> impl Strategy<Value = Vec<Buffer>> {
    let size = (1..50_u16, 1..7_u16).prop_map(Size::from);
    let depth = prop::sample::select(vec![
        ColorDepth::True,
        ColorDepth::True,
        ColorDepth::Indexed256,
        ColorDepth::Indexed16,
        ColorDepth::Mono,
    ]);
    let glyphs = prop::sample::select(vec![
        GlyphSet::Half,
        GlyphSet::Quadrant,
        GlyphSet::Sextant,
        GlyphSet::Octant,
    ]);
    (size, depth, glyphs, any::<bool>())
        .prop_flat_map(|(size, depth, glyphs, is_text)| {
            let moves = prop::collection::vec((any::<u16>(), 0..6_usize, any::<bool>()), 1..6);
            let pictures = any_picture(size, depth, glyphs, is_text);
            (prop::collection::vec(pictures, 1..3), moves)
        })
        .prop_map(|(mut pictures, moves)| {
            let mut picture = pictures[0].clone();
            let width = usize::from(picture.area.width);
            for (row, by, is_left) in moves {
                let rows = picture.content.chunks_mut(width);
                let row = usize::from(row) % rows.len();
                let row = &mut picture.content[row * width..][..width];
                let by = by.min(width);
                if is_left {
                    row.rotate_left(by);
                } else {
                    row.rotate_right(by);
                }
                pictures.push(picture.clone());
            }
            pictures
        })
}

proptest! {
    #[test]
    fn every_picture_is_shown_within_the_stated_distance(
        history in any_history(),
        tolerance in prop_oneof![Just(0_u8), 1..60_u8, any::<u8>()],
        way in prop::sample::select(vec![Way::Backend, Way::Canvas]),
        is_shorter: bool,
        is_greedy: bool,
    ) {
        let size = history[0].area.as_size();
        let mut screens = Screens::shorter(way, size, Fidelity::new(tolerance), is_shorter);
        if is_greedy {
            screens.terminal.backend_mut().set_effort(Effort::Greedy);
        }
        for picture in &history {
            screens.draw(picture);
            let distance = screens.largest_distance(picture);
            let stated = if tolerance == 0 { 0.0 } else { f64::from(tolerance) + ROUNDING };
            prop_assert!(distance <= stated, "{} at {}", distance, tolerance);
        }
        // A still picture becomes exact.
        let last = history.last().unwrap();
        for _ in 0..10 {
            screens.draw(last);
        }
        prop_assert_eq!(screens.largest_distance(last), 0.0);
        prop_assert!(screens.terminal.backend().is_settled());
        for kind in &screens.sequences {
            let is_safe = SAFE.contains(&kind.as_str());
            prop_assert!(is_safe || is_shorter && ["b", "]4"].contains(&kind.as_str()), "{}", kind);
        }
    }
}

#[test]
fn a_resting_picture_becomes_exact_in_frames_of_similar_size() {
    let size = Size::new(80, 24);
    let mut screens = Screens::new(Way::Backend, size, Fidelity::LOW);
    // The two gradients differ by less than the tolerance, so nothing is sent for the second one.
    let gradient = |offset: u16| {
        let cells = (0..size.width * size.height).map(|index| {
            let value = (index % size.width + offset) as u8;
            block([value, 100, value], [value, 90, value])
        });
        Buffer { area: Rect::from(size), content: cells.collect() }
    };
    screens.draw(&gradient(0));
    screens.draw(&gradient(1));
    let mut sizes = Vec::new();
    while !screens.terminal.backend().is_settled() {
        let before = screens.terminal.backend().bytes_written();
        screens.draw(&gradient(1));
        sizes.push(screens.terminal.backend().bytes_written() - before);
    }
    assert_eq!(sizes.len(), 10, "{sizes:?}");
    let (least, most) = (sizes.iter().min().unwrap(), sizes.iter().max().unwrap());
    assert!(*most < 2 * least, "{sizes:?}");
    let cells = u64::from(size.width) * u64::from(size.height);
    assert!(*most < cells / 10 * MAX_CELL_BYTES, "{sizes:?}");
}

/// The bytes of a cursor motion, two colours and a glyph.
const MAX_CELL_BYTES: u64 = 10 + 38 + 3;
