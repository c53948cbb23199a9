//! A host whose link to NATS and the database is cut.

use std::thread;
use std::time::Duration;

use super::network::Network;
use super::{Hosts, goes_on, says};
use crate::play::enter_room;
use crate::running::user_key;
use crate::transport::folder;

#[test]
fn a_cut_off_host_is_replaced_and_catches_up_later() {
    let network = Network::new();
    let hosts = Hosts::start_behind(&network);
    // The host of the first player writes the room.
    let mara = hosts.running[0].0.player(Some(&user_key(&folder())));
    enter_room(&mara, "Mara");
    let jon = hosts.player(1, "Jon");
    mara.wait_for("Jon has joined.");
    says(&mara, &jon, "before the cut");

    network.cut();
    mara.wait_for("the game waits");
    let time = goes_on(&jon, "anybody there");
    println!("the room goes on after {time:?}");
    jon.wait_for("Mara is away.");

    network.mend();
    mara.wait_for("are connected again");
    jon.wait_for("Mara is back.");
    says(&jon, &mara, "after the cut");
    says(&mara, &jon, "I was waiting");
    thread::sleep(Duration::from_secs(3));
    hosts.assert_equal(&[0, 1], 1.0);
}

#[test]
fn a_short_network_outage_only_pauses_the_room() {
    let network = Network::new();
    let hosts = Hosts::start_behind(&network);
    let mara = hosts.player(0, "Mara");
    let jon = hosts.player(1, "Jon");
    mara.wait_for("Jon has joined.");
    network.cut();
    thread::sleep(Duration::from_secs(1));
    network.mend();
    // Mara has no account. If she had become away, she would be gone.
    let time = says(&mara, &jon, "still here");
    println!("it is read after {time:?}");
    says(&jon, &mara, "as am I");
    thread::sleep(Duration::from_secs(3));
    hosts.assert_equal(&[0, 1], 1.0);
}
