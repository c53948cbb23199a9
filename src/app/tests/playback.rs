//! Recorded runs on the screen.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use super::*;
use crate::game::Script;
use crate::map::builtin;
use crate::terminal::{MouseButton, MouseEvent, MouseEventKind};
use crate::tui::GlyphSet;

const WINS: &str = include_str!("../../../maps/scripts/cellar.normal.script");

fn script(text: &str) -> Script {
    Script::parse(text, "it").unwrap_or_else(|faults| panic!("{faults}"))
}

/// The cellar as `cellcaster replay` begins it.
fn cellar() -> Levels {
    let game = Game::new(builtin::LEVELS[0].world().unwrap());
    Levels::of_games(game, iter::empty())
}

/// A playback of a run in the cellar.
fn playback(text: &str) -> App {
    let mut app = App { store: Store::in_memory(), ..App::default() };
    app.begin_playback(cellar(), &script(text));
    app
}

fn watching(text: &str) -> Rig {
    Rig::of(playback(text), None)
}

fn tap(rig: &mut Rig, key: Key) {
    rig.tap(key, 1);
    rig.wait(1);
}

fn type_in(rig: &mut Rig, keys: &str) {
    keys.chars().for_each(|key| tap(rig, Key::Char(key)));
}

/// The last rows of a window of 80×24 cells.
fn rows(rig: &mut Rig, count: usize) -> String {
    let mut screen = Buffer::empty(Rect::new(0, 0, 80, 24));
    rig.app.draw(&mut screen);
    rig.app.drawn();
    let symbols: Vec<&str> = screen.content.iter().map(Cell::symbol).collect();
    let rows: Vec<String> = symbols.chunks(80).map(|row| row.concat().trim_end().into()).collect();
    rows[rows.len() - count..].join("\n")
}

fn steps(rig: &Rig) -> u64 {
    rig.game().steps()
}

/// The checksum of the game after the first `steps` steps of the script.
fn checksum_after(text: &str, steps: u64) -> u64 {
    let mut game = Game::new(builtin::LEVELS[0].world().unwrap());
    script(text).iter().take(steps as usize).for_each(|(_, intents)| game.step(intents));
    game.checksum()
}

#[test]
fn a_run_plays_pauses_and_steps_both_ways() {
    let mut rig = watching(WINS);
    rig.wait(981);
    assert_eq!(steps(&rig), 60);
    tap(&mut rig, SPACE);
    let paused = steps(&rig);
    rig.wait(1000);
    assert_eq!(steps(&rig), paused);
    type_in(&mut rig, "..,,,");
    assert_eq!(steps(&rig), paused - 1);
    assert_eq!(rig.game().checksum(), checksum_after(WINS, paused - 1));
    tap(&mut rig, Key::Right);
    tap(&mut rig, Key::Right);
    tap(&mut rig, Key::Left);
    assert_eq!(steps(&rig), paused - 1 + 300);
    assert_eq!(rig.game().checksum(), checksum_after(WINS, paused + 299));
    tap(&mut rig, Key::Home);
    assert_eq!(steps(&rig), 0);
    tap(&mut rig, Key::Down);
    assert_eq!(steps(&rig), 0);
    tap(&mut rig, Key::Up);
    assert_eq!(
        rig.game().checksum(),
        checksum_after(WINS, 3600),
        "a minute is longer than the run"
    );
}

#[test]
fn a_run_plays_at_each_speed() {
    for (keys, expected) in [("<<<<", 15), ("<", 30), ("", 60), (">", 120), (">>>>>>>", 960)] {
        let mut rig = watching("60 s stand\n");
        tap(&mut rig, SPACE);
        type_in(&mut rig, keys);
        tap(&mut rig, Key::Home);
        tap(&mut rig, SPACE);
        let before = steps(&rig);
        rig.wait(1000);
        assert!(
            (steps(&rig) - before).abs_diff(expected) <= expected / 15,
            "{keys}: {}",
            steps(&rig)
        );
    }
}

#[test]
fn the_time_line_shows_the_marks_and_the_keys_jump_to_them() {
    let mut rig = watching(WINS);
    tap(&mut rig, SPACE);
    tap(&mut rig, Key::Home);
    let mut shown = vec![rows(&mut rig, 2)];
    for keys in ["n", "n", "b", "<v", ">v"] {
        type_in(&mut rig, keys);
        shown.push(rows(&mut rig, 2));
    }
    tap(&mut rig, Key::End);
    shown.push(rows(&mut rig, 2));
    rig.app.settings.glyphs = GlyphSet::Ascii;
    tap(&mut rig, SPACE);
    shown.push(rows(&mut rig, 2));
    insta::assert_snapshot!(shown.join("\n"));
}

#[test]
fn a_press_on_the_time_line_goes_there() {
    let mut rig = watching("60 s stand\n");
    tap(&mut rig, SPACE);
    rows(&mut rig, 1);
    let cell = MouseEvent::UNITS_PER_CELL;
    let kind = MouseEventKind::Pressed(MouseButton::Left);
    for (x, y, expected) in
        [(40, 22, None), (200, 23, None), (6, 23, Some(0)), (40, 23, Some(2353))]
    {
        let before = steps(&rig);
        rig.app.mouse(MouseEvent { x: x * cell + 32, y: y * cell + 32, kind }, rig.now);
        rig.wait(1);
        assert_eq!(steps(&rig), expected.unwrap_or(before), "{x}, {y}");
    }
}

#[test]
fn the_end_is_shown_until_the_run_begins_again() {
    let mut rig = watching("2 s stand\n");
    rig.wait(4000);
    assert_eq!(steps(&rig), 120);
    assert_eq!(rig.app.next_change(), None);
    assert!(rows(&mut rig, 1).contains("end"));
    tap(&mut rig, SPACE);
    rig.wait(500);
    assert!((20..40).contains(&steps(&rig)), "{}", steps(&rig));
}

#[test]
fn a_place_that_is_not_read_yet_is_shown_once_it_is() {
    let mut rig =
        Rig { app: playback(&"3600 s stand\n".repeat(2)), keyboard: None, now: Duration::ZERO };
    rig.press(Key::End);
    rig.app.advance(rig.now);
    assert!(rows(&mut rig, 1).contains("reading"), "{}", rows(&mut rig, 1));
    rig.wait(10);
    assert_eq!(steps(&rig), 2 * 3600 * 60);
    assert!(rows(&mut rig, 1).contains("end"));
}

#[test]
fn the_free_camera_flies_without_the_player() {
    let mut rig = watching("60 s stand\n");
    tap(&mut rig, SPACE);
    type_in(&mut rig, "vv");
    let (before, checksum) = (rows(&mut rig, 24), rig.game().checksum());
    assert!(before.ends_with("free"), "{before}");
    rig.press(W);
    rig.wait(500);
    assert!(rig.app.is_stale());
    rig.release(W);
    rig.wait(50);
    assert_ne!(rows(&mut rig, 24), before);
    assert_eq!(rig.game().checksum(), checksum);
    assert_eq!(rig.app.next_change(), None);
}

#[test]
fn playing_on_with_the_intents_of_the_script_leads_to_the_same_result() {
    let script = script(WINS);
    for place in [0, 1, 3] {
        let mut rig = watching(WINS);
        tap(&mut rig, SPACE);
        tap(&mut rig, Key::Home);
        (0..place).for_each(|_| tap(&mut rig, Key::Right));
        // The free view adds the player's figure to the world.
        for _ in 0..3 {
            type_in(&mut rig, "v");
            rows(&mut rig, 1);
        }
        let from = steps(&rig) as usize;
        tap(&mut rig, Key::Enter);
        assert_eq!(rig.app.screen(), AppScreen::Paused);
        for (_, intents) in script.iter().skip(from) {
            rig.app.game.step(intents);
        }
        assert!(rig.app.game.is_finished());
        assert_eq!(rig.game().checksum(), checksum_after(WINS, script.steps()));
    }
}

#[test]
fn a_game_from_the_middle_of_a_run_does_not_count() {
    let mut rig = watching(&format!("{WINS}\n2 s stand\n"));
    tap(&mut rig, Key::End);
    tap(&mut rig, SPACE);
    tap(&mut rig, Key::End);
    tap(&mut rig, Key::Left);
    let from = steps(&rig) as usize;
    tap(&mut rig, Key::Enter);
    assert!(rows(&mut rig, 1).contains("unranked: "), "{}", rows(&mut rig, 24));
    tap(&mut rig, Key::Char('p'));
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    // The last steps before the exit, as a player would do them.
    for (_, intents) in script(WINS).iter().skip(from) {
        rig.app.game.step(intents);
        rig.app.record(intents, 1);
    }
    rig.wait(100);
    assert_eq!(rig.app.screen(), AppScreen::LevelDone);
    assert_eq!(rig.app.store.best("cellar", Difficulty::Normal), None);
    assert_eq!(rig.app.store.won(Difficulty::Normal).count(), 0);
    rig.app.leave();
    assert_eq!(rig.app.store.saves().count(), 0);
}

#[test]
fn an_unfinished_game_from_the_middle_of_a_run_is_not_saved() {
    let mut rig = watching(WINS);
    rig.wait(2000);
    tap(&mut rig, Key::Enter);
    tap(&mut rig, Key::Char('p'));
    rig.tap(W, 500);
    rig.app.leave();
    assert_eq!(rig.app.store.saves().count(), 0);
}

#[test]
fn the_help_lists_the_keys_of_the_playback() {
    let mut rig = watching(WINS);
    type_in(&mut rig, "?");
    let (before, help) = (steps(&rig), rows(&mut rig, 24));
    for key in ["space pauses", "step back", "slower", "a minute", "mark", "play on", "map"] {
        assert!(help.contains(key), "{key}: {help}");
    }
    assert!(!help.contains("smoke"), "{help}");
    rig.wait(1000);
    assert_eq!(steps(&rig), before, "the run goes on behind the help");
    type_in(&mut rig, "q");
    assert!(rig.app.has_left);
}

#[test]
fn a_small_window_shows_no_playback() {
    let mut rig = watching(WINS);
    for (width, height) in [(1, 1), (20, 6), (30, 7), (19, 6), (1000, 2), (40, 1)] {
        let mut screen = Buffer::empty(Rect::new(0, 0, width, height));
        for _ in 0..3 {
            rig.app.draw(&mut screen);
            type_in(&mut rig, "v");
        }
    }
}
