use std::net::Ipv4Addr;

use proptest::prelude::*;

use super::*;

const START: Duration = Duration::ZERO;

/// With small limits.
fn admission() -> Admission {
    let startups = Startups { begin: 10, percent: 30, full: 100, per_network: 20 };
    Admission::new(Limits { per_address: 8, startups, ..Limits::default() })
}

/// Forty people behind one address, or with addresses of one /64, read the fingerprint of the host at the same
/// time, whatever chance says.
#[test]
fn a_classroom_gets_in_by_default() {
    for (seed, last) in (0..50).zip([0, 1].into_iter().cycle()) {
        let mut admission = Admission::new(Limits::default());
        let mut chance = SplitMix64::new(seed);
        let pupil = |number: u16| IpAddr::from([0x2001, 0xdb8, 0, 7, 0, 0, 0, number * last]);
        let ids: Vec<VisitId> = (1..=40)
            .map(|number| admission.arrive(pupil(number), START, &mut chance).unwrap())
            .collect();
        for id in ids {
            assert_eq!(admission.log_in(id, None, START), Ok(()));
        }
        // Some open a second window.
        for number in 1..=24 {
            let id = admission.arrive(pupil(number), START, &mut chance).unwrap();
            assert_eq!(admission.log_in(id, None, START), Ok(()));
        }
        assert_eq!(admission.arrive(pupil(41), START, &mut chance), Err(Refusal::Address));
        assert!(admission.arrive(address(1, 1), START, &mut chance).is_ok());
    }
}

/// However many connections of one network say nothing.
#[test]
fn one_network_alone_has_nobody_else_refused_by_default() {
    let mut admission = Admission::new(Limits::default());
    let mut chance = SplitMix64::new(1);
    for host in 0..1000_u32 {
        _ = admission.arrive(address(1, host as u8), START, &mut chance);
    }
    for network in 2..200 {
        let id = admission.arrive(address(network, 1), START, &mut chance).unwrap();
        admission.leave(id, Outcome::Served, START);
    }
}

#[test]
fn a_network_of_ipv6_counts_as_one_address() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let of = |network: u16, host: u16| IpAddr::from([0x2001, 0xdb8, 0, network, 0, 0, 0, host]);
    for host in 0..8 {
        assert!(admission.arrive(of(1, host), START, &mut chance).is_ok());
    }
    assert_eq!(admission.arrive(of(1, 8), START, &mut chance), Err(Refusal::Address));
    assert!(admission.arrive(of(2, 8), START, &mut chance).is_ok());
    let mapped: IpAddr = "::ffff:192.0.2.1".parse().unwrap();
    assert_eq!(counted_address(mapped), IpAddr::from([192, 0, 2, 1]));
}

#[test]
fn a_refusal_names_its_limit_in_one_sentence() {
    let limits = Limits { per_key: 1, ..Limits::default() };
    for (refusal, part) in [
        (Refusal::Full, "at most 1200 connections at a time"),
        (Refusal::Address, "at most 64 connections from one address"),
        (Refusal::Key, "at most 1 connection with one key"),
        (Refusal::Startups, "at most 40 of one network, and 200 in all"),
        (Refusal::Penalty, "one is forgotten every 10 s"),
    ] {
        let sentence = refusal.sentence(&limits);
        assert!(sentence.contains(part) && sentence.ends_with('.'), "{sentence}");
        // More than this, OpenSSH does not print.
        assert!(sentence.len() < 400 && sentence.lines().count() == 1, "{sentence}");
    }
}

fn address(network: u8, host: u8) -> IpAddr {
    IpAddr::V4(Ipv4Addr::new(10, 0, network, host))
}

fn key(number: u8) -> KeyData {
    use russh::keys::ssh_key::public::{Ed25519PublicKey, KeyData as Public};
    KeyData::new(&Public::from(Ed25519PublicKey([number; 32]))).unwrap()
}

#[test]
fn one_address_has_eight_connections() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let mut ids = Vec::new();
    for _ in 0..8 {
        let id = admission.arrive(address(1, 1), START, &mut chance).unwrap();
        assert_eq!(admission.log_in(id, None, START), Ok(()));
        ids.push(id);
    }
    assert_eq!(admission.arrive(address(1, 1), START, &mut chance), Err(Refusal::Address));
    assert!(admission.arrive(address(1, 2), START, &mut chance).is_ok());
    admission.leave(ids[0], Outcome::Served, START);
    assert!(admission.arrive(address(1, 1), START, &mut chance).is_ok());
}

#[test]
fn one_key_has_three_connections_from_anywhere() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let ids: Vec<VisitId> = (0..4)
        .map(|host| admission.arrive(address(host, 1), START, &mut chance).unwrap())
        .collect();
    for &id in &ids[..3] {
        assert_eq!(admission.log_in(id, Some(key(7)), START), Ok(()));
    }
    assert_eq!(admission.log_in(ids[3], Some(key(7)), START), Err(Refusal::Key));
    admission.leave(ids[3], Outcome::Served, START);
    admission.leave(ids[0], Outcome::Served, START);
    let next = admission.arrive(address(9, 1), START, &mut chance).unwrap();
    assert_eq!(admission.log_in(next, Some(key(7)), START), Ok(()));
}

/// From one network, connections that say nothing leave room for everybody else.
#[test]
fn half_open_connections_of_one_network_lock_nobody_out() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    for round in 0..10_000_u32 {
        _ = admission.arrive(address(1, round as u8), START, &mut chance);
    }
    assert!(admission.unauthenticated() <= 20);
    let admitted = (0..200).filter(|&network| {
        let Ok(id) = admission.arrive(address(network, 1), START, &mut chance) else {
            return false;
        };
        admission.leave(id, Outcome::Served, START);
        true
    });
    assert!(admitted.count() > 100);
}

/// A network that floods is refused nearly always, and forgiven in time.
#[test]
fn failures_are_penalised_and_forgotten() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let mut tries = |admission: &mut Admission, outcome, now| {
        let mut admitted = 0;
        for _ in 0..1000 {
            if let Ok(id) = admission.arrive(address(1, 1), now, &mut chance) {
                admission.leave(id, outcome, now);
                admitted += 1;
            }
        }
        admitted
    };
    let admitted = tries(&mut admission, Outcome::BrokeProtocol, START);
    assert!((7..200).contains(&admitted), "{admitted}");
    assert!(tries(&mut admission, Outcome::Served, START) < 200);
    let later = Duration::from_secs(100);
    assert_eq!(tries(&mut admission, Outcome::Served, later), 1000);
}

/// Behind one address are an attacker and four players, who log in now and then.
#[test]
fn a_player_beside_an_attacker_gets_in() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let mut tries_of_players = Vec::new();
    for second in 0..3600 {
        let now = Duration::from_secs(second);
        for _ in 0..10 {
            if let Ok(id) = admission.arrive(address(1, 1), now, &mut chance) {
                admission.leave(id, Outcome::LeftEarly, now);
            }
        }
        if second % 60 == 0 {
            let mut tries = 1;
            let id = loop {
                match admission.arrive(address(1, 1), now, &mut chance) {
                    Ok(id) => break id,
                    Err(refusal) => assert_eq!(refusal, Refusal::Penalty),
                }
                tries += 1;
            };
            _ = admission.log_in(id, None, now);
            admission.leave(id, Outcome::Served, now);
            tries_of_players.push(tries);
        }
    }
    tries_of_players.sort_unstable();
    assert!(tries_of_players[tries_of_players.len() / 2] <= 12, "{tries_of_players:?}");
}

#[derive(Clone, Debug)]
enum Act {
    Arrive(u8, u8),
    LogIn(usize, Option<u8>),
    Leave(usize, Outcome),
    Wait(u16),
}

fn acts() -> impl Strategy<Value = Vec<Act>> {
    let outcome = prop_oneof![
        Just(Outcome::Served),
        Just(Outcome::LeftEarly),
        Just(Outcome::TimedOut),
        Just(Outcome::BrokeProtocol),
    ];
    let act = prop_oneof![
        4 => (0..4_u8, 0..4_u8).prop_map(|(network, host)| Act::Arrive(network, host)),
        3 => (0..300_usize, prop::option::of(0..4_u8)).prop_map(|(id, key)| Act::LogIn(id, key)),
        3 => (0..300_usize, outcome).prop_map(|(id, outcome)| Act::Leave(id, outcome)),
        1 => any::<u16>().prop_map(Act::Wait),
    ];
    prop::collection::vec(act, 0..400)
}

proptest! {
    /// Whatever happens, in whatever order, no count passes its limit, and all return to nothing.
    #[test]
    fn counts_are_exact(acts in acts(), seed: u64) {
        let (mut admission, mut chance) = (admission(), SplitMix64::new(seed));
        let mut now = START;
        for act in acts {
            match act {
                Act::Arrive(network, host) => {
                    _ = admission.arrive(address(network, host), now, &mut chance);
                }
                Act::LogIn(id, number) => {
                    _ = admission.log_in(VisitId(id as u64), number.map(key), now);
                }
                Act::Leave(id, outcome) => admission.leave(VisitId(id as u64), outcome, now),
                Act::Wait(time) => now += Duration::from_millis(u64::from(time)),
            }
            let open = admission.visits.values().filter(|visit| !visit.is_authenticated);
            prop_assert_eq!(admission.unauthenticated(), open.count());
            prop_assert!(admission.per_address.values().all(|&count| (1..=8).contains(&count)));
            prop_assert!(admission.per_key.values().all(|&count| (1..=3).contains(&count)));
            prop_assert!(admission.per_network.values().all(|&count| (1..=20).contains(&count)));
            let total: u32 = admission.per_address.values().sum();
            prop_assert_eq!(total as usize, admission.connections());
        }
        for id in admission.visits.keys().copied().collect::<Vec<_>>() {
            admission.leave(id, Outcome::Served, now);
        }
        prop_assert_eq!(admission.unauthenticated(), 0);
        prop_assert!(admission.per_address.is_empty());
        prop_assert!(admission.per_key.is_empty());
        prop_assert!(admission.per_network.is_empty());
    }

    /// The answers depend on the time, the chance and what happened, and on nothing else.
    #[test]
    fn the_same_seed_gives_the_same_answers(seed: u64) {
        let run = || {
            let (mut admission, mut chance) = (admission(), SplitMix64::new(seed));
            (0..200_u32)
                .map(|round| {
                    let now = Duration::from_millis(u64::from(round));
                    let arrived = admission.arrive(address(round as u8 % 3, 1), now, &mut chance);
                    if let Ok(id) = arrived {
                        admission.leave(id, Outcome::TimedOut, now);
                    }
                    arrived
                })
                .collect::<Vec<_>>()
        };
        prop_assert_eq!(run(), run());
    }
}
