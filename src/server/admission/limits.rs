//! The limits of connections.

use std::time::Duration;

/// Which connections are admitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most connections at a time.
    pub connections: u32,
    /// The most connections of one address, or of one /64 of IPv6.
    pub per_address: u32,
    /// The most connections with one key.
    pub per_key: u32,
    /// The limits of connections that are not authenticated.
    pub startups: Startups,
    /// The failures of one network after which nearly all of its connections are refused.
    pub failures: u32,
    /// The time after which a failure is forgotten.
    pub forget: Duration,
}

/// The limits of connections that are not authenticated, as OpenSSH's `MaxStartups`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Startups {
    /// From this number on, new ones are refused by chance.
    pub begin: u32,
    /// The share that is refused then, in percent.
    pub percent: u32,
    /// From this number on, all are refused.
    pub full: u32,
    /// The most of one network.
    pub per_network: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 1200,
            per_address: 64,
            per_key: 3,
            startups: Startups::default(),
            failures: 20,
            forget: Duration::from_secs(10),
        }
    }
}

impl Default for Startups {
    fn default() -> Self {
        Self { begin: 50, percent: 30, full: 200, per_network: 40 }
    }
}

impl Startups {
    /// The share of new connections that is refused when `waiting` are not authenticated: `percent`
    /// at `begin`, and linearly more up to all at `full`.
    pub(super) fn refused_share(self, waiting: u32) -> f64 {
        if waiting >= self.full {
            return 1.0;
        }
        if waiting < self.begin {
            return 0.0;
        }
        let least = f64::from(self.percent) / 100.0;
        let position = f64::from(waiting - self.begin) / f64::from(self.full - self.begin);
        least + (1.0 - least) * position
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The figures of `sshd_config(5)` for 10:30:100.
    #[test]
    fn the_share_is_that_of_openssh() {
        let startups = Startups { begin: 10, percent: 30, full: 100, per_network: 20 };
        for (waiting, share) in [(0, 0.0), (9, 0.0), (10, 0.3), (55, 0.65), (100, 1.0), (9999, 1.0)]
        {
            assert!((startups.refused_share(waiting) - share).abs() < 1e-12, "{waiting}");
        }
    }

    #[test]
    fn limits_that_cross_are_no_harm() {
        let startups = Startups { begin: 50, percent: 30, full: 10, per_network: 5 };
        assert_eq!([9, 10, 50].map(|waiting| startups.refused_share(waiting)), [0.0, 1.0, 1.0]);
    }
}
