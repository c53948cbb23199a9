//! The limit on the accounts that a network may create.

use super::*;

fn origin(address: &str) -> Origin {
    Origin::new(address.parse().unwrap(), AccountRate { per_hour: 20, at_once: 3 })
}

/// Creates an account at the given second.
fn create(
    store: &mut HostStore,
    address: &str,
    number: u8,
    second: u64,
) -> Result<Account, AccountRefusal> {
    let name = name(&format!("n-{number}-x"));
    let now = UnixTime::new(1_795_300_000 + second);
    store.create_account(Some(&origin(address)), &key(number), &name, now)
}

#[test]
fn accounts_per_network_are_limited() {
    with_each(|store| {
        for number in 0..3 {
            create(store, &format!("192.0.2.{number}"), number, 0).unwrap();
        }
        let refused = create(store, "192.0.2.9", 9, 1).unwrap_err();
        assert_eq!(refused, AccountRefusal::TooManyAccounts { seconds: 179 });
        let sentence = "Your network has created too many accounts; try again in 3m.";
        assert_eq!(refused.to_string(), sentence);
        assert_eq!(store.account(&key(9)).unwrap(), None);
        // Other networks do not matter, and neither does a refused name.
        create(store, "192.0.3.1", 3, 1).unwrap();
        create(store, "2001:db8::1", 4, 1).unwrap();
        let taken =
            store.create_account(Some(&origin("192.0.3.2")), &key(10), &name("n-0-x"), at(0));
        assert_eq!(taken, Err(AccountRefusal::NameTaken));
        create(store, "192.0.3.2", 5, 1).unwrap();
        create(store, "192.0.3.3", 6, 1).unwrap();
        assert!(create(store, "192.0.3.4", 7, 1).is_err());
        // One more after three minutes.
        create(store, "192.0.2.9", 9, 180).unwrap();
        let refused = create(store, "192.0.2.9", 11, 359).unwrap_err();
        assert!(refused.to_string().ends_with("try again in 1m."), "{refused}");
        // After an hour, the whole allowance again.
        for number in 12..15 {
            create(store, "192.0.2.9", number, 4000).unwrap();
        }
        assert!(create(store, "192.0.2.9", 15, 4000).is_err());
        // There is no limit without a network.
        store.create_account(None, &key(16), &name("Ada"), at(0)).unwrap();
    });
}

#[cfg(all(unix, feature = "system-tests"))]
#[test]
fn hosts_count_accounts_per_network_together() {
    let address = postgres_server::PostgresServer::shared().address();
    HostStore::connect(&address).unwrap();
    let made: usize = std::thread::scope(|scope| {
        let hosts: Vec<_> = (0..4_u8)
            .map(|host| {
                let address = &address;
                scope.spawn(move || {
                    let mut store = HostStore::connect(address).unwrap();
                    let number = |index| 4 * host + index;
                    let made =
                        (0..4).map(|index| create(&mut store, "192.0.2.1", number(index), 0));
                    made.flatten().count()
                })
            })
            .collect();
        hosts.into_iter().map(|host| host.join().unwrap()).sum()
    });
    assert_eq!(made, 3);
}
