//! The game on a server: real OpenSSH clients that see each other's pictures.

mod cut;
mod daily;
pub(crate) mod private;
mod race;

use std::thread;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use self::cut::Relay;
use crate::emulator::Emulator;
use crate::looks::looks;
use crate::player::Player;
use crate::running::{Running, user_key};

/// Takes a name and enters the first room. Enter accepts the offer on each page.
pub(crate) fn enter_room(player: &Player, name: &str) {
    player.wait_for("Enter saves it");
    // Ctrl-U clears the line.
    player.send(format!("\x15{name}"));
    player.wait_for(name);
    player.send("\r");
    player.wait_for("Open a room");
    player.send("\r");
    player.wait_for("Go in");
    player.send("\r");
    player.wait_for(&format!("{name} has joined."));
}

#[test]
fn two_players_meet_talk_and_part() {
    let server = Running::start("", "text");
    let [mara, jon] = [(); 2].map(|()| server.visitor());
    enter_room(&mara, "Mara");
    enter_room(&jon, "Jon");
    mara.wait_for("Jon has joined.");
    jon.send("\r");
    jon.send("behind you\x1b[31m");
    jon.send("\r");
    mara.wait_for("behind you");
    mara.send("/");
    mara.send("where?\r");
    jon.wait_for("where?");
    drop(jon);
    mara.wait_for("Jon leaves.");
}

const HOLD_FORWARD: &str = "\x1b[119;1:1u";
const RELEASE_FORWARD: &str = "\x1b[119;1:3u";
const TURN_BACK: &str = "\x1b[98;1:1u\x1b[98;1:3u";

#[test]
fn players_see_each_other_walk() {
    let server = Running::start("", "text");
    let [mara, jon] = [(); 2].map(|()| server.visitor());
    enter_room(&mara, "Mara");
    enter_room(&jon, "Jon");
    see_each_other_walk(&mara, &jon);
}

/// Two players have come in and look in the same direction; each must see the other walk.
pub(crate) fn see_each_other_walk(mara: &Player, jon: &Player) {
    mara.wait_for("Jon has joined.");
    // Chat lines are shown for some seconds.
    let says = |emulator: &Emulator| emulator.text().contains("has joined.");
    mara.wait_until("forgot what was said", |emulator| !says(emulator));
    // Jon walks until Mara sees him: his name is above his head.
    jon.send(HOLD_FORWARD);
    mara.wait_for("Jon");
    jon.send(RELEASE_FORWARD);
    jon.send(TURN_BACK);
    jon.wait_for("Mara");
    // While nobody moves, the picture stays the same, until Mara takes a step.
    let picture = || jon.look(|emulator| looks(emulator.screen()));
    // Within two seconds, the budget of bytes allows the picture to become exact.
    thread::sleep(Duration::from_secs(2));
    let before = picture();
    thread::sleep(Duration::from_millis(500));
    assert!(picture() == before, "{}", jon.text());
    mara.send(HOLD_FORWARD);
    jon.wait_until("saw a step", |emulator| looks(emulator.screen()) != before);
    mara.send(RELEASE_FORWARD);
}

#[test]
fn a_cut_link_frees_its_player_within_fifteen_seconds() {
    let server = Running::start("", "text");
    let relay = Relay::to(server.address());
    let mara = server.visitor();
    let jon = server.player_at(&relay.port.to_string(), None);
    enter_room(&mara, "Mara");
    enter_room(&jon, "Jon");
    mara.wait_for("Jon has joined.");
    let cut = Instant::now();
    relay.cut();
    mara.wait_for("Jon leaves.");
    assert!(cut.elapsed() < Duration::from_secs(15), "{:?}", cut.elapsed());
}

#[test]
fn an_unresponsive_client_is_gone_within_fifteen_seconds() {
    let server = Running::start("", "text");
    let [mara, jon] = [(); 2].map(|()| server.visitor());
    enter_room(&mara, "Mara");
    enter_room(&jon, "Jon");
    mara.wait_for("Jon has joined.");
    let cut = Instant::now();
    jon.signal(Signal::STOP);
    mara.wait_for("Jon leaves.");
    assert!(cut.elapsed() < Duration::from_secs(15), "{:?}", cut.elapsed());
    jon.signal(Signal::CONT);
}

#[test]
fn the_account_of_a_key_survives_a_restart() {
    let mut server = Running::start("drain-seconds = 1\n", "text");
    let key = user_key(&server.folder);
    enter_room(&server.player(Some(&key)), "Mara");
    server.signal(Signal::TERM);
    server.wait_for_end();
    server.restart();
    let player = server.player(Some(&key));
    player.wait_for("Mara");
    player.wait_for("Enter saves it");
    player.send("\r");
    player.wait_for("Open a room");
    let guest = server.visitor();
    guest.wait_for("Enter saves it");
    guest.send("\x15MARA\r");
    guest.wait_for("This name, or one");
}

#[test]
fn a_server_announces_its_shutdown() {
    let server = Running::start("drain-seconds = 1\n", "text");
    let mut player = server.visitor();
    enter_room(&player, "Mara");
    server.signal(Signal::TERM);
    let ending = player.wait_for_end();
    assert_eq!(ending.status.code(), Some(0));
}
