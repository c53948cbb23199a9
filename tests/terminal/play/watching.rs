//! Maps that change while they are shown, and maps that come from standard input.

use std::fs;
use std::path::{Path, PathBuf};

use super::game::{ENVIRONMENT, Key, PROGRAM, test_map};
use crate::emulator::Speaks;
use crate::player::Player;

const MAP: &str = r##"
title = "First"
grid = '''
#########
#@......#
#.......#
#########
'''
[tiles]
"#" = { wall = "#a04030" }
[things]
"@" = { start = 0 }
"##;

/// A new map file for the test `name`.
fn map(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("watching").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("map.toml");
    fs::write(&path, MAP).unwrap();
    path
}

/// Writes `text` as editors do: to another file, which then replaces the map.
fn save(path: &Path, text: &str) {
    let draft = path.with_extension("draft");
    fs::write(&draft, text).unwrap();
    fs::rename(draft, path).unwrap();
}

fn start(words: &[&str], path: &Path) -> Player {
    let words = words.iter().copied().chain([path.to_str().unwrap()]);
    Player::start((80, 24), Speaks::Kitty, PROGRAM, words, &ENVIRONMENT)
}

/// Waits until a panel shows `text`, with any line breaks.
#[track_caller]
fn wait_for_words(player: &Player, text: &str) {
    player.wait_until(&format!("said {text:?}"), |emulator| {
        let screen = emulator.text().replace('│', " ");
        let words: Vec<&str> = screen.split_whitespace().collect();
        words.join(" ").contains(text)
    });
}

#[test]
fn a_game_continues_in_the_newly_saved_map() {
    let path = map("play");
    let mut player = start(&["play", "--watch"], &path);
    player.wait_for("First");
    player.wait_for("? help");

    save(&path, &MAP.replace("First", "Second"));
    player.wait_for("Second");

    save(&path, &MAP.replace("First", "Third").replace("#@......#", "#@.....#"));
    player.wait_for("the map has faults");
    wait_for_words(&player, "row 2 of the grid has 8 cells");
    player.wait_for("Second");

    fs::remove_file(&path).unwrap();
    wait_for_words(&player, "there is no file");

    // A larger map with an exit.
    let larger = MAP.replace("#@......#", "#@......#\n#......X#");
    let larger = larger.replace("{ start = 0 }", "{ start = 0 }\n\"X\" = { exit = true }");
    save(&path, &larger.replace("First", "Fourth"));
    player.wait_until("was mended", |emulator| {
        emulator.text().contains("Fourth") && !emulator.text().contains("faults")
    });
    player.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    player.wait_for_end().assert_given_back();
}

#[test]
fn the_player_keeps_their_place_while_it_is_free() {
    let path = map("place");
    let mut player = start(&["play", "--watch"], &path);
    player.wait_for("? help");
    player.wait_until("asked for releases", |it| it.modes().key_flags == [0, 1]);
    let column = |player: &Player| {
        player.look(|emulator| {
            let row = emulator.text().lines().find(|line| line.contains('→'))?.to_owned();
            row.chars().position(|symbol| symbol == '→')
        })
    };
    let start = column(&player);
    player.send(Key::Char('w').event(1));
    player.wait_for_rest();
    player.send(Key::Char('w').event(3));
    let walked = column(&player);
    assert!(start.is_some() && walked > start, "{start:?} {walked:?}");

    save(&path, &MAP.replace("First", "Second").replace("a04030", "3040a0"));
    player.wait_for("Second");
    player.wait_for_rest();
    assert_eq!(column(&player), walked);

    // A wall at the player's position.
    save(&path, &MAP.replace("First", "Third").replace("#@......#", "#@...####"));
    player.wait_for("Third");
    player.wait_for_rest();
    assert_eq!(column(&player), start);
    player.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    player.wait_for_end().assert_given_back();
}

#[test]
fn a_map_from_standard_input_is_played_with_the_keys_of_the_terminal() {
    let script = "cat \"$1\" | \"$0\" play -; echo status $?";
    let map = test_map("corridor");
    let words = ["-c", script, PROGRAM, map.to_str().unwrap()];
    let mut player = Player::start((80, 24), Speaks::Kitty, "/bin/sh", words, &ENVIRONMENT);
    player.wait_for("? help");
    player.wait_until("asked for releases", |emulator| emulator.modes().key_flags == [0, 1]);
    player.send(Key::Char('q').event(1) + &Key::Enter.event(1));
    player.wait_for_end().assert_given_back();
    player.wait_for("status 0");
}

#[test]
fn a_png_is_not_written_to_a_terminal() {
    let words = ["snapshot", "--format", "png"];
    let mut player = Player::start((200, 24), Speaks::Plain, PROGRAM, words, &ENVIRONMENT);
    assert_eq!(player.wait_for_end().status.code(), Some(2));
    player.wait_for("redirect it to a file");
    assert!(player.bytes_written() < 300, "{}", player.text());
}
