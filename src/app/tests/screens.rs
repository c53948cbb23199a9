//! The cells of every screen.

use crate::tui::GlyphSet;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use super::super::*;
use crate::app::MapDisplay;
use crate::map::{Level, builtin, parse_str};
use crate::terminal::{Key, KeyEvent, Phase};
use crate::world::World;

fn app(level: &str, settings: Settings) -> App {
    let level = builtin::LEVELS.iter().find(|known| known.name == level).unwrap();
    app_in(level.world().unwrap(), settings)
}

/// A game in the second of three levels.
fn app_in(world: World, settings: Settings) -> App {
    let levels = Levels::new(Level::from(world), std::iter::empty());
    App::new(levels.numbered(2, 3), settings)
}

fn ascii(minimap: MapDisplay) -> Settings {
    let depth = Some(ColorDepth::Mono);
    Settings { glyphs: GlyphSet::Ascii, depth, minimap, ..Settings::default() }
}

fn press(app: &mut App, key: Key) {
    let modifiers = crate::terminal::Modifiers::default();
    app.key(KeyEvent { key, base: None, modifiers, phase: Phase::Press }, Duration::ZERO);
}

fn buffer(app: &mut App, (columns, rows): (u16, u16)) -> Buffer {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
    app.draw(&mut buffer);
    buffer
}

fn text(app: &mut App, size: (u16, u16)) -> String {
    let buffer = buffer(app, size);
    let lines = buffer.content().chunks(size.0.into());
    lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
}

const SIZES: [(u16, u16); 3] = [(80, 24), (40, 12), (20, 6)];

#[test]
fn the_first_screen_says_what_to_do() {
    for (columns, rows) in SIZES {
        let mut app = app("museum", ascii(MapDisplay::Seen));
        let name = format!("first_screen_{columns}x{rows}");
        insta::assert_snapshot!(name, text(&mut app, (columns, rows)));
    }
}

#[test]
fn help_scrolls_if_it_does_not_fit() {
    for (columns, rows) in SIZES {
        let mut app = app("museum", ascii(MapDisplay::Seen));
        press(&mut app, Key::Char('?'));
        text(&mut app, (columns, rows));
        press(&mut app, Key::PageDown);
        press(&mut app, Key::Down);
        let name = format!("help_scrolled_{columns}x{rows}");
        insta::assert_snapshot!(name, text(&mut app, (columns, rows)));
    }
}

#[test]
fn maps_show_heights() {
    let maps = [
        ("cistern", include_str!("../../../tests/maps/cistern.toml")),
        ("observatory", include_str!("../../../tests/maps/observatory.toml")),
    ];
    for (level, map) in maps {
        let mut app = app_in(parse_str(map).unwrap(), ascii(MapDisplay::All));
        press(&mut app, Key::Char('3'));
        insta::assert_snapshot!(format!("map_of_{level}"), text(&mut app, (120, 40)));
    }
}

#[test]
fn the_goal_is_shown_until_the_player_has_acted_for_a_while() {
    let mut app = app("cellar", ascii(MapDisplay::Seen));
    let size = (80, 24);
    let goal = app.goal.text.clone();
    for second in 1..=60 {
        app.advance(Duration::from_secs(second));
    }
    assert!(app.game.elapsed() > 4.0, "the warden walks");
    assert!(text(&mut app, size).contains(&goal), "the player has done nothing");
    app.goal.moved(4 * 60 - 1);
    assert!(text(&mut app, size).contains(&goal));
    app.goal.moved(1);
    let later = text(&mut app, size);
    assert!(!later.contains(&goal), "{later}");
    assert!(later.contains("Cellar") && later.contains("0 of 130 gold, 100 needed"), "{later}");
}

#[test]
fn the_explored_share_grows() {
    let size = (120, 40);
    let mut app = app("cellar", ascii(MapDisplay::Seen));
    text(&mut app, size);
    let share = |app: &App| app.map.share_seen(app.game.grid().unwrap()).unwrap();
    let mut before = share(&app);
    assert!(before > 0.0 && before < 0.5, "{before}");
    let turn = [crate::game::Intent::TurnRight].into_iter().collect();
    for _ in 0..40 {
        (0..4).for_each(|_| app.game.step(turn));
        text(&mut app, size);
        let after = share(&app);
        assert!(after >= before);
        before = after;
    }
    assert!(before < 0.9, "walls hide cells: {before}");
}

#[test]
fn nothing_on_a_map_is_as_bright_as_the_arrow() {
    use ratatui::style::Color;
    for level in builtin::LEVELS {
        for display in [MapDisplay::All, MapDisplay::Seen] {
            let settings = Settings { minimap: display, ..Settings::default() };
            let mut app = app(level.name, settings);
            let buffer = buffer(&mut app, (120, 40));
            let luma = |color: Color| match color {
                Color::Rgb(red, green, blue) => crate::color::Rgb::new(red, green, blue).luma(),
                _ => 0,
            };
            let left = (0..120).find(|&x| buffer[(x, 0)].symbol() == "┌").unwrap();
            let bottom = (0..40).find(|&y| buffer[(left, y)].symbol() == "└").unwrap();
            let cells = (1..bottom).flat_map(|y| (left + 1..119).map(move |x| (x, y)));
            let mut arrows = 0;
            for place in cells {
                let cell = &buffer[place];
                if "→↘↓↙←↖↑↗".contains(cell.symbol()) {
                    arrows += 1;
                    assert!(luma(cell.bg) > 220);
                } else {
                    let brightest = luma(cell.fg).max(luma(cell.bg));
                    assert!(brightest < 190, "{} at {place:?}: {cell:?}", level.name);
                }
            }
            assert_eq!(arrows, 1, "{}", level.name);
        }
    }
}

#[test]
fn the_map_zooms_moves_and_returns() {
    let size = (120, 40);
    let mut app = app("citadel", ascii(MapDisplay::All));
    let first = text(&mut app, size);
    let mut shown = vec![first.clone()];
    for key in ['9', '9', '4', '8', '6', '2'] {
        press(&mut app, Key::Char(key));
        let now = text(&mut app, size);
        assert_ne!(Some(&now), shown.last(), "{key} changes nothing");
        shown.push(now);
    }
    press(&mut app, Key::Char('5'));
    assert_eq!(text(&mut app, size), first);
}
