//! Guards on the screen: their suspicion, where they look, and how they found the
//! player.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::missions::{playing_own, text};
use super::*;
use crate::tui::GlyphSet;

/// A warden who looks at the player from afar.
const HALL: &str = r##"
title = "Hall"
light = 0.7
grid = '''
###############
#@...........w#
#.............#
#............X#
###############
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"w" = { guard = "warden", heading = 180 }
"X" = { exit = true }
"##;

/// An archer at a door in the north, who looks at the player.
const GATE: &str = r##"
title = "Gate"
grid = '''
###########
#.........#
#.........#
###+#######
#..a......#
#.........#
#.........#
#.........#
#.........#
#.@......X#
###########
'''
[tiles]
"#" = { wall = "brick" }
"+" = { door = "oak" }
[things]
"@" = { start = 315 }
"a" = { guard = "archer", heading = 60 }
"X" = { exit = true }
"##;

/// The marks above heads, in a picture of ASCII characters without colours.
const MARKS: [&str; 5] = ["!!!", "<?>", "???", "??", "?"];

fn ascii(rig: &mut Rig) -> String {
    rig.app.settings.glyphs = GlyphSet::Ascii;
    rig.app.terminal.depth = ColorDepth::Mono;
    text(&mut rig.app, 80, 24)
}

/// The mark in the middle columns of the picture, where nothing else writes such characters.
fn mark(rig: &mut Rig) -> Option<&'static str> {
    let shown = ascii(rig);
    let rows: Vec<String> =
        shown.lines().take(23).map(|line| line.chars().skip(35).take(12).collect()).collect();
    MARKS.into_iter().find(|mark| rows.iter().any(|row| row.contains(mark)))
}

#[test]
fn a_mark_above_the_head_fills_until_the_guard_is_sure() {
    let mut rig = playing_own(HALL, Store::in_memory());
    let mut marks = vec![mark(&mut rig)];
    // The player comes nearer, into the warden's sight.
    rig.press(W);
    rig.wait(2000);
    rig.release(W);
    for _ in 0..600 {
        rig.wait(20);
        let mark = mark(&mut rig);
        if marks.last() != Some(&mark) {
            marks.push(mark);
        }
        if mark == Some("!!!") {
            break;
        }
    }
    assert_eq!(marks, [None, Some("?"), Some("??"), Some("???"), Some("!!!")]);
    let status = ascii(&mut rig);
    assert!(status.lines().last().unwrap().contains("ALARM: warden"), "{status}");
}

#[test]
fn the_map_shows_where_the_guards_in_view_look() {
    // The panel in the upper right corner.
    let watched = |rig: &mut Rig| {
        let shown = ascii(rig);
        let panel = shown.lines().take(6).flat_map(|line| line.chars().skip(64));
        panel.filter(|&character| character == '%').count()
    };
    let mut rig = playing_own(HALL, Store::in_memory());
    let seen = watched(&mut rig);
    rig.tap(Key::Char('b'), 30);
    rig.wait(500);
    let behind = watched(&mut rig);
    assert!(seen > 10 && behind == 0, "{seen} {behind}\n{}", ascii(&mut rig));
}

/// A player who tried a door that is not there, and then waited in the open until the archer killed
/// them.
fn shot() -> Rig {
    let mut rig = playing_own(GATE, Store::in_memory());
    rig.tap(Key::Char('e'), 30);
    // The picture explores the map.
    text(&mut rig.app, 80, 24);
    // Guards notice nobody who has not acted.
    rig.tap(Key::Char('e'), 30);
    for _ in 0..60_000 {
        rig.wait(1);
        if rig.app.screen() == AppScreen::Dead {
            return rig;
        }
    }
    panic!("alive with {:?}", rig.game().health());
}

#[test]
fn the_panel_after_a_death_names_the_guard_and_shows_the_last_seconds_from_above() {
    let mut rig = shot();
    let shown = text(&mut rig.app, 80, 24);
    let panel: String = shown.lines().flat_map(|line| line.chars().skip(45).chain([' '])).collect();
    let words: Vec<&str> = panel.split([' ', '│']).filter(|word| !word.is_empty()).collect();
    let said = words.join(" ");
    assert!(said.contains("killed by an archer's bolt"), "{shown}");
    assert!(said.contains("An archer at a door 5 cells to the north saw you 11 s ago."), "{shown}");
    assert!(said.contains("Take back 10 s 3 left"), "{shown}");
    // The picture moves by itself.
    let picture = |rig: &mut Rig| {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 80, 24));
        rig.app.draw(&mut buffer);
        rig.app.drawn();
        buffer
    };
    let first = picture(&mut rig);
    assert!(!rig.app.is_stale());
    let next = rig.app.next_change().expect("it goes on");
    assert!(next > rig.now && next <= rig.now + Duration::from_millis(100));
    rig.wait(200);
    assert!(rig.app.is_stale());
    assert_ne!(picture(&mut rig), first);
}

#[test]
fn the_look_back_looks_unchanged_without_colours() {
    let mut rig = shot();
    rig.wait(3000);
    insta::assert_snapshot!(ascii(&mut rig));
}
