//! Logins, and results of runs that end, while the database is unreachable.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use rustix::process::Signal;

use super::maps::{HALL, choose, enter_hall, go_in, maps, win};
use super::metrics::{free_port, scrape};
use crate::postgres_server::PostgresServer;
use crate::running::{Running, user_key};
use crate::transport::{folder, wait_until};

/// A host with its own database, one map and metrics.
struct Host {
    postgres: PostgresServer,
    store: String,
    running: Running,
    metrics: u16,
}

impl Host {
    fn start() -> Self {
        let (postgres, metrics) = (PostgresServer::start(), free_port());
        let store = postgres.address();
        let maps = maps(&[("moss.toml", HALL)]);
        let config = format!(
            "maps = \"{}\"\nroom = []\n[metrics]\nlisten = \"127.0.0.1:{metrics}\"\n",
            maps.display()
        );
        let running = Running::start_with(&config, "text", &["--store", &store]);
        Self { postgres, store, running, metrics }
    }

    fn waiting(&self) -> f64 {
        scrape(self.metrics)["cellcaster_results_waiting"]
    }

    /// The name, steps and time of each result in the database, ordered by time.
    fn results(&self) -> Vec<(String, u64, u64)> {
        let place = self.store.rsplit_once("%3D").unwrap().1;
        let rows = self.postgres.sql(&format!(
            "SELECT name, steps, verified_at FROM {place}.results \
             JOIN {place}.accounts ON id = account ORDER BY verified_at, steps"
        ));
        let row = |row: &str| {
            let [name, steps, at] = row.split('|').collect::<Vec<_>>().try_into().unwrap();
            (name.to_owned(), steps.parse().unwrap(), at.parse().unwrap())
        };
        rows.lines().map(row).collect()
    }
}

/// A new key for a user.
fn key() -> PathBuf {
    user_key(&folder())
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs()
}

const KEPT: &str = "your result is kept and will be recorded.";

#[test]
fn results_won_during_an_outage_survive_the_host() {
    let mut host = Host::start();
    let players = ["Mara", "Jon"].map(|name| {
        let player = host.running.player(Some(&key()));
        enter_hall(&player, name);
        player
    });
    host.postgres.crash();
    assert_eq!(host.waiting(), 0.0);
    let mut told = Vec::new();
    for player in &players {
        let start = now();
        win(player, KEPT);
        told.push(start..=now());
        // Stored times are whole seconds.
        wait_until("the next second", || now() > *told.last().unwrap().end());
    }
    assert_eq!(host.waiting(), 2.0);
    host.running.signal(Signal::KILL);
    host.running.wait_for_end();
    drop(players);

    host.postgres.restart();
    assert_eq!(host.results(), []);
    host.running.restart();
    wait_until("the results", || host.results().len() == 2);
    let results = host.results();
    for ((name, _, at), (expected, told)) in results.iter().zip(["Mara", "Jon"].iter().zip(told)) {
        assert_eq!(name, expected);
        assert!(told.contains(at), "{at} is not in {told:?}");
    }
    wait_until("none to wait", || host.waiting() == 0.0);
    wait_until("the file to go", || !host.running.folder.join("waiting_results").exists());
}

#[test]
fn a_player_who_is_still_connected_sees_the_result_recorded() {
    let host = Host::start();
    let mara = host.running.player(Some(&key()));
    enter_hall(&mara, "Mara");
    // A paused server neither answers nor closes its connections.
    host.postgres.pause();
    win(&mara, KEPT);
    host.postgres.resume();
    mara.wait_for("has been recorded.");
    let results = host.results();
    let (_, steps, _) = results.first().unwrap();
    let time = format!("The moss hall, 0:{:02}.{}", steps / 60, steps * 10 / 60 % 10);
    assert!(mara.text().contains(&time), "{time} is not in\n{}", mara.text());
    assert_eq!((results.len(), host.waiting()), (1, 0.0));
}

#[test]
fn known_players_can_log_in_during_an_outage() {
    const AWAY: &str = "The host's database is away";
    let mut host = Host::start();
    let [mara, jon, stranger] = [(); 3].map(|()| key());
    for (key, name) in [(&mara, "Mara"), (&jon, "Jon")] {
        choose(&host.running.player(Some(key)), name, "\x1b");
    }
    host.running.admin_says(&["ban", "jon", "--reason", "insults", "--store", &host.store]);
    // The host learns of the ban with the next login.
    host.running.player(Some(&mara)).wait_for("> Mara");
    host.running.signal(Signal::TERM);
    assert_eq!(host.running.wait_for_end(), Some(0));
    let file = fs::metadata(host.running.folder.join("known_players")).unwrap();
    assert_eq!(file.permissions().mode() & 0o777, 0o600);
    host.running.restart();

    host.postgres.crash();
    let player = host.running.player(Some(&mara));
    player.wait_for(AWAY);
    host.running.player(Some(&jon)).wait_for("banned from this server: insults");
    host.running.player(Some(&stranger)).wait_for("The host can't look you up now");
    player.send("\r");
    player.wait_for("Alone, for the board");
    player.send("4");
    go_in(&player);
    win(&player, KEPT);

    host.postgres.restart();
    player.wait_for("has been recorded.");
    assert_eq!(host.results()[0].0, "Mara");
    wait_until("a login as usual", || {
        let player = host.running.player(Some(&mara));
        player.wait_for("> Mara");
        !player.text().contains(AWAY)
    });
}
