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
fn stats_fit_in_80_columns() {
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
fn stats_never_displace_the_players_state() {
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
fn any_width_can_be_drawn() {
    let line = line(&[(Part::Title, "Cellar", "Cellar"), (Part::Help, "?", "? help")]);
    for columns in 0..10 {
        shown(&line, columns);
    }
}

#[test]
fn pauses_do_not_count() {
    let mut meter = Meter::default();
    let figures: Vec<_> = (0..40_u64)
        .filter_map(|frame| {
            // Two periods of two seconds with ten frames per second, a minute apart.
            let time = frame * 100 + if frame < 20 { 1_000 } else { 61_000 };
            meter.frame(Duration::from_millis(time), frame * 500)
        })
        .collect();
    assert_eq!(figures.len(), 6);
    for Rates { frames_per_second, bytes_per_second } in figures {
        assert!((frames_per_second - 10.0).abs() < 0.1, "{frames_per_second}");
        assert!((bytes_per_second - 5000.0).abs() < 1.0, "{bytes_per_second}");
    }
}

#[test]
fn stats_are_short() {
    let rates = Rates { frames_per_second: 29.6, bytes_per_second: 118_432.0 };
    let round_trip = Some(Duration::from_micros(104_900));
    let fidelity = Fidelity::new(7);
    let stats = Stats { rates, round_trip, fidelity, wants_compression: false };
    assert_eq!(stats.to_string(), "30 fps  118 kB/s  104 ms  fidelity 7");
    let stats = Stats { round_trip: None, fidelity: Fidelity::EXACT, ..stats };
    assert_eq!(stats.to_string(), "30 fps  118 kB/s  fidelity exact");
    let stats = Stats { fidelity: Fidelity::HIGH, wants_compression: true, ..stats };
    assert!(stats.to_string().ends_with("fidelity high  (ssh -C helps)"), "{stats}");
}

#[test]
fn times_are_minutes_seconds_and_tenths() {
    assert_eq!(tenths(0.0), "0:00.0");
    assert_eq!(tenths(61.26), "1:01.2");
    assert_eq!(tenths(3600.0), "60:00.0");
}
