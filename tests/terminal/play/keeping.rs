//! What is kept of a game: in a folder that cannot be written, and in the script of a descent.

use std::fs;
use std::path::{Path, PathBuf};

use super::game::{ENVIRONMENT, PROGRAM};
use crate::emulator::Speaks;
use crate::player::Player;
use crate::support::cellcaster;

fn empty(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("keeping").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Plays a few steps of the daily run, and leaves. Returns the last screen.
fn play_daily(data: &Path, options: &[&str]) -> String {
    let environment = [&ENVIRONMENT[..], &[("CELLCASTER_DATA", data.to_str().unwrap())]].concat();
    let arguments = [&["play", "--daily"], options].concat();
    let mut player = Player::start((80, 24), Speaks::Plain, PROGRAM, arguments, &environment);
    player.wait_for("? help");
    player.send("w");
    player.wait_for_rest();
    player.send("\x03");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
    player.text()
}

#[test]
fn a_folder_that_cannot_be_written_costs_a_sentence_and_no_game() {
    let blocked = empty("blocked");
    // Where the user is root, permissions stop nobody: a file stands in the way.
    fs::write(blocked.join("runs"), "").unwrap();
    for (data, reason) in
        [(blocked, "can't be written"), (empty("file").join("progress.toml"), "can't be")]
    {
        if reason == "can't be" {
            fs::write(&data, "").unwrap();
        }
        let screen = play_daily(&data, &[]).replace('\n', "");
        assert_eq!(screen.matches("cellcaster: ").count(), 1, "{screen}");
        assert!(screen.contains(reason) && screen.contains("kept"), "{screen}");
        assert!(screen.contains("Floor 1 on normal: "), "{screen}");
    }
}

#[test]
fn the_script_of_a_daily_run_names_the_floor_and_the_day() {
    let folder = empty("daily");
    let script = folder.join("daily.script");
    let script = script.to_str().unwrap();
    play_daily(&folder, &["--record", script]);
    let date = fs::read_to_string(folder.join("progress.toml")).unwrap();
    let date = date.split("[daily.").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let output = cellcaster(&["replay", script, "--verify"]).output().unwrap();
    let report = String::from_utf8(output.stdout).unwrap();
    let begins = format!("level      floor 1\ndifficulty normal\nseed       {date}\n");
    assert!(report.starts_with(&begins), "{report}");
    assert_eq!(output.status.code(), Some(1));
}
