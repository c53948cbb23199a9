use ratatui::buffer::{Buffer, Cell};

use super::*;

fn shown(menu: &mut Menu<u8>, columns: u16, rows: u16) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
    menu.draw(&mut buffer, Rect::new(0, 0, columns, rows));
    let lines = buffer.content().chunks(columns.into());
    lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
}

fn menu() -> Menu<u8> {
    let menu = Menu::new("fruit").line("Choose one of these.");
    (0..6).fold(menu, |menu, index| {
        menu.entry_with(format!("fruit {index}"), format!("{}", index * 7), index)
    })
}

fn select(menu: &mut Menu<u8>, key: Key) {
    menu.selected = menu.selected_by(key, &Bindings::default()).unwrap();
}

#[test]
fn the_selected_entry_is_shown_in_any_window() {
    for (columns, rows) in [(40, 12), (30, 8), (20, 5), (12, 4), (20, 3), (3, 1), (1, 1)] {
        let mut menu = menu();
        for _ in 0..14 {
            let text = shown(&mut menu, columns, rows);
            if columns >= 20 && rows >= 3 {
                let wanted = format!("> fruit {}", menu.selected());
                assert!(text.contains(&wanted[..9]), "{columns} by {rows}:\n{text}");
            }
            select(&mut menu, Key::Down);
        }
    }
}

#[test]
fn text_is_cut_before_entries() {
    let mut menu = menu();
    insta::assert_snapshot!(shown(&mut menu, 24, 10), @r"
    ┌fruit─────────────────┐
    │ Choose one of these. │
    │                      │
    │ > fruit 0          0 │
    │   fruit 1          7 │
    │   fruit 2         14 │
    │   fruit 3         21 │
    │   fruit 4         28 │
    │   fruit 5         35 │
    └──────────────────────┘
    ");
    assert!(!shown(&mut menu, 28, 8).contains("Choose"));
}

#[test]
fn the_selection_wraps_and_digits_select() {
    let mut menu = menu();
    select(&mut menu, Key::Up);
    assert_eq!(menu.choice(), Some(5));
    select(&mut menu, Key::Down);
    assert_eq!(menu.choice(), Some(0));
    let chosen = |digit| menu.chosen_by(Key::Char(digit));
    assert_eq!(['3', '6', '7', '0'].map(chosen), [Some(2), Some(5), None, None]);
    let mut empty: Menu<u8> = Menu::new("nothing");
    for key in [Key::Down, Key::Up, Key::PageUp, Key::PageDown, Key::Home, Key::End] {
        select(&mut empty, key);
    }
    assert_eq!(empty.choice(), None);
    shown(&mut empty, 20, 5);
}

fn shown_help(columns: u16, rows: u16, help: &mut HelpScroll) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
    let note = "256 colours: your terminal did not offer more; see docs/terminals.md".to_owned();
    let notes = [note].into_iter();
    let keys = (&[][..], &Bindings::default());
    help.draw(&mut buffer, Rect::new(0, 0, columns, rows), keys, notes);
    let lines = buffer.content().chunks(columns.into());
    lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
}

fn shows_words(seen: &str, line: &str) -> bool {
    line.split_whitespace().all(|word| seen.contains(word))
}

#[test]
fn every_line_can_be_reached_in_any_window() {
    for (columns, rows) in [(80, 23), (32, 24), (64, 13), (200, 60), (60, 9), (20, 5)] {
        let mut help = HelpScroll::default();
        let mut seen = String::new();
        loop {
            let text = shown_help(columns, rows, &mut help);
            assert!(text.contains("? closes"), "{columns} by {rows}:\n{text}");
            seen.extend(text.chars().filter(|letter| !letter.is_whitespace() && *letter != '│'));
            if help.first >= help.last() {
                break;
            }
            help.first += help.page;
        }
        // Words longer than a line are broken.
        let most = usize::from(columns - BORDERS - PADDING);
        let shows = |text: &str| wrapped(text, most).iter().all(|line| shows_words(&seen, line));
        for (_, does) in described(&Bindings::default()) {
            assert!(shows(does), "{does}, {columns} by {rows}:\n{seen:?}");
        }
        assert!(shows("did not offer more; see docs/terminals.md"), "{columns} by {rows}");
    }
}

#[test]
fn help_that_fits_does_not_scroll() {
    let mut help = HelpScroll::default();
    let text = shown_help(80, 24, &mut help);
    assert_eq!(help.last(), 0, "{text}");
    assert!(!text.contains(" of "), "{text}");
}

#[test]
fn lines_are_filled_to_the_width() {
    for (text, width, lines) in [
        ("", 5, &[""][..]),
        ("one two three", 7, &["one two", "three"]),
        ("one two three", 13, &["one two three"]),
        ("abcdefgh i", 3, &["abc", "def", "gh", "i"]),
        ("ä ö", 1, &["ä", "ö"]),
    ] {
        assert_eq!(wrapped(text, width), lines, "{text} in {width}");
    }
}
