//! The policy that admits connections. It has no sockets and no clocks.
//!
//! - **Counts.** The number of visitors who are logged in at a time is limited, and so are the connections from one
//!   address and with one key. A /64 of IPv6 counts as one address: a client with one of its addresses has all of
//!   them, and a household gets one /64 just as it gets one IPv4 address.
//! - **The busiest network makes room.** The number of connections that have not logged in yet is limited, too. At
//!   the limit, a new connection is still admitted, and displaces the oldest connection of the busiest network. This
//!   is the /16 of IPv4 or the /48 of IPv6 with the most such connections, including the new one; within it the
//!   busiest /24 or /56; within that the busiest address or /64. So a flood displaces itself, however it spreads
//!   over its addresses. A newcomer who is alone in a network is displaced only if there are as many networks as
//!   places.
//! - **Penalties.** A failed connection costs its network (/24, /64) tokens of a bucket. The bucket refills with
//!   time and with each successful login. If it runs low, the server refuses connections from the network at random,
//!   but never all of them, because the people behind one address share the bucket with any attacker there. Rejected for
//!   that reason: blocking an address outright, as OpenSSH's `PerSourcePenalties` does.
//!
//! Rejected: early random drop, as in OpenSSH's `MaxStartups` (`sshd_config(5)`), with a share of 40 connections for
//! each network. With 140 silent connections from eight /24 networks, it turned away 231 of 238 newcomers. Also
//! rejected: displacing from the busiest /24 or /64 first, and from wider networks on a tie. A flood from one /16
//! with a /24 for each connection would displace every household with two connections.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::net::IpAddr;
use std::time::Duration;

use crate::accounts::{AccountKey, AddressPrefix};
use cellcaster::rng::SplitMix64;

/// The connections of a server, and the counts and penalties of their networks.
#[derive(Debug)]
pub struct Admission {
    limits: Limits,
    visits: BTreeMap<ConnectionId, ConnectionSource>,
    next: u64,
    /// The unauthenticated connections, oldest first.
    waiting: BTreeMap<ConnectionId, Networks>,
    /// The number of unauthenticated connections in each network of each width.
    per_network: BTreeMap<AddressPrefix, u32>,
    /// Keyed by [`counted_address`].
    per_address: BTreeMap<AddressPrefix, u32>,
    per_key: BTreeMap<AccountKey, u32>,
    penalties: Penalties,
}

/// The limits on connections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most visitors who are logged in at a time.
    pub connections: u32,
    /// The most connections from one address, or from one /64 of IPv6.
    pub per_address: u32,
    /// The most connections with one key.
    pub per_key: u32,
    /// The most unauthenticated connections at a time, in addition to `connections`; 0 counts as 1.
    pub startups: u32,
    /// The number of failures after which the server refuses nearly all connections of a network.
    pub failures: u32,
    /// The time after which one failure is forgotten.
    pub forget: Duration,
}

/// The networks in which an unauthenticated connection counts, widest first.
type Networks = [AddressPrefix; WIDTHS.len()];

/// Prefix lengths of IPv4 and IPv6 in bits. [`counted_address`] uses the last pair.
const WIDTHS: [[u8; 2]; 3] = [[16, 48], [24, 56], [32, 64]];

/// The number of an admitted connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ConnectionId(u64);

/// An admitted connection, and the connection that it displaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Admitted {
    /// The new connection.
    pub id: ConnectionId,
    /// The connection that was displaced to make room. It no longer counts.
    pub displaced: Option<ConnectionId>,
}

/// The reason for a refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Refusal {
    /// Too many visitors are logged in.
    Full,
    /// There are too many connections from its address.
    Address,
    /// There are too many connections with its key.
    Key,
    /// It was displaced because too many connections are unauthenticated.
    Startups,
    /// Too many connections from its network have failed.
    Penalty,
}

/// The way in which a connection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// It ended normally.
    Served,
    /// The client left before it was authenticated, as a scanner does, or a person who doubts the host key.
    LeftEarly,
    /// It made room for another connection before it was authenticated.
    Displaced,
    /// The client was too slow or sent too much before it was authenticated.
    TimedOut,
    /// The client broke the protocol.
    BrokeProtocol,
}

impl Refusal {
    /// All reasons, in the order of the variants.
    pub const ALL: [Self; 5] =
        [Self::Full, Self::Address, Self::Key, Self::Startups, Self::Penalty];

    /// The name in logs and metrics.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Address => "address",
            Self::Key => "key",
            Self::Startups => "startups",
            Self::Penalty => "penalty",
        }
    }

    /// A sentence for the refused visitor, with the limit.
    pub(crate) fn sentence(self, limits: &Limits) -> String {
        let Limits { connections, per_address, per_key, startups, .. } = *limits;
        match self {
            Self::Full => {
                let most = counted(connections);
                format!("This host accepts at most {most} at a time: try again later.")
            }
            Self::Address => {
                let most = counted(per_address);
                format!(
                    "This host accepts at most {most} from one address (/64 of IPv6): end another game first."
                )
            }
            Self::Key => {
                let most = counted(per_key);
                format!("This host accepts at most {most} with one key: end another game first.")
            }
            Self::Startups => {
                let most = counted(startups);
                format!(
                    "Too many visitors are logging in, most of them from your network (at most {most} at a \
                     time): try again in a few seconds."
                )
            }
            Self::Penalty => {
                let seconds = limits.forget.as_secs();
                format!(
                    "Too many connections from your network have failed (one is forgotten every {seconds} s): \
                     try again later."
                )
            }
        }
    }
}

/// A number with its unit, such as "1 connection".
fn counted(connections: u32) -> String {
    let unit = if connections == 1 { "connection" } else { "connections" };
    format!("{connections} {unit}")
}

/// The prefix that counts as one address: an IPv4 address, or a /64 of IPv6.
pub(crate) fn counted_address(address: IpAddr) -> AddressPrefix {
    let [.., narrowest] = WIDTHS;
    AddressPrefix::around(address, narrowest)
}

impl Outcome {
    /// The name in logs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Served => "served",
            Self::LeftEarly => "left early",
            Self::Displaced => "displaced",
            Self::TimedOut => "timed out",
            Self::BrokeProtocol => "broke the protocol",
        }
    }
}

#[derive(Debug)]
struct ConnectionSource {
    address: IpAddr,
    key: Option<AccountKey>,
}

impl Admission {
    /// Creates an admission without connections and penalties.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            visits: BTreeMap::new(),
            next: 0,
            waiting: BTreeMap::new(),
            per_network: BTreeMap::new(),
            per_address: BTreeMap::new(),
            per_key: BTreeMap::new(),
            penalties: Penalties::new(limits.failures, limits.forget),
        }
    }

    /// Changes the limits. Connections that exceed the new limits stay.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
        self.penalties.set_limits(limits.failures, limits.forget);
    }

    fn authenticated(&self) -> usize {
        self.visits.len() - self.waiting.len()
    }

    /// Admits or refuses a connection from `address`. If all startup places are taken, it displaces another
    /// connection.
    ///
    /// # Errors
    /// The reason for the refusal.
    pub fn arrive(
        &mut self,
        address: IpAddr,
        now: Duration,
        chance: &mut SplitMix64,
    ) -> Result<Admitted, Refusal> {
        let counted = counted_address(address);
        if self.authenticated() >= self.limits.connections as usize {
            return Err(Refusal::Full);
        }
        if count(&self.per_address, &counted) >= self.limits.per_address {
            return Err(Refusal::Address);
        }
        let network = AddressPrefix::network_of(address);
        if chance.unit() < self.penalties.refused_share(network, now) {
            return Err(Refusal::Penalty);
        }
        let networks = WIDTHS.map(|bits| AddressPrefix::around(address, bits));
        for network in networks {
            add(&mut self.per_network, network);
        }
        let is_full = self.waiting.len() >= self.limits.startups as usize;
        let displaced = if is_full { self.oldest_of_the_busiest() } else { None };
        if let Some(displaced) = displaced {
            self.leave(displaced, Outcome::Displaced, now);
        }
        let id = ConnectionId(self.next);
        self.next += 1;
        self.visits.insert(id, ConnectionSource { address, key: None });
        self.waiting.insert(id, networks);
        add(&mut self.per_address, counted);
        Ok(Admitted { id, displaced })
    }

    /// The unauthenticated connection that makes room. The search visits all of them: about 10 µs for 200.
    fn oldest_of_the_busiest(&self) -> Option<ConnectionId> {
        let busy = |networks: &Networks| networks.map(|network| count(&self.per_network, &network));
        let all = self.waiting.iter();
        all.max_by_key(|&(id, networks)| (busy(networks), Reverse(id))).map(|(id, _)| *id)
    }

    /// Removes a connection from the unauthenticated ones. Returns true if it was one of them.
    fn stop_waiting(&mut self, id: ConnectionId) -> bool {
        let networks = self.waiting.remove(&id);
        for network in networks.iter().flatten() {
            remove(&mut self.per_network, network);
        }
        networks.is_some()
    }

    /// Marks a connection as authenticated, with `key` or as a guest. The login makes up for one failure of its
    /// network.
    ///
    /// # Errors
    /// - [`Refusal::Startups`] if it was displaced.
    /// - [`Refusal::Full`] if too many visitors are logged in, and [`Refusal::Key`] if there are too many
    ///   connections with that key. The connection then counts as one without a key until it leaves.
    pub fn log_in(
        &mut self,
        id: ConnectionId,
        key: Option<AccountKey>,
        now: Duration,
    ) -> Result<(), Refusal> {
        let has_waited = self.stop_waiting(id);
        let authenticated = self.authenticated();
        let Some(visit) = self.visits.get_mut(&id) else { return Err(Refusal::Startups) };
        if has_waited {
            self.penalties.repay(AddressPrefix::network_of(visit.address), now);
            if authenticated > self.limits.connections as usize {
                return Err(Refusal::Full);
            }
        }
        let Some(key) = key.filter(|_| visit.key.is_none()) else { return Ok(()) };
        if count(&self.per_key, &key) >= self.limits.per_key {
            return Err(Refusal::Key);
        }
        add(&mut self.per_key, key);
        visit.key = Some(key);
        Ok(())
    }

    /// Removes a connection that has ended.
    pub fn leave(&mut self, id: ConnectionId, outcome: Outcome, now: Duration) {
        let Some(visit) = self.visits.remove(&id) else { return };
        self.stop_waiting(id);
        remove(&mut self.per_address, &counted_address(visit.address));
        if let Some(key) = &visit.key {
            remove(&mut self.per_key, key);
        }
        self.penalties.charge(AddressPrefix::network_of(visit.address), outcome, now);
    }
}

fn count<K: Ord>(counts: &BTreeMap<K, u32>, key: &K) -> u32 {
    counts.get(key).copied().unwrap_or(0)
}

fn add<K: Ord>(counts: &mut BTreeMap<K, u32>, key: K) {
    *counts.entry(key).or_default() += 1;
}

fn remove<K: Ord + Clone>(counts: &mut BTreeMap<K, u32>, key: &K) {
    if let Some(count) = counts.get_mut(key) {
        *count -= 1;
        if *count == 0 {
            counts.remove(key);
        }
    }
}

/// The failures that are not forgotten yet, for each network: a /24 of IPv4 or a /64 of IPv6.
#[derive(Debug)]
struct Penalties {
    networks: BTreeMap<AddressPrefix, Failures>,
    /// The same networks, in the order of their last failure or login.
    order: BTreeSet<(Duration, AddressPrefix)>,
    /// The size of a bucket.
    most: f64,
    forget: Duration,
}

/// The tokens that are missing from a bucket.
#[derive(Clone, Copy, Debug)]
struct Failures {
    count: f64,
    since: Duration,
}

/// The most networks that are remembered: about two megabytes.
const MAX_NETWORKS: usize = 1 << 14;
/// Failures up to this share of the bucket have no effect.
const FREE_SHARE: f64 = 0.5;
/// The share of refused connections from a network with an empty bucket. A person who tries again a few times gets
/// in.
const REFUSED_SHARE: f64 = 0.9;

impl Penalties {
    fn new(failures: u32, forget: Duration) -> Self {
        let (networks, order) = (BTreeMap::new(), BTreeSet::new());
        Self { networks, order, most: f64::from(failures), forget }
    }

    fn set_limits(&mut self, failures: u32, forget: Duration) {
        (self.most, self.forget) = (f64::from(failures), forget);
    }

    /// The share of a network's connections to refuse.
    fn refused_share(&self, network: AddressPrefix, now: Duration) -> f64 {
        let failures = self.networks.get(&network).map_or(0.0, |known| self.left(*known, now));
        let free = self.most * FREE_SHARE;
        ((failures - free) / (self.most - free)).clamp(0.0, 1.0) * REFUSED_SHARE
    }

    /// Charges a network for a connection that has ended.
    fn charge(&mut self, network: AddressPrefix, outcome: Outcome, now: Duration) {
        let cost = match outcome {
            Outcome::Served => return,
            Outcome::LeftEarly | Outcome::Displaced => 1.0,
            Outcome::TimedOut => 2.0,
            Outcome::BrokeProtocol => 3.0,
        };
        self.change(network, cost, now);
    }

    /// Repays a network for a successful login.
    fn repay(&mut self, network: AddressPrefix, now: Duration) {
        if self.networks.contains_key(&network) {
            self.change(network, -1.0, now);
        }
    }

    fn change(&mut self, network: AddressPrefix, cost: f64, now: Duration) {
        let before = self.networks.get(&network).map_or(0.0, |known| self.left(*known, now));
        let count = (before + cost).min(self.most);
        self.remove(network);
        if count <= 0.0 {
            return;
        }
        if self.networks.len() >= MAX_NETWORKS
            && let Some(&(_, oldest)) = self.order.first()
        {
            self.remove(oldest);
        }
        self.networks.insert(network, Failures { count, since: now });
        self.order.insert((now, network));
    }

    fn remove(&mut self, network: AddressPrefix) {
        if let Some(failures) = self.networks.remove(&network) {
            self.order.remove(&(failures.since, network));
        }
    }

    /// The part of the failures that is not forgotten yet.
    fn left(&self, failures: Failures, now: Duration) -> f64 {
        let time = now.saturating_sub(failures.since).as_secs_f64();
        (failures.count - time / self.forget.as_secs_f64()).max(0.0)
    }
}

#[cfg(test)]
mod tests;
