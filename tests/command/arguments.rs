//! The command line: help, completions and the manual page, which are made from one description;
//! the position of options; and one sentence for each mistake.
#![cfg(feature = "cli")]

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Stdio;

use crate::support::{cellcaster, complaint_about, output_of, run_with_input};

const SUBCOMMANDS: &[&str] = &[
    "play",
    "snapshot",
    "cast",
    "check",
    "levels",
    "replay",
    "share",
    "config",
    "completions",
    "man",
];

const MAP: &str = "tests/maps/cross.toml";

fn text_of(arguments: &[&str]) -> String {
    String::from_utf8(output_of(arguments)).unwrap()
}

/// An empty folder for the test `name`.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("command").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The options in the help of `subcommand`.
fn options_of(subcommand: &str) -> BTreeSet<String> {
    let help = text_of(&[subcommand, "-h"]);
    let lines = help.lines().filter(|line| line.starts_with("  "));
    let words = lines.flat_map(str::split_whitespace);
    words
        .filter(|word| word.starts_with("--"))
        .map(|word| word.trim_end_matches(',').to_owned())
        .collect()
}

#[test]
fn every_subcommand_explains_itself_in_80_columns() {
    for &subcommand in SUBCOMMANDS {
        let long = text_of(&[subcommand, "--help"]);
        let short = text_of(&[subcommand, "-h"]);
        assert!(long.lines().chain(short.lines()).all(|line| line.chars().count() <= 80));
        assert!(long.lines().count() > short.lines().count(), "{subcommand}");
        assert_eq!(text_of(&["help", subcommand]), long);
    }
}

#[test]
fn the_help_of_the_program_is_enough_to_use_it() {
    let long = text_of(&["--help"]);
    assert_eq!(text_of(&["help"]), long);
    assert_eq!(text_of(&["help", "--help"]), long);
    assert!(long.lines().all(|line| line.chars().count() <= 80));
    for &subcommand in SUBCOMMANDS {
        assert!(long.contains(&format!("  {subcommand} ")), "no {subcommand}");
        for option in options_of(subcommand) {
            assert!(long.contains(&option), "no {option} of {subcommand}");
        }
    }
    for words in ["strafe left", "look up", "2.5 s forward run", "\"X Y DX DY\"", "Exit status"] {
        assert!(long.contains(words), "no {words}");
    }
    assert!(text_of(&["-h"]).lines().count() < long.lines().count() / 2);
}

#[test]
fn the_version_matches_the_package() {
    let version = format!("cellcaster {}\n", cellcaster::VERSION);
    assert!(version.starts_with(concat!("cellcaster ", env!("CARGO_PKG_VERSION"))));
    assert_eq!([text_of(&["--version"]), text_of(&["-V"])], [&*version, &*version]);
}

#[test]
fn completions_and_the_manual_page_know_every_subcommand_and_option() {
    let manual = text_of(&["man"]).replace("\\-", "-");
    let completions = ["bash", "zsh", "fish"].map(|shell| text_of(&["completions", shell]));
    for &subcommand in SUBCOMMANDS {
        assert!(manual.contains(&subcommand.to_uppercase()), "no {subcommand} in the manual");
        for script in &completions {
            assert!(script.contains(subcommand), "no {subcommand} in\n{script}");
        }
        let options = options_of(subcommand);
        assert!(options.contains("--help"), "{options:?}");
        for option in options {
            assert!(manual.contains(&option), "no {option} in the manual");
            // Fish lists the name without its dashes.
            let name = option.trim_start_matches('-');
            for script in &completions {
                assert!(script.contains(name), "no {option} of {subcommand} in\n{script}");
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn bash_completes_subcommands_options_and_values() {
    let complete = |words: &str| {
        let script = format!(
            "source <(\"$0\" completions bash); COMP_WORDS=({words}); \
             COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             _cellcaster cellcaster \"${{COMP_WORDS[-1]}}\" \"${{COMP_WORDS[-2]}}\"; \
             echo \"${{COMPREPLY[@]}}\""
        );
        let program = env!("CARGO_BIN_EXE_cellcaster");
        let output =
            std::process::Command::new("bash").args(["-c", &script, program]).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    };
    assert_eq!(complete("cellcaster sna"), "snapshot");
    assert_eq!(complete("cellcaster snapshot --expl"), "--explain");
    assert_eq!(complete("cellcaster snapshot --colors ''"), "true 256 16 mono");
    assert_eq!(complete("cellcaster completions f"), "fish");
}

#[test]
fn options_may_stand_before_the_subcommand() {
    let size = ["--size", "20x4"];
    let after =
        output_of(&[&["snapshot", "--format", "ansi", "--colors", "256"], &size[..]].concat());
    for before in [
        &["--colors", "256", "snapshot", "--format", "ansi"][..],
        &["--format", "ansi", "--colors=256", "snapshot"],
    ] {
        assert_eq!(output_of(&[before, &size[..]].concat()), after, "{before:?}");
    }
    assert!(text_of(&["-h", "check"]).contains("Usage: cellcaster check"));
}

#[test]
fn the_last_of_several_equal_options_counts() {
    let once = output_of(&["snapshot", "--size", "9x3", "--fov", "100"]);
    assert_eq!(output_of(&["snapshot", "--fov", "20", "--size", "9x3", "--fov", "100"]), once);
}

#[test]
fn each_mistake_is_reported_in_one_sentence() {
    let refused: [&[&str]; 31] = [
        &["plya"],
        &["cellar", "snapshot"],
        &["cellar", "museum"],
        &["--fsp", "30"],
        &["--cast", "x"],
        &["-x"],
        &["--stats=yes"],
        &["--config"],
        &["--config="],
        &["--fps", "0"],
        &["--fps", "--stats"],
        &["--fidelity", "medium"],
        &["--", "--help"],
        &["snapshot", "--version"],
        &["--colors", "256", "check", MAP],
        &["check"],
        &["check", "-", "-"],
        &["cast", "-"],
        &["replay"],
        &["replay", "a", "b", "c"],
        &["completions"],
        &["completions", "tcsh"],
        &["man", "snapshot"],
        &["help", "snapsht"],
        &["help", "nonsense"],
        &["--watch"],
        &["--watch", "cellar"],
        &["--watch", "absent.toml"],
        &["--watch", "-"],
        &["--watch", "--generate", "maze"],
        &["--watch", "--record", "walk.script", MAP],
    ];
    let complaints = refused.map(|arguments| {
        let complaint = complaint_about(arguments);
        assert_eq!(complaint.lines().count(), 1, "{complaint}");
        format!("{}\n  {complaint}", arguments.join(" "))
    });
    insta::assert_snapshot!(complaints.concat());
}

#[test]
fn a_map_may_come_from_standard_input() {
    let map = fs::read(MAP).unwrap();
    let size = ["--size", "20x4"];
    let of_file = output_of(&[&["snapshot", MAP], &size[..]].concat());
    let output = run_with_input(&[&["snapshot", "-"], &size[..]].concat(), &map);
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.stdout == of_file);

    let output = run_with_input(&["check", "-"], b"grid = 3\n");
    assert_eq!(output.status.code(), Some(2));
    let report = String::from_utf8(output.stderr).unwrap();
    assert!(report.contains("<standard input>:1:8"), "{report}");
}

#[test]
fn a_missing_file_is_the_only_reported_fault() {
    assert_eq!(complaint_about(&["check", "absent.toml"]), "error: there is no file absent.toml\n");
    let complaint = complaint_about(&["check", "absent.toml", "absent2.toml"]);
    insta::assert_snapshot!(complaint, @r"
    error: there is no file absent.toml
    error: there is no file absent2.toml
    cellcaster: 2 of 2 maps have faults; see above
    ");
    let output = cellcaster(&["check", MAP, "tests/bad_maps/no_start.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stdout).contains("cross.toml: valid"));
    let report = String::from_utf8(output.stderr).unwrap();
    assert!(report.ends_with("cellcaster: 1 of 2 maps have faults; see above\n"), "{report}");
}

#[test]
fn a_recording_replaces_no_file_and_needs_a_known_extension() {
    let folder = scratch("recording");
    let taken = folder.join("taken.cast");
    fs::write(&taken, "precious").unwrap();
    let told = |name: &str, options: &[&str]| {
        let path = folder.join(name);
        let words = [&["play", "--record", path.to_str().unwrap()], options].concat();
        complaint_about(&words).replace(&format!("{}/", folder.display()), "")
    };
    insta::assert_snapshot!(told("taken.cast", &[]), @"cellcaster: taken.cast already exists: name another file, or replace it with --force");
    assert_eq!(fs::read_to_string(&taken).unwrap(), "precious");
    insta::assert_snapshot!(told("walk.txt", &[]), @r#"cellcaster: --record takes a file that ends in .cast (for the terminal's output) or in .script (for your actions), not "walk.txt""#);
    assert_eq!(told("cast", &[]), told("walk.txt", &[]).replace("walk.txt", "cast"));
    // Without a terminal, the game leaves no file that would prevent the next recording.
    for name in ["new.cast", "new.script"] {
        assert!(told(name, &[]).contains("playing needs a terminal"));
        assert!(!folder.join(name).exists(), "{name} was left behind");
    }
    assert!(told("taken.cast", &["--force"]).contains("playing needs a terminal"));
}

#[test]
fn without_a_terminal_over_ssh_the_error_names_the_option() {
    let output = cellcaster(&[])
        .env("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(String::from_utf8_lossy(&output.stderr), @"cellcaster: playing needs a terminal, which ssh provides only with -t: ssh -t HOST cellcaster");
}
