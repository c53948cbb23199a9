//! Two hosts with one PostgreSQL database.

use std::process::{Command, Output};

use rustix::process::Signal;

use super::maps::choose;
use crate::postgres_server::PostgresServer;
use crate::running::{Running, user_key};
use crate::support::server;
use crate::transport::{folder, wait_until};

/// Runs the program with the store named in its environment.
fn with_store(store: &str, arguments: &[&str]) -> Output {
    let mut command: Command = server(arguments);
    command.env("CELLCASTER_DATA", folder()).env("CELLCASTER_STORE", store).output().unwrap()
}

fn written(store: &str, arguments: &[&str]) -> String {
    let output = with_store(store, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), error.as_str()), (Some(0), ""), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

const AWAY: &str = "The host's database is away";

#[test]
fn hosts_share_accounts_and_bans_and_survive_a_database_outage() {
    let server = PostgresServer::start();
    let store = server.address();
    let options = ["--store", store.as_str()];
    let [one, mut other] = [0; 2].map(|_| Running::start_with("room = []\n", "text", &options));
    let key = user_key(&one.folder);
    choose(&one.player(Some(&key)), "Mara", "\x1b");
    other.player(Some(&key)).wait_for("> Mara");
    assert_eq!(written(&store, &["scores"]), "no results\n");

    // While the database is down, the hosts keep running and tell players about it.
    server.crash();
    for host in [&one, &other] {
        host.player(Some(&key)).wait_for(AWAY);
    }
    server.restart();
    for host in [&one, &other] {
        wait_until("the store to answer", || {
            let player = host.player(Some(&key));
            player.wait_for("> Mara");
            !player.text().contains(AWAY)
        });
    }

    let banned = written(&store, &["admin", "ban", "mara", "--reason", "insults"]);
    assert!(banned.contains("mara") && banned.contains("SHA256:"), "{banned}");
    for host in [&one, &other] {
        host.player(Some(&key)).wait_for("banned from this server: insults");
    }
    assert!(written(&store, &["admin", "bans"]).contains("insults"));
    other.signal(Signal::TERM);
    assert_eq!(other.wait_for_end(), Some(0));
}

#[test]
fn hosts_count_new_accounts_per_network_together() {
    let server = PostgresServer::shared();
    let store = server.address();
    let options = ["--store", store.as_str()];
    let config = "room = []\naccounts-at-once = 1\n";
    let [one, other] = [0; 2].map(|_| Running::start_with(config, "text", &options));
    let keys = [0; 2].map(|_| user_key(&folder()));
    choose(&one.player(Some(&keys[0])), "Mara", "\x1b");
    let jon = other.player(Some(&keys[1]));
    jon.wait_for("Enter saves it");
    jon.send("\x15Jon\r");
    jon.wait_for("Your network has created too many accounts; try again in 3m.");
    // Existing accounts can still log in, and guests can play.
    other.player(Some(&keys[0])).wait_for("> Mara");
    choose(&other.visitor(), "Jon", "\x1b");
}

#[test]
fn a_connection_is_encrypted_if_the_certificate_is_trusted() {
    let (server, stranger) = (PostgresServer::start_encrypted(), PostgresServer::start_encrypted());
    let store = server.address_over_tcp();
    let asked = |store: &str, trusted: &PostgresServer| {
        let mut command = crate::support::server(&["scores", "--store", store]);
        command.env("CELLCASTER_DATA", folder()).env("SSL_CERT_FILE", trusted.certificate());
        String::from_utf8(command.output().unwrap().stderr).unwrap()
    };
    let encrypted = format!("{store}&sslmode=require");
    let said = asked(&encrypted, &server);
    assert!(said.contains("this database contains no store of a host"), "{said}");
    let said = asked(&encrypted, &stranger);
    assert!(said.contains("certificate") && said.lines().count() == 1, "{said}");
    // The server accepts only encrypted connections.
    let said = asked(&store, &server);
    assert!(said.contains("no encryption") && said.lines().count() == 1, "{said}");
}

#[test]
fn a_missing_store_is_reported_without_its_password() {
    let store = "postgres://ada:geheim@127.0.0.1:1/games";
    for arguments in [&[][..], &["scores"], &["admin", "bans"], &["admin", "ban", "ada"]] {
        let output = with_store(store, arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && output.stdout.is_empty(), "{arguments:?}");
        assert!(error.contains("\"games\" at 127.0.0.1") && error.lines().count() == 1, "{error}");
        assert!(!error.contains("geheim"), "{error}");
    }
    let empty = PostgresServer::shared().address();
    let output = with_store(&empty, &["scores"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("this database contains no store of a host"), "{error}");
}
