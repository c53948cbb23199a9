mod erasing;
mod support;
mod symbols;

use proptest::prelude::*;
use ratatui::Terminal;
use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};

use self::support::{
    Screen, any_buffer, any_pixels, any_size, assert_shown, bytes_of, colored, draw, readable,
    terminal,
};
use super::*;
use crate::tui::canvas::Canvas;

#[test]
fn a_block_that_spares_a_colour_is_taken() {
    let [a, b] = [Color::Rgb(1, 2, 3), Color::Rgb(4, 5, 6)];
    let cells = [colored("▀", a, b), colored("▄", a, b), colored("█", a, b), colored(" ", a, a)];
    insta::assert_snapshot!(readable(&cells));
}

proptest! {
    #[test]
    fn pixels_look_the_same_with_any_glyphs(cells in any_pixels(24)) {
        let size = Size::new(6, 4);
        let (mut terminal, screen) = terminal(size);
        let content = Buffer { area: Rect::from(size), content: cells };
        draw(&mut terminal, &content);
        assert_shown(&screen, &content);
    }

    /// A picture that turns: stretches of rows move by some columns from frame to frame.
    #[test]
    fn cells_that_move_sideways_are_right(
        cells in any_pixels(160),
        moves in prop::collection::vec((0..4_usize, 0..40_usize, 0..40_usize, 0..9_usize), 1..8),
    ) {
        let size = Size::new(40, 4);
        let (mut terminal, screen) = terminal(size);
        let mut content = Buffer { area: Rect::from(size), content: cells };
        draw(&mut terminal, &content);
        for (row, one, other, by) in moves {
            let stretch = 40 * row + one.min(other)..40 * row + one.max(other) + 1;
            let stretch = &mut content.content[stretch];
            let count = stretch.len();
            stretch.rotate_left(by % count);
            draw(&mut terminal, &content);
            assert_shown(&screen, &content);
        }
    }

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
    fn a_frame_without_a_change_writes_nothing(
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

proptest! {
    #[test]
    fn a_resting_picture_is_exact_within_ten_frames(
        history in prop::collection::vec(any_pixels(24), 1..4),
        tolerance: u8,
    ) {
        let size = Size::new(6, 4);
        let (mut terminal, screen) = terminal(size);
        terminal.backend_mut().set_fidelity(Fidelity::new(tolerance));
        let pictures = history.into_iter().map(|content| Buffer { area: Rect::from(size), content });
        let pictures: Vec<_> = pictures.collect();
        for content in &pictures {
            draw(&mut terminal, content);
        }
        let last = pictures.last().unwrap();
        for _ in 0..10 {
            draw(&mut terminal, last);
        }
        assert_shown(&screen, last);
        prop_assert!(terminal.backend().is_settled());
        let writes = screen.writes();
        draw(&mut terminal, last);
        prop_assert_eq!(screen.writes(), writes);
    }
}

#[test]
fn only_differences_from_the_cell_before_are_sent() {
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
fn control_characters_in_a_cell_reach_no_terminal() {
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

/// A glyph without an id is shown nevertheless, however it is drawn.
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
fn a_window_of_no_size_is_drawn_without_an_error() {
    let screen = Screen::new(Size::new(1, 1));
    let mut terminal = Terminal::new(CellWriter::new(screen, Size::ZERO)).unwrap();
    terminal.draw(|_| ()).unwrap();
}

/// A blinking cell does not keep the others from becoming exact.
#[test]
fn rows_that_rest_become_exact_while_another_changes() {
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
