//! Which connections are admitted: a policy without sockets and clocks.
//!
//! - **Counts.** So many connections at a time in all, of one address and with one key. A /64 of IPv6 counts as
//!   one address: whoever has one address of it has all, and a household has one /64 as it has one IPv4 address.
//! - **Early random drop**, as by OpenSSH's `MaxStartups` (`sshd_config(5)`): when many connections
//!   are not authenticated yet, new ones are refused by chance, the more the more there are. A
//!   network may have a share of them only, so that one that opens connections and says nothing
//!   does not fill the place of all others. The default share is below the number from which connections are
//!   refused by chance, so that one network alone causes nobody else to be refused.
//! - **Penalties.** A failed connection costs its network (/24, /64) tokens of a bucket, which fills
//!   again with time and with each successful login. A network whose bucket runs low is refused by
//!   chance, and never always: many people behind one address share their bucket with whoever
//!   attacks from there. Rejected for that reason: blocking an address outright, as OpenSSH's
//!   `PerSourcePenalties` does.

mod limits;
mod penalties;

use std::collections::BTreeMap;
use std::net::{IpAddr, Ipv6Addr};
use std::time::Duration;

use super::KeyData;
use crate::rng::SplitMix64;
pub use limits::{Limits, Startups};
pub(in crate::server) use penalties::Network;
use penalties::Penalties;

/// The connections of a server, and what is known about where they come from.
#[derive(Debug)]
pub struct Admission {
    limits: Limits,
    visits: BTreeMap<VisitId, Visit>,
    next: u64,
    unauthenticated: u32,
    /// By [`counted_address`].
    per_address: BTreeMap<IpAddr, u32>,
    per_key: BTreeMap<KeyData, u32>,
    /// Of connections that are not authenticated.
    per_network: BTreeMap<Network, u32>,
    penalties: Penalties,
}

/// An admitted connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct VisitId(u64);

/// Why a connection is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Refusal {
    /// There are too many connections.
    Full,
    /// There are too many of its address.
    Address,
    /// There are too many with its key.
    Key,
    /// Too many connections are not authenticated.
    Startups,
    /// Too many connections of its network have failed.
    Penalty,
}

/// How a connection has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// In order.
    Served,
    /// The client left before it was authenticated, as a scanner does, or somebody who doubts the
    /// host key.
    LeftEarly,
    /// The client was too slow, or has sent too much, before it was authenticated.
    TimedOut,
    /// The client broke the protocol.
    BrokeProtocol,
}

impl Refusal {
    /// All reasons, in the order of the variants.
    pub const ALL: [Self; 5] =
        [Self::Full, Self::Address, Self::Key, Self::Startups, Self::Penalty];

    /// A word for logs and metrics.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Address => "address",
            Self::Key => "key",
            Self::Startups => "startups",
            Self::Penalty => "penalty",
        }
    }

    /// A sentence for the refused visitor, which names the limit.
    pub(super) fn sentence(self, limits: &Limits) -> String {
        let Limits { connections, per_address, per_key, startups, .. } = *limits;
        match self {
            Self::Full => {
                let most = counted(connections);
                format!("This host takes at most {most} at a time: try again later.")
            }
            Self::Address => {
                let most = counted(per_address);
                format!(
                    "This host takes at most {most} from one address (/64 of IPv6): end another game first."
                )
            }
            Self::Key => {
                let most = counted(per_key);
                format!("This host takes at most {most} with one key: end another game first.")
            }
            Self::Startups => {
                let Startups { per_network, full, .. } = startups;
                format!(
                    "Too many visitors log in just now (at most {per_network} of one network, and {full} in \
                     all): try again in a few seconds."
                )
            }
            Self::Penalty => {
                let seconds = limits.forget.as_secs();
                format!(
                    "Too many connections from your network have failed (one is forgotten every {seconds} s): \
                     try again."
                )
            }
        }
    }
}

/// A number of connections in words.
fn counted(connections: u32) -> String {
    let unit = if connections == 1 { "connection" } else { "connections" };
    format!("{connections} {unit}")
}

/// The address that a connection counts as: that of IPv4, or the first one of its /64.
pub(super) fn counted_address(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V4(address) => address.into(),
        IpAddr::V6(address) => Ipv6Addr::from_bits(address.to_bits() >> 64 << 64).into(),
    }
}

impl Outcome {
    /// A few words for logs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Served => "served",
            Self::LeftEarly => "left early",
            Self::TimedOut => "timed out",
            Self::BrokeProtocol => "broke the protocol",
        }
    }
}

#[derive(Debug)]
struct Visit {
    address: IpAddr,
    is_authenticated: bool,
    key: Option<KeyData>,
}

impl Admission {
    /// No connections, and no penalties.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            visits: BTreeMap::new(),
            next: 0,
            unauthenticated: 0,
            per_address: BTreeMap::new(),
            per_key: BTreeMap::new(),
            per_network: BTreeMap::new(),
            penalties: Penalties::new(limits.failures, limits.forget),
        }
    }

    /// Changes the limits. Connections that exceed the new ones stay.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
        self.penalties.set_limits(limits.failures, limits.forget);
    }

    /// The number of connections.
    pub fn connections(&self) -> usize {
        self.visits.len()
    }

    /// The number of connections that are not authenticated.
    pub fn unauthenticated(&self) -> usize {
        self.unauthenticated as usize
    }

    /// Admits a connection from `address`, or refuses it.
    ///
    /// # Errors
    /// The reason of the refusal.
    pub fn arrive(
        &mut self,
        address: IpAddr,
        now: Duration,
        chance: &mut SplitMix64,
    ) -> Result<VisitId, Refusal> {
        let network = Network::of(address);
        let address = counted_address(address);
        if self.visits.len() >= self.limits.connections as usize {
            return Err(Refusal::Full);
        }
        if count(&self.per_address, &address) >= self.limits.per_address {
            return Err(Refusal::Address);
        }
        if chance.unit() < self.penalties.refused_share(network, now) {
            return Err(Refusal::Penalty);
        }
        let startups = self.limits.startups;
        if count(&self.per_network, &network) >= startups.per_network
            || chance.unit() < startups.refused_share(self.unauthenticated)
        {
            return Err(Refusal::Startups);
        }
        let id = VisitId(self.next);
        self.next += 1;
        self.visits.insert(id, Visit { address, is_authenticated: false, key: None });
        self.unauthenticated += 1;
        add(&mut self.per_address, address);
        add(&mut self.per_network, network);
        Ok(id)
    }

    /// The connection is authenticated, with `key` or as a guest. That makes up for a failure of its
    /// network.
    ///
    /// # Errors
    /// [`Refusal::Key`] if there are too many connections with that key; the connection then counts
    /// as one without a key until it leaves.
    pub fn log_in(
        &mut self,
        id: VisitId,
        key: Option<KeyData>,
        now: Duration,
    ) -> Result<(), Refusal> {
        let Some(visit) = self.visits.get_mut(&id) else { return Ok(()) };
        if !visit.is_authenticated {
            visit.is_authenticated = true;
            let network = Network::of(visit.address);
            self.unauthenticated -= 1;
            remove(&mut self.per_network, &network);
            self.penalties.repay(network, now);
        }
        let Some(key) = key.filter(|_| visit.key.is_none()) else { return Ok(()) };
        if count(&self.per_key, &key) >= self.limits.per_key {
            return Err(Refusal::Key);
        }
        add(&mut self.per_key, key.clone());
        visit.key = Some(key);
        Ok(())
    }

    /// The connection has ended.
    pub fn leave(&mut self, id: VisitId, outcome: Outcome, now: Duration) {
        let Some(visit) = self.visits.remove(&id) else { return };
        let network = Network::of(visit.address);
        remove(&mut self.per_address, &visit.address);
        if !visit.is_authenticated {
            self.unauthenticated -= 1;
            remove(&mut self.per_network, &network);
        }
        if let Some(key) = &visit.key {
            remove(&mut self.per_key, key);
        }
        self.penalties.charge(network, outcome, now);
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

#[cfg(test)]
mod tests;
