//! `cellcaster-server admin` and metrics in a cluster of several hosts.

use std::thread;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::Hosts;
use crate::play::enter_room;
use crate::player::Player;
use crate::running::user_key;
use crate::transport::folder;

#[test]
fn operators_see_and_reach_visitors_on_all_hosts() {
    let hosts = Hosts::start(2);
    let [one, other] = [0, 1].map(|host| &hosts.running[host].0);
    let key = user_key(&folder());
    let mut mara = one.player(Some(&key));
    enter_room(&mara, "Mara");
    let mut jon = hosts.player(1, "Jon");
    for host in [one, other] {
        let who = host.admin_says(&["who"]);
        let titles = who.lines().next().unwrap();
        assert!(titles.contains("host") && who.lines().count() == 3, "{who}");
        assert!(who.contains("Mara") && who.contains("Jon"), "{who}");
    }
    assert_eq!(other.admin_says(&["say", "closing soon"]), "said to 2 visitors\n");
    mara.wait_for("closing soon");
    jon.wait_for("closing soon");

    // A ban on one host ends the session on another host at once.
    let start = Instant::now();
    let said = other.admin_says(&["ban", "mara", "--reason", "insults", "--store", &hosts.store]);
    assert!(said.ends_with("ended 1 session\n"), "{said}");
    mara.wait_for("You are banned from this host: insults");
    println!("the session ends after {:?}", start.elapsed());
    mara.wait_for_end();
    one.player(Some(&key)).wait_for("banned from this server: insults");
    // The session runs on the other host.
    let who = one.admin_says(&["who"]);
    let session = who.lines().find(|line| line.contains("Jon")).unwrap().split(' ').next().unwrap();
    assert_eq!(one.admin_says(&["kick", "--session", session]), "ended 1 session\n");
    jon.wait_for_end();
}

#[test]
fn private_messages_and_mutes_reach_all_hosts() {
    let hosts = Hosts::start(2);
    let key = user_key(&folder());
    let mara = hosts.running[0].0.player(Some(&key));
    enter_room(&mara, "Mara");
    let jon = hosts.player(1, "Jon");
    let say = |player: &Player, line: &str| {
        player.send("/");
        player.wait_for(" say: ");
        player.send(format!("{line}\r"));
    };
    say(&mara, "/tell jon hello from afar");
    jon.wait_for("Mara (private) hello from afar");
    mara.wait_for("to jon (private) hello from afar");
    say(&mara, "/tell nobody1 hello");
    mara.wait_for("Nobody here is called nobody1.");
    // The operator of one host mutes a guest of the other host, by address.
    let mute = ["mute", "jon", "--for", "10m", "--store", &hosts.store];
    let muted = hosts.running[0].0.admin_says(&mute);
    assert!(muted.ends_with("for 10m\n"), "{muted}");
    thread::sleep(Duration::from_secs(4));
    say(&jon, "you are slow");
    jon.wait_for("The operator of this host has muted you for ");
    assert!(!mara.text().contains("you are slow"), "{}", mara.text());
}

#[test]
fn the_host_list_shows_written_rooms_and_unresponsive_hosts() {
    let hosts = Hosts::start(2);
    let [one, other] = [0, 1].map(|host| &hosts.running[host].0);
    let _mara = hosts.player(0, "Mara");
    let list = other.admin_says(&["hosts"]);
    let rows: Vec<&str> = list.lines().collect();
    assert!(rows.len() == 3 && rows[0].contains("writes rooms"), "{list}");
    let writing = rows[1..].iter().filter(|row| !row.ends_with("none")).count();
    assert!(writing == 1 && list.contains("127.0.0.1:"), "{list}");

    one.signal(Signal::STOP);
    thread::sleep(Duration::from_secs(1));
    let output = other.admin(&["hosts"]);
    one.signal(Signal::CONT);
    let (said, error) = (String::from_utf8(output.stdout), String::from_utf8(output.stderr));
    let (said, error) = (said.unwrap(), error.unwrap());
    assert!(error.contains("did not answer") && error.lines().count() == 1, "{error}");
    assert!(output.status.success() && said.lines().count() == 3, "{said}");
}

#[test]
fn a_stopped_host_is_no_longer_listed() {
    let mut hosts = Hosts::start(2);
    hosts.running[0].0.signal(Signal::TERM);
    assert_eq!(hosts.running[0].0.wait_for_end(), Some(0));
    let other = &hosts.running[1].0;
    assert_eq!(other.admin_says(&["hosts"]).lines().count(), 2);
    assert_eq!(other.admin_says(&["who"]), "nobody is online\n");
    assert!(other.admin_says(&["drain"]).starts_with("the server is shutting down"));
}
