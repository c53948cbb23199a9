//! What the screen shows of guards: what they suspect, and where they look.

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
        let panel = shown.lines().take(6).flat_map(|line| line.chars().skip(54));
        panel.filter(|&character| character == '%').count()
    };
    let mut rig = playing_own(HALL, Store::in_memory());
    let seen = watched(&mut rig);
    rig.tap(Key::Char('b'), 30);
    rig.wait(500);
    let behind = watched(&mut rig);
    assert!(seen > 10 && behind == 0, "{seen} {behind}\n{}", ascii(&mut rig));
}
