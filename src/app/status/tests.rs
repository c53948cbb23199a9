use ratatui::buffer::Cell;

use super::*;

fn line(parts: &[(Part, &str, &str)]) -> StatusLine {
    let mut line = StatusLine::default();
    for &(part, short, long) in parts {
        line.texts[part as usize] = [short.to_owned(), long.to_owned()];
    }
    line
}

fn shown(line: &StatusLine, columns: u16) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, 1));
    line.render(buffer.area, &mut buffer);
    buffer.content().iter().map(Cell::symbol).collect()
}

#[test]
fn less_important_parts_are_left_out() {
    let line = line(&[
        (Part::Title, "The Museum of Walls", "The Museum of Walls"),
        (Part::Level, "2/5", "level 2 of 5"),
        (Part::Keys, "brass key", "brass key"),
        (Part::Time, "1:05", "1:05"),
        (Part::Help, "?", "? help"),
    ]);
    let expected = [
        " The Museum of Walls  level 2 of 5  brass key         1:05  ? help ",
        " The Museum of Walls  2/5  brass key   1:05  ? help ",
        " The Museum of Walls  brass key  ? help ",
        " The Museum of Walls  ? ",
        " The Museum of Wa  ? ",
        "  ? ",
    ];
    for expected in expected {
        assert_eq!(shown(&line, expected.len() as u16).trim_end(), expected.trim_end());
    }
}

#[test]
fn the_goal_is_more_important_than_the_title() {
    let line = line(&[
        (Part::Title, "Cellar", "Cellar"),
        (Part::Notice, "Find the exit", "Find the way out: green on the map"),
        (Part::Time, "0:00", "0:00"),
        (Part::Help, "?", "? help"),
    ]);
    for expected in [
        " Cellar  Find the way out: green on the map  0:00  ? help ",
        " Cellar  Find the exit  0:00  ? help ",
        " Find the exit   ? ",
    ] {
        assert_eq!(shown(&line, expected.len() as u16), expected);
    }
}

#[test]
fn stats_have_room_in_80_columns() {
    let stats = "30 fps  272 kB/s  0 ms  fidelity exact";
    let line = line(&[
        (Part::Title, "The Museum of Walls", "The Museum of Walls"),
        (Part::Level, "2/5", "level 2 of 5"),
        (Part::Notice, "Find the exit", "Find the way out: green on the map"),
        (Part::Stats, stats, stats),
        (Part::Time, "0:02", "0:02"),
        (Part::Help, "?", "? help"),
    ]);
    let expected = format!(" The Museum of Walls  Find the exit {stats}  ? ");
    assert_eq!(shown(&line, 80).replace("   ", " "), expected);
}

#[test]
fn stats_take_no_room_from_the_player() {
    let line = line(&[
        (Part::Health, "♥♥♥♥♡♡", "♥♥♥♥♡♡"),
        (Part::Alarm, "ALARM", "ALARM: warden"),
        (Part::Light, "dark", "dark"),
        (Part::Supplies, "2p 1d", "2 pebbles, 1 dart"),
        (Part::Title, "The Museum of Walls", "The Museum of Walls"),
        (Part::Modes, "running, lamp", "running, lamp"),
        (Part::Keys, "iron key", "iron key"),
        (Part::Stats, "30 fps  272 kB/s", "30 fps  272 kB/s  104 ms  fidelity exact"),
        (Part::Time, "0:02", "0:02"),
        (Part::Help, "?", "? help"),
    ]);
    let state = " ♥♥♥♥♡♡  ALARM  dark  2p 1d  running, lamp  iron key";
    for (columns, right) in [
        (100, "30 fps  272 kB/s  104 ms  fidelity exact  ? "),
        (80, "30 fps  272 kB/s  ? "),
        (60, "? "),
    ] {
        let shown = shown(&line, columns).replace("? help ", "? ");
        assert!(shown.starts_with(state) && shown.ends_with(right), "{columns}: {shown}");
    }
}

#[test]
fn any_width_is_possible() {
    let line = line(&[(Part::Title, "Cellar", "Cellar"), (Part::Help, "?", "? help")]);
    for columns in 0..10 {
        shown(&line, columns);
    }
}
