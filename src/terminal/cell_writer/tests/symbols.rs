//! Cells whose text is wider than a cell, has no width, or contains control characters.

use proptest::prelude::*;
use ratatui::backend::Backend;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::Widget;

use super::super::CellWriter;
use super::support::{self, assert_shown, colored, terminal, tidy_wide_symbols};
use crate::tui::canvas::Canvas;

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
    let on_screen = support::Screen::new(size);
    let mut writer = CellWriter::new(on_screen.clone(), size);
    for picture in history {
        support::draw(&mut by_ratatui, picture);
        assert_shown(&shown, picture);
        writer.draw_frame(|screen| screen.draw_widget(Picture(picture), screen.bounds()));
        writer.flush().unwrap();
        assert_shown(&on_screen, picture);
    }
}

#[test]
fn a_wide_character_that_was_covered_does_not_return() {
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
fn a_text_that_is_unfit_for_a_cell_is_a_space() {
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
        let screen = support::Screen::new(size);
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
        let screen = support::Screen::new(size);
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
fn a_width_that_terminals_dispute_moves_no_other_cell() {
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
        let mut terminal = vt100::Parser::new(support::length(1), support::length(20), 0);
        terminal.process(seen.as_bytes());
        let row = terminal.screen().contents();
        let (start, end) = (row.get(..5), row.get(row.len() - 5..));
        assert_eq!((start, end), (Some("say: "), Some("| end")), "{width}: {row:?}");
        assert_eq!(row.chars().count(), 20, "{width}: {row:?}");
    }
}

#[test]
fn a_wide_character_in_the_last_column_is_a_space() {
    let size = Size::new(6, 2);
    let screen = support::Screen::new(size);
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
    let screen = support::Screen::new(size);
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
