//! `levels` and `replay --verify`: the best results, and the result of a script.
#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;
use std::{env, fs};

use cellcaster::app::store::{Run, Store};
use cellcaster::game::{Rank, Share, Tally};
use cellcaster::map::builtin;
use cellcaster::world::Difficulty;
use serde_json::Value;

use crate::support::{cellcaster, run_with_input};

/// An empty folder for the test `name`.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("scores").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs `levels` with a data folder in which a run is stored.
fn levels(name: &str, arguments: &[&str]) -> String {
    let folder = scratch(name);
    let (mut store, _) = Store::open(&folder);
    let tally = Tally { steps: 4567, treasure: Share { found: 1, total: 2 }, ..Tally::default() };
    store.record(
        "cellar",
        Difficulty::Hard,
        Run { tally, rank: Rank::Shadow, script: String::new() },
    );
    let output = cellcaster(arguments).env("CELLCASTER_DATA", &folder).output().unwrap();
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn levels_are_listed_in_order_with_best_results() {
    let table = levels("table", &["levels"]);
    assert_eq!(table.lines().count(), builtin::LEVELS.len() + 1);
    let row = table.lines().find(|line| line.contains("cellar")).unwrap();
    assert!(row.ends_with("1:16.1 Shadow"), "{row}");
    let list: Value =
        serde_json::from_str(&levels("json", &["levels", "--format", "json"])).unwrap();
    for (index, (entry, level)) in list.as_array().unwrap().iter().zip(builtin::LEVELS).enumerate()
    {
        assert_eq!(entry["order"], index + 1);
        assert_eq!(entry["name"], level.name);
        assert_eq!(entry["title"], level.world().unwrap().title());
        let best = &entry["best"]["hard"]["steps"];
        assert_eq!(*best, if level.name == "cellar" { 4567.into() } else { Value::Null });
    }
}

#[test]
fn a_newer_data_folder_is_reported_and_left_alone() {
    let folder = scratch("newer");
    fs::write(folder.join("progress.toml"), "version = 9\n").unwrap();
    let output = cellcaster(&["levels"]).env("CELLCASTER_DATA", &folder).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let sentence = String::from_utf8(output.stderr).unwrap();
    assert!(sentence.contains("version 9") && sentence.lines().count() == 1, "{sentence}");
}

/// A test with several processes starts itself with this variable, which names the data folder and
/// the game.
const GAME: &str = "CELLCASTER_TEST_GAME";

#[test]
fn two_processes_recording_at_once_lose_nothing() {
    const RUNS: u64 = 20;
    if let Ok(game) = env::var(GAME) {
        let (folder, number) = game.rsplit_once(':').unwrap();
        return record_runs(Path::new(folder), number.parse().unwrap(), RUNS);
    }
    let folder = scratch("processes");
    let itself = env::current_exe().unwrap();
    let start = |number: u64| {
        Command::new(&itself)
            .args(["--exact", "scores::two_processes_recording_at_once_lose_nothing"])
            .env(GAME, format!("{}:{number}", folder.display()))
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for mut process in [start(0), start(1)] {
        assert!(process.wait().unwrap().success());
    }
    let (store, sentence) = Store::open(&folder);
    assert_eq!((store.won(Difficulty::Normal).count() as u64, sentence), (2 * RUNS + 1, None));
    let least = 1000 - 2 * RUNS + 1;
    assert_eq!(store.best("same", Difficulty::Normal).unwrap().tally.steps, least);
    assert_eq!(store.script("same", Difficulty::Normal), Some(least.to_string()));
}

/// Records runs in levels of this process alone, and in a level that both processes play.
fn record_runs(folder: &Path, number: u64, runs: u64) {
    let (mut store, _) = Store::open(folder);
    for index in 0..runs {
        let steps = 1000 - (2 * index + number);
        for level in [format!("own {number} {index}"), "same".to_owned()] {
            let tally = Tally { steps, ..Tally::default() };
            let run = Run { tally, rank: Rank::Thief, script: steps.to_string() };
            store.record(&level, Difficulty::Normal, run);
            // Locks are not fair: without a pause, one process could keep the other waiting.
            thread::sleep(Duration::from_millis(4));
        }
    }
    assert_eq!(store.trouble(), None);
}

const MAP: &str = "title = \"Hall\"\npar = 5\ngrid = '''\n#######\n#@...X#\n#######\n'''\n[tiles]\n\
                   \"#\" = { wall = \"brick\" }\n[things]\n\"@\" = { start = 0 }\n\"X\" = { exit = true }\n";

/// Verifies a script, with further arguments.
fn verify(name: &str, script: &str, arguments: &[&str]) -> Output {
    let folder = scratch(name);
    let path = folder.join("it.script");
    fs::write(&path, script).unwrap();
    let words = [&["replay", path.to_str().unwrap(), "--verify"], arguments].concat();
    run_with_input(&words, b"")
}

#[test]
fn the_exit_status_tells_whether_a_script_wins() {
    let folder = scratch("map");
    let map = folder.join("hall.toml");
    fs::write(&map, MAP).unwrap();
    let script = format!("level {}\ndifficulty hard\nseed 7\n\n5 s forward\n", map.display());
    let won = verify("won", &script, &[]);
    let report = String::from_utf8(won.stdout).unwrap();
    assert_eq!(won.status.code(), Some(0), "{report}");
    let report = report.replace(map.to_str().unwrap(), "hall.toml");
    insta::assert_snapshot!(report);
    // MAP takes precedence, and without a header, the usual rules apply.
    let map = map.to_str().unwrap();
    let other = verify("other", "level cellar\n2 steps forward\n", &[map]);
    let report = String::from_utf8(other.stdout).unwrap();
    assert_eq!(other.status.code(), Some(1), "{report}");
    assert!(report.contains("difficulty normal") && report.contains("not won"), "{report}");
    assert!(other.stderr.is_empty() && !report.contains("rank"));
}

#[test]
fn a_script_can_name_a_floor_as_its_level() {
    let report = |name| {
        let output = verify(name, "level floor 2\nseed 20261122\n\n2 s forward\n", &[]);
        assert_eq!(output.status.code(), Some(1));
        String::from_utf8(output.stdout).unwrap()
    };
    let first = report("floor");
    assert!(first.contains("level      floor 2") && first.contains("floors     0"), "{first}");
    assert_eq!(first, report("floor again"));
}

#[test]
fn a_descent_takes_no_level() {
    for arguments in [
        &["play", "--daily", "--endless"][..],
        &["play", "--daily", "--difficulty", "hard"],
        &["play", "--endless", "cellar"],
    ] {
        let output = cellcaster(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let sentence = String::from_utf8(output.stderr).unwrap();
        assert!(sentence.contains(" cannot be combined with "), "{sentence}");
    }
}

#[test]
fn missing_input_is_reported_in_one_sentence() {
    let told = |name, script, arguments: &[&str]| {
        let output = verify(name, script, arguments);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(told("nameless", "1 s forward\n", &[]).contains("does not name its level"));
    let generated = told("generated", "1 s forward\n", &["--generate", "maze"]);
    assert!(generated.contains("--verify"), "{generated}");
    let folder = scratch("broken");
    let path = folder.join("it.script");
    fs::write(&path, b"level cellar\n[caf\xe9]\n1 s forward\n").unwrap();
    let broken = run_with_input(&["replay", path.to_str().unwrap(), "--verify"], b"");
    let sentence = String::from_utf8(broken.stderr).unwrap();
    assert_eq!(broken.status.code(), Some(2));
    assert!(sentence.contains("line 2 has an invalid byte"), "{sentence}");
    assert!(told("faulty", "level cellar\n1 s fly\n", &[]).contains("fly"));
    assert!(told("absent", "level nowhere.toml\n1 s forward\n", &[]).contains("no file"));
}
