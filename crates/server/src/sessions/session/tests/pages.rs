//! The path from the name into a room, and back.

use super::*;
use crate::config::Config;
use crate::rooms::room::Phase;
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::session::pages::{Page, RoomTarget};
use crate::simulation::emulator::{Emulator, Modes};
use cellcaster::app::Configuration;
use cellcaster::world::Difficulty;

#[test]
fn enter_alone_leads_into_a_room() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("amber-fox", (80, 24), Speaks::Kitty);
    assert_eq!(rig.page(one), Page::Name);
    for page in [Page::Lobby, Page::Card(RoomTarget::Existing(ROOM)), Page::Room] {
        rig.press(one, ENTER);
        assert_eq!(rig.page(one), page, "{}", rig.text(one));
    }
    let before = rig.position(one);
    rig.send(one, "\x1b[119;1:1u");
    rig.pump(600);
    assert!(rig.position(one).x > before.x + 1.0, "{:?}", rig.position(one));
}

#[test]
fn a_typed_name_replaces_the_offer() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("amber-fox", (80, 24), Speaks::Plain);
    rig.press(one, "\x1b]0;evil\x07\x1b[31mMara\x1b[2J\u{9b}31m\u{202e} v");
    assert!(rig.text(one).contains("Mara31m v_"), "{}", rig.text(one));
    assert_eq!(rig.clients[one].look(|emulator| emulator.title().to_owned()), "");
    rig.press(one, "\x7f\x7f\x7f\x7f\x7f\r");
    let name = rig.session(one, |session, _| session.ui.identity.name.clone());
    assert_eq!(name, line("Mara"));
    assert_eq!(rig.page(one), Page::Lobby);
}

#[test]
fn a_refused_name_can_be_typed_again() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("g", (80, 24), Speaks::Plain);
    rig.press(one, "\x7f\r");
    assert!(rig.text(one).contains("A name must end with a letter"), "{}", rig.text(one));
    rig.press(one, "\x7f\x7f\x7f\x7f\x7f\x7fJo\r");
    assert_eq!(rig.page(one), Page::Lobby, "{}", rig.text(one));
}

#[test]
fn escape_goes_back_and_asks_before_it_leaves() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::RoomMenu);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::Room);
    rig.press(one, "q");
    rig.press(one, "q");
    assert_eq!(rig.page(one), Page::Lobby);
    assert_eq!(rig.view().members.len(), 0);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::Leaving);
    rig.press(one, "x");
    assert_eq!(rig.page(one), Page::Lobby);
    rig.press(one, "\x03");
    rig.press(one, "\x03");
    assert!(rig.is_over(one));
    let modes = rig.clients[one].look(Emulator::modes);
    assert_eq!(modes, Modes::default());
    assert!(rig.text(one).contains("Goodbye."));
}

#[test]
fn arrow_keys_never_end_a_session() {
    for speaks in [Speaks::Plain, Speaks::Kitty] {
        let mut rig = Rig::new(Mode::Roam);
        let one = rig.visitor("Mara", (80, 24), speaks);
        for _ in 0..4 {
            for arrow in ["\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D", "\x1bOA", "\x1bOB"] {
                rig.press(one, arrow);
            }
            // Half of an arrow key's sequence, and the rest after a pause.
            rig.send(one, "\x1b");
            rig.pump(20);
            rig.press(one, "[A");
            rig.press(one, "\x1b[H");
            rig.press(one, ENTER);
        }
        assert_eq!(rig.page(one), Page::Chat, "{}", rig.text(one));
    }
}

#[test]
fn an_idle_visitor_is_warned_and_disconnected() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    rig.pump(240_000);
    assert!(rig.text(one).contains("Still there?"), "{}", rig.text(one));
    rig.press(one, "\x1b[109;1:1u\x1b[109;1:3u");
    assert!(!rig.text(one).contains("Still there?"));
    rig.pump(300_000);
    assert_eq!(rig.page(one), Page::Lobby);
    assert!(
        rig.text(one).contains("You have not pressed a key for 5 minutes."),
        "{}",
        rig.text(one)
    );
    assert_eq!(rig.view().members.len(), 0);
    rig.pump(14 * 60_000);
    assert!(rig.text(one).contains("this session ends"), "{}", rig.text(one));
    rig.pump(60_000);
    assert!(rig.is_over(one));
}

#[test]
fn the_operator_sets_how_long_a_visitor_may_be_idle() {
    let mut rig = Rig::new(Mode::Roam);
    let early = rig.member("Mara", (80, 24), Speaks::Kitty);
    let (idle_room, idle_lobby) = (Duration::from_mins(30), Duration::from_mins(2));
    rig.live.replace(Config { idle_room, idle_lobby, ..Config::clone(&rig.live.get()) });
    let one = rig.member("Noor", (80, 24), Speaks::Kitty);
    rig.pump(29 * 60_000 - 1000);
    assert_eq!(rig.page(one), Page::Room);
    assert!(!rig.text(one).contains("Still there?"), "{}", rig.text(one));
    assert!(rig.is_over(early), "a session keeps the limits that it begins with");
    rig.pump(61_000);
    assert!(
        rig.text(one).contains("You have not pressed a key for 30 minutes."),
        "{}",
        rig.text(one)
    );
    rig.pump(2 * 60_000);
    assert!(rig.is_over(one));
}

#[test]
fn a_room_can_be_opened_and_watched() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.press(one, ENTER);
    rig.press(one, "2");
    assert_eq!(rig.page(one), Page::Modes, "{}", rig.text(one));
    rig.press(one, "2");
    assert_eq!(rig.page(one), Page::Levels(Mode::Tag));
    rig.press(one, ENTER);
    assert!(rig.text(one).contains("Touch anybody"), "{}", rig.text(one));
    rig.press(one, ENTER);
    assert!(rig.text(one).contains("waiting for a second player"), "{}", rig.text(one));
    let other = rig.visitor("Jon", (80, 24), Speaks::Plain);
    rig.press(other, ENTER);
    rig.press(other, ENTER);
    rig.press(other, "2");
    assert!(rig.text(other).contains("watching Mara"), "{}", rig.text(other));
    let view = rig.rooms().view(RoomId(2)).unwrap();
    assert_eq!(view.members.len(), 1);
    rig.press(other, "hello\r");
    let view = rig.rooms().view(RoomId(2)).unwrap();
    assert!(view.said.iter().all(|said| said.text != "hello"));
}

#[test]
fn excess_keys_are_dropped() {
    let mut rig = Rig::new(Mode::Roam);
    let [fast, slow] = ["Mara", "Jon"].map(|name| {
        let visitor = rig.visitor(name, (80, 24), Speaks::Plain);
        rig.press(visitor, ENTER);
        rig.press(visitor, "7");
        visitor
    });
    rig.pump(2_000);
    rig.press(fast, &"\x1b[C".repeat(1000));
    (0..KEYS_AT_ONCE as usize % 3).for_each(|_| rig.press(slow, "\x1b[C"));
    let difficulty = |rig: &Rig, index| {
        rig.session(index, |session, _| session.ui.identity.preferences.difficulty)
    };
    assert_eq!(difficulty(&rig, fast), difficulty(&rig, slow));
    for visitor in [fast, slow] {
        rig.press(visitor, "\x1b[C");
    }
    assert_eq!(difficulty(&rig, fast), difficulty(&rig, slow));
    rig.press(fast, &("w".repeat(20_000) + "\x03"));
    assert_eq!(rig.page(fast), Page::Leaving);
}

#[test]
fn a_pasted_line_is_kept_whole() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let line: String =
        ('a'..='z').cycle().take(60).flat_map(|letter| [letter, '\u{301}']).collect();
    rig.press(one, &format!("/{line} and more that does not fit\r"));
    let said = rig.view().said.last().map(|said| said.text.clone());
    assert_eq!(said, crate::line::Line::of(&line, 60).map(|line| line.to_string()));
}

#[test]
fn boards_settings_and_help_return_to_the_lobby() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.press(one, ENTER);
    for (number, shown) in [
        ("4", "left and right change"),
        ("5", "board"),
        ("6", "The menu of a private room"),
        ("7", "Difficulty"),
        ("8", "walk back"),
        ("9", "Nobody else is here."),
    ] {
        rig.press(one, number);
        assert!(rig.text(one).contains(shown), "{number}: {}", rig.text(one));
        rig.press(one, ESCAPE);
        assert_eq!(rig.page(one), Page::Lobby, "{number}");
    }
    rig.press(one, "52");
    assert_eq!(rig.page(one), Page::Board);
    assert!(rig.text(one).contains("Nobody has won it yet."), "{}", rig.text(one));
    rig.press(one, "\x1b[C");
    assert!(rig.text(one).contains("On hard"), "{}", rig.text(one));
}

#[test]
fn every_entry_of_the_lobby_has_a_key_that_is_shown() {
    let mut rig = Rig::new(Mode::Roam);
    let others: Vec<_> = (10..17).map(|id| room_elsewhere(id, "hall")).collect();
    rig.rooms().show_shared(others);
    let one = rig.visitor("Mara", (80, 40), Speaks::Plain);
    rig.press(one, ENTER);
    let text = rig.text(one);
    let entries = text.lines().filter_map(|line| line.strip_prefix('|')?.split_once(" |"));
    let entries: Vec<String> = entries.map(|it| it.0.trim_start_matches(" >").to_owned()).collect();
    let expected = [
        ("Tag in The Hall", "1/8  1"),
        ("Tag in The Hall", "1/8  2"),
        ("Tag in The Hall", "1/8  3"),
        ("Tag in The Hall", "1/8  4"),
        ("Tag in The Hall", "1/8  5"),
        ("Tag in The Hall", "1/8  6"),
        ("All rooms", "8  7"),
        ("Open a room", "o"),
        ("Daily 2001-09-09", "d"),
        ("Alone, for the board", "l"),
        ("Board", "b"),
        ("Enter a code", "c"),
        ("Settings", "t"),
        ("Help", "?"),
        ("Players and talk", "p"),
        ("Leave", "q"),
    ];
    for (entry, (label, key)) in entries.iter().zip(expected) {
        let is_shown = entry.trim_start().starts_with(label) && entry.ends_with(&format!(" {key}"));
        assert!(is_shown, "{label} {key}: {text}");
    }
    let card = |id| Page::Card(RoomTarget::Existing(RoomId(id)));
    for (key, page) in [
        ("1", card(10)),
        ("6", card(15)),
        ("7", Page::Rooms),
        ("d", Page::Daily),
        ("o", Page::Modes),
        ("l", Page::Levels(Mode::Alone)),
        ("b", Page::Boards),
        ("c", Page::Code),
        ("t", Page::Settings),
        ("?", Page::Help),
        ("p", Page::Players),
        ("q", Page::Leaving),
    ] {
        rig.press(one, key);
        assert_eq!(rig.page(one), page, "{key}");
        rig.press(one, ESCAPE);
        assert_eq!(rig.page(one), Page::Lobby, "{key}");
    }
}

#[test]
fn a_key_that_walks_selects_in_the_lobby_and_is_not_shown() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.session(one, |session, _| {
        let text = "[keys]\nforward = [\"e\"]\nback = [\"d\"]\n";
        let configuration = Configuration::parse(text, "settings").unwrap();
        session.ui.bindings = ui::bindings_of(&configuration);
    });
    rig.press(one, ENTER);
    let text = rig.text(one);
    assert!(text.contains("  o |") && !text.contains("  d |"), "{text}");
    rig.press(one, "d");
    assert!(rig.text(one).contains("> Open a room"), "{}", rig.text(one));
}

/// A room of another host, in which Kim waits.
fn room_elsewhere(id: u32, level: &str) -> RoomSummary {
    RoomSummary {
        id: RoomId(id),
        level: level.to_owned(),
        mode: Mode::Tag,
        difficulty: Difficulty::Normal,
        phase: Phase::Waiting,
        members: [line("Kim")].into(),
        watchers: 0,
        browsers: 0,
        code: None,
    }
}

#[test]
fn a_room_says_how_many_browsers_watch() {
    let mut rig = Rig::new(Mode::Roam);
    rig.rooms().show_shared(vec![room_elsewhere(7, "hall")]);
    rig.rooms().note_browsers(RoomId(7), 12);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    for _ in 0..2 {
        rig.press(one, ENTER);
    }
    assert!(rig.text(one).contains("Here: Kim. 12 browsers."), "{}", rig.text(one));
}

#[test]
fn rooms_in_missing_maps_are_not_listed() {
    let mut rig = Rig::new(Mode::Roam);
    let elsewhere = |level| vec![room_elsewhere(7, level), room_elsewhere(8, "museum")];
    rig.rooms().show_shared(elsewhere("hall"));
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.press(one, ENTER);
    assert_eq!(rig.text(one).matches("Tag in The Hall").count(), 2, "{}", rig.text(one));
    // The room moves on to a map that only other hosts have, while Mara looks at its card.
    rig.press(one, ENTER);
    rig.rooms().show_shared(elsewhere("moss-0123456789abcdef"));
    rig.pump(500);
    let text = rig.text(one);
    assert!(text.contains("This host does not have the map of this room."), "{text}");
    assert!(!text.contains("Go in"), "{text}");
    rig.press(one, ESCAPE);
    let text = rig.text(one);
    assert_eq!(text.matches("Tag in").count(), 1, "{text}");
    assert!(!text.contains("moss"), "{text}");
}
