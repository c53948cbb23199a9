//! Today's daily level: in the lobby, in rooms, on the board, and at midnight.

use std::sync::Arc;

use super::private::in_lobby;
use super::*;
use crate::accounts::{AccountKey, Day, UnixTime};
use crate::rooms::room::Catalog;
use crate::rooms::summary::RoomId;
use crate::sessions::session::pages::Page;
use crate::simulation::{guest, replayed};
use crate::ssh::Visitor;
use cellcaster::color::palette::ColorDepth;
use cellcaster::map;

/// A corridor whose exit is eight cells ahead of the start.
const CORRIDOR: &str = r##"
title = "Corridor"
grid = '''
###############
#@.......>....#
###############
'''
[tiles]
"#" = { wall = "#808080" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;
const FIRST: &str = "daily-2001-09-09";
const SECOND: &str = "daily-2001-09-10";
/// Midnight between the two days.
const MIDNIGHT: u64 = 1_000_080_000;
const WALK: &str = "\x1b[119;1:1u";
const STAND: &str = "\x1b[119;1:3u";

/// A host on which both daily levels are the corridor, this many seconds before midnight.
fn host(seconds: u64) -> Rig {
    let mut catalog = catalog(HALL);
    for level in [FIRST, SECOND] {
        catalog.add(level, map::parse(CORRIDOR, level, &map::NoFiles).unwrap());
    }
    let time = UnixTime::new(MIDNIGHT - seconds);
    Rig::with(RigOptions { catalog, time, ..RigOptions::new(Mode::Roam) })
}

/// Connects a player with an account to the lobby.
fn player(rig: &mut Rig, name: &str, number: u8) -> usize {
    let key = Some(AccountKey::new([number; 32]));
    let visitor = Visitor { key, ..guest(name, (80, 24)) };
    let index = rig.connect(visitor, Speaks::Kitty, ColorDepth::Mono);
    rig.pump(300);
    rig.press(index, ENTER);
    assert_eq!(rig.page(index), Page::Lobby, "{}", rig.text(index));
    index
}

/// Opens a room in the daily level, in the mode with this number on its page.
fn open_daily(rig: &mut Rig, index: usize, mode: &str) {
    for key in ["3", mode, ENTER] {
        rig.press(index, key);
    }
    assert_eq!(rig.page(index), Page::Room, "{}", rig.text(index));
}

fn shows(rig: &Rig, index: usize, texts: &[&str]) {
    let shown = rig.text(index);
    for text in texts {
        assert!(shown.contains(text), "{text}\n{shown}");
    }
}

fn level(rig: &Rig, room: u32) -> String {
    rig.rooms().view(RoomId(room)).expect("the room is there").header.level.clone()
}

#[test]
fn a_win_in_the_daily_level_is_on_its_board() {
    let mut rig = host(3_600);
    let mara = player(&mut rig, "Mara", 1);
    shows(&rig, mara, &["|   Daily 2001-09-09", "+Daily 2001-09-09", "no results yet"]);
    open_daily(&mut rig, mara, "1");
    rig.send(mara, WALK);
    rig.pump(8_000);
    shows(&rig, mara, &["your best. You are number 1."]);
    for key in [STAND, "q", "q"] {
        rig.press(mara, key);
    }
    shows(&rig, mara, &["| 1. Mara"]);
    let jon = in_lobby(&mut rig, "Jon", (40, 12));
    rig.press(jon, "3");
    shows(&rig, jon, &["Daily 2001-09-09", "1. Mara 0:0", "Race"]);
    // Its board is the first one, and the boards before it are the boards of earlier days.
    for keys in ["\x1b", "5", "1"] {
        rig.press(jon, keys);
    }
    shows(&rig, jon, &["Left and right change the day.", " 1. Mara"]);
    // The run is shown as Mara saw it.
    for keys in [ENTER, " ", "\x1b[F"] {
        rig.press(jon, keys);
    }
    shows(&rig, jon, &[" end"]);
    rig.press(jon, "q");
    assert_eq!(rig.page(jon), Page::Board);
    for _ in 0..9 {
        rig.press(jon, "\x1b[D");
    }
    shows(&rig, jon, &["Daily 2001-09-03", "Nobody has won it yet."]);
}

#[test]
fn players_meet_in_a_room_in_the_daily_level() {
    let mut rig = host(3_600);
    let mara = player(&mut rig, "Mara", 1);
    open_daily(&mut rig, mara, "2");
    let jon = in_lobby(&mut rig, "Jon", (80, 24));
    rig.press(jon, "4");
    shows(&rig, jon, &["> Race", "1/8"]);
    rig.press(jon, ENTER);
    shows(&rig, jon, &["Daily 2001-09-09", "Here: Mara."]);
    rig.press(jon, ENTER);
    assert_eq!(rig.rooms().view(RoomId(2)).unwrap().members.len(), 2);
}

#[test]
fn a_room_plays_the_next_day_after_its_round() {
    let mut rig = host(20);
    let mara = player(&mut rig, "Mara", 1);
    let jon = in_lobby(&mut rig, "Jon", (80, 24));
    open_daily(&mut rig, mara, "2");
    rig.pump(30_000);
    shows(&rig, jon, &["Daily 2001-09-10", "no results yet"]);
    assert_eq!(level(&rig, 2), FIRST);
    rig.send(mara, WALK);
    rig.pump(8_000);
    assert_eq!(level(&rig, 2), FIRST, "the standings are of the first day");
    rig.send(mara, STAND);
    rig.pump(12_000);
    assert_eq!(level(&rig, 2), SECOND);
    // A room that somebody enters on a later day goes on likewise.
    let text = rig.logs.text(RoomId(2));
    assert!(
        text.contains(" day 1 2001-09-10\n") && text.contains("\"level\":\"daily-2001-09-10\"")
    );
    let room = rig.rooms().view(RoomId(2)).unwrap();
    let again = replayed(&text, rig.rooms().catalog(), room.step);
    assert_eq!(again.header(), &*room.header);
}

#[test]
fn a_result_counts_for_the_day_on_which_the_run_began() {
    let mut rig = host(20);
    let mara = player(&mut rig, "Mara", 1);
    open_daily(&mut rig, mara, "1");
    rig.pump(60_000);
    rig.send(mara, WALK);
    rig.pump(8_000);
    shows(&rig, mara, &["You are number 1."]);
    for key in [STAND, "q", "q", "5", "1"] {
        rig.press(mara, key);
    }
    shows(&rig, mara, &["Daily 2001-09-10", "Nobody has won it yet."]);
    rig.press(mara, "\x1b[D");
    shows(&rig, mara, &["Daily 2001-09-09", "Mara (you)"]);
}

#[test]
fn a_card_that_was_opened_before_midnight_leads_to_the_new_level() {
    let mut rig = host(20);
    let mara = player(&mut rig, "Mara", 1);
    for key in ["3", "2"] {
        rig.press(mara, key);
    }
    shows(&rig, mara, &["Daily 2001-09-09"]);
    rig.pump(30_000);
    shows(&rig, mara, &["Daily 2001-09-10"]);
    rig.press(mara, ENTER);
    assert_eq!(level(&rig, 2), SECOND);
}

#[test]
fn each_daily_level_is_generated_once() {
    let catalog = Arc::new(Catalog::builtin());
    let day = Day::of(UnixTime::new(MIDNIGHT));
    let world = catalog.world(&day.level()).unwrap();
    assert!(Arc::ptr_eq(&world, &catalog.world(&day.level()).unwrap()));
    assert_eq!(*world, day.world().unwrap());
    // Only the last ones are kept.
    (1..=3).for_each(|days| _ = catalog.world(&day.before(days).level()));
    assert!(!Arc::ptr_eq(&world, &catalog.world(&day.level()).unwrap()));
    assert!(catalog.world("daily-2001-09-31").is_none() && !catalog.has("daily-"));
}
