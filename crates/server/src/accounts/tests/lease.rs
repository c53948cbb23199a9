//! Leases, with a clock that the test sets and with a database's own clock.

use proptest::prelude::*;

use super::*;

/// Longer than any test takes.
const LONG: Duration = Duration::from_mins(1);
const SHORT: Duration = Duration::from_millis(200);

#[test]
fn a_room_has_one_holder() {
    with_each_clock(|leases| {
        assert_eq!(holder(leases, "cellar"), None);
        let lease = leases.acquire("cellar", "one", LONG, 0).unwrap().unwrap();
        assert_eq!((lease.room.as_str(), lease.host.as_str(), lease.time), ("cellar", "one", LONG));
        for host in ["one", "other"] {
            assert_eq!(leases.acquire("cellar", host, LONG, 0).unwrap(), None);
        }
        assert_eq!(holder(leases, "cellar").as_ref(), Some(&lease));
        // The lease of another room is independent.
        let other = leases.acquire("museum", "other", LONG, 0).unwrap().unwrap();
        assert_eq!(holder(leases, "museum"), Some(other));
        assert!(renew(leases, &lease));
    });
}

#[test]
fn many_leases_are_renewed_at_once() {
    with_each_clock(|leases| {
        let rooms: Vec<String> = (0..40).map(|it| format!("room \u{e9} \\ \"{it}\"")).collect();
        let take = |room: &String| leases.acquire(room, "one", SHORT * 5, 0).unwrap().unwrap();
        let mut held: Vec<Lease> = rooms.iter().map(take).collect();
        leases.release(&held[7]).unwrap();
        leases.release(&held[8]).unwrap();
        let taken = leases.acquire(&held[8].room, "other", LONG, 0).unwrap().unwrap();
        // One lease twice, and a lease of another host.
        held.extend([held[9].clone(), taken]);
        wait(leases, SHORT);
        let renewed = leases.renew(&held).unwrap();
        let expected: Vec<bool> = (0..42).map(|it| it != 7 && it != 8).collect();
        assert_eq!(renewed, expected);
        assert!(leases.renew(&[]).unwrap().is_empty());
    });
}

#[test]
fn epochs_grow_even_after_a_release() {
    with_each_clock(|leases| {
        let mut last = 0;
        for round in 0..6 {
            let host = ["one", "other"][round % 2];
            let lease = leases.acquire("cellar", host, LONG, 0).unwrap().unwrap();
            assert!(lease.epoch > last);
            last = lease.epoch;
            assert!(leases.release(&lease).unwrap());
            assert_eq!(holder(leases, "cellar"), None);
            // The lease has ended for good.
            assert!(!leases.release(&lease).unwrap() && !renew(leases, &lease));
        }
    });
}

#[test]
fn a_forgotten_room_starts_again_at_epoch_one() {
    with_each_clock(|leases| {
        let old = leases.acquire("cellar", "one", LONG, 0).unwrap().unwrap();
        leases.release(&old).unwrap();
        assert!(!leases.forget(&old).unwrap());
        let lease = leases.acquire("cellar", "one", LONG, 0).unwrap().unwrap();
        assert!(!leases.forget(&old).unwrap());
        assert!(leases.forget(&lease).unwrap() && !leases.forget(&lease).unwrap());
        assert!(!renew(leases, &lease));
        assert_eq!(holder(leases, "cellar"), None);
        assert_eq!(leases.acquire("cellar", "other", LONG, 0).unwrap().unwrap().epoch, 1);
    });
}

#[test]
fn an_expired_lease_can_be_taken() {
    with_each_clock(|leases| {
        let lease = leases.acquire("cellar", "one", SHORT, 0).unwrap().unwrap();
        wait(leases, SHORT * 2);
        assert_eq!(holder(leases, "cellar"), None);
        let next = leases.acquire("cellar", "other", LONG, 0).unwrap().unwrap();
        assert!(next.epoch > lease.epoch);
        assert!(!renew(leases, &lease) && !leases.release(&lease).unwrap());
        assert_eq!(holder(leases, "cellar"), Some(next));
    });
}

#[test]
fn an_expired_lease_can_be_renewed_if_nobody_took_it() {
    with_each_clock(|leases| {
        let lease = leases.acquire("cellar", "one", SHORT, 0).unwrap().unwrap();
        wait(leases, SHORT * 2);
        assert!(renew(leases, &lease));
        assert_eq!(holder(leases, "cellar"), Some(lease));
        assert_eq!(leases.acquire("cellar", "other", LONG, 0).unwrap(), None);
    });
}

#[test]
fn a_renewed_lease_lasts() {
    with_each_clock(|leases| {
        let lease = leases.acquire("cellar", "one", SHORT * 5, 0).unwrap().unwrap();
        for _ in 0..4 {
            wait(leases, SHORT * 2);
            assert!(renew(leases, &lease));
        }
        assert_eq!(leases.acquire("cellar", "other", LONG, 0).unwrap(), None);
    });
}

#[test]
fn a_new_epoch_exceeds_the_one_the_caller_knows() {
    with_each_clock(|leases| {
        let lease = leases.acquire("cellar", "one", LONG, 41).unwrap().unwrap();
        assert_eq!(lease.epoch, 42);
        leases.release(&lease).unwrap();
        assert_eq!(leases.acquire("cellar", "one", SHORT, 7).unwrap().unwrap().epoch, 43);
        wait(leases, SHORT * 2);
        assert_eq!(leases.acquire("cellar", "other", LONG, 99).unwrap().unwrap().epoch, 100);
    });
}

fn renew(leases: &mut HostStore, lease: &Lease) -> bool {
    leases.renew(std::slice::from_ref(lease)).unwrap() == [true]
}

/// The lease of a room, if it is in force.
fn holder(leases: &mut HostStore, room: &str) -> Option<Lease> {
    let sql = "SELECT host, epoch, time_ms FROM leases WHERE room = ?1 AND host IS NOT NULL \
               AND ends_at > (SELECT ms FROM clock)";
    let row = leases.database.once(|it| it.row(sql, &[&room])).unwrap()?;
    let (host, time) = (row.get(0).unwrap(), Duration::from_millis(row.count(2).unwrap()));
    Some(Lease { room: room.to_owned(), host, epoch: row.count(1).unwrap(), time })
}

/// A call of a host, or the passage of time.
#[derive(Clone, Debug)]
enum Event {
    Acquire(usize, usize, u64),
    /// Renews the newest lease that the host knows.
    Renew(usize, usize),
    Release(usize, usize),
    Pass(u64),
}

const HOSTS: [&str; 3] = ["one", "other", "third"];
const ROOMS: [&str; 2] = ["cellar", "museum"];

fn events() -> impl Strategy<Value = Vec<Event>> {
    let (host, room) = (0..HOSTS.len(), 0..ROOMS.len());
    let event = prop_oneof![
        4 => (host.clone(), room.clone(), 1..9_u64).prop_map(|(a, b, c)| Event::Acquire(a, b, c)),
        3 => (host.clone(), room.clone()).prop_map(|(a, b)| Event::Renew(a, b)),
        1 => (host, room).prop_map(|(a, b)| Event::Release(a, b)),
        4 => (0..6_u64).prop_map(Event::Pass),
    ];
    prop::collection::vec(event, 1..120)
}

/// A lease that a host knows to be its own until a time on the store's clock.
#[derive(Clone)]
struct Known {
    lease: Lease,
    until: u64,
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_two_hosts_share_a_room_or_an_epoch(events in events()) {
        let (mut leases, mut now) = (HostStore::in_memory(), 0);
        let mut known: Vec<Vec<Option<Known>>> = vec![vec![None; ROOMS.len()]; HOSTS.len()];
        let mut owners: Vec<Vec<(u64, usize)>> = vec![Vec::new(); ROOMS.len()];
        for event in events {
            match event {
                Event::Pass(seconds) => {
                    now += seconds;
                    leases.pass(Duration::from_secs(seconds));
                }
                Event::Acquire(host, room, seconds) => {
                    let time = Duration::from_secs(seconds);
                    if let Some(lease) = leases.acquire(ROOMS[room], HOSTS[host], time, 0).unwrap() {
                        let last = owners[room].last().map_or(0, |(epoch, _)| *epoch);
                        prop_assert!(lease.epoch > last);
                        owners[room].push((lease.epoch, host));
                        known[host][room] = Some(Known { lease, until: now + seconds });
                    }
                }
                Event::Renew(host, room) => {
                    let Some(own) = &mut known[host][room] else { continue };
                    if renew(&mut leases, &own.lease) {
                        prop_assert_eq!(owners[room].last(), Some(&(own.lease.epoch, host)));
                        own.until = now + own.lease.time.as_secs();
                    }
                }
                Event::Release(host, room) => {
                    let Some(own) = known[host][room].take() else { continue };
                    leases.release(&own.lease).unwrap();
                }
            }
            for (room, name) in ROOMS.iter().enumerate() {
                let holders: Vec<_> = known
                    .iter()
                    .filter_map(|of_host| of_host[room].as_ref().filter(|own| now < own.until))
                    .collect();
                let holder = holder(&mut leases, name);
                prop_assert!(holders.len() <= 1);
                prop_assert_eq!(holders.first().map(|own| &own.lease), holder.as_ref());
            }
        }
    }
}

#[cfg(all(unix, feature = "system-tests"))]
#[test]
fn hosts_racing_for_a_lease_have_one_winner() {
    let address = postgres_server::PostgresServer::shared().address();
    let mut last = 0;
    for round in 0..20 {
        let time = if round % 2 == 0 { SHORT / 10 } else { LONG };
        let taken = postgres::at_once(&address, 4, |host, store| {
            store.acquire("cellar", &host.to_string(), time, 0).unwrap()
        });
        let taken: Vec<Lease> = taken.into_iter().flatten().collect();
        // A short lease may end before the last host asks.
        assert!(taken.len() == 1 || (round % 2 == 0 && !taken.is_empty()), "{taken:?}");
        let mut epochs: Vec<u64> = taken.iter().map(|lease| lease.epoch).collect();
        epochs.sort_unstable();
        epochs.dedup();
        assert!(epochs.len() == taken.len() && epochs[0] > last, "{taken:?} after {last}");
        last = epochs[epochs.len() - 1];
        let mut store = HostStore::connect(&address).unwrap();
        if round % 2 == 0 {
            std::thread::sleep(SHORT / 5);
        } else {
            assert!(store.release(&taken[0]).unwrap());
        }
    }
}
