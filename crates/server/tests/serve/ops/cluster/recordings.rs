//! Recordings of shared rooms.

use std::fs;
use std::num::NonZero;
use std::path::Path;

use rustix::process::Signal;
use serde_json::Value;

use super::{Hosts, says};
use crate::play::enter_room;
use crate::running::user_key;
use crate::support::server;
use crate::transport::folder;

/// Returns true if a picture of a cast shows `text`.
fn shows(cast: &Path, text: &str) -> bool {
    let [rows, columns] = [24, 80].map(|length| NonZero::new(length).unwrap());
    let mut terminal = vt100::Parser::new(rows, columns, 0);
    fs::read_to_string(cast).unwrap().lines().skip(1).any(|line| {
        let event: Value = serde_json::from_str(line).unwrap();
        terminal.process(event[2].as_str().unwrap().as_bytes());
        terminal.screen().contents().contains(text)
    })
}

#[test]
fn a_host_records_the_rooms_of_its_players() {
    let mut hosts = Hosts::start(2);
    let recordings = folder();
    let host = &mut hosts.running[0].0;
    host.signal(Signal::TERM);
    assert_eq!(host.wait_for_end(), Some(0));
    host.add_option("--record-room");
    host.add_option(recordings.to_str().unwrap());
    host.restart();

    let mara = hosts.running[0].0.player(Some(&user_key(&folder())));
    enter_room(&mara, "Mara");
    let jon = hosts.player(1, "Jon");
    mara.wait_for("Jon has joined.");
    says(&jon, &mara, "behind you");
    drop(jon);
    mara.wait_for("Jon leaves.");
    hosts.running[0].0.signal(Signal::TERM);
    assert_eq!(hosts.running[0].0.wait_for_end(), Some(0));

    let files = fs::read_dir(&recordings).unwrap().map(|file| file.unwrap().path());
    let files: Vec<_> =
        files.filter(|path| path.extension().is_some_and(|it| it == "log")).collect();
    let [log] = &files[..] else { panic!("{files:?}") };
    let text = fs::read_to_string(log).unwrap();
    for entry in [" keep 1\n", " say 2 behind you\n", " leave 2\n"] {
        assert!(text.contains(entry), "{entry} is not in\n{text}");
    }
    let cast = log.with_extension("cast");
    assert!(shows(&cast, "Mara") && !shows(&cast, "behind you"));
    let replayed = server(&["replay", "--verify"]).arg(log).output().unwrap();
    let shown = String::from_utf8(replayed.stdout).unwrap();
    assert!(shown.starts_with("round 1: ") && shown.contains("Mara"), "{shown}");
}
