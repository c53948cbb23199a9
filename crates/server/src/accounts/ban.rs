//! Bans of a key, a name, or a range of addresses: from the host, or from talking on it.

use std::fmt;
use std::net::IpAddr;

use ipnet::IpNet;
use serde::{Deserialize, Serialize};

use super::account::serialized_as_text;
use super::{AccountKey, Name, UnixTime};

/// A ban.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ban {
    /// The forbidden thing.
    pub scope: BanScope,
    /// The visitors that it applies to.
    pub target: BanTarget,
    /// The end; `None` for never.
    pub until: Option<UnixTime>,
    /// The reason.
    pub reason: String,
    /// The name of its author.
    pub by: String,
    /// When it was made.
    pub made_at: UnixTime,
}

/// The thing that a ban forbids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BanScope {
    /// Visits to the host.
    Visit,
    /// Talk: the visitor is muted, but can play.
    Talk,
}

/// The visitors that a ban applies to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BanTarget {
    /// The account of a key.
    Key(AccountKey),
    /// Everybody with this name or a similar-looking one.
    Name(Name),
    /// Everybody with an address in this range.
    #[serde(rename = "address")]
    Addresses(AddressPrefix),
}

/// The known facts about a visitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Identity<'a> {
    /// The address of the client.
    pub address: Option<IpAddr>,
    /// The key, once it is verified.
    pub key: Option<&'a AccountKey>,
    /// The name.
    pub name: Option<&'a Name>,
}

/// The addresses that begin with the same bits, such as `203.0.113.0/24` or `2001:db8::/64`.
///
/// ```
/// use cellcaster_server::accounts::AddressPrefix;
///
/// let prefix = AddressPrefix::parse("203.0.113.7/24").unwrap();
/// assert_eq!(prefix.to_string(), "203.0.113.0/24");
/// assert!(prefix.contains("::ffff:203.0.113.99".parse().unwrap()));
/// assert!(!prefix.contains("203.0.114.7".parse().unwrap()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct AddressPrefix(IpNet);

serialized_as_text!(AddressPrefix: "a range of addresses");

impl Ban {
    /// Returns true if the ban is in force.
    pub fn is_in_force(&self, now: UnixTime) -> bool {
        self.until.is_none_or(|until| now < until)
    }

    /// The author of a ban by a moderator. An operator is a user of the host's system, whose name has no blank.
    pub(crate) fn by_moderator(name: &Name) -> String {
        format!("moderator {name}")
    }

    /// The author, as players may read it. They do not read the names of the system's users.
    pub(crate) fn author(&self) -> &str {
        if self.by.starts_with("moderator ") { &self.by } else { "operator of this host" }
    }
}

impl BanTarget {
    /// Returns true if a ban of this target replaces a ban of `other`.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Name(name), Self::Name(other)) => name.looks_like(other),
            _ => self == other,
        }
    }

    /// Returns true if a ban of this target applies to a visitor.
    pub fn applies_to(&self, identity: &Identity<'_>) -> bool {
        match self {
            Self::Key(key) => identity.key == Some(key),
            Self::Name(name) => identity.name.is_some_and(|other| other.looks_like(name)),
            Self::Addresses(prefix) => {
                identity.address.is_some_and(|address| prefix.contains(address))
            }
        }
    }
}

impl fmt::Display for BanTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => key.fmt(f),
            Self::Name(name) => f.write_str(name.as_str()),
            Self::Addresses(range) => range.fmt(f),
        }
    }
}

impl AddressPrefix {
    /// The addresses that share their first `length` bits with `address`; `None` if the address has fewer
    /// bits. An IPv4 address in IPv6 notation counts as an IPv4 address.
    pub fn new(address: IpAddr, length: u8) -> Option<Self> {
        IpNet::new(address.to_canonical(), length).ok().map(|range| Self(range.trunc()))
    }

    /// The network that an address's owner holds: a /24 of IPv4 or a /64 of IPv6.
    pub fn network_of(address: IpAddr) -> Self {
        Self::around(address, [24, 64])
    }

    /// The addresses that share their first bits with `address`: `v4` bits of an IPv4 address, `v6` bits
    /// of an IPv6 address.
    pub(crate) fn around(address: IpAddr, [v4, v6]: [u8; 2]) -> Self {
        let address = address.to_canonical();
        let length = if address.is_ipv4() { v4 } else { v6 };
        // If an address has fewer bits, the range is that address alone.
        Self::new(address, length).unwrap_or_else(|| Self(address.into()))
    }

    /// Parses a range such as 203.0.113.0/24. An address without a length is a range of one address.
    pub fn parse(text: &str) -> Option<Self> {
        if !text.contains('/') {
            return text.parse().ok().map(|address| Self::around(address, [32, 128]));
        }
        let range: IpNet = text.parse().ok()?;
        Self::new(range.addr(), range.prefix_len())
    }

    /// Returns true if an address belongs to the range.
    pub fn contains(&self, address: IpAddr) -> bool {
        self.0.contains(&address.to_canonical())
    }
}

impl fmt::Display for AddressPrefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The ban in `bans` that applies to a visitor. If several apply, returns the last to end.
pub(crate) fn applying<'b>(
    bans: impl IntoIterator<Item = &'b Ban>,
    identity: &Identity<'_>,
) -> Option<&'b Ban> {
    let applying = bans.into_iter().filter(|ban| ban.target.applies_to(identity));
    applying.max_by_key(|ban| (ban.until.is_none(), ban.until))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_range_is_an_address_and_a_length() {
        for (text, shown) in [
            ("192.0.2.1", "192.0.2.1/32"),
            ("::ffff:192.0.2.1", "192.0.2.1/32"),
            ("192.0.2.1/0", "0.0.0.0/0"),
            ("2001:db8:1:2:3::4/64", "2001:db8:1:2::/64"),
            ("::/0", "::/0"),
        ] {
            assert_eq!(AddressPrefix::parse(text).unwrap().to_string(), shown);
        }
        for text in ["", "/", "192.0.2.1/33", "::/129", "192.0.2.1/+8", "192.0.2.1/", "a/8"] {
            assert_eq!(AddressPrefix::parse(text), None, "{text}");
        }
        let everything_of_v4 = AddressPrefix::parse("0.0.0.0/0").unwrap();
        assert!(!everything_of_v4.contains("2001:db8::1".parse().unwrap()));
    }

    #[test]
    fn addresses_map_to_networks_of_one_owner() {
        for (address, network) in [
            ("192.0.2.77", "192.0.2.0/24"),
            ("::ffff:192.0.2.77", "192.0.2.0/24"),
            ("2001:db8:1:2:3::4", "2001:db8:1:2::/64"),
        ] {
            let prefix = AddressPrefix::network_of(address.parse().unwrap());
            assert_eq!(prefix.to_string(), network);
        }
    }

    proptest! {
        #[test]
        fn a_range_contains_addresses_with_its_prefix(address: IpAddr, other: IpAddr, length in 0..=128_u8) {
            if let Some(prefix) = AddressPrefix::new(address, length) {
                prop_assert!(prefix.contains(address));
                prop_assert_eq!(AddressPrefix::parse(&prefix.to_string()), Some(prefix));
                let same = AddressPrefix::new(other, length) == Some(prefix);
                prop_assert_eq!(prefix.contains(other), same);
            }
        }
    }
}
