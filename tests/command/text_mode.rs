//! `play --text`: whole games by commands in lines of text.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Output, Stdio};

use crate::support::{cellcaster, complaint_about, run_with_input};

/// A key, a door that needs it, and an exit behind the door.
const MAP: &str = "
title = 'Cell'
grid = '''
#########
#@..k+.X#
#########
'''
[tiles]
'#' = { wall = 'brick' }
'+' = { door = 'oak', key = 'brass' }
[things]
'@' = { start = 0 }
'k' = { key = 'brass' }
'X' = { exit = true }
";

/// A warden who comes towards the player.
const AMBUSH: &str = "
title = 'Ambush'
grid = '''
###########
#@.....w..#
###########
'''
[tiles]
'#' = { wall = 'brick' }
[things]
'@' = { start = 0 }
'w' = { guard = 'warden', heading = 180 }
";

/// A path for a file of the test `test`.
fn path(test: &str, name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("text_mode").join(test);
    folder.join(name).to_str().unwrap().to_owned()
}

/// The program's answers to `commands` in `map`, in an empty folder of the test `test`.
fn play(test: &str, map: &str, more: &[&str], commands: &[&str]) -> String {
    _ = fs::remove_dir_all(path(test, ""));
    fs::create_dir_all(path(test, "data")).unwrap();
    let file = path(test, "map.toml");
    fs::write(&file, map).unwrap();
    let mut arguments = vec!["play", &file, "--text"];
    arguments.extend(more);
    let mut child = cellcaster(&arguments)
        .env("CELLCASTER_DATA", path(test, "data"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let input = commands.join("\n") + "\n";
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let Output { status, stdout, stderr } = child.wait_with_output().unwrap();
    let errors = String::from_utf8(stderr).unwrap();
    assert!(status.success() && errors.is_empty(), "{errors}");
    String::from_utf8(stdout).unwrap()
}

#[test]
fn a_level_is_won_by_typing() {
    let script = path("won", "run.script");
    let commands = ["forward 3", "open", "wait 2", "forward 3", "quit"];
    let told = play("won", MAP, &["--record", &script], &commands);
    insta::assert_snapshot!(told);
    // The commands are a game like any other.
    let verified = run_with_input(&["replay", &script, &path("won", "map.toml"), "--verify"], b"");
    let verified = String::from_utf8(verified.stdout).unwrap();
    assert!(verified.contains("won"), "{verified}");
}

#[test]
fn a_guard_is_announced_and_a_death_says_who_it_was() {
    let commands = ["forward 1", "wait 60", "wait 60", "wait 60", "wait 60", "wait 60", "wait 60"];
    let told = play("ambush", AMBUSH, &["--difficulty", "hard"], &commands);
    insta::assert_snapshot!(told);
}

#[test]
fn mistakes_are_one_sentence_and_change_nothing() {
    let commands = ["fly", "forward -1", "forward x", "wait 1000", "", "menu", "9", "fly", "back"];
    let told = play("mistakes", MAP, &[], &commands);
    insta::assert_snapshot!(told);
}

#[test]
fn options_that_do_not_fit_are_rejected() {
    let cast = complaint_about(&["play", "cellar", "--text", "--record", "run.cast"]);
    assert!(cast.contains("FILE.script"), "{cast}");
    let standard_input = complaint_about(&["play", "-", "--text"]);
    assert!(standard_input.contains("name a map file"), "{standard_input}");
}

#[test]
fn no_line_is_too_long_or_too_strange() {
    let long = "x".repeat(100_000);
    let commands = [&*long, "\u{1b}[A", "forward 99999999999999999999", "left 1e400", "quit"];
    let told = play("long", MAP, &[], &commands);
    assert!(told.len() < 50_000, "{}", told.len());
}
