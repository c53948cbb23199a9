//! Recordings of games.

use std::fs;
use std::path::{Path, PathBuf};

use rustix::process::Signal;
use vt100::Parser;

use super::game::{Game, Key, test_map};
use crate::asciicast::Asciicast;
use crate::emulator::Speaks;
use crate::looks::looks;
use crate::support::output_of;

/// A game that is recorded in a new file with this name.
fn recorded(name: &str) -> (Game, PathBuf) {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let options = ["--force", "--record", path.to_str().unwrap()];
    (Game::with(Speaks::Kitty, (80, 24), None, &options, &[]), path)
}

fn walk_a_little(game: &Game) {
    let before = game.arrow();
    game.press(Key::Char('w'));
    game.press(Key::Right);
    game.wait_for_arrow("walked", |arrow| (arrow.column, arrow.row) != (before.column, before.row));
    game.release(Key::Right);
    game.release(Key::Char('w'));
    game.wait_for_rest();
}

#[test]
fn a_recording_holds_exactly_what_the_terminal_was_sent() {
    let (mut game, path) = recorded("game.cast");
    walk_a_little(&game);
    game.resize(100, 30);
    game.wait_for_rest();
    game.leave();
    game.wait_for_end();
    let recording = Asciicast::read(&fs::read_to_string(path).unwrap());
    assert_eq!((recording.columns, recording.rows), (80, 24));
    let sent = recording.sent();
    assert!(!sent.is_empty() && game.bytes().starts_with(sent.as_bytes()));
    assert!(sent.ends_with("\x1b[?1049l"), "the end is missing");
    let sizes = recording.events.iter().filter(|event| event.code == "r");
    assert_eq!(sizes.map(|event| event.data.as_str()).collect::<Vec<_>>(), ["100x30"]);
}

#[cfg(unix)]
#[test]
fn other_users_cannot_read_a_recording() {
    use std::os::unix::fs::PermissionsExt;
    for name in ["private.cast", "private.script"] {
        _ = fs::remove_file(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        let (mut game, path) = recorded(name);
        game.press(Key::Right);
        game.wait_for_arrow("turned", |arrow| arrow.points != '→');
        assert_eq!(fs::metadata(path).unwrap().permissions().mode() & 0o777, 0o600);
        game.leave();
        game.wait_for_end();
    }
}

#[test]
fn a_killed_game_leaves_a_whole_file() {
    let (mut game, path) = recorded("killed.cast");
    game.press(Key::Right);
    game.wait_for_arrow("turned", |arrow| arrow.points != '→');
    game.signal(Signal::KILL);
    game.wait_for_end();
    let sent = Asciicast::read(&fs::read_to_string(path).unwrap()).sent();
    assert!(sent.len() > 10_000, "{}", sent.len());
}

#[test]
fn a_full_disk_ends_the_recording_but_not_the_game() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for name in ["full.cast", "full.script"] {
        let link = folder.join(name);
        _ = fs::remove_file(&link);
        std::os::unix::fs::symlink("/dev/full", &link).unwrap();
        let (mut game, path) = recorded(name);
        walk_a_little(&game);
        game.leave();
        let ending = game.wait_for_end();
        ending.assert_given_back();
        assert_eq!(ending.status.code(), Some(1));
        let screen = game.text().replace('\n', "");
        assert_eq!(screen.matches("cellcaster: ").count(), 1, "{screen}");
        assert!(screen.contains("can't be written: No space left on device"), "{screen}");
        assert!(path.is_symlink());
    }
}

#[test]
fn a_recorded_walk_replays_to_the_same_picture() {
    let (mut game, path) = recorded("walk.script");
    walk_a_little(&game);
    let played = game.look(|emulator| looks(emulator.screen()));
    game.leave();
    game.wait_for_end();

    let map = test_map("cellar");
    let words = ["share", path.to_str().unwrap(), map.to_str().unwrap()];
    let file = output_of(&[&words[..], &["--format", "cast", "--fps", "30"]].concat());
    let recording = Asciicast::read(&String::from_utf8(file).unwrap());
    let (_, frames) = recording.events.split_last().unwrap();
    let mut terminal = Parser::new(24.try_into().unwrap(), 80.try_into().unwrap(), 0);
    for event in frames {
        terminal.process(event.data.as_bytes());
    }
    assert!(looks(terminal.screen()) == played, "{}", fs::read_to_string(path).unwrap());
}
