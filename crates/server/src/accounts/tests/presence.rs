//! Visits and hosts, with a clock that the test sets and with a database's own clock.

use super::*;

const LONG: Duration = Duration::from_mins(1);
const SHORT: Duration = Duration::from_millis(200);

fn ada() -> String {
    key(1).to_string()
}

fn network() -> String {
    "2001:db8::/64".to_owned()
}

fn notice(name: &str, load: u32) -> HostNotice {
    HostNotice {
        name: name.to_owned(),
        version: "0.1.0".to_owned(),
        address: format!("{name}.example.org:2222"),
        load,
    }
}

fn announce(presence: &mut HostStore, hosts: &[&str]) {
    for host in hosts {
        presence.announce(&notice(host, 0)).unwrap();
    }
}

/// Begins a visit that must be let in.
fn begin(presence: &mut HostStore, host: &str, visitor: &str, most: u32) -> VisitId {
    match presence.begin_visits(host, &[(visitor.to_owned(), most)], LONG).unwrap() {
        Ok(visits) => visits[0],
        Err((_, ago)) => panic!("too many on hosts that were there {ago:?} ago"),
    }
}

/// Asserts a visit's refusal, and returns the age of the information behind it.
fn refused(presence: &mut HostStore, host: &str, visitor: &str, most: u32) -> Duration {
    match presence.begin_visits(host, &[(visitor.to_owned(), most)], LONG).unwrap() {
        Err((_, ago)) => ago,
        Ok(visits) => panic!("{visits:?} have begun"),
    }
}

/// The hosts and the visitors of all visits.
fn visits(presence: &mut HostStore) -> Vec<(String, String)> {
    let sql = "SELECT host, visitor FROM visits ORDER BY id";
    let rows = presence.database.once(|it| it.rows(sql, &[])).unwrap();
    rows.iter().map(|row| (row.get(0).unwrap(), row.get(1).unwrap())).collect()
}

#[test]
fn a_visitor_is_limited_across_all_hosts() {
    with_each_clock(|presence| {
        announce(presence, &["one", "other", "third"]);
        let first = begin(presence, "one", &ada(), 2);
        let second = begin(presence, "other", &ada(), 2);
        assert_ne!(first, second);
        for host in ["one", "other", "third"] {
            refused(presence, host, &ada(), 2);
        }
        let third = begin(presence, "one", &network(), 1);
        let expected = [("one", ada()), ("other", ada()), ("one", network())];
        assert_eq!(visits(presence), expected.map(|(host, visitor)| (host.to_owned(), visitor)));
        presence.end_other_visits("one", &[third].into()).unwrap();
        assert_eq!(visits(presence).len(), 2);
        begin(presence, "third", &ada(), 2);
        assert_eq!(refused(presence, "third", &ada(), 0), Duration::ZERO);
        // A host that has left has no visits, and is not present.
        presence.leave("one").unwrap();
        assert_eq!(visits(presence).len(), 2);
        assert_eq!(presence.hosts(LONG).unwrap().len(), 2);
    });
}

#[test]
fn visits_count_while_their_host_is_present() {
    with_each_clock(|presence| {
        announce(presence, &["one", "killed"]);
        begin(presence, "one", &ada(), 1);
        begin(presence, "killed", &network(), 1);
        wait(presence, SHORT * 2);
        announce(presence, &["one", "other"]);
        assert!(refused(presence, "other", &ada(), 1) < SHORT);
        // The host may have been killed, so the refusal says how old its last announcement is.
        assert!(refused(presence, "other", &network(), 1) >= SHORT * 2);
        let limits = [(ada(), 2), (network(), 1)];
        let begun = presence.begin_visits("other", &limits, SHORT).unwrap();
        assert!(begun.is_ok(), "{begun:?}");
        // A host that was late still has its visitors.
        announce(presence, &["killed"]);
        refused(presence, "other", &network(), 2);
        // A visit by two limits begins by both or by none.
        let limits = [(ada(), 3), (network(), 2)];
        let begun = presence.begin_visits("other", &limits, LONG).unwrap();
        assert_eq!(begun.unwrap_err().0, 1);
        assert_eq!(visits(presence).len(), 4);
    });
}

#[test]
fn a_refusal_reports_the_age_of_the_oldest_host_it_needs() {
    with_each_clock(|presence| {
        announce(presence, &["old", "one", "other"]);
        for host in ["old", "one", "other"] {
            begin(presence, host, &ada(), 3);
        }
        wait(presence, SHORT * 2);
        announce(presence, &["one", "other"]);
        assert!(refused(presence, "one", &ada(), 3) >= SHORT * 2);
        assert!(refused(presence, "one", &ada(), 2) < SHORT);
    });
}

#[test]
fn a_host_is_present_while_it_announces_itself() {
    with_each_clock(|presence| {
        presence.announce(&notice("one", 1)).unwrap();
        presence.announce(&notice("other", 2)).unwrap();
        wait(presence, SHORT * 2);
        presence.announce(&notice("one", 3)).unwrap();
        let told = |presence: &mut HostStore, time| -> Vec<HostNotice> {
            presence.hosts(time).unwrap().into_iter().map(|row| row.notice).collect()
        };
        assert_eq!(told(presence, LONG), [notice("one", 3), notice("other", 2)]);
        assert_eq!(told(presence, SHORT), [notice("one", 3)]);
        let rows = presence.hosts(LONG).unwrap();
        assert!(rows[0].ago < rows[1].ago && rows[1].ago >= SHORT * 2, "{rows:?}");
    });
}

#[cfg(all(unix, feature = "system-tests"))]
#[test]
fn simultaneous_visits_do_not_exceed_the_limit() {
    let address = postgres_server::PostgresServer::shared().address();
    let hosts = ["a", "b", "c", "d", "e", "f"];
    announce(&mut HostStore::connect(&address).unwrap(), &hosts);
    let begun = postgres::at_once(&address, 6, |host, store| {
        let host = hosts[usize::from(host) - 1];
        let mut begin = || store.begin_visits(host, &[(ada(), 7)], LONG).unwrap();
        [begin(), begin(), begin()]
    });
    assert_eq!(begun.as_flattened().iter().flatten().count(), 7);
    assert_eq!(visits(&mut HostStore::connect(&address).unwrap()).len(), 7);
}
