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
    match presence.begin_visit(host, visitor, most, LONG).unwrap() {
        Ok(visit) => visit,
        Err(ago) => panic!("too many on hosts that were there {ago:?} ago"),
    }
}

/// Asserts a visit's refusal, and returns the age of the information behind it.
fn refused(presence: &mut HostStore, host: &str, visitor: &str, most: u32) -> Duration {
    match presence.begin_visit(host, visitor, most, LONG).unwrap() {
        Err(ago) => ago,
        Ok(visit) => panic!("{visit:?} has begun"),
    }
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
        let visits = presence.visits(LONG).unwrap();
        let shown: Vec<_> =
            visits.iter().map(|it| (it.id, it.host.as_str(), it.visitor.clone())).collect();
        let expected = [(first, "one", ada()), (second, "other", ada()), (third, "one", network())];
        assert_eq!(shown, expected);
        presence.end_visit(first).unwrap();
        begin(presence, "third", &ada(), 2);
        assert_eq!(refused(presence, "third", &ada(), 0), Duration::ZERO);
        // A host that has left has no visits, and is not present.
        presence.leave("one").unwrap();
        assert_eq!(presence.visits(LONG).unwrap().len(), 2);
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
        assert_eq!(presence.visits(SHORT).unwrap().len(), 1);
        let begun = presence.begin_visit("other", &network(), 1, SHORT).unwrap();
        assert!(begun.is_ok(), "{begun:?}");
        // A host that was late still has its visitors.
        announce(presence, &["killed"]);
        assert_eq!(presence.visits(SHORT).unwrap().len(), 3);
        refused(presence, "other", &network(), 2);
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
        let mut begin = || store.begin_visit(host, &ada(), 7, LONG).unwrap();
        [begin(), begin(), begin()]
    });
    assert_eq!(begun.as_flattened().iter().flatten().count(), 7);
    assert_eq!(HostStore::connect(&address).unwrap().visits(LONG).unwrap().len(), 7);
}
