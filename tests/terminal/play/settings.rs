//! The effect of the command line and of the configuration.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::game::{ENVIRONMENT, Game, Key, PROGRAM};
use crate::emulator::{Modes, Speaks};
use crate::player::Player;
use crate::support::{complaint_about, output_of};

fn file(name: &str, text: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_named_configuration_remaps_the_keys() {
    let azerty = file("azerty.toml", "preset = \"azerty\"\n");
    let options = ["--config", azerty.to_str().unwrap()];
    let game = Game::with(Speaks::Kitty, (80, 24), None, &options, &[]);
    let before = game.arrow();
    game.press(Key::Char('z'));
    game.wait_for_arrow("walked", |arrow| arrow.column > before.column);
}

#[test]
fn the_users_own_configuration_is_found() {
    let config = file("own/cellcaster/config.toml", "[keys]\nforward = \"e\"\n");
    let folder = config.parent().unwrap().parent().unwrap().to_str().unwrap();
    let environment = [("XDG_CONFIG_HOME", folder)];
    let game = Game::with(Speaks::Kitty, (80, 24), None, &[], &environment);
    let before = game.arrow();
    game.press(Key::Char('e'));
    game.wait_for_arrow("walked", |arrow| arrow.column > before.column);
}

#[test]
fn options_take_precedence_over_settings_in_a_file() {
    let text = "glyphs = \"ascii\"\nminimap = \"off\"\nfov = 90\n";
    let config = file("settings.toml", text);
    let config = ["--config", config.to_str().unwrap()];
    let game = Game::with(Speaks::Kitty, (80, 24), None, &config, &[]);
    assert!(!game.text().contains("┌map") && !game.text().contains('▀'), "{}", game.text());
    game.wait_for("Find the way out");
    let options = [&config[..], &["--glyphs", "half"]].concat();
    let game = Game::with(Speaks::Kitty, (80, 24), None, &options, &[]);
    game.wait_for_bare_picture(&["--fov", "90"]);
}

#[test]
fn config_prints_an_equivalent_file() {
    let text = "preset = \"azerty\"\nfps = 60\ncolors = 16\n[keys]\nleave = \"f10\"\n";
    let written = file("written.toml", text);
    let config = |path: &PathBuf| {
        let printed = output_of(&["config", "--config", path.to_str().unwrap()]);
        let printed = String::from_utf8(printed).unwrap();
        let (place, settings) = printed.split_once('\n').unwrap();
        assert!(place.starts_with("# ") && place.ends_with(path.to_str().unwrap()), "{place}");
        (printed.clone(), settings.to_owned())
    };
    let (printed, settings) = config(&written);
    for line in ["preset = \"azerty\"", "fps = 60", "colors = \"16\"", "leave = [\"f10\"]"] {
        assert!(settings.contains(line), "{line} is not in\n{settings}");
    }
    let (_, again) = config(&file("printed.toml", &printed));
    assert_eq!(again, settings);
    let complaint = complaint_about(&["config", "cellar"]);
    assert!(complaint.contains("\"cellar\" is one argument too many"), "{complaint}");
}

#[test]
fn a_bad_configuration_is_an_error_that_names_the_line() {
    let bad = file("bad.toml", "[keys]\nforward = \"w\"\nforwards = \"x\"\n");
    let complaint = complaint_about(&["play", "--config", bad.to_str().unwrap()]);
    assert!(complaint.contains("bad.toml:3:1"), "{complaint}");
    let complaint = complaint_about(&["play", "--config", "no such file"]);
    assert!(complaint.contains("no such file"), "{complaint}");
}

#[cfg(unix)]
#[test]
fn a_pipe_as_a_configuration_is_refused_without_waiting() {
    let pipe = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pipe.toml");
    _ = fs::remove_file(&pipe);
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for command in ["play", "config"] {
        let complaint = complaint_about(&[command, "--config", pipe.to_str().unwrap()]);
        let expected = "pipe.toml can't be read: it is a named pipe, not a file";
        assert!(complaint.contains(expected), "{complaint}");
    }
}

#[test]
fn a_bad_map_is_reported_without_touching_the_terminal() {
    let map = file("bad_map.toml", "grid = '''\n#@#\n'''\n[things]\n\"@\" = { start = 0 }\n");
    let map = map.to_str().unwrap();
    let complaint = complaint_about(&["play", map]);
    assert!(complaint.contains("bad_map.toml:2:1"), "{complaint}");

    let mut player = Player::start((80, 24), Speaks::Kitty, PROGRAM, ["play", map], &ENVIRONMENT);
    let ending = player.wait_for_end();
    assert_eq!(ending.status.code(), Some(2));
    player.wait_for("bad_map.toml:2:1");
    assert_untouched(&player.bytes());
}

#[test]
fn without_a_terminal_one_sentence_names_what_works() {
    let complaint = complaint_about(&["play"]);
    assert!(complaint.contains("standard input"), "{complaint}");
    assert!(complaint.contains("`cellcaster snapshot`"), "{complaint}");
    assert_eq!(complaint.lines().count(), 1, "{complaint}");

    let script = "\"$0\" play > /dev/null; echo status $?";
    let arguments = ["-c", script, PROGRAM];
    let mut player = Player::start((200, 24), Speaks::Kitty, "/bin/sh", arguments, &ENVIRONMENT);
    player.wait_for_end().assert_given_back();
    player.wait_for("standard output");
    player.wait_for("`cellcaster snapshot`");
    player.wait_for("status 2");
    assert_untouched(&player.bytes());
    assert_eq!(player.modes(), Modes::default());
}

fn assert_untouched(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    assert!(!text.contains("\x1b[?"), "{text:?}");
}
