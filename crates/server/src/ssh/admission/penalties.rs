//! Failures of networks (/24 of IPv4, /64 of IPv6), in token buckets.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use super::Outcome;
use crate::accounts::AddressPrefix;

/// The failures of networks that are not forgotten.
#[derive(Debug)]
pub(crate) struct Penalties {
    networks: BTreeMap<AddressPrefix, Failures>,
    /// The same networks in the order of their last failure or login.
    order: BTreeSet<(Duration, AddressPrefix)>,
    /// The size of a bucket.
    most: f64,
    forget: Duration,
}

/// The tokens that are missing in a bucket.
#[derive(Clone, Copy, Debug)]
struct Failures {
    count: f64,
    since: Duration,
}

/// The most networks that are remembered; that is about two megabytes.
const MOST_NETWORKS: usize = 1 << 14;
/// Failures up to this share of the bucket have no effect.
const FREE_SHARE: f64 = 0.5;
/// The share of connections that is refused of a network whose bucket is empty. A person who tries
/// again a few times gets in.
const REFUSED_SHARE: f64 = 0.9;

impl Penalties {
    pub(crate) fn new(failures: u32, forget: Duration) -> Self {
        let (networks, order) = (BTreeMap::new(), BTreeSet::new());
        Self { networks, order, most: f64::from(failures), forget }
    }

    pub(crate) fn set_limits(&mut self, failures: u32, forget: Duration) {
        (self.most, self.forget) = (f64::from(failures), forget);
    }

    /// The share of a network's connections that is refused.
    pub(crate) fn refused_share(&self, network: AddressPrefix, now: Duration) -> f64 {
        let failures = self.networks.get(&network).map_or(0.0, |known| self.left(*known, now));
        let free = self.most * FREE_SHARE;
        ((failures - free) / (self.most - free)).clamp(0.0, 1.0) * REFUSED_SHARE
    }

    /// Counts a connection that has ended.
    pub(crate) fn charge(&mut self, network: AddressPrefix, outcome: Outcome, now: Duration) {
        let cost = match outcome {
            Outcome::Served => return,
            Outcome::LeftEarly | Outcome::Displaced => 1.0,
            Outcome::TimedOut => 2.0,
            Outcome::BrokeProtocol => 3.0,
        };
        self.change(network, cost, now);
    }

    /// Counts a successful login.
    pub(crate) fn repay(&mut self, network: AddressPrefix, now: Duration) {
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
        if self.networks.len() >= MOST_NETWORKS
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

    /// What is not forgotten of failures.
    fn left(&self, failures: Failures, now: Duration) -> f64 {
        let time = now.saturating_sub(failures.since).as_secs_f64();
        (failures.count - time / self.forget.as_secs_f64()).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::net::{IpAddr, Ipv6Addr};

    use super::*;

    /// The networks that have failed longest ago are dropped first.
    #[test]
    fn memory_for_networks_is_bounded() {
        let mut penalties = Penalties::new(20, Duration::from_secs(1000));
        let network = |number: u64| {
            let address = Ipv6Addr::from_bits((u128::from(number) << 64) | (1 << 127));
            AddressPrefix::network_of(IpAddr::V6(address))
        };
        let time = |number: u64| Duration::from_millis(number);
        for number in 0..3 * MOST_NETWORKS as u64 {
            penalties.charge(network(number), Outcome::LeftEarly, time(number));
            penalties.charge(network(0), Outcome::LeftEarly, time(number));
        }
        assert_eq!(penalties.networks.len(), MOST_NETWORKS);
        assert_eq!(penalties.order.len(), MOST_NETWORKS);
        let last = 3 * MOST_NETWORKS as u64 - 1;
        assert!(penalties.refused_share(network(0), time(last)) > 0.8);
        for (number, is_known) in
            [(1, false), (last + 1 - MOST_NETWORKS as u64, false), (last, true)]
        {
            assert_eq!(penalties.networks.contains_key(&network(number)), is_known, "{number}");
        }
    }
}
