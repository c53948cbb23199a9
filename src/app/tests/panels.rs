//! Every screen, in windows of many sizes and in every mode.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Color;

use super::missions::{danger, dead, text};
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::app::page::{framed, leaving, message};
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

/// All screens, each with a game behind it.
fn screens() -> Vec<(&'static str, Rig)> {
    let opened = |label: &'static str| {
        let mut rig = titled(Offers::default(), Store::in_memory());
        rig.choose(label);
        rig
    };
    let mut keys = opened("Settings");
    keys.choose("Keys");
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
        ("keys", keys),
        ("help", opened("Help")),
        ("paused", paused),
        ("hud", hud),
        ("dead", dead()),
    ]
}

#[test]
fn every_screen_is_readable_in_80_and_in_40_columns_without_colours() {
    for (name, mut rig) in screens() {
        rig.app.settings.glyphs = GlyphSet::Ascii;
        rig.app.terminal.depth = ColorDepth::Mono;
        for (columns, rows) in [(80, 24), (40, 12)] {
            let name = format!("{name}_{columns}x{rows}");
            insta::assert_snapshot!(name, text(&mut rig.app, columns, rows));
        }
    }
}

#[test]
fn every_screen_can_be_drawn_in_any_window_and_mode() {
    for (name, mut rig) in screens() {
        for glyphs in [GlyphSet::Half, GlyphSet::Ascii, GlyphSet::Ramp] {
            for depth in [ColorDepth::True, ColorDepth::Indexed16, ColorDepth::Mono] {
                rig.app.settings.glyphs = glyphs;
                rig.app.terminal.depth = depth;
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

/// Windows of 0 to 3 columns and rows, windows around the smallest playable size, and a large one.
fn windows() -> impl Iterator<Item = Rect> {
    let small = (0..4).flat_map(|width| (0..4).map(move |height| (width, height)));
    let sizes = small.chain([(19, 6), (20, 5), (20, 6), (21, 7), (36, 12), (80, 24)]);
    sizes.map(|(width, height)| Rect::new(0, 0, width, height))
}

#[test]
fn every_screen_can_be_drawn_in_every_small_window_after_every_other() {
    for (_, mut rig) in screens() {
        for before in windows() {
            for window in windows() {
                rig.app.draw(&mut Buffer::empty(before));
                rig.app.draw(&mut Buffer::empty(window));
            }
        }
    }
}

#[test]
fn panels_stay_within_every_small_area() {
    let mut rig = danger();
    let screen = Rect::new(0, 0, 90, 30);
    for size in windows() {
        let area = Rect { x: 2, y: 2, ..size };
        let mut drawn = Buffer::empty(screen);
        let canvas = &mut drawn;
        message(canvas, area, "title", "some text\nin two lines".into());
        leaving(canvas, area, &rig.app.settings.bindings, "leaves");
        framed(canvas, area, "title");
        title::draw_banner(canvas, area, GlyphSet::Half, ColorDepth::True);
        picture::draw_note(canvas, area, "a note that is long enough to be wrapped into lines");
        rig.app.pages.menu.draw(canvas, area);
        let bindings = &rig.app.settings.bindings;
        rig.app.pages.help.draw(canvas, area, (&[], bindings), iter::once("a note".to_owned()));
        canvas.draw_widget(&rig.app.status, Rect { height: area.height.min(1), ..area });
        for position in screen.positions().filter(|&position| !area.contains(position)) {
            assert_eq!(drawn[position], Cell::EMPTY, "{position} of {area}");
        }
    }
}
