//! A database that several hosts share: its tables, and hosts that change the same rows.

mod faults;
mod proxy;

use std::sync::Barrier;
use std::thread;

use super::postgres_server::PostgresServer;
use super::*;

fn open(address: &str) -> HostStore {
    HostStore::connect(address).unwrap()
}

/// The name of the schema in an address.
fn place(address: &str) -> &str {
    address.rsplit_once("%3D").unwrap().1
}

/// Runs `act` on several hosts at once, each with a store of its own, and returns their answers.
pub(crate) fn at_once<T: Send>(
    address: &str,
    hosts: u8,
    act: impl Fn(u8, &mut HostStore) -> T + Sync,
) -> Vec<T> {
    let barrier = Barrier::new(hosts.into());
    thread::scope(|scope| {
        let threads: Vec<_> = (1..=hosts)
            .map(|number| {
                let (act, barrier) = (&act, &barrier);
                scope.spawn(move || {
                    let mut store = open(address);
                    barrier.wait();
                    act(number, &mut store)
                })
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    })
}

#[test]
fn hosts_starting_together_create_the_tables_once() {
    let server = PostgresServer::shared();
    for _ in 0..4 {
        let address = server.address();
        assert!(HostStore::connect_to_read(&address).unwrap().is_none());
        at_once(&address, 6, |_, _| ());
        let sql = format!("SELECT version FROM {}.cellcaster", place(&address));
        let version: usize = server.sql(&sql).trim().parse().unwrap();
        assert!(version > 0);
    }
}

#[test]
fn each_host_sees_the_data_of_the_others() {
    let address = PostgresServer::shared().address();
    let (mut one, mut other) = (open(&address), open(&address));
    let ada = one.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    one.record(ada.id, &run("cellar", 9, Rank::Ghost), at(0)).unwrap();
    assert_eq!(other.account(&key(1)).unwrap(), Some(ada.clone()));
    assert_eq!(other.level_scores(&board("cellar"), 9).unwrap()[0].name, ada.name);
    drop((one, other));
    let mut reader = HostStore::connect_to_read(&address).unwrap().unwrap();
    assert_eq!(reader.account(&key(1)).unwrap(), Some(ada));
    let refused = reader.create_account(None, &key(2), &name("Bob"), at(0));
    assert!(matches!(refused, Err(AccountRefusal::Failed(_))), "{refused:?}");
    assert!(reader.note_visit(AccountId(1), at(1)).is_err());
}

#[test]
fn hosts_racing_to_create_a_name_create_one() {
    let address = PostgresServer::shared().address();
    for round in 0..12_u8 {
        let text = format!("Bill-{round}");
        // These names look alike.
        let names =
            [text.clone(), text.to_lowercase(), text.replace('B', "b"), text.replace("ll", "Il")];
        let answers = at_once(&address, 4, |host, store| {
            let name = name(&names[usize::from(host) - 1]);
            store.create_account(None, &key(round * 8 + host), &name, at(0))
        });
        assert_eq!(answers.iter().filter(|answer| answer.is_ok()).count(), 1, "{answers:?}");
        let refused = answers.iter().filter(|answer| **answer == Err(AccountRefusal::NameTaken));
        assert_eq!(refused.count(), 3, "{answers:?}");
    }
}

#[test]
fn hosts_racing_to_create_an_account_create_one() {
    let address = PostgresServer::shared().address();
    for round in 0..12_u8 {
        let answers = at_once(&address, 4, |host, store| {
            store.create_account(None, &key(round), &name(&format!("n-{round}-{host}")), at(0))
        });
        assert_eq!(answers.iter().filter(|answer| answer.is_ok()).count(), 1, "{answers:?}");
        let refused = answers.iter().filter(|answer| **answer == Err(AccountRefusal::KeyKnown));
        assert_eq!(refused.count(), 3, "{answers:?}");
    }
}

#[test]
fn accounts_racing_for_a_name_have_one_winner() {
    let address = PostgresServer::shared().address();
    let mut store = open(&address);
    let accounts: Vec<_> = (1..=4_u8)
        .map(|number| {
            store
                .create_account(None, &key(number), &name(&format!("n-{number}")), at(0))
                .unwrap()
                .id
        })
        .collect();
    for round in 1..=8_u8 {
        let (wanted, now) = (format!("Eve-{round}"), at(u64::from(round) * 7));
        let answers = at_once(&address, 4, |host, store| {
            store.rename(accounts[usize::from(host) - 1], &name(&wanted), now)
        });
        let winners: Vec<_> = answers.iter().flatten().collect();
        assert_eq!(winners.len(), 1, "{answers:?}");
        assert_eq!(store.account_named(&name(&wanted)).unwrap().as_ref(), Some(winners[0]));
        let taken = answers.iter().filter(|answer| **answer == Err(AccountRefusal::NameTaken));
        assert_eq!(taken.count(), 3, "{answers:?}");
    }
}

#[test]
fn simultaneous_results_leave_the_best() {
    let address = PostgresServer::shared().address();
    let ada = open(&address).create_account(None, &key(1), &name("Ada"), at(0)).unwrap().id;
    at_once(&address, 4, |host, store| {
        for round in 0..10_u64 {
            let steps = 1000 - round * 10 - u64::from(host);
            store.record(ada, &run("cellar", steps, Rank::Thief), at(0)).unwrap();
        }
    });
    let scores = open(&address).level_scores(&board("cellar"), 9).unwrap();
    assert_eq!(scores.iter().map(|it| it.tally.steps).collect::<Vec<_>>(), [1000 - 90 - 4]);
    let script = open(&address).script(ada, &board("cellar")).unwrap();
    assert_eq!(script.as_deref(), Some(run("cellar", 906, Rank::Thief).script()));
}

#[test]
fn databases_of_other_programs_are_left_alone() {
    let server = PostgresServer::shared();
    let refused = |address: &str| {
        let sentence = HostStore::connect(address).unwrap_err().to_string();
        let to_read = HostStore::connect_to_read(address).unwrap_err().to_string();
        assert_eq!((to_read.as_str(), sentence.lines().count()), (sentence.as_str(), 1));
        sentence
    };
    let newer = server.address();
    open(&newer).create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    server.sql(&format!("UPDATE {}.cellcaster SET version = 99", place(&newer)));
    assert!(refused(&newer).contains("has version 99, which a newer Cellcaster wrote"));
    let accounts = format!("SELECT count(*) FROM {}.accounts", place(&newer));
    assert_eq!(server.sql(&accounts).trim(), "1");
    let other = server.address();
    server.sql(&format!("CREATE TABLE {}.accounts (id BIGINT)", place(&other)));
    assert!(refused(&other).contains("belongs to another program"));
    server.sql("CREATE DATABASE latin ENCODING 'LATIN1' TEMPLATE template0 LOCALE 'C'");
    let latin = newer.replace("/postgres?", "/latin?");
    assert!(refused(&latin).contains("encoding UTF8"));
}

#[test]
fn an_older_database_is_left_alone() {
    let server = PostgresServer::shared();
    let address = server.address();
    server.sql(&format!(
        "SET search_path TO {}; CREATE TABLE cellcaster (version BIGINT NOT NULL); \
         INSERT INTO cellcaster VALUES (4)",
        place(&address)
    ));
    for opened in [HostStore::connect(&address).map(Some), HostStore::connect_to_read(&address)] {
        let sentence = opened.unwrap_err().to_string();
        assert!(sentence.contains("has version 4, which this Cellcaster can't read"), "{sentence}");
    }
}
