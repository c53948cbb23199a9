//! Screens in full colour.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::missions::{dead, playing_own, won};
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::color::Rgb;
use crate::game::FlashKind;
use crate::testing::assert_grid;

/// A warden strikes the player, a lantern bearer raises the alarm behind them, and treasure lies
/// beyond.
const AMBUSH: &str = r##"
title = "Ambush"
par = 30
treasure_needed = 50
floor = "flagstone"
ceiling = "wood"
light = 0.8
grid = '''
##############
#....#......X#
#.l....@..w.t#
#............#
##############
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"w" = { guard = "warden", heading = 180 }
"l" = { guard = "lantern", heading = 0 }
"t" = { treasure = 100 }
"X" = { exit = true }
"##;

/// A player who has just been struck, with everything on that can be shown over the picture.
pub(crate) fn struck() -> Rig {
    let mut rig = playing_own(AMBUSH, Store::in_memory());
    for key in [Key::Char('e'), Key::Char('.'), Key::Char(',')] {
        rig.tap(key, 30);
        rig.wait(100);
    }
    for _ in 0..20_000 {
        let is_hurt = |game: &Game| {
            game.flash().is_some_and(|flash| matches!(flash.kind, FlashKind::Hurt { .. }))
        };
        if is_hurt(rig.game()) && !rig.game().heard().is_empty() {
            rig.wait(60);
            return rig;
        }
        rig.wait(1);
    }
    panic!("nobody strikes: {:?}", rig.game().alarm());
}

#[test]
fn screens_look_unchanged_in_all_colours() {
    let screens = vec![
        ("title", titled(Offers::default(), Store::in_memory())),
        ("hud", struck()),
        ("dead", dead()),
        ("summary", won()),
    ];
    for (name, mut rig) in screens {
        rig.app.terminal.depth = ColorDepth::True;
        let mut buffer = Buffer::empty(Rect::new(0, 0, 80, 24));
        rig.app.draw(&mut buffer);
        assert_grid!(buffer, name);
    }
}

/// The colours in the map's panel at the upper right of a picture with 80 columns.
fn map_colors(rig: &mut Rig) -> Vec<Rgb> {
    let mut buffer = Buffer::empty(Rect::new(0, 0, 80, 24));
    rig.app.draw(&mut buffer);
    let text: Vec<&str> = (0..80).map(|x| buffer[(x, 0)].symbol()).collect();
    let left = text.iter().rposition(|&symbol| symbol == "┌").unwrap() as u16 + 1;
    let bottom = (1..24).find(|&y| buffer[(79, y)].symbol() == "┘").unwrap();
    let cells = (1..bottom).flat_map(|y| (left..79).map(move |x| (x, y)));
    let colors = cells.flat_map(|place| [buffer[place].fg, buffer[place].bg]);
    let of = |color| match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        _ => None,
    };
    colors.filter_map(of).collect()
}

#[test]
fn the_map_is_darker_while_guards_are_alarmed_and_the_exit_stays() {
    let calm = map_colors(&mut playing_own(AMBUSH, Store::in_memory()));
    let alarmed = map_colors(&mut struck());
    let mean = |colors: &[Rgb]| {
        let luma = colors.iter().map(|color| u32::from(color.luma())).sum::<u32>();
        f64::from(luma) / colors.len() as f64
    };
    assert_eq!(calm.len(), alarmed.len());
    let (before, now) = (mean(&calm), mean(&alarmed));
    assert!(now < 0.8 * before, "{before} {now}");
    let exit = Rgb::new(0x50, 0xd8, 0x78);
    assert!(calm.contains(&exit) && alarmed.contains(&exit), "{calm:?} {alarmed:?}");
}

#[test]
fn the_map_is_narrow_in_80_columns_until_the_player_enlarges_it() {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    let mut columns = |width, key| {
        rig.tap(key, 30);
        rig.wait(700);
        let mut buffer = Buffer::empty(Rect::new(0, 0, width, 24));
        rig.app.draw(&mut buffer);
        (0..width).rev().position(|x| buffer[(x, 0)].symbol() == "┌").unwrap() + 1
    };
    let usual = Key::Char('5');
    assert!(columns(80, usual) <= 16);
    assert!(columns(100, usual) > 30);
    assert!(columns(80, Key::Char('9')) > 20);
    assert!(columns(80, usual) <= 16);
}
