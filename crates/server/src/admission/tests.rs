use std::collections::VecDeque;
use std::net::{Ipv4Addr, Ipv6Addr};

use proptest::prelude::*;

use super::*;

const START: Duration = Duration::ZERO;
const LIMITS: Limits = Limits {
    connections: 1200,
    per_address: 64,
    per_key: 3,
    startups: 200,
    failures: 20,
    forget: Duration::from_secs(10),
};

/// An admission with small limits.
fn admission() -> Admission {
    Admission::new(Limits { per_address: 8, startups: 20, ..LIMITS })
}

/// Forty people behind one address, or with addresses in one /64, read the host's fingerprint at the same
/// time. All of them get in, whatever the random numbers.
#[test]
fn a_classroom_gets_in_by_default() {
    for (seed, last) in (0..50).zip([0, 1].into_iter().cycle()) {
        let mut admission = Admission::new(LIMITS);
        let mut chance = SplitMix64::new(seed);
        let pupil = |number: u16| IpAddr::from([0x2001, 0xdb8, 0, 7, 0, 0, 0, number * last]);
        let ids: Vec<ConnectionId> = (1..=40)
            .map(|number| admission.arrive(pupil(number), START, &mut chance).unwrap().id)
            .collect();
        for id in ids {
            assert_eq!(admission.log_in(id, None, START), Ok(()));
        }
        // Some open a second window.
        for number in 1..=24 {
            let id = admission.arrive(pupil(number), START, &mut chance).unwrap().id;
            assert_eq!(admission.log_in(id, None, START), Ok(()));
        }
        assert_eq!(admission.arrive(pupil(41), START, &mut chance), Err(Refusal::Address));
        assert!(admission.arrive(address(1, 1), START, &mut chance).is_ok());
    }
}

/// The share of newcomers who log in during a flood. A newcomer arrives every tenth of a second, each alone in
/// a network, and takes a second to log in. In each tenth of a second, `flood` connections arrive and say
/// nothing.
fn logged_in_during(flood: u32, address_of: impl Fn(u32) -> IpAddr) -> f64 {
    const NEWCOMERS: u32 = 238;
    let mut admission = Admission::new(LIMITS);
    let mut chance = SplitMix64::new(1);
    let (mut arrivals, mut silent) = (0, VecDeque::new());
    let (mut newcomers, mut logged_in) = (VecDeque::new(), 0);
    for tenth in 0..NEWCOMERS + 10 {
        let now = Duration::from_millis(100) * tenth;
        for _ in 0..flood {
            arrivals += 1;
            if let Ok(Admitted { id, .. }) =
                admission.arrive(address_of(arrivals), now, &mut chance)
            {
                silent.push_back((now + Duration::from_secs(3), id));
            }
        }
        while let Some((_, id)) = silent.pop_front_if(|(until, _)| *until <= now) {
            admission.leave(id, Outcome::TimedOut, now);
        }
        if let Some(Ok(Admitted { id, .. })) = newcomers.pop_front_if(|_| tenth >= 10) {
            logged_in += u32::from(admission.log_in(id, None, now).is_ok());
        }
        let newcomer = Ipv4Addr::from_bits(0x5000_0001 + (tenth << 16));
        newcomers.push_back(admission.arrive(newcomer.into(), now, &mut chance));
        assert!(admission.waiting.len() <= 200);
    }
    f64::from(logged_in) / f64::from(NEWCOMERS)
}

#[test]
fn silent_connections_from_few_networks_block_no_newcomer() {
    let of_eight =
        |arrival: u32| Ipv4Addr::from_bits(0x0a00_0000 + ((arrival % 8) << 16) + arrival);
    for flood in [14, 140] {
        let share = logged_in_during(flood, |arrival| of_eight(arrival).into());
        assert!(share >= 0.95, "{share} at {flood}");
    }
}

/// A flood without penalties, because each connection comes from a network of its own.
#[test]
fn a_flood_from_one_wide_network_displaces_itself() {
    let v4 = |arrival: u32| IpAddr::V4(Ipv4Addr::from_bits(0x0a00_0001 + ((arrival % 256) << 8)));
    let v6 = |arrival: u32| {
        let network = 0x2001_0db8_0007_0000_u64 + u64::from(arrival % 65_536);
        IpAddr::V6(Ipv6Addr::from_bits((u128::from(network) << 64) | 1))
    };
    for flood in [20, 200] {
        for share in [logged_in_during(flood, v4), logged_in_during(flood, v6)] {
            assert!(share >= 0.95, "{share} at {flood}");
        }
    }
}

/// At each width, the busiest network makes room. Its oldest connection goes first.
#[test]
fn the_oldest_connection_of_the_busiest_network_makes_room() {
    let limits = Limits { startups: 8, ..LIMITS };
    let (mut admission, mut chance) = (Admission::new(limits), SplitMix64::new(1));
    let addresses = [
        "192.0.2.1",
        "198.51.100.1",
        // Four in one /48; three of them in one /56; two of these in one /64.
        "2001:db8:1:100::1",
        "2001:db8:1:200::1",
        "2001:db8:1:201::1",
        "2001:db8:1:201::2",
        "203.0.113.1",
        "203.0.113.2",
    ];
    let mut arrive =
        |address: &str| admission.arrive(address.parse().unwrap(), START, &mut chance).unwrap();
    let ids = addresses.map(|address| arrive(address).id);
    let displaced = ["192.0.3.1", "10.0.0.1", "10.1.0.1", "10.2.0.1"];
    let displaced = displaced.map(|address| arrive(address).displaced);
    // Then three networks of the first width have two connections each. One of them has both in a /24 and goes
    // next. After that, the oldest connection goes.
    assert_eq!(displaced, [4, 3, 6, 0].map(|index| Some(ids[index])));
}

#[test]
fn a_displaced_connection_cannot_log_in() {
    let limits = Limits { startups: 1, ..LIMITS };
    let (mut admission, mut chance) = (Admission::new(limits), SplitMix64::new(1));
    let first = admission.arrive(address(1, 1), START, &mut chance).unwrap();
    let second = admission.arrive(address(2, 1), START, &mut chance).unwrap();
    assert_eq!((first.displaced, second.displaced), (None, Some(first.id)));
    assert_eq!(admission.log_in(first.id, None, START), Err(Refusal::Startups));
    assert_eq!(admission.log_in(second.id, None, START), Ok(()));
    assert_eq!((admission.visits.len(), admission.waiting.len()), (1, 0));
}

/// Visitors who have logged in are counted apart from connections that have not, because the latter may be
/// nobody.
#[test]
fn silent_connections_do_not_displace_players() {
    let limits = Limits { connections: 2, startups: 3, ..LIMITS };
    let (mut admission, mut chance) = (Admission::new(limits), SplitMix64::new(1));
    let mut arrive = |admission: &mut Admission, network| {
        admission.arrive(address(network, 1), START, &mut chance).map(|admitted| admitted.id)
    };
    let ids = [1, 2, 3].map(|network| arrive(&mut admission, network).unwrap());
    let logged_in = ids.map(|id| admission.log_in(id, None, START));
    assert_eq!(logged_in, [Ok(()), Ok(()), Err(Refusal::Full)]);
    admission.leave(ids[2], Outcome::Served, START);
    assert_eq!(arrive(&mut admission, 4), Err(Refusal::Full));
    admission.leave(ids[0], Outcome::Served, START);
    assert!(arrive(&mut admission, 4).is_ok());
}

#[test]
fn an_ipv6_network_counts_as_one_address() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let of = |network: u16, host: u16| IpAddr::from([0x2001, 0xdb8, 0, network, 0, 0, 0, host]);
    for host in 0..8 {
        assert!(admission.arrive(of(1, host), START, &mut chance).is_ok());
    }
    assert_eq!(admission.arrive(of(1, 8), START, &mut chance), Err(Refusal::Address));
    assert!(admission.arrive(of(2, 8), START, &mut chance).is_ok());
    admission.leave(ConnectionId(0), Outcome::Served, START);
    assert!(admission.arrive(of(1, 8), START, &mut chance).is_ok());
    let mapped: IpAddr = "::ffff:192.0.2.1".parse().unwrap();
    assert_eq!(counted_address(mapped), counted_address([192, 0, 2, 1].into()));
    assert_ne!(counted_address(mapped), counted_address([192, 0, 2, 2].into()));
}

#[test]
fn a_refusal_states_its_limit_in_one_sentence() {
    let limits = Limits { per_key: 1, ..LIMITS };
    for (refusal, part) in [
        (Refusal::Full, "at most 1200 connections at a time"),
        (Refusal::Address, "at most 64 connections from one address"),
        (Refusal::Key, "at most 1 connection with one key"),
        (Refusal::Startups, "at most 200 connections at a time"),
        (Refusal::Penalty, "one is forgotten every 10 s"),
    ] {
        let sentence = refusal.sentence(&limits);
        assert!(sentence.contains(part) && sentence.ends_with('.'), "{sentence}");
        // OpenSSH prints no more than this.
        assert!(sentence.len() < 400 && sentence.lines().count() == 1, "{sentence}");
    }
}

fn address(network: u8, host: u8) -> IpAddr {
    IpAddr::V4(Ipv4Addr::new(10, 0, network, host))
}

fn key(number: u8) -> AccountKey {
    AccountKey::new([number; 32])
}

#[test]
fn one_key_is_limited_to_three_connections() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let ids: Vec<ConnectionId> = (0..4)
        .map(|host| admission.arrive(address(host, 1), START, &mut chance).unwrap().id)
        .collect();
    for &id in &ids[..3] {
        assert_eq!(admission.log_in(id, Some(key(7)), START), Ok(()));
    }
    assert_eq!(admission.log_in(ids[3], Some(key(7)), START), Err(Refusal::Key));
    admission.leave(ids[3], Outcome::Served, START);
    admission.leave(ids[0], Outcome::Served, START);
    let next = admission.arrive(address(9, 1), START, &mut chance).unwrap().id;
    assert_eq!(admission.log_in(next, Some(key(7)), START), Ok(()));
}

/// A network that floods is nearly always refused, and is forgiven in time.
#[test]
fn failures_are_penalised_and_later_forgiven() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let mut tries = |admission: &mut Admission, outcome, now| {
        let mut admitted = 0;
        for _ in 0..1000 {
            if let Ok(Admitted { id, .. }) = admission.arrive(address(1, 1), now, &mut chance) {
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

/// An attacker and four players share one address. The players log in now and then.
#[test]
fn a_player_beside_an_attacker_gets_in() {
    let (mut admission, mut chance) = (admission(), SplitMix64::new(1));
    let mut tries_of_players = Vec::new();
    for second in 0..3600 {
        let now = Duration::from_secs(second);
        for _ in 0..10 {
            if let Ok(Admitted { id, .. }) = admission.arrive(address(1, 1), now, &mut chance) {
                admission.leave(id, Outcome::LeftEarly, now);
            }
        }
        if second % 60 == 0 {
            let mut tries = 1;
            let id = loop {
                match admission.arrive(address(1, 1), now, &mut chance) {
                    Ok(Admitted { id, .. }) => break id,
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
    /// Whatever happens, in whatever order, no count exceeds its limit, and all counts return to zero.
    #[test]
    fn counts_stay_within_limits_and_return_to_zero(acts in acts(), seed: u64) {
        let (mut admission, mut chance) = (admission(), SplitMix64::new(seed));
        let mut now = START;
        for act in acts {
            match act {
                Act::Arrive(network, host) => {
                    _ = admission.arrive(address(network, host), now, &mut chance);
                }
                Act::LogIn(id, number) => {
                    _ = admission.log_in(ConnectionId(id as u64), number.map(key), now);
                }
                Act::Leave(id, outcome) => admission.leave(ConnectionId(id as u64), outcome, now),
                Act::Wait(time) => now += Duration::from_millis(u64::from(time)),
            }
            prop_assert!(admission.waiting.len() <= 20);
            let waiting = admission.waiting.keys().all(|id| admission.visits.contains_key(id));
            prop_assert!(waiting);
            prop_assert!(admission.per_address.values().all(|&count| (1..=8).contains(&count)));
            prop_assert!(admission.per_key.values().all(|&count| (1..=3).contains(&count)));
            prop_assert!(admission.per_network.values().all(|&count| (1..=20).contains(&count)));
            let total: u32 = admission.per_network.values().sum();
            prop_assert_eq!(total as usize, WIDTHS.len() * admission.waiting.len());
            let total: u32 = admission.per_address.values().sum();
            prop_assert_eq!(total as usize, admission.visits.len());
        }
        for id in admission.visits.keys().copied().collect::<Vec<_>>() {
            admission.leave(id, Outcome::Served, now);
        }
        prop_assert_eq!(admission.waiting.len(), 0);
        prop_assert!(admission.per_address.is_empty());
        prop_assert!(admission.per_key.is_empty());
        prop_assert!(admission.per_network.is_empty());
    }
}

/// The networks whose failures are oldest are dropped first.
#[test]
fn memory_for_networks_is_bounded() {
    let mut penalties = Penalties::new(20, Duration::from_secs(1000));
    let network = |number: u64| {
        let address = Ipv6Addr::from_bits((u128::from(number) << 64) | (1 << 127));
        AddressPrefix::network_of(IpAddr::V6(address))
    };
    let time = |number: u64| Duration::from_millis(number);
    for number in 0..3 * MAX_NETWORKS as u64 {
        penalties.charge(network(number), Outcome::LeftEarly, time(number));
        penalties.charge(network(0), Outcome::LeftEarly, time(number));
    }
    assert_eq!(penalties.networks.len(), MAX_NETWORKS);
    assert_eq!(penalties.order.len(), MAX_NETWORKS);
    let last = 3 * MAX_NETWORKS as u64 - 1;
    assert!(penalties.refused_share(network(0), time(last)) > 0.8);
    for (number, is_known) in [(1, false), (last + 1 - MAX_NETWORKS as u64, false), (last, true)] {
        assert_eq!(penalties.networks.contains_key(&network(number)), is_known, "{number}");
    }
}
