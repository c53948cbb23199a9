//! Players whose host shuts down and who connect to another host.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::{Hosts, goes_on};
use crate::emulator::Emulator;
use crate::looks::{Look, looks};
use crate::play::enter_room;
use crate::player::Player;
use crate::running::user_key;
use crate::transport::folder;

const WELCOME: &str = "Welcome back: you are where you were.";
/// Starts walking forward.
const WALK: &str = "\x1b[119;1:1u";
/// Stops, and turns back to a view in which nothing moves.
const TURN: &str = "\x1b[119;1:3u\x1b[98;1:1u\x1b[98;1:3u";

/// A player with a key on a host who has entered the first room, walked ahead, and turned back.
fn walker(hosts: &Hosts, host: usize) -> (Player, PathBuf) {
    let key = user_key(&folder());
    let mara = hosts.running[host].0.player(Some(&key));
    enter_room(&mara, "Mara");
    mara.send(WALK);
    std::thread::sleep(Duration::from_millis(700));
    mara.send(TURN);
    (mara, key)
}

/// The picture at rest, without the lines at its edges and the map.
fn picture(player: &Player) -> Vec<Look> {
    let is_quiet = |emulator: &Emulator| {
        let text = emulator.text();
        ["has joined.", "is away.", "is back.", "leaves.", "Welcome"]
            .iter()
            .all(|it| !text.contains(it))
    };
    player.wait_until("forgot what was said", is_quiet);
    player.wait_for_rest();
    let cells = player.look(|emulator| looks(emulator.screen()));
    let rows = cells.chunks(80).take(22).skip(1);
    rows.flat_map(|row| row[..50].to_vec()).collect()
}

/// Mara connects to a host and gets her place back; returns the time that this took.
fn returned(hosts: &Hosts, host: usize, key: &Path) -> (Player, Duration) {
    let start = Instant::now();
    let mara = hosts.running[host].0.player(Some(key));
    mara.wait_for(WELCOME);
    (mara, start.elapsed())
}

#[test]
fn a_player_returns_to_their_place_after_a_drain() {
    let mut hosts = Hosts::start(2);
    let (mara, key) = walker(&hosts, 0);
    let jon = hosts.player(1, "Jon");
    mara.wait_for("Jon has joined.");
    let before = picture(&mara);

    hosts.running[0].0.signal(Signal::TERM);
    mara.wait_for("Connect again to continue where you were.");
    // She leaves at once, before the host exits.
    mara.send("\x03\x03");
    jon.wait_for("Mara is away.");
    let (mara, time) = returned(&hosts, 1, &key);
    println!("she is back after {time:?}");
    jon.wait_for("Mara is back.");
    assert!(picture(&mara) == before, "{}", mara.text());
    assert_eq!(hosts.running[0].0.wait_for_end(), Some(0));

    // She is a full member again.
    mara.send("/here I am\r");
    jon.wait_for("here I am");
    mara.send("\t");
    mara.wait_for("2/16");
    // A second connection cannot take the place of a player who is connected.
    let other = hosts.running[1].0.player(Some(&key));
    other.wait_for("You are already in a room through another connection.");
}

#[test]
fn players_of_a_stopped_host_return_and_guests_are_gone() {
    let mut hosts = Hosts::start(2);
    let (mut mara, key) = walker(&hosts, 0);
    let _guest = hosts.player(0, "Kim");
    let jon = hosts.player(1, "Jon");
    mara.wait_for("Jon has joined.");
    hosts.running[0].0.signal(Signal::TERM);
    assert_eq!(hosts.running[0].0.wait_for_end(), Some(0));
    mara.wait_for_end();
    assert!(mara.text().contains("Connect again to continue where you were."), "{}", mara.text());
    let time = goes_on(&jon, "anybody there");
    println!("the room goes on after {time:?}");
    jon.wait_for("Mara is away.");
    jon.wait_for("Kim leaves.");
    // A few seconds later.
    std::thread::sleep(Duration::from_secs(2));
    let (_mara, time) = returned(&hosts, 1, &key);
    println!("she is back after {time:?}");
    jon.wait_for("Mara is back.");
    hosts.assert_equal(&[1], 0.0);
}

#[test]
fn a_player_returns_to_their_place_after_a_kill() {
    let hosts = Hosts::start(2);
    let (mara, key) = walker(&hosts, 0);
    let before = picture(&mara);
    hosts.running[0].0.signal(Signal::KILL);
    let (mara, time) = returned(&hosts, 1, &key);
    println!("she is back after {time:?}");
    assert!(picture(&mara) == before, "{}", mara.text());
}
