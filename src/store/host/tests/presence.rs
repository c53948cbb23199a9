//! Visits and hosts, by a clock that is set and by that of a database.

use std::time::Duration;

use super::*;

/// What a test waits for the clock of, one way or another.
trait Timed: Presence {
    fn wait(&mut self, time: Duration);
}

impl Timed for MemoryPresence {
    fn wait(&mut self, time: Duration) {
        self.pass(time);
    }
}

#[cfg(all(unix, feature = "cluster-tests"))]
impl Timed for PostgresStore {
    fn wait(&mut self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// Runs a test with a store of each kind.
fn with_each(test: impl Fn(&mut dyn Timed)) {
    test(&mut MemoryPresence::default());
    #[cfg(all(unix, feature = "cluster-tests"))]
    test(&mut PostgresStore::open(&postgres_server::PostgresServer::shared().address()).unwrap());
}

const LONG: Duration = Duration::from_mins(1);
const SHORT: Duration = Duration::from_millis(200);

fn ada() -> Visitor {
    Visitor::Key(key(1))
}

fn network() -> Visitor {
    Visitor::Addresses(AddressPrefix::parse("2001:db8::/64").unwrap())
}

#[test]
fn the_visits_of_somebody_are_limited_over_all_hosts() {
    with_each(|presence| {
        let first = presence.begin_visit("one", &ada(), 2, LONG).unwrap().unwrap();
        let second = presence.begin_visit("other", &ada(), 2, LONG).unwrap().unwrap();
        assert_ne!(first, second);
        for host in ["one", "other", "third"] {
            assert_eq!(presence.begin_visit(host, &ada(), 2, LONG).unwrap(), None);
        }
        let third = presence.begin_visit("one", &network(), 1, LONG).unwrap().unwrap();
        let visits = presence.visits().unwrap();
        let shown: Vec<_> = visits.iter().map(|it| (it.id, it.host.as_str(), it.visitor)).collect();
        let expected = [(first, "one", ada()), (second, "other", ada()), (third, "one", network())];
        assert_eq!(shown, expected);
        assert!(visits.iter().all(|visit| visit.since < LONG));
        presence.end_visit(first).unwrap();
        presence.begin_visit("third", &ada(), 2, LONG).unwrap().unwrap();
        assert_eq!(presence.begin_visit("third", &ada(), 0, LONG).unwrap(), None);
        // A host that begins anew has nobody.
        assert_eq!(presence.end_visits("one").unwrap(), 1);
        assert_eq!(presence.end_visits("one").unwrap(), 0);
        assert_eq!(presence.visits().unwrap().len(), 2);
    });
}

#[test]
fn visits_count_while_their_host_renews_them() {
    with_each(|presence| {
        presence.begin_visit("one", &ada(), 1, SHORT).unwrap().unwrap();
        presence.begin_visit("killed", &network(), 1, SHORT).unwrap().unwrap();
        assert_eq!(presence.renew_visits("one", LONG).unwrap(), 1);
        presence.wait(SHORT * 2);
        assert_eq!(presence.begin_visit("other", &ada(), 1, LONG).unwrap(), None);
        presence.begin_visit("other", &network(), 1, LONG).unwrap().unwrap();
        assert_eq!(presence.visits().unwrap().len(), 2);
        // A host that was late has its visitors none the less.
        assert_eq!(presence.renew_visits("killed", LONG).unwrap(), 1);
        assert_eq!(presence.visits().unwrap().len(), 3);
        assert_eq!(presence.begin_visit("other", &network(), 2, LONG).unwrap(), None);
    });
}

#[test]
fn a_host_is_there_while_it_announces_itself() {
    let notice = |name: &str, load| HostNotice {
        name: name.to_owned(),
        version: "0.1.0".to_owned(),
        address: format!("{name}.example.org:2222"),
        load,
    };
    with_each(|presence| {
        presence.announce(&notice("one", 1)).unwrap();
        presence.announce(&notice("other", 2)).unwrap();
        presence.wait(SHORT * 2);
        presence.announce(&notice("one", 3)).unwrap();
        let told = |presence: &mut dyn Timed, time| -> Vec<HostNotice> {
            presence.hosts(time).unwrap().into_iter().map(|row| row.notice).collect()
        };
        assert_eq!(told(presence, LONG), [notice("one", 3), notice("other", 2)]);
        assert_eq!(told(presence, SHORT), [notice("one", 3)]);
        let rows = presence.hosts(LONG).unwrap();
        assert!(rows[0].ago < rows[1].ago && rows[1].ago >= SHORT * 2, "{rows:?}");
    });
}

#[test]
fn a_visitor_is_read_as_it_is_written() {
    for visitor in [ada(), network()] {
        assert_eq!(Visitor::parse(&visitor.to_string()), Some(visitor));
    }
    assert_eq!(Visitor::parse("ada"), None);
}

#[cfg(all(unix, feature = "cluster-tests"))]
#[test]
fn of_visits_that_begin_at_once_no_more_than_allowed_do() {
    let address = postgres_server::PostgresServer::shared().address();
    PostgresStore::open(&address).unwrap();
    let barrier = std::sync::Barrier::new(6);
    let begun: Vec<VisitId> = std::thread::scope(|scope| {
        let threads: Vec<_> = ["a", "b", "c", "d", "e", "f"]
            .into_iter()
            .map(|host| {
                let (barrier, address) = (&barrier, &address);
                scope.spawn(move || {
                    let mut store = PostgresStore::open(address).unwrap();
                    barrier.wait();
                    let mut begin = || store.begin_visit(host, &ada(), 7, LONG).unwrap();
                    [begin(), begin(), begin()]
                })
            })
            .collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).flatten().collect()
    });
    assert_eq!(begun.len(), 7, "{begun:?}");
    assert_eq!(PostgresStore::open(&address).unwrap().visits().unwrap().len(), 7);
}
