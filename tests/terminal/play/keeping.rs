//! The stored data of a game: in a folder that cannot be written, and in the script of a descent.

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
    play_daily_by(&[PROGRAM], data, options)
}

/// The same as [`play_daily`], with `program` in front of the arguments.
fn play_daily_by(program: &[&str], data: &Path, options: &[&str]) -> String {
    let environment = [&ENVIRONMENT[..], &[("CELLCASTER_DATA", data.to_str().unwrap())]].concat();
    let arguments = [&program[1..], &["play", "--daily"], options].concat();
    let mut player = Player::start((100, 24), Speaks::Plain, program[0], arguments, &environment);
    player.wait_for("> Begin the try that counts");
    player.send("\r");
    player.wait_for("? help");
    // The floor differs each day, so the test cannot know whether the player can walk or is seen.
    // Turning takes its steps on all floors.
    player.send("\x1b[C".repeat(12));
    player.wait_for("0:01");
    player.send("\x03");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
    player.text()
}

/// Runs the program under a limit at which no file can have any content.
const WITHOUT_ROOM: [&str; 4] = ["/bin/sh", "-c", "ulimit -f 0; exec \"$0\" \"$@\"", PROGRAM];

#[test]
fn a_full_disk_is_reported_and_loses_no_stored_data() {
    let folder = empty("full");
    let progress = folder.join("progress.toml");
    play_daily(&folder, &[]);
    let today = fs::read_to_string(&progress).unwrap();
    let date = today.split("[daily.").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    // With the run of another day, there is something to lose.
    let another_day = today.replace(date, "20200101");
    fs::write(&progress, &another_day).unwrap();
    let screen = play_daily_by(&WITHOUT_ROOM, &folder, &[]).replace('\n', "");
    assert_eq!(screen.matches("cellcaster: ").count(), 1, "{screen}");
    assert!(screen.contains("File too large") && screen.contains("not saved"), "{screen}");
    assert_eq!(fs::read_to_string(&progress).unwrap(), another_day);
    let names = fs::read_dir(&folder).unwrap().chain(fs::read_dir(folder.join("runs")).unwrap());
    let names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    assert!(!names.iter().any(|name| name.to_string_lossy().ends_with(".new")), "{names:?}");
    // Once there is room again, both days are stored.
    play_daily(&folder, &[]);
    let both = fs::read_to_string(&progress).unwrap();
    assert!(both.contains("[daily.20200101]") && both.contains(date), "{both}");
}

#[test]
fn an_unwritable_folder_is_reported_and_the_game_goes_on() {
    let blocked = empty("blocked");
    // If the user is root, permissions stop nothing, so a file stands in the way.
    fs::write(blocked.join("runs"), "").unwrap();
    for (data, reason) in
        [(blocked, "can't be written"), (empty("file").join("progress.toml"), "can't be")]
    {
        if reason == "can't be" {
            fs::write(&data, "").unwrap();
        }
        let screen = play_daily(&data, &[]).replace('\n', "");
        assert_eq!(screen.matches("cellcaster: ").count(), 1, "{screen}");
        assert!(screen.contains(reason) && screen.contains("not saved"), "{screen}");
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
