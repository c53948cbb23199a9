//! Hosts with different maps.

use std::net::Ipv4Addr;

use super::{Hosts, host};
use crate::nats_server::NatsServer;
use crate::ops::maps::{HALL, choose, maps};
use crate::postgres_server::PostgresServer;
use crate::transport::wait_until;

#[test]
fn hosts_list_rooms_of_their_maps_and_report_differences() {
    let (nats, postgres) = (NatsServer::start(), PostgresServer::start());
    let (bus, store) = (nats.address(), postgres.address());
    let other_hall = HALL.replace("#@....>.#", "#@...>..#");
    let start = |text: &str| {
        let maps = maps(&[("moss.toml", text), ("fern.toml", HALL)]);
        let settings = format!("maps = \"{}\"\n", maps.display());
        host(None, Ipv4Addr::LOCALHOST, &bus, &store, &settings)
    };
    let mut running = vec![start(HALL)];
    running.push(start(&other_hall));
    let hosts = Hosts { running, nats, postgres, store };
    let [one, other] = [0, 1].map(|host| &hosts.running[host].0);
    other.wait_for_log(
        "it has a different text of moss; this host does not list its rooms in those maps",
    );

    // Only visitors of this host see a room in its map.
    let mara = one.visitor();
    choose(&mara, "Mara", "3");
    mara.wait_for("Campaign together");
    mara.send("4");
    mara.wait_for("The moss hall");
    // The last level in the list.
    mara.send("\x1b[F\r");
    mara.wait_for("Go in");
    mara.send("\r");
    mara.wait_for("Mara has joined.");
    let [jon, kim] = [(one, "Jon"), (other, "Kim")].map(|(host, name)| {
        let player = host.visitor();
        player.wait_for("Enter saves it");
        player.send(format!("\x15{name}\r"));
        player.wait_for("Open a room");
        player
    });
    jon.wait_for("Race in The moss hall");
    wait_until("the room for operators", || other.admin_says(&["rooms"]).contains("Mara"));
    assert!(!kim.text().contains("Race in"), "{}", kim.text());

    let output = other.admin(&["hosts"]);
    let (said, error) = (String::from_utf8(output.stdout), String::from_utf8(output.stderr));
    let (said, error) = (said.unwrap(), error.unwrap());
    assert!(error.ends_with("it has a different text of moss\n"), "{error}");
    let hashes: Vec<&str> = said
        .lines()
        .filter_map(|row| row.split_once("2 (")?.1.split_once(')'))
        .map(|it| it.0)
        .collect();
    assert!(hashes.len() == 2 && hashes[0] != hashes[1], "{said}");
}
