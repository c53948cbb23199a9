//! Three hosts with one NATS server and one PostgreSQL database.

mod cut_off;
mod limits;
mod maps;
mod network;
mod operators;
mod private;
mod recordings;
mod returning;

use std::collections::BTreeMap;
use std::env;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::process::Output;
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use self::network::Network;
use super::metrics::scrape_at;
use crate::nats_server::NatsServer;
use crate::play::{enter_room, see_each_other_walk};
use crate::player::Player;
use crate::postgres_server::PostgresServer;
use crate::running::Running;
use crate::support::server;
use crate::transport::folder;

/// The longest time until a room continues after its host was killed.
const TAKEOVER: Duration = Duration::from_secs(5);

/// Hosts that share their rooms.
struct Hosts {
    /// The hosts, each with the address of its metrics.
    running: Vec<(Running, SocketAddr)>,
    nats: NatsServer,
    postgres: PostgresServer,
    /// The address of the shared store.
    store: String,
}

impl Hosts {
    fn start(count: usize) -> Self {
        Self::start_with(count, "")
    }

    /// Hosts with these extra settings.
    fn start_with(count: usize, settings: &str) -> Self {
        let (nats, postgres) = (NatsServer::start(), PostgresServer::start());
        let (bus, store) = (nats.address(), postgres.address());
        let host = |_| host(None, Ipv4Addr::LOCALHOST, &bus, &store, settings);
        let running = (0..count).map(host).collect();
        Self { running, nats, postgres, store }
    }

    /// Two hosts, the first of which runs in a separate network.
    fn start_behind(network: &Network) -> Self {
        let shared = network.shared();
        let (nats, postgres) = (NatsServer::start_at(shared), PostgresServer::start_at(shared));
        let (bus, store) = (nats.address(), postgres.address_at(shared));
        let running = vec![
            host(Some(network.namespace()), network.host(), &bus, &store, ""),
            host(None, Ipv4Addr::LOCALHOST, &bus, &store, ""),
        ];
        Self { running, nats, postgres, store }
    }

    /// A player on a host who has entered the first room.
    fn player(&self, host: usize, name: &str) -> Player {
        let player = self.running[host].0.visitor();
        enter_room(&player, name);
        player
    }

    fn figure(&self, host: usize, name: &str) -> f64 {
        self.figures(host)[&format!("cellcaster_{name}")]
    }

    /// All metrics of a host, without the host label that each of them has.
    fn figures(&self, host: usize) -> BTreeMap<String, f64> {
        let lines = scrape_at(self.running[host].1).into_iter().map(|(line, value)| {
            let (name, rest) = line.split_once("{host=\"").expect(&line);
            let (_, labels) = rest.split_once('"').expect(&line);
            let labels = labels.trim_start_matches(',').trim_end_matches('}');
            let labels = if labels.is_empty() { String::new() } else { format!("{{{labels}}}") };
            (format!("{name}{labels}"), value)
        });
        lines.collect()
    }

    /// Asserts that the hosts have compared room states at least `least` times and found no difference.
    fn assert_equal(&self, hosts: &[usize], least: f64) {
        for &host in hosts {
            assert_eq!(self.figure(host, "room_checks_total{result=\"different\"}"), 0.0);
        }
        let equal = |host: &usize| self.figure(*host, "room_checks_total{result=\"equal\"}");
        let equal: Vec<f64> = hosts.iter().map(equal).collect();
        // The host that runs the sequencer has nothing to compare.
        let compared = equal.iter().filter(|count| **count >= least).count();
        assert!(compared >= hosts.len() - 1, "{equal:?}");
    }
}

/// A host in a network namespace, with metrics at `address`; returns it with the address of its metrics.
fn host(
    namespace: Option<&str>,
    address: Ipv4Addr,
    bus: &str,
    store: &str,
    settings: &str,
) -> (Running, SocketAddr) {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let config = format!("{settings}[metrics]\nlisten = \"{address}:{port}\"\n");
    let options = ["--store", store, "--cluster", bus];
    let running = Running::start_in(namespace, &config, "text", &options);
    (running, (address, port).into())
}

/// Sends a chat line and waits until `other` shows it; returns the time that this took.
fn says(player: &Player, other: &Player, text: &str) -> Duration {
    let start = Instant::now();
    player.send(format!("/{text}\r"));
    other.wait_for(text);
    start.elapsed()
}

/// In a room that has lost its host or the bus, sends chat lines until the player sees one of them; returns the time.
/// Lines sent before another host takes over the room, or hears from this one again, are lost.
fn goes_on(player: &Player, text: &str) -> Duration {
    let start = Instant::now();
    while !player.text().contains(&format!("Jon {text}")) {
        assert!(start.elapsed() < TAKEOVER, "{}", player.text());
        player.send(format!("/{text}\r"));
        thread::sleep(Duration::from_millis(300));
    }
    start.elapsed()
}

#[test]
fn players_on_three_hosts_see_each_other_and_rooms_stay_equal() {
    let hosts = Hosts::start(3);
    let (mara, jon) = (hosts.player(0, "Mara"), hosts.player(1, "Jon"));
    see_each_other_walk(&mara, &jon);
    let kim = hosts.player(2, "Kim");
    mara.wait_for("Kim has joined.");
    says(&kim, &jon, "here I am");
    let seconds = env::var("CLUSTER_SECONDS").ok().and_then(|it| it.parse().ok()).unwrap_or(5);
    let players = [&mara, &jon, &kim];
    for second in 0..seconds {
        players[second % 3].send("\x1b[119;1:1u\x1b[98;1:1u\x1b[98;1:3u");
        thread::sleep(Duration::from_secs(1));
        players[second % 3].send("\x1b[119;1:3u");
    }
    hosts.assert_equal(&[0, 1, 2], seconds as f64 * 0.6);
    drop(kim);
    jon.wait_for("Kim leaves.");
}

#[test]
fn a_room_survives_its_killed_host() {
    let hosts = Hosts::start(3);
    let _mara = hosts.player(0, "Mara");
    let (jon, kim) = (hosts.player(1, "Jon"), hosts.player(2, "Kim"));
    jon.wait_for("Kim has joined.");
    assert!(hosts.running[0].0.log().contains("this host has taken over a room"));
    hosts.running[0].0.signal(Signal::KILL);
    let time = goes_on(&jon, "anybody there");
    kim.wait_for("anybody there");
    println!("the room goes on after {time:?}");
    jon.wait_for("Mara leaves.");
    says(&kim, &jon, "she is gone");
    thread::sleep(Duration::from_secs(2));
    hosts.assert_equal(&[1, 2], 1.0);
}

#[test]
fn rooms_wait_without_nats_and_go_on_without_the_database() {
    let mut hosts = Hosts::start(2);
    let (mara, jon) = (hosts.player(0, "Mara"), hosts.player(1, "Jon"));
    mara.wait_for("Jon has joined.");
    hosts.nats.kill();
    for player in [&mara, &jon] {
        player.wait_for("the game waits");
    }
    hosts.nats.restart();
    for player in [&mara, &jon] {
        player.wait_for("are connected again");
    }
    // A line is lost if the other host is not subscribed again yet.
    goes_on(&jon, "that was long");
    mara.wait_for("that was long");

    hosts.postgres.crash();
    thread::sleep(Duration::from_secs(4));
    let time = says(&mara, &jon, "no results now");
    assert!(time < Duration::from_secs(1), "{time:?}");
    hosts.postgres.restart();
    thread::sleep(Duration::from_secs(2));
    says(&jon, &mara, "and again");
    hosts.assert_equal(&[0, 1], 1.0);
}

#[test]
fn a_room_with_one_host_goes_on_without_nats() {
    let mut hosts = Hosts::start(2);
    let (mara, jon) = (hosts.player(0, "Mara"), hosts.player(0, "Jon"));
    mara.wait_for("Jon has joined.");
    hosts.nats.kill();
    for player in [&mara, &jon] {
        player.wait_for("the game goes on here");
    }
    let time = says(&mara, &jon, "just the two of us");
    assert!(time < Duration::from_secs(1), "{time:?}");
    hosts.nats.restart();
    for player in [&mara, &jon] {
        player.wait_for("are connected again");
    }
    assert!(hosts.figure(0, "room_steps_alone_total") > 0.0);
    let kim = hosts.player(1, "Kim");
    says(&kim, &mara, "what have I missed");
    thread::sleep(Duration::from_secs(3));
    hosts.assert_equal(&[0, 1], 1.0);
}

#[test]
fn a_draining_host_hands_its_rooms_to_the_others() {
    let mut hosts = Hosts::start(2);
    let _mara = hosts.player(0, "Mara");
    let jon = hosts.player(1, "Jon");
    hosts.running[0].0.signal(Signal::TERM);
    hosts.running[0].0.signal(Signal::TERM);
    assert_eq!(hosts.running[0].0.wait_for_end(), Some(0));
    jon.wait_for("Mara leaves.");
}

#[test]
fn cluster_requirements_are_explained() {
    let serve = |options: &[&str]| -> Output {
        let words = [&["--listen", "127.0.0.1:0"], options].concat();
        server(&words).env("CELLCASTER_DATA", folder()).output().unwrap()
    };
    let postgres = PostgresServer::shared().address();
    let nobody = "nats://ada:geheim@127.0.0.1:1";
    for (options, sentence) in [
        (vec!["--cluster", nobody], "a cluster needs a database that all hosts share"),
        (vec!["--cluster", nobody, "--store", &postgres], "NATS at 127.0.0.1:1"),
        (vec!["--cluster", "localhost"], "a NATS address"),
    ] {
        let output = serve(&options);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(sentence) && !error.contains("geheim"), "{error}");
    }
}
