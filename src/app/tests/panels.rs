//! Every screen, in windows of many sizes and in every mode.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::missions::{danger, dead, text};
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::tui::GlyphMode;

/// All screens, each with the game behind it.
fn screens() -> Vec<(&'static str, Rig)> {
    let opened = |label: &'static str| {
        let mut rig = titled(Offers::default(), Store::in_memory());
        rig.choose(label);
        rig
    };
    let mut paused = danger();
    paused.tap(Key::Char('p'), 30);
    let mut hud = danger();
    for key in [Key::Char('.'), Key::Char(',')] {
        hud.tap(key, 30);
        hud.wait(100);
    }
    vec![
        ("title", titled(Offers::default(), Store::in_memory())),
        ("new_game", opened("New game")),
        ("levels", opened("Levels")),
        ("settings", opened("Settings")),
        ("help", opened("Help")),
        ("paused", paused),
        ("hud", hud),
        ("dead", dead()),
    ]
}

#[test]
fn every_screen_is_readable_in_80_and_in_40_columns_without_colours() {
    for (name, mut rig) in screens() {
        rig.app.settings.glyphs = GlyphMode::Ascii;
        rig.app.depth = ColorDepth::Mono;
        for (columns, rows) in [(80, 24), (40, 12)] {
            let name = format!("{name}_{columns}x{rows}");
            insta::assert_snapshot!(name, text(&mut rig.app, columns, rows));
        }
    }
}

#[test]
fn every_screen_can_be_drawn_in_any_window_and_mode() {
    for (name, mut rig) in screens() {
        for glyphs in [GlyphMode::Half, GlyphMode::Ascii, GlyphMode::Ramp] {
            for depth in [ColorDepth::True, ColorDepth::Indexed16, ColorDepth::Mono] {
                rig.app.settings.glyphs = glyphs;
                rig.app.depth = depth;
                for (columns, rows) in [(80, 24), (37, 9), (20, 6), (200, 60), (5, 3), (1, 1)] {
                    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
                    rig.app.draw(&mut buffer);
                    let has_colors = buffer
                        .content()
                        .iter()
                        .any(|cell| cell.fg != Color::Reset || cell.bg != Color::Reset);
                    assert!(!has_colors || depth != ColorDepth::Mono, "{name} {columns}x{rows}");
                }
            }
        }
    }
}
