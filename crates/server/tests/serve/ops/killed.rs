//! The data that remains after a server was killed, and after it has drained.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use cellcaster_server::accounts::{HostStore, Name};
use rustix::process::Signal;

use crate::play::enter_room;
use crate::player::Player;
use crate::running::{Running, user_key};
use crate::support::server;
use crate::transport::folder;

/// A host that records its rooms, with the folder of the recordings.
fn recorded(config: &str) -> (Running, PathBuf) {
    let recordings = folder();
    let options = ["--record-room", recordings.to_str().unwrap()];
    (Running::start_with(config, "text", &options), recordings)
}

fn say(player: &Player, text: &str) {
    player.send(format!("/{text}\r"));
    player.wait_for(text);
}

/// The recording of the first room. Asserts that its last line is complete and that it can be replayed.
fn recording(folder: &Path) -> String {
    let path = folder.join("room-1.log");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.ends_with('\n'), "{text}");
    let replayed = server(&["replay", "--verify"]).arg(&path).output().unwrap();
    assert!(replayed.status.success(), "{replayed:?}\n{text}");
    assert!(String::from_utf8(replayed.stdout).unwrap().contains("round 1: Roam"));
    text
}

#[test]
fn a_killed_server_loses_at_most_one_second() {
    let (mut running, recordings) = recorded("");
    let key = user_key(&running.folder);
    let player = running.player(Some(&key));
    enter_room(&player, "Mara");
    say(&player, "the first words");
    // The room flushes its recording once a second.
    thread::sleep(Duration::from_millis(1_500));
    say(&player, "the last words");
    running.signal(Signal::KILL);
    running.wait_for_end();
    let text = recording(&recordings);
    assert!(text.contains("say 1 the first words\n"), "{text}");

    running.restart();
    let player = running.player(Some(&key));
    player.wait_for("> Mara");
    let guest = running.visitor();
    guest.wait_for("Enter saves it");
    guest.send("\x15MARA\r");
    guest.wait_for("This name, or one");
}

#[test]
fn a_draining_server_loses_nothing() {
    let (mut running, recordings) = recorded("drain-seconds = 3\n");
    let key = user_key(&running.folder);
    let mut player = running.player(Some(&key));
    enter_room(&player, "Mara");
    running.signal(Signal::TERM);
    player.wait_for("The server ends in 3 seconds.");
    let begun = Instant::now();
    say(&player, "the last words");
    player.wait_for("The server ends in 2 seconds.");
    player.wait_for("The server ends in 1 second.");
    assert_eq!(player.wait_for_end().status.code(), Some(0));
    // The first countdown may come up to a second after the drain begins.
    assert!(begun.elapsed() >= Duration::from_secs(2), "{:?}", begun.elapsed());
    assert_eq!(running.wait_for_end(), Some(0));
    let text = recording(&recordings);
    assert!(text.contains("say 1 the last words\n"), "{text}");
    assert!(text.ends_with(" leave 1\n"), "{text}");
    running.restart();
    running.player(Some(&key)).wait_for("> Mara");
}

/// After a shutdown, a copy of `host.db` alone is a complete backup.
#[test]
fn a_stopped_server_leaves_everything_in_one_file() {
    let mut running = Running::start("drain-seconds = 0\n", "text");
    let key = user_key(&running.folder);
    enter_room(&running.player(Some(&key)), "Mara");
    running.signal(Signal::TERM);
    assert_eq!(running.wait_for_end(), Some(0));
    let log = fs::metadata(running.folder.join("host.db-wal")).map_or(0, |data| data.len());
    assert_eq!(log, 0);
    let backup = folder();
    fs::copy(running.folder.join("host.db"), backup.join("host.db")).unwrap();
    let mut store = HostStore::open(&backup).unwrap();
    assert!(store.account_named(&Name::new("Mara").unwrap()).unwrap().is_some());
}

#[test]
fn a_damaged_store_is_refused_and_kept() {
    let mut running = Running::start("drain-seconds = 0\n", "text");
    running.signal(Signal::TERM);
    assert_eq!(running.wait_for_end(), Some(0));
    let file = running.folder.join("host.db");
    let garbage = b"garbage".repeat(1000);
    fs::write(&file, &garbage).unwrap();
    let serve = ["--listen", "127.0.0.1:0", "--data"];
    let refused = server(&serve).arg(&running.folder).output().unwrap();
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!((refused.status.code(), said.lines().count()), (Some(2), 1), "{said}");
    let names = ["host.db is damaged", "a backup"];
    assert!(names.iter().all(|name| said.contains(name)), "{said}");
    assert_eq!(fs::read(&file).unwrap(), garbage);
    let banned = running.admin(&["ban", "ada"]);
    assert!(!banned.status.success() && fs::read(&file).unwrap() == garbage, "{banned:?}");
}
