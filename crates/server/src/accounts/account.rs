//! Accounts: a key, a name, and settings.

use std::fmt;

use super::{Name, StoreFailure, UnixTime};
use cellcaster::app::store::Preferences;

/// The number of an account.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct AccountId(pub(crate) i64);

/// The SHA-256 of the data of a public key: its fingerprint.
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

/// An account.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// When the player was here last.
    pub seen_at: UnixTime,
}

/// What the player of an account has chosen.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct AccountSettings {
    /// The choices in the game.
    pub preferences: Preferences,
    /// Keys, glyphs, colours and the rest, as the text of a configuration file. The store does not read
    /// it. A text of more than [`Self::MOST_BYTES`] bytes is refused.
    pub configuration: String,
}

impl AccountSettings {
    /// The longest configuration that is kept, in bytes.
    pub const MOST_BYTES: usize = 16 << 10;

    pub(crate) fn checked(&self) -> Result<&Self, StoreFailure> {
        let is_short = self.configuration.len() <= Self::MOST_BYTES;
        is_short.then_some(self).ok_or_else(|| StoreFailure::new("the settings are too long"))
    }
}

/// What OpenSSH puts before the digits.
const PREFIX: &str = "SHA256:";
/// The digits of RFC 4648, section 4.
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

impl AccountKey {
    /// The key whose data has this SHA-256.
    pub const fn new(sha256: [u8; 32]) -> Self {
        Self(sha256)
    }

    /// The key that is written as `ssh-keygen -l` does.
    pub fn parse(text: &str) -> Option<Self> {
        let mut bytes = [0; 32];
        let digits = text.strip_prefix(PREFIX)?.trim_end_matches('=').as_bytes();
        let (mut bits, mut count, mut index) = (0_u32, 0, 0);
        for digit in digits {
            let value = DIGITS.iter().position(|known| known == digit)?;
            (bits, count) = ((bits << 6 | value as u32) & 0xffff, count + 6);
            if count >= 8 {
                count -= 8;
                *bytes.get_mut(index)? = (bits >> count) as u8;
                index += 1;
            }
        }
        // A digit too many, or one whose last bits are not 0, would be a second text for the same key.
        let key = Self(bytes);
        (index == bytes.len() && &key.to_string().as_bytes()[PREFIX.len()..] == digits)
            .then_some(key)
    }

    /// The SHA-256.
    pub const fn bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for AccountKey {
    /// Writes it as `ssh-keygen -l` does.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = PREFIX.to_owned();
        for chunk in self.0.chunks(3) {
            let byte = |index: usize| u32::from(chunk.get(index).copied().unwrap_or_default());
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            let digits = (0..=chunk.len()).map(|index| bits >> (18 - 6 * index) & 63);
            text.extend(digits.map(|value| char::from(DIGITS[value as usize])));
        }
        f.write_str(&text)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_key_has_one_text(bytes in any::<[u8; 32]>(), end in "[A-Za-z0-9+/=]{0,2}") {
            let key = AccountKey::new(bytes);
            let text = key.to_string();
            prop_assert_eq!(text.len(), PREFIX.len() + 43);
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
