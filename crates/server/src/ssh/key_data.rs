//! Public keys as accounts.

use std::fmt;

use russh::keys::ssh_encoding::Encode;
use russh::keys::ssh_key::HashAlg;
use russh::keys::ssh_key::public;

/// A public key without its comment, which identifies an account.
///
/// Two keys are equal if the bytes that SSH sends for them are.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KeyData {
    encoded: Box<[u8]>,
    fingerprint: String,
}

impl KeyData {
    /// The data of a key; `None` if it can't be encoded.
    pub(crate) fn new(key: &public::KeyData) -> Option<Self> {
        let encoded = key.encode_vec().ok()?.into_boxed_slice();
        Some(Self { encoded, fingerprint: key.fingerprint(HashAlg::Sha256).to_string() })
    }

    /// The key as SSH sends it (RFC 4253, section 6.6).
    pub fn as_bytes(&self) -> &[u8] {
        &self.encoded
    }

    /// The fingerprint as `ssh-keygen -l` prints it, such as `SHA256:…`.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

impl fmt::Debug for KeyData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.fingerprint)
    }
}
