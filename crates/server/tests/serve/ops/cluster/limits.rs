//! Connection limits that hold across all hosts.

use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::{Hosts, says};
use crate::play::enter_room;
use crate::running::user_key;
use crate::transport::{folder, wait_until};

const TOO_OFTEN: &str = "This host accepts at most 1 connection with one key";
const ONE: &str = "connections-per-key = 1\n";

#[test]
fn a_key_is_limited_across_all_hosts() {
    let hosts = Hosts::start_with(2, ONE);
    let key = user_key(&folder());
    let player = |host: usize| hosts.running[host].0.player(Some(&key));
    let mut mara = player(0);
    enter_room(&mara, "Mara");
    let mut other = player(1);
    other.wait_for(TOO_OFTEN);
    assert_eq!(other.wait_for_end().status.code(), Some(2));
    wait_until("the refusal to be counted", || {
        hosts.figure(1, "connections_refused_total{reason=\"key\"}") == 1.0
    });
    // Mara leaves, and may then come to any host.
    mara.send("\x03\x03");
    mara.wait_for_end();
    player(1).wait_for("> Mara");
}

#[test]
fn an_address_is_limited_across_all_hosts() {
    let hosts = Hosts::start_with(2, "connections-per-address = 2\n");
    let guests = [0, 1].map(|host| hosts.running[host].0.visitor());
    for guest in &guests {
        guest.wait_for("Enter saves it");
    }
    hosts.running[1]
        .0
        .visitor()
        .wait_for("This host accepts at most 2 connections from one address");
    let [one, _other] = guests;
    drop(one);
    hosts.running[1].0.visitor().wait_for("Enter saves it");
}

#[test]
fn visits_on_a_killed_host_do_not_lock_anyone_out() {
    let mut hosts = Hosts::start_with(2, ONE);
    let key = user_key(&folder());
    let mara = hosts.running[0].0.player(Some(&key));
    enter_room(&mara, "Mara");
    hosts.running[0].0.signal(Signal::KILL);
    let killed_at = Instant::now();
    let mara = hosts.running[1].0.player(Some(&key));
    mara.wait_for("Welcome back: you are where you were.");
    println!("she is back after {:?}", killed_at.elapsed());
    assert!(killed_at.elapsed() < Duration::from_secs(25), "{:?}", killed_at.elapsed());
    assert!(!mara.text().contains(TOO_OFTEN), "{}", mara.text());
    hosts.running[0].0.wait_for_end();
}

#[test]
fn players_stay_during_a_database_outage_and_count_afterwards() {
    let hosts = Hosts::start_with(2, ONE);
    let key = user_key(&folder());
    let mara = hosts.running[0].0.player(Some(&key));
    enter_room(&mara, "Mara");
    hosts.postgres.crash();
    hosts.running[1].0.player(Some(&key)).wait_for("The host can't look you up now");
    hosts.postgres.restart();
    wait_until("the visit to count", || {
        let other = hosts.running[1].0.player(Some(&key));
        wait_until("an answer", || {
            ["> Mara", "can't look you up", "Welcome back", TOO_OFTEN]
                .iter()
                .any(|it| other.text().contains(it))
        });
        other.text().contains(TOO_OFTEN)
    });
    says(&mara, &mara, "still here");
}
