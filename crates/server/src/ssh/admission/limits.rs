//! The limits of connections.

use std::time::Duration;

/// Which connections are admitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most visitors at a time who have logged in.
    pub connections: u32,
    /// The most connections of one address, or of one /64 of IPv6.
    pub per_address: u32,
    /// The most connections with one key.
    pub per_key: u32,
    /// The most connections at a time that are not authenticated, besides `connections`; 0 counts as 1.
    pub startups: u32,
    /// The failures of one network after which nearly all of its connections are refused.
    pub failures: u32,
    /// The time after which a failure is forgotten.
    pub forget: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 1200,
            per_address: 64,
            per_key: 3,
            startups: 200,
            failures: 20,
            forget: Duration::from_secs(10),
        }
    }
}
