//! A full disk: every command that writes says so in one sentence, and the previous content of a
//! file is still in it.
#![cfg(unix)]

use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use crate::support::cellcaster;

const SCRIPT: &str = "maps/showcase.script";

/// An empty folder for the test `name`.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("full_disk").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Asserts that the program printed `sentence`, and nothing else, and failed.
#[track_caller]
fn assert_failed(output: &Output, sentence: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(said, format!("cellcaster: {sentence}\n"));
    assert_eq!(output.status.code(), Some(1));
}

/// Runs the program with a limit of `blocks` of 512 bytes for each file.
fn run_without_room(blocks: u32, arguments: &[&str]) -> Output {
    // Without the trap, the signal would end the program.
    let limit = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let program = env!("CARGO_BIN_EXE_cellcaster");
    let shell = ["-c", &limit, program];
    Command::new("sh").args(shell).args(arguments).stdin(Stdio::null()).output().unwrap()
}

#[test]
fn every_command_reports_that_standard_output_is_full() {
    let map = "tests/maps/cross.toml";
    let commands: [&[&str]; 16] = [
        &["--help"],
        &["--version"],
        &["help", "play"],
        &["completions", "bash"],
        &["man"],
        &["config"],
        &["levels"],
        &["levels", "--format", "json"],
        &["check", map],
        &["snapshot", map, "--format", "text"],
        &["snapshot", map, "--format", "ansi"],
        &["snapshot", map, "--format", "json"],
        &["snapshot", map, "--format", "png"],
        &["snapshot", map, "--explain"],
        &["replay", "--verify", SCRIPT, "citadel"],
        &["share", SCRIPT, "citadel", "--size", "20x6", "--format", "cast"],
    ];
    for arguments in commands {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = cellcaster(arguments).stdout(full).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        let sentence = "cellcaster: standard output can't be written: No space left on device";
        assert!(said.starts_with(sentence) && said.lines().count() == 1, "{arguments:?}: {said}");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    }
}

#[test]
fn unanswered_rays_are_reported() {
    let rays = "2.5 2.5 1 0\n".repeat(1000);
    let folder = scratch("rays");
    fs::write(folder.join("rays"), rays).unwrap();
    let full = File::options().write(true).open("/dev/full").unwrap();
    let rays = File::open(folder.join("rays")).unwrap();
    let output = cellcaster(&["cast"]).stdin(rays).stdout(full).output().unwrap();
    let sentence = "standard output can't be written: No space left on device (os error 28)";
    assert_failed(&output, sentence);
}

#[test]
fn a_recording_without_room_keeps_the_previous_one() {
    let folder = scratch("replay");
    let cast = folder.join("walk.cast");
    let path = cast.to_str().unwrap();
    let arguments = ["share", SCRIPT, "citadel", "--size", "20x6", "--output", path];
    for blocks in [0, 1, 8] {
        for before in [None, Some("the recording before")] {
            _ = fs::remove_file(&cast);
            before.inspect(|before| fs::write(&cast, before).unwrap());
            let output = run_without_room(blocks, &arguments);
            assert_failed(
                &output,
                &format!("{path} can't be written: File too large (os error 27)"),
            );
            assert_eq!(fs::read_to_string(&cast).ok().as_deref(), before);
            assert_eq!(fs::read_dir(&folder).unwrap().count(), usize::from(before.is_some()));
        }
    }
    assert!(run_without_room(1 << 20, &arguments).status.success());
    assert!(fs::read_to_string(&cast).unwrap().starts_with("{\"term\""));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn devices_and_link_targets_are_written_in_place() {
    let folder = scratch("link");
    let (file, link, full) =
        (folder.join("file.cast"), folder.join("link.cast"), folder.join("full.cast"));
    fs::write(&file, "before").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let share = |path: &PathBuf| {
        let path = path.to_str().unwrap();
        cellcaster(&["share", SCRIPT, "citadel", "--size", "20x6", "--output", path])
            .output()
            .unwrap()
    };
    assert!(share(&link).status.success());
    assert!(link.is_symlink());
    assert!(fs::read_to_string(&file).unwrap().starts_with("{\"term\""));
    let sentence = "can't be written: No space left on device (os error 28)";
    assert_failed(&share(&full), &format!("{} {sentence}", full.display()));
    assert!(full.is_symlink());
}

#[test]
fn a_game_that_cannot_start_keeps_the_previous_recording() {
    let folder = scratch("record");
    for name in ["walk.cast", "walk.script"] {
        let path = folder.join(name);
        fs::write(&path, "the recording before").unwrap();
        let arguments = ["play", "--force", "--record", path.to_str().unwrap()];
        // There is no terminal.
        let output = cellcaster(&arguments).stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(fs::read_to_string(&path).unwrap(), "the recording before");
    }
}
