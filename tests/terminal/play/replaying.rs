//! Recorded runs, watched in a terminal.

use std::fs;
use std::path::{Path, PathBuf};

use super::game::{ENVIRONMENT, PROGRAM};
use crate::emulator::Speaks;
use crate::player::Player;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("replaying").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Starts the replay of a file in a terminal that answers nothing.
fn replay(file: &Path, data: &Path) -> Player {
    let data = [("CELLCASTER_DATA", data.to_str().unwrap())];
    let environment = [&ENVIRONMENT[..], &data].concat();
    let arguments = ["replay", file.to_str().unwrap()];
    Player::start((80, 24), Speaks::Plain, PROGRAM, arguments, &environment)
}

#[test]
fn a_run_is_watched_from_all_sides_and_played_on() {
    let data = folder("watched");
    let script = Path::new("maps/scripts/observatory.normal.script");
    let mut player = replay(script, &data);
    player.wait_for("? help");
    player.send(" ");
    player.wait_for("paused");
    player.send("n");
    player.wait_for("0:10 ━");
    player.send("v");
    player.wait_for("paused  above");
    player.resize(100, 30);
    player.wait_for_rest();
    let screen = player.text();
    assert!(screen.trim_end().lines().last().unwrap().ends_with("paused  above"), "{screen}");
    player.send("v");
    player.wait_for("paused  free");
    player.send("wwww");
    player.wait_for_rest();
    player.send("?");
    player.wait_for("play on from here");
    player.send("?");
    player.send("\r");
    player.wait_for("this game does not count");
    player.send("\r");
    player.wait_until("played on", |emulator| !emulator.text().contains("Continue"));
    player.wait_for("unranked: The Observatory");
    player.send("q");
    player.wait_for("leave?");
    player.send("\r");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
    assert!(player.text().contains("The Observatory on normal, unranked: 0:1"));
    let kept = fs::read_to_string(data.join("progress.toml")).unwrap_or_default();
    assert!(!kept.contains("observatory"), "{kept}");
    assert!(!data.join("runs").exists());
}

#[test]
fn leaving_a_replay_asks_nothing() {
    let data = folder("left");
    let mut player = replay(Path::new("maps/scripts/cellar.normal.script"), &data);
    player.wait_for("| 0:");
    player.send("q");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

#[test]
fn a_damaged_script_leaves_the_screen_alone() {
    let data = folder("damaged");
    let script = data.join("damaged.script");
    fs::write(&script, "level cellar\n1 s foward\n").unwrap();
    let mut player = replay(&script, &data);
    let ending = player.wait_for_end();
    assert_eq!(ending.status.code(), Some(2));
    let screen = player.text();
    assert!(screen.contains("unknown intent \"foward\""), "{screen}");
    assert!(!player.modes().alternate_screen, "{screen}");
}
