use std::pin::pin;
use std::task::{Context, Poll, Waker};

use super::*;
use crate::accounts::AddressPrefix;

fn next(presence: &mut Presence) -> Option<Notice> {
    match pin!(presence.notice()).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(notice) => Some(notice),
        Poll::Pending => None,
    }
}

fn here(last: u8) -> IpAddr {
    IpAddr::from([192, 0, 2, last])
}

#[test]
fn a_visitor_is_listed_while_present() -> Result<(), Box<dyn std::error::Error>> {
    let visitors = Visitors::default();
    let key = AccountKey::new([1; 32]);
    let one = visitors.arrive("::ffff:192.0.2.1".parse()?, Some(key));
    let other = visitors.arrive(here(2), None);
    one.set_name("Ada");
    one.set_room(Some("1 roam museum".to_owned()));
    let list = visitors.list();
    assert_eq!(list.len(), 2);
    assert_eq!((list[0].address, list[0].key), (here(1), Some(key)));
    assert_eq!(list[0].name, Some(Name::new("Ada")?));
    assert_eq!(list[0].room.as_deref(), Some("1 roam museum"));
    assert_eq!((list[1].address, &list[1].name, &list[1].room), (here(2), &None, &None));
    drop(one);
    assert_eq!(visitors.list().len(), 1);
    drop(other);
    assert!(visitors.list().is_empty());
    Ok(())
}

#[test]
fn lines_wait_in_order_and_are_bounded() {
    let visitors = Visitors::default();
    let mut present = [1, 2].map(|last| visitors.arrive(here(last), None));
    for number in 0..MAX_LINES + 3 {
        assert_eq!(visitors.say(&number.to_string()), 2);
    }
    for presence in &mut present {
        for number in 3..MAX_LINES + 3 {
            assert_eq!(next(presence), Some(Notice::Said(number.to_string())));
        }
        assert_eq!(next(presence), None);
    }
}

#[test]
fn a_flood_of_other_visitors_displaces_no_line_of_the_operator() {
    let visitors = Visitors::default();
    let [mut ada, mut ben, mut unnamed] = [1, 2, 3].map(|last| visitors.arrive(here(last), None));
    ada.set_name("Ada");
    ben.set_name("Ben");
    ben.set_room(Some("room 1".to_owned()));
    visitors.say("closing soon");
    let line = |number: usize, is_private| {
        let (from, text) = ("Eve".to_owned(), number.to_string());
        Heard { from, text, is_private }
    };
    for number in 0..MAX_LINES + 3 {
        assert_eq!(visitors.tell(&Name::kept("ADA"), &line(number, true)), 1);
    }
    visitors.tell_lobby(&line(99, false));
    assert_eq!(visitors.tell(&Name::kept("Eve"), &line(0, true)), 0);
    for presence in [&mut ada, &mut ben, &mut unnamed] {
        assert_eq!(next(presence), Some(Notice::Said("closing soon".to_owned())));
    }
    for number in 4..MAX_LINES + 3 {
        assert_eq!(next(&mut ada), Some(Notice::Heard(line(number, true))));
    }
    assert_eq!(next(&mut ada), Some(Notice::Heard(line(99, false))));
    for presence in [&mut ada, &mut ben, &mut unnamed] {
        assert_eq!(next(presence), None);
    }
}

#[test]
fn a_removal_reaches_its_targets_before_any_line() -> Result<(), Box<dyn std::error::Error>> {
    let visitors = Visitors::default();
    let key = AccountKey::new([1; 32]);
    let mut ada = visitors.arrive(here(1), Some(key));
    let mut ben = visitors.arrive(here(2), None);
    ada.set_name("Ada");
    ben.set_name("guest-4");
    let network = AddressPrefix::parse("192.0.2.0/24").ok_or("no prefix")?;
    visitors.say("hello");
    for (target, count) in [
        (BanTarget::Name(Name::new("ADA")?), 1),
        (BanTarget::Key(key), 1),
        (BanTarget::Key(AccountKey::new([2; 32])), 0),
        (BanTarget::Name(Name::of_guest(4)), 1),
        (BanTarget::Addresses(network), 2),
    ] {
        assert_eq!(visitors.remove(&target, "go"), count, "{target:?}");
    }
    for presence in [&mut ada, &mut ben] {
        assert_eq!(next(presence), Some(Notice::Removed("go".to_owned())));
        assert_eq!(next(presence), Some(Notice::Said("hello".to_owned())));
    }
    Ok(())
}

#[test]
fn one_of_several_sessions_with_one_name_can_be_removed() {
    let (visitors, later) = (Visitors::default(), Visitors::default());
    let mut sessions = [1, 1].map(|last| visitors.arrive(here(last), None));
    let mut other = later.arrive(here(1), None);
    for session in &sessions {
        session.set_name("Ada");
    }
    let ids: Vec<SessionId> = visitors.list().iter().map(|present| present.session).collect();
    assert_ne!(ids[0], ids[1]);
    let written = SessionId::parse(&ids[1].to_string());
    assert_eq!(written, Some(ids[1]));
    assert!(visitors.remove_session(ids[1], "go"));
    assert_eq!(next(&mut sessions[0]), None);
    assert_eq!(next(&mut sessions[1]), Some(Notice::Removed("go".to_owned())));
    // The same number in another run of the host is a different session.
    let of_other_run = SessionId { run: locked(&later.0, |table| table.run) ^ 1, number: 1 };
    assert!(!later.remove_session(of_other_run, "go"));
    assert_eq!(next(&mut other), None);
    for text in ["", "7", "-", "3f9a-", "3f9a-+7", "+f9a-7", "3f9-7", "3f9a-99999999999999999999"] {
        assert_eq!(SessionId::parse(text), None, "{text}");
    }
}
