//! A server that ends, stops, or drops a connection.

use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::proxy::{Cut, Proxy};
use super::*;

/// The most time that a call takes, with a margin for a machine under load.
const MAX: Duration = Duration::from_secs(8);

/// Calls the store until it answers again.
fn until_it_answers(store: &mut HostStore) {
    let start = Instant::now();
    while let Err(failure) = store.level_boards() {
        assert!(start.elapsed() < Duration::from_secs(30), "{failure}");
        thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn acknowledged_changes_survive_a_crash() {
    let server = PostgresServer::start();
    let address = server.address();
    let mut store = open(&address);
    let mut acknowledged = Vec::new();
    for round in 0..3_u8 {
        let (sender, receiver) = mpsc::channel();
        thread::scope(|scope| {
            let writer = scope.spawn(|| {
                let sender = sender;
                for number in 0..=250_u8 {
                    let key = AccountKey::new([round, number].repeat(16).try_into().unwrap());
                    let name = name(&format!("n-{round}-{number}-x"));
                    match store.create_account(None, &key, &name, at(0)) {
                        Ok(account) => _ = sender.send(account),
                        Err(failure) => return Some(failure),
                    }
                }
                None
            });
            // Crash when some calls have ended and others are under way.
            for _ in 0..20 {
                acknowledged.push(receiver.recv().unwrap());
            }
            server.crash();
            let failure = writer.join().unwrap();
            assert!(matches!(failure, Some(AccountRefusal::Failed(_))), "{failure:?}");
            acknowledged.extend(receiver);
        });
        server.restart();
        until_it_answers(&mut store);
        for account in &acknowledged {
            assert_eq!(store.account(&account.key).unwrap().as_ref(), Some(account));
        }
    }
    assert!(acknowledged.len() >= 60);
}

#[test]
fn calls_fail_at_once_while_the_server_is_down() {
    let server = PostgresServer::start();
    let address = server.address_over_tcp();
    let mut store = open(&address);
    let ada = store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    server.crash();
    for _ in 0..3 {
        let start = Instant::now();
        let failure = store.account(&key(1)).unwrap_err();
        assert!(matches!(failure, StoreFailure::Away(_)));
        let failure = failure.to_string();
        assert!(failure.contains("can't be used") && failure.lines().count() == 1, "{failure}");
        assert!(store.create_account(None, &key(2), &name("Bob"), at(0)).is_err());
        assert!(start.elapsed() < MAX, "{:?}", start.elapsed());
    }
    assert!(HostStore::connect(&address).is_err());
    server.restart();
    until_it_answers(&mut store);
    assert_eq!(store.account(&key(1)).unwrap(), Some(ada));
    store.create_account(None, &key(2), &name("Bob"), at(0)).unwrap();
    let refused = store.record(AccountId(99), &run("cellar", 9, Rank::Ghost), at(0)).unwrap_err();
    assert!(!matches!(refused, StoreFailure::Away(_)), "{refused}");
}

#[test]
fn an_unresponsive_server_does_not_block_calls_for_long() {
    let server = PostgresServer::start();
    let address = server.address_over_tcp();
    let mut store = open(&address);
    server.pause();
    for _ in 0..2 {
        let start = Instant::now();
        let failure = store.note_visit(AccountId(1), at(1)).unwrap_err();
        assert!(
            matches!(failure, StoreFailure::Away(_))
                && failure.to_string().ends_with("no answer in time"),
            "{failure}"
        );
        let changed = store.create_account(None, &key(1), &name("Ada"), at(0));
        assert!(matches!(changed, Err(AccountRefusal::Failed(_))), "{changed:?}");
        assert!(start.elapsed() < 2 * MAX, "{:?}", start.elapsed());
        thread::sleep(Duration::from_millis(1100));
    }
    server.resume();
    until_it_answers(&mut store);
    store.create_account(None, &key(2), &name("Bob"), at(0)).unwrap();
}

#[test]
fn a_dropped_connection_is_silently_reopened() {
    let server = PostgresServer::start();
    let mut store = open(&server.address());
    for number in 1..=4_u8 {
        let drop_all = "SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity \
                        WHERE application_name = 'cellcaster'";
        assert_eq!(server.sql(drop_all).trim(), "1");
        if number % 2 == 0 {
            assert_eq!(store.account(&key(9)).unwrap(), None);
        } else {
            store.create_account(None, &key(number), &name(&format!("n-{number}")), at(0)).unwrap();
        }
    }
}

#[test]
fn a_change_of_unknown_outcome_is_reported_and_not_retried() {
    let server = PostgresServer::shared();
    let proxy = Proxy::before(server.port());
    let mut store = open(&proxy.address(&server.address_over_tcp(), server.port()));
    for (number, is_passed_on) in [(1_u8, true), (2, false), (3, true)] {
        proxy.cut(Cut { at: "COMMIT", is_passed_on });
        let name = name(&format!("n-{number}"));
        let answer = store.create_account(None, &key(number), &name, at(0));
        let Err(AccountRefusal::Failed(failure)) = answer else { panic!("{answer:?}") };
        assert!(
            failure.to_string().ends_with("the last change may or may not have been saved"),
            "{failure}"
        );
        assert!(proxy.has_cut());
        // The server may still be executing the statement.
        thread::sleep(Duration::from_millis(600));
        assert_eq!(store.account(&key(number)).unwrap().is_some(), is_passed_on);
    }
}

#[test]
fn a_rolled_back_change_is_retried() {
    let server = PostgresServer::shared();
    let address = server.address_over_tcp();
    // Each case has a connection of its own, because the text of a statement crosses a connection
    // only once.
    for (number, text, is_passed_on) in
        [(1_u8, "BEGIN", true), (2, "INSERT INTO accounts", true), (3, "INSERT INTO names", false)]
    {
        let proxy = Proxy::before(server.port());
        let mut store = open(&proxy.address(&address, server.port()));
        proxy.cut(Cut { at: text, is_passed_on });
        let account =
            store.create_account(None, &key(number), &name(&format!("n-{number}")), at(0));
        assert_eq!(store.account(&key(number)).unwrap(), Some(account.unwrap()));
        assert!(proxy.has_cut());
    }
}

#[test]
fn a_password_is_required_and_never_shown() {
    let server = PostgresServer::start();
    server.sql("CREATE ROLE guarded LOGIN PASSWORD 'ge@heim'");
    server.sql("CREATE SCHEMA AUTHORIZATION guarded");
    let address = |password: &str| {
        format!("postgres://guarded:{password}@127.0.0.1:{}/postgres", server.port())
    };
    let mut store = open(&address("ge%40heim"));
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    assert!(!format!("{store:?}").contains("heim"));
    for password in ["geheim", "ge@heim", "", "ge%40heim1"] {
        let sentence = HostStore::connect(&address(password)).unwrap_err().to_string();
        assert!(!sentence.contains("heim") && sentence.lines().count() == 1, "{sentence}");
    }
    server.crash();
    let sentence = store.account(&key(1)).unwrap_err().to_string();
    assert!(sentence.contains("127.0.0.1") && !sentence.contains("heim"), "{sentence}");
}
