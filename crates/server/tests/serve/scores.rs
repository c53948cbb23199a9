//! `scores`: the leaderboards of a host.

use std::path::Path;
use std::process::Output;

use cellcaster::map;
use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime, verify};
use serde_json::Value;

use crate::kept::WON;
use crate::support::server;
use crate::transport::folder;

const HARD: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/cellar.hard.script"));
const MUSEUM: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/museum.normal.script"));

/// A store with the results of two accounts. It stays open, like the store of a running host.
pub(crate) fn filled(folder: &Path) -> HostStore {
    let mut store = HostStore::open(folder).unwrap();
    let now = UnixTime::new(1_795_300_000);
    for (number, name, scripts) in [(1, "漢字", &[WON, HARD][..]), (2, "Ada", &[WON, MUSEUM])] {
        let (key, name) = (AccountKey::new([number; 32]), Name::new(name).unwrap());
        let account = store.create_account(None, &key, &name, now).unwrap();
        for script in scripts {
            let run = verify(script, |_| None).unwrap();
            store.record(account.id, &run, now.after(u64::from(number))).unwrap();
        }
    }
    store
}

fn scores(folder: &Path, arguments: &[&str]) -> Output {
    let words = [&["scores"], arguments].concat();
    server(&words).env("CELLCASTER_DATA", folder).output().unwrap()
}

fn written(folder: &Path, arguments: &[&str]) -> String {
    let output = scores(folder, arguments);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn boards_can_be_listed_while_a_host_runs() {
    let folder = folder();
    let _host = filled(&folder);
    let table = written(&folder, &[]);
    let titles: Vec<&str> = table.lines().filter(|line| line.contains(", ")).collect();
    assert_eq!(titles, ["cellar, normal", "cellar, hard", "museum, normal"]);
    let entries: Vec<&str> = table.lines().skip(2).take(2).collect();
    // The run is the same for both, and the earlier result comes first.
    assert!(
        entries[0].starts_with("   1  漢字              ")
            && entries[1].starts_with("   2  Ada               ")
    );
    assert_eq!(entries[0].split_whitespace().nth(2), entries[1].split_whitespace().nth(2));
    let some = written(&folder, &["--level", "cellar", "--difficulty", "hard"]);
    assert_eq!(
        some.lines().filter(|line| line.contains(", ")).collect::<Vec<_>>(),
        ["cellar, hard"]
    );
    assert_eq!(written(&folder, &["--level", "prison"]), "no results\n");
    let elsewhere = crate::transport::folder();
    assert_eq!(written(&elsewhere, &["--data", folder.to_str().unwrap()]), table);
}

#[test]
fn the_board_of_a_day_can_be_listed() {
    let folder = folder();
    let mut store = filled(&folder);
    let corridor = "grid = '''\n#####\n#@.>#\n#####\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                    [things]\n\"@\" = { start = 0 }\n\">\" = { exit = true }\n";
    let world = |level: &str| map::parse(corridor, level, &map::NoFiles).ok();
    let run = verify("level daily-2026-11-28\n4 s forward\n", world).unwrap();
    let ada = store.account(&AccountKey::new([2; 32])).unwrap().unwrap();
    store.record(ada.id, &run, UnixTime::new(1_795_824_000)).unwrap();
    let table = written(&folder, &["--level", "daily-2026-11-28"]);
    assert!(
        table.starts_with("daily-2026-11-28, normal\n") && table.contains("   1  Ada"),
        "{table}"
    );
    // Built-in levels come first.
    assert!(written(&folder, &[]).ends_with(&table));
}

#[test]
fn json_contains_every_figure() {
    let folder = folder();
    drop(filled(&folder));
    let boards: Value = serde_json::from_str(&written(&folder, &["--format", "json"])).unwrap();
    let run = verify(MUSEUM, |_| None).unwrap();
    let museum = &boards[2];
    assert_eq!((&museum["level"], &museum["difficulty"]), (&"museum".into(), &"normal".into()));
    let entry = &museum["entries"][0];
    assert_eq!((&entry["place"], &entry["name"]), (&1.into(), &"Ada".into()));
    assert_eq!(entry["steps"], run.tally().steps);
    assert_eq!(entry["rank"], run.rank().name());
    assert_eq!(entry["verified"], 1_795_300_002_u64);
}

#[test]
fn mistakes_are_explained_in_a_sentence() {
    let folder = folder();
    for (arguments, said) in [
        (&[][..], "contains no store of a host"),
        (&["--level", "No where"], "the name of a built-in level, or of one"),
    ] {
        let output = scores(&folder, arguments);
        let sentence = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
        assert!(sentence.contains(said) && sentence.lines().count() == 1, "{sentence}");
    }
}

#[test]
fn a_folder_can_be_named_as_the_store() {
    let folder = folder();
    let _host = filled(&folder);
    let elsewhere = crate::transport::folder();
    let table = written(&folder, &[]);
    assert_eq!(written(&elsewhere, &["--store", folder.to_str().unwrap()]), table);
    let mut command = server(&["scores"]);
    command.env("CELLCASTER_DATA", &elsewhere).env("CELLCASTER_STORE", &folder);
    assert_eq!(String::from_utf8(command.output().unwrap().stdout).unwrap(), table);
    let output = scores(&folder, &["--store", ""]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("--store takes a folder, or an address"), "{error}");
}
