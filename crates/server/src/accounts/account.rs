//! Accounts: a key, a name, settings, and times.

use std::fmt;
use std::time::{SystemTime, UNIX_EPOCH};

use cellcaster::app::store::Preferences;
use russh::keys::ssh_key::Fingerprint;
use serde::{Deserialize, Serialize};

use super::{Name, StoreFailure};

/// Seconds since 1970-01-01, in UTC.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
#[serde(from = "u64")]
pub struct UnixTime(u64);

/// The number of an account.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AccountId(pub(crate) i64);

/// The SHA-256 of a public key's data: its fingerprint.
///
/// ```
/// use cellcaster_server::accounts::AccountKey;
///
/// let key = AccountKey::new([7; 32]);
/// let shown = "SHA256:BwcHBwcHBwcHBwcHBwcHBwcHBwcHBwcHBwcHBwcHBwc";
/// assert_eq!(key.to_string(), shown);
/// assert_eq!(AccountKey::parse(shown), Some(key));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct AccountKey([u8; 32]);

/// Implements serde's traits for types with `Display` and a function `parse`. They are serialized as their text.
macro_rules! serialized_as_text {
    ($($kind:ty: $what:literal),*) => {$(
        impl serde::Serialize for $kind {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.collect_str(self)
            }
        }

        impl<'de> serde::Deserialize<'de> for $kind {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let text = <String as serde::Deserialize>::deserialize(from)?;
                let fault = || serde::de::Error::custom(concat!("not ", $what));
                Self::parse(&text).ok_or_else(fault)
            }
        }
    )*};
}
pub(crate) use serialized_as_text;

serialized_as_text!(AccountKey: "a fingerprint of a key");

/// An account.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Account {
    /// Its number.
    pub id: AccountId,
    /// Its key.
    pub key: AccountKey,
    /// Its name.
    pub name: Name,
    /// When the name was chosen.
    pub named_at: UnixTime,
    /// When the account was created.
    pub created_at: UnixTime,
    /// When the player was last on the host.
    pub seen_at: UnixTime,
}

/// The choices of an account's player.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct AccountSettings {
    /// The choices in the game.
    pub preferences: Preferences,
    /// Keys, glyphs, colours and other settings, as the text of a configuration file. The store does
    /// not read it, but refuses a text of more than [`Self::MAX_BYTES`] bytes.
    pub configuration: String,
    /// The players whose talk is not shown, at most [`Self::MAX_IGNORED`].
    pub ignored: Vec<Name>,
}

impl UnixTime {
    /// The time that many seconds after the beginning of 1970, but at most the latest time that a
    /// database can store.
    pub const fn new(seconds: u64) -> Self {
        const LAST: u64 = i64::MAX as u64;
        Self(if seconds < LAST { seconds } else { LAST })
    }

    /// The current time by the clock of this machine.
    pub fn now() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self::new(since.as_secs())
    }

    /// The seconds since 1970.
    pub const fn seconds(self) -> u64 {
        self.0
    }

    /// The time that many seconds later.
    #[must_use]
    pub const fn after(self, seconds: u64) -> Self {
        Self::new(self.0.saturating_add(seconds))
    }
}

impl From<u64> for UnixTime {
    fn from(seconds: u64) -> Self {
        Self::new(seconds)
    }
}

/// A time span in its two largest units, such as `6d 23h` or `10m`.
pub(crate) fn time_text(seconds: u64) -> String {
    const UNITS: [(u64, char); 4] = [(86_400, 'd'), (3600, 'h'), (60, 'm'), (1, 's')];
    let first = UNITS.iter().position(|unit| seconds >= unit.0).unwrap_or(UNITS.len() - 1);
    let mut left = seconds;
    let counts = UNITS[first..].iter().take(2).map(|&(unit, name)| {
        let count = left / unit;
        left %= unit;
        (count, name)
    });
    let shown = counts.enumerate().filter(|&(place, (count, _))| place == 0 || count > 0);
    let words: Vec<String> = shown.map(|(_, (count, name))| format!("{count}{name}")).collect();
    words.join(" ")
}

impl AccountSettings {
    /// The longest configuration that is stored, in bytes.
    pub const MAX_BYTES: usize = 16 << 10;
    /// The most players who are ignored.
    pub const MAX_IGNORED: usize = 32;

    pub(crate) fn checked(&self) -> Result<&Self, StoreFailure> {
        let is_short =
            self.configuration.len() <= Self::MAX_BYTES && self.ignored.len() <= Self::MAX_IGNORED;
        is_short.then_some(self).ok_or_else(|| StoreFailure::new("the settings are too long"))
    }
}

impl AccountKey {
    /// The key whose data has this SHA-256.
    pub const fn new(sha256: [u8; 32]) -> Self {
        Self(sha256)
    }

    /// Parses a key in the format of `ssh-keygen -l`.
    pub fn parse(text: &str) -> Option<Self> {
        match text.trim_end_matches('=').parse() {
            Ok(Fingerprint::Sha256(sha256)) => Some(Self(sha256)),
            _ => None,
        }
    }

    /// The SHA-256.
    pub const fn bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for AccountKey {
    /// Writes the key in the format of `ssh-keygen -l`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Fingerprint::Sha256(self.0).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_time_shows_at_most_two_units() {
        for (seconds, text) in [
            (0, "0s"),
            (59, "59s"),
            (60, "1m"),
            (61, "1m 1s"),
            (3601, "1h"),
            (3661, "1h 1m"),
            (7 * 86_400 - 1, "6d 23h"),
            (7 * 86_400, "7d"),
        ] {
            assert_eq!(time_text(seconds), text);
        }
    }

    #[test]
    fn times_are_capped_at_what_a_database_can_store() {
        assert_eq!(UnixTime::new(u64::MAX).after(9), UnixTime::new(i64::MAX as u64));
    }

    proptest! {
        #[test]
        fn each_key_has_one_text_form(bytes in any::<[u8; 32]>(), end in "[A-Za-z0-9+/=]{0,2}") {
            let key = AccountKey::new(bytes);
            let text = key.to_string();
            prop_assert_eq!(text.len(), "SHA256:".len() + 43);
            prop_assert_eq!(AccountKey::parse(&text), Some(key));
            let longer = text.clone() + &end;
            prop_assert_eq!(AccountKey::parse(&longer).is_some(), end.chars().all(|c| c == '='));
            let other_end = text[..text.len() - 1].to_owned() + &end;
            let is_same = other_end.trim_end_matches('=') == text;
            prop_assert_eq!(AccountKey::parse(&other_end) == Some(key), is_same);
        }

        #[test]
        fn no_text_panics(text in "(SHA256:)?.{0,60}") {
            _ = AccountKey::parse(&text);
        }
    }
}
