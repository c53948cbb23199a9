mod support;

use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::{Backend, ClearType};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier};
use ratatui::widgets::Widget;

use self::support::{
    Screen, any_buffer, any_pixels, any_size, assert_shown, bytes_of, colored, draw, length,
    readable, terminal, tidy_wide_symbols,
};
use super::*;
use crate::tui::canvas::Canvas;

#[test]
fn a_block_that_saves_a_colour_change_is_chosen() {
    let [a, b] = [Color::Rgb(1, 2, 3), Color::Rgb(4, 5, 6)];
    let cells = [colored("▀", a, b), colored("▄", a, b), colored("█", a, b), colored(" ", a, a)];
    insta::assert_snapshot!(readable(&cells));
}

proptest! {
    #[test]
    fn a_terminal_shows_the_drawn_cells_after_any_history(
        (size, history) in any_size()
            .prop_flat_map(|size| (Just(size), prop::collection::vec(any_buffer(size), 1..6)))
    ) {
        let (mut terminal, screen) = terminal(size);
        for content in &history {
            draw(&mut terminal, content);
            assert_shown(&screen, content);
        }
        prop_assert!(screen.writes() <= history.len());
        prop_assert_eq!(terminal.backend().bytes_written(), screen.take_text().len() as u64);
    }

    #[test]
    fn an_unchanged_frame_writes_nothing(
        content in any_size().prop_flat_map(any_buffer)
    ) {
        let (mut terminal, screen) = terminal(content.area.as_size());
        draw(&mut terminal, &content);
        let writes = screen.writes();
        draw(&mut terminal, &content);
        prop_assert_eq!(screen.writes(), writes);
    }

    #[test]
    fn a_resized_window_is_redrawn(
        before in any_size().prop_flat_map(any_buffer),
        after in any_size().prop_flat_map(any_buffer),
    ) {
        let (mut terminal, screen) = terminal(before.area.as_size());
        draw(&mut terminal, &before);
        screen.resize(after.area.as_size());
        terminal.backend_mut().set_size(after.area.as_size());
        draw(&mut terminal, &after);
        assert_shown(&screen, &after);
    }
}

#[test]
fn only_differences_from_the_previous_cell_are_sent() {
    let (red, blue) = (Color::Rgb(200, 0, 0), Color::Rgb(0, 0, 200));
    let row = [
        colored("o", red, blue),
        colored("o", red, blue),
        colored("o", red, red),
        colored("o", blue, red),
        colored("o", Color::Red, Color::White),
        colored("o", Color::Indexed(100), Color::White),
        Cell::EMPTY,
        colored("x", Color::Reset, Color::Reset),
    ];
    insta::assert_snapshot!(readable(&row), @r"
    ESC[?2026h
    ESC[1H
    ESC[m
    ESC[38;2;200;0;0;48;2;0;0;200moo
    ESC[48;2;200;0;0mo
    ESC[38;2;0;0;200mo
    ESC[31;107mo
    ESC[38;5;100mo
    ESC[C
    ESC[mx
    ESC[?2026l
    ");
}

#[test]
fn modifiers_are_switched_one_by_one_except_intensity() {
    let with = |modifier: Modifier| {
        let mut cell = Cell::new("x");
        cell.modifier = modifier;
        cell
    };
    let row = [
        with(Modifier::BOLD | Modifier::DIM | Modifier::REVERSED),
        with(Modifier::DIM | Modifier::REVERSED),
        with(Modifier::DIM | Modifier::CROSSED_OUT),
        with(Modifier::empty()),
    ];
    insta::assert_snapshot!(readable(&row), @r"
    ESC[?2026h
    ESC[1H
    ESC[m
    ESC[1;2;7mx
    ESC[22;2mx
    ESC[27mx
    ESC[mx
    ESC[?2026l
    ");
}

#[test]
fn control_characters_in_a_cell_never_reach_the_terminal() {
    let bytes = bytes_of(&[colored("\x1b]0;mine\x07", Color::Red, Color::Reset)]);
    assert!(!bytes.contains("mine"), "{bytes:?}");
}

#[test]
fn the_cursor_is_shown_where_a_frame_puts_it_and_hidden_again() {
    let (mut terminal, screen) = terminal(Size::new(10, 4));
    let hidden = |screen: &Screen| screen.0.borrow().parser.screen().hide_cursor();
    terminal.draw(|frame| frame.set_cursor_position((3, 2))).unwrap();
    assert!(!hidden(&screen));
    assert_eq!(screen.0.borrow().parser.screen().cursor_position(), (2, 3));
    terminal.draw(|_| ()).unwrap();
    assert!(hidden(&screen));
}

/// A glyph without an id is still shown, however it is drawn.
#[test]
fn glyphs_without_ids_are_shown() {
    let intensities = [Modifier::empty(), Modifier::BOLD, Modifier::DIM];
    let others = [Modifier::empty(), Modifier::ITALIC, Modifier::UNDERLINED, Modifier::REVERSED];
    let modifiers = intensities.map(|one| others.map(|other| one | other));
    let letters = ('\u{100}'..).flat_map(|letter| {
        modifiers.as_flattened().iter().map(move |&modifier| {
            let mut cell = Cell::new("");
            cell.set_char(letter).modifier = modifier;
            cell
        })
    });
    let size = Size::new(64, 64);
    let (mut terminal, screen) = terminal(size);
    let mut buffer = Buffer::empty(size.into());
    buffer.content = letters.take(64 * 64).collect();
    for _ in 0..2 {
        draw(&mut terminal, &buffer);
        assert_shown(&screen, &buffer);
        buffer.content.rotate_left(5);
    }
    let writer = terminal.backend_mut();
    writer.draw_frame(|screen| {
        screen.draw_character(1, 0, 'λ', [Color::Red, Color::White]);
        screen.draw_halves(1, 1, std::iter::once([Color::Red, Color::Reset]));
    });
    writer.flush().unwrap();
    let mut expected = Buffer::empty(size.into());
    expected[(1, 0)] = colored("λ", Color::Red, Color::White);
    expected[(1, 1)] = colored("▀", Color::Red, Color::Reset);
    assert_shown(&screen, &expected);
}

#[test]
fn an_empty_window_is_drawn_without_an_error() {
    let screen = Screen::new(Size::new(1, 1));
    let mut terminal = Terminal::new(CellWriter::new(screen, Size::ZERO)).unwrap();
    terminal.draw(|_| ()).unwrap();
}

/// A blinking cell does not keep the others from becoming exact.
#[test]
fn resting_rows_become_exact_while_another_changes() {
    let size = Size::new(40, 6);
    let (mut terminal, screen) = terminal(size);
    terminal.backend_mut().set_fidelity(Fidelity::LOW);
    let picture = |offset: u16, blink: u16| {
        let cells = (0..40 * 6).map(|place: u16| {
            let value = (place % 40 + offset + if place == 5 { 100 * blink } else { 0 }) as u8;
            colored("▀", Color::Rgb(value, 100, value), Color::Rgb(value, 90, value))
        });
        Buffer { area: Rect::from(size), content: cells.collect() }
    };
    draw(&mut terminal, &picture(0, 0));
    for frame in 0..25 {
        draw(&mut terminal, &picture(1, frame % 2));
    }
    let expected = picture(1, 0);
    let shown = screen.0.borrow();
    for y in 1..6 {
        for x in 0..40 {
            let cell = shown.parser.screen().cell(y, x).unwrap();
            let Color::Rgb(red, green, blue) = expected[(x, y)].fg else { unreachable!() };
            let upper = if cell.contents() == "▄" { cell.bgcolor() } else { cell.fgcolor() };
            assert_eq!(upper, vt100::Color::Rgb(red, green, blue), "at {x}, {y}");
        }
    }
}

/// A widget that is a picture.
struct Picture<'a>(&'a Buffer);

impl Widget for Picture<'_> {
    fn render(self, _: Rect, buffer: &mut Buffer) {
        buffer.merge(self.0);
    }
}

fn row(text: &str) -> Buffer {
    let mut row = Buffer::empty(Rect::new(0, 0, 6, 1));
    row.set_string(0, 0, text, ratatui::style::Style::default());
    row
}

/// Asserts that a terminal shows each picture of `history` after the ones before, whether it is drawn
/// through ratatui's buffers or on the encoder's screen.
fn assert_shown_in_turn(history: &[Buffer]) {
    let size = history[0].area.as_size();
    let (mut by_ratatui, shown) = terminal(size);
    let on_screen = Screen::new(size);
    let mut writer = CellWriter::new(on_screen.clone(), size);
    for picture in history {
        draw(&mut by_ratatui, picture);
        assert_shown(&shown, picture);
        writer.draw_frame(|screen| screen.draw_widget(Picture(picture), screen.bounds()));
        writer.flush().unwrap();
        assert_shown(&on_screen, picture);
    }
}

#[test]
fn a_covered_wide_character_does_not_return() {
    assert_shown_in_turn(&[row(" 語  z"), row("字  z"), row("a   z"), row("    z")]);
    assert_shown_in_turn(&[row("語語語"), row(" 語語"), row("  語"), row("   a"), row("語語語")]);
}

proptest! {
    #[test]
    fn wide_characters_come_and_go(
        history in prop::collection::vec(
            prop::collection::vec(prop::sample::select(vec![" ", " ", "a", "字", "語"]), 12),
            2..8,
        ),
        ground in prop::sample::select(vec![Color::Reset, Color::White]),
    ) {
        let pictures = history.into_iter().map(|symbols| {
            let mut picture = Buffer::empty(Rect::new(0, 0, 6, 2));
            for (cell, symbol) in picture.content.iter_mut().zip(symbols) {
                cell.set_symbol(symbol);
                if symbol != " " {
                    cell.set_bg(ground);
                }
            }
            tidy_wide_symbols(&mut picture);
            picture
        });
        assert_shown_in_turn(&pictures.collect::<Vec<_>>());
    }
}

/// Texts that a terminal would obey, or would not show in a cell of their own.
const UNFIT: [&str; 10] = [
    "\t",
    "\x1b",
    "\x7f",
    "\u{85}",
    "\u{9b}",
    "\x1b[31m",
    "\x1b]0;mine\x07",
    "\u{301}",
    "\u{200b}",
    "",
];

#[test]
fn text_unfit_for_a_cell_becomes_a_space() {
    for unfit in UNFIT {
        let size = Size::new(6, 1);
        let cells = [
            colored("a", Color::Red, Color::White),
            Cell::EMPTY,
            colored("b", Color::Red, Color::Reset),
        ];
        let mut expected = Buffer::empty(size.into());
        expected.content[..3].clone_from_slice(&cells);
        let mut picture = expected.clone();
        picture[(1, 0)].set_symbol(unfit);
        let screen = Screen::new(size);
        let mut writer = CellWriter::new(screen.clone(), size);
        let positions = picture.area.positions().map(|at| (at.x, at.y));
        writer.draw(positions.zip(&picture.content).map(|((x, y), cell)| (x, y, cell))).unwrap();
        writer.flush().unwrap();
        assert_shown(&screen, &expected);
        writer.draw_frame(|screen| screen.draw_widget("xxxxxx", screen.bounds()));
        writer.flush().unwrap();
        writer.draw_frame(|screen| screen.draw_widget(Picture(&picture), screen.bounds()));
        writer.flush().unwrap();
        assert_shown(&screen, &expected);
    }
}

#[test]
fn any_character_can_be_drawn_alone() {
    let size = Size::new(6, 1);
    for (character, expected) in [
        ('\t', "a zzzz"),
        ('\u{9b}', "a zzzz"),
        ('\u{301}', "a zzzz"),
        ('字', "a字zzz"),
        ('é', "aézzzz"),
    ] {
        let screen = Screen::new(size);
        let mut writer = CellWriter::new(screen.clone(), size);
        for _ in 0..2 {
            writer.draw_frame(|screen| {
                screen.draw_widget("azzzzz", screen.bounds());
                screen.draw_character(1, 0, character, [Color::Reset; 2]);
            });
            writer.flush().unwrap();
        }
        assert_shown(&screen, &row(expected));
    }
}

/// Terminals that shape Arabic show two letters in one cell, and others give one letter two cells.
#[test]
fn a_disputed_width_moves_no_other_cell() {
    let size = Size::new(20, 1);
    let mut sent = Vec::new();
    let mut writer = CellWriter::new(&mut sent, size);
    writer.draw_frame(|screen| screen.draw_widget("say: سلام שלום | end", screen.bounds()));
    writer.flush().unwrap();
    drop(writer);
    let sent = String::from_utf8(sent).unwrap();
    let is_disputed = |it: char| ('\u{590}'..'\u{700}').contains(&it);
    assert!(sent.contains(is_disputed));
    for width in 0..=2 {
        let seen: String = sent
            .chars()
            .map(|it| if is_disputed(it) { "x".repeat(width) } else { it.to_string() })
            .collect();
        let mut terminal = vt100::Parser::new(length(1), length(20), 0);
        terminal.process(seen.as_bytes());
        let row = terminal.screen().contents();
        let (start, end) = (row.get(..5), row.get(row.len() - 5..));
        assert_eq!((start, end), (Some("say: "), Some("| end")), "{width}: {row:?}");
        assert_eq!(row.chars().count(), 20, "{width}: {row:?}");
    }
}

#[test]
fn a_wide_character_in_the_last_column_becomes_a_space() {
    let size = Size::new(6, 2);
    let screen = Screen::new(size);
    let mut writer = CellWriter::new(screen.clone(), size);
    for character in ['x', '字', 'y', '字'] {
        writer.draw_frame(|screen| screen.draw_character(5, 0, character, [Color::Red; 2]));
        writer.flush().unwrap();
        let mut expected = Buffer::empty(size.into());
        let symbol = if character == '字' { ' ' } else { character };
        expected[(5, 0)].set_char(symbol).set_fg(Color::Red).set_bg(Color::Red);
        assert_shown(&screen, &expected);
    }
}

/// Glyphs without an id are intricate, and so are their substitutes.
#[test]
fn substitutes_in_ascii_are_shown_even_without_ids() {
    let size = Size::new(64, 64);
    let screen = Screen::new(size);
    let mut writer = CellWriter::new(screen.clone(), size);
    writer.draw_frame(|screen| {
        let places = (0..64_u16).flat_map(|y| (0..64).map(move |x| (x, y)));
        for ((x, y), letter) in places.zip('\u{10000}'..) {
            screen.draw_character(x, y, letter, [Color::Reset; 2]);
        }
    });
    writer.flush().unwrap();
    writer.set_ascii(true);
    let unfit: Vec<_> = UNFIT.into_iter().chain(["字", "é", "x"]).collect();
    for _ in 0..2 {
        writer.draw_frame(|screen| {
            for (x, symbol) in (0..).zip(&unfit) {
                let mut cell = Buffer::empty(Rect::new(x, 0, 1, 1));
                cell.content[0].set_symbol(symbol);
                screen.draw_widget(Picture(&cell), cell.area);
                let character = symbol.chars().next().unwrap_or(' ');
                screen.draw_character(x, 1, character, [Color::Red; 2]);
            }
        });
        writer.flush().unwrap();
    }
    let mut expected = Buffer::empty(size.into());
    for x in 0..unfit.len() as u16 {
        let symbol = if x == 12 {
            "x"
        } else if x == 9 {
            " "
        } else {
            "?"
        };
        expected[(x, 0)].set_symbol(symbol);
        expected[(x, 1)].set_symbol(symbol).set_fg(Color::Red).set_bg(Color::Red);
    }
    assert_shown(&screen, &expected);
}

const SIZE: Size = Size::new(6, 4);

fn writer(size: Size) -> (CellWriter<Screen>, Screen) {
    let screen = Screen::new(size);
    (CellWriter::new(screen.clone(), size), screen)
}

fn draw_cells(writer: &mut CellWriter<Screen>, picture: &Buffer) {
    let positions = picture.area.positions().map(|at| (at.x, at.y));
    writer.draw(positions.zip(&picture.content).map(|((x, y), cell)| (x, y, cell))).unwrap();
    writer.flush().unwrap();
}

/// Erases `region` of a picture, whose cells are in reading order.
fn erase(picture: &mut Buffer, region: ClearType, cursor: Position) {
    let width = usize::from(picture.area.width);
    let line = usize::from(cursor.y) * width;
    let at = line + usize::from(cursor.x);
    let cells = match region {
        ClearType::All => &mut picture.content[..],
        ClearType::AfterCursor => &mut picture.content[at..],
        ClearType::BeforeCursor => &mut picture.content[..=at],
        ClearType::CurrentLine => &mut picture.content[line..line + width],
        ClearType::UntilNewLine => &mut picture.content[at..line + width],
    };
    cells.fill(Cell::EMPTY);
}

proptest! {
    #[test]
    fn an_erased_region_is_known_to_be_blank(
        pictures in prop::collection::vec(any_pixels(24), 2),
        // Some places are off the screen. A terminal uses the nearest cell instead.
        place in (0..9_u16, 0..6_u16),
        moves: bool,
        region in prop::sample::select(vec![
            ClearType::All,
            ClearType::AfterCursor,
            ClearType::BeforeCursor,
            ClearType::CurrentLine,
            ClearType::UntilNewLine,
        ]),
    ) {
        let [before, after] = [0, 1].map(|index| {
            Buffer { area: SIZE.into(), content: pictures[index].clone() }
        });
        let (mut writer, screen) = writer(SIZE);
        draw_cells(&mut writer, &before);
        if moves {
            writer.set_cursor_position(place).unwrap();
        }
        let cursor = writer.get_cursor_position().unwrap();
        prop_assert!(!moves || cursor == Position::new(place.0.min(5), place.1.min(3)));
        writer.clear_region(region).unwrap();
        writer.flush().unwrap();
        let mut erased = before;
        erase(&mut erased, region, cursor);
        assert_shown(&screen, &erased);
        draw_cells(&mut writer, &after);
        assert_shown(&screen, &after);
    }

    #[test]
    fn the_cursor_is_placed_correctly_in_a_resized_window(
        sizes in prop::collection::vec((1..12_u16, 1..8_u16), 2..5),
        cells in any_pixels(96),
        place in (0..12_u16, 0..8_u16),
    ) {
        let size = |(width, height)| Size::new(width, height);
        let (mut writer, screen) = writer(size(sizes[0]));
        for &next in &sizes {
            screen.resize(size(next));
            writer.set_size(size(next));
            writer.set_cursor_position(place).unwrap();
            writer.flush().unwrap();
            let expected = (place.1.min(next.1 - 1), place.0.min(next.0 - 1));
            prop_assert_eq!(screen.0.borrow().parser.screen().cursor_position(), expected);
            writer.clear().unwrap();
            let content = cells[..usize::from(next.0 * next.1)].to_vec();
            let picture = Buffer { area: size(next).into(), content };
            draw_cells(&mut writer, &picture);
            assert_shown(&screen, &picture);
        }
    }
}

#[test]
fn half_of_a_wide_character_may_be_erased() {
    for (column, region) in [(1, ClearType::UntilNewLine), (0, ClearType::BeforeCursor)] {
        let (mut writer, screen) = writer(SIZE);
        let mut picture = Buffer::empty(SIZE.into());
        picture.set_string(0, 1, "字b", ratatui::style::Style::default());
        draw_cells(&mut writer, &picture);
        writer.set_cursor_position((column, 1)).unwrap();
        writer.clear_region(region).unwrap();
        let mut after = Buffer::empty(SIZE.into());
        after.set_string(0, 1, "x字", ratatui::style::Style::default());
        draw_cells(&mut writer, &after);
        assert_shown(&screen, &after);
        draw_cells(&mut writer, &picture);
        assert_shown(&screen, &picture);
    }
}
