//! Hostile names and values: control bytes in them never reach the terminal.
#![cfg(unix)]

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::PathBuf;
use std::process::{Output, Stdio};

use crate::support::{cellcaster, output_of};

/// A title, a colour, a line break, a rubout and a C1 introducer, each in the form that a terminal
/// obeys. It contains no path separator.
const HOSTILE: &str = "h\u{1b}]0;title\u{7}\u{9b}31m\r\n\u{7f}\u{202e}";

/// The prefix of [`HOSTILE`] as the program shows it.
const SHOWN: &str = "h\\u{1b}]0;title\\u{7}\\u{9b}31m\\r";

/// An empty folder for the test `name`, whose own name is hostile.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{HOSTILE}"));
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs the program in its own folder, without input.
fn run<A: AsRef<OsStr>>(folder: &PathBuf, arguments: impl IntoIterator<Item = A>) -> Output {
    cellcaster(&[]).args(arguments).current_dir(folder).stdin(Stdio::null()).output().unwrap()
}

/// Returns the text, which must contain no control character except line breaks.
fn harmless(bytes: &[u8], about: &str) -> String {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    let obeyed = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
    assert!(!text.contains(obeyed), "{about}: {text:?}");
    text
}

fn subcommands() -> Vec<String> {
    let help = String::from_utf8(output_of(&["--help"])).unwrap();
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = list.take_while(|line| !line.is_empty());
    let names = names.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

fn options_of(subcommand: &str) -> BTreeSet<String> {
    let help = String::from_utf8(output_of(&[subcommand, "-h"])).unwrap();
    let words = help.lines().filter(|line| line.starts_with("  ")).flat_map(str::split_whitespace);
    words.filter(|word| word.starts_with("--")).map(str::to_owned).collect()
}

#[test]
fn no_command_sends_the_control_bytes_of_its_arguments() {
    let folder = scratch("arguments");
    let subcommands = subcommands();
    assert!(subcommands.len() >= 10, "{subcommands:?}");
    let check = |arguments: &[&str]| {
        let output = run(&folder, arguments);
        let said = harmless(&output.stderr, &format!("{arguments:?}"));
        assert_ne!(output.status.code(), Some(0), "{arguments:?}");
        said
    };
    let option = format!("--{HOSTILE}");
    assert!(check(&[HOSTILE]).contains(SHOWN));
    assert!(check(&[&option]).contains(SHOWN));
    for subcommand in &subcommands {
        check(&[subcommand, HOSTILE, HOSTILE]);
        assert!(check(&[subcommand, &option]).contains(SHOWN), "{subcommand}");
        for option in options_of(subcommand).iter().filter(|option| *option != "--help") {
            check(&[subcommand, option, HOSTILE, HOSTILE]);
            // The last word is a mistake, so no command runs with the value.
            check(&[subcommand, &format!("{option}={HOSTILE}"), "--nonsense"]);
        }
    }
}

#[test]
fn no_command_sends_the_control_bytes_of_files_and_their_names() {
    let folder = scratch("files");
    let write = |name: &str, content: &str| {
        let name = format!("{name}-{HOSTILE}");
        fs::write(folder.join(&name), content).unwrap();
        name
    };
    let map = write("right", &fs::read_to_string("tests/maps/cross.toml").unwrap());
    let faulty =
        write("wrong", &format!("title = '{HOSTILE}'\n{HOSTILE} = 1\nfloor = '{HOSTILE}'"));
    let settings = write("settings", "fov = '\u{1b}[31m'\n[keys]\n'\u{1b}[31m' = 'x'\n");
    let script = write("script", "0.5 s \u{1b}[31mforward\u{7}\n");
    let nothing = format!("nothing-{HOSTILE}");
    let faults: [&[&str]; 11] = [
        &["check", &faulty, &nothing],
        &["snapshot", &faulty],
        &["cast", &nothing],
        &["play", &faulty],
        &["play", &nothing, "--watch"],
        &["config", "--config", &settings],
        &["config", "--config", &nothing],
        &["replay", &script],
        &["replay", &nothing, &map],
        &["replay", &script, &faulty],
        &["play", "--record", &nothing],
    ];
    for arguments in faults {
        let output = run(&folder, arguments);
        let said = harmless(&output.stderr, &format!("{arguments:?}"));
        assert!(said.contains("\\u{1b}") || said.contains('␛'), "{arguments:?}: {said}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    let right = run(&folder, ["check", map.as_str()]);
    let said = harmless(&right.stdout, "check");
    assert!(said.starts_with("right-h\\u{1b}]0;title"), "{said}");
}

#[test]
fn only_regular_files_are_opened_as_maps() {
    let folder = scratch("special");
    let fifo = folder.join("fifo.toml");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status().unwrap();
    assert!(made.success());
    fs::write(folder.join("map.toml"), "floor = 'fifo.png'\ngrid = '@'\n[things]\n'@'.start = 0\n")
        .unwrap();
    fs::rename(&fifo, folder.join("fifo.png")).unwrap();
    let special: [(&[&str], &str); 7] = [
        (&["check", "fifo.png"], "fifo.png is a pipe or a device, not a map"),
        (&["check", "/dev/zero"], "/dev/zero is a pipe or a device, not a map"),
        (&["check", "/"], "/ is a folder, not a map"),
        (&["check", "map.toml"], "the texture \"fifo.png\" is not a file"),
        (&["snapshot", "fifo.png"], "fifo.png is a pipe or a device"),
        (&["cast", "fifo.png"], "fifo.png is a pipe or a device"),
        (&["play", "fifo.png"], "fifo.png is a pipe or a device"),
    ];
    for (arguments, sentence) in special {
        let output = run(&folder, arguments);
        let said = harmless(&output.stderr, &format!("{arguments:?}"));
        assert!(said.contains(sentence), "{arguments:?}: {said}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}
