//! The first packets of a client, which are not encrypted: its version, its offer of algorithms and
//! its half of the key exchange (RFC 4253, sections 4.2, 6 and 7.1).
//!
//! russh keeps the chosen algorithms to itself, and a session has to know whether its bytes are
//! compressed. After the key exchange, a client may wait for its user, who looks at the host key for
//! the first time or types a passphrase; before it, a client has nothing to wait for.

use russh::keys::ssh_encoding::Decode;

/// Parses the first bytes of a client as they arrive.
#[derive(Debug, Default)]
pub(crate) struct Hello {
    stage: Stage,
    /// What has arrived and is not parsed.
    bytes: Vec<u8>,
    compresses: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Its version is missing.
    #[default]
    Version,
    /// Its offer of algorithms is missing.
    Offer,
    /// Its half of the key exchange is missing.
    Exchange,
    /// It has sent all of these, and may wait for its user now.
    Done,
}

/// Longer offers are not parsed.
const LONGEST: usize = 35_000;
const KEXINIT: u8 = 20;
/// Length, length of the padding, type, cookie.
const OFFER_START: usize = 4 + 1 + 1 + 16;
/// The name list of compression from server to client, in the order of an offer.
const COMPRESSION: usize = 7;

impl Hello {
    /// Adds bytes that have arrived.
    pub(crate) fn receive(&mut self, bytes: &[u8]) {
        if self.stage == Stage::Done {
            return;
        }
        self.bytes.extend_from_slice(bytes);
        while self.step().is_some() {}
        if self.stage == Stage::Done || self.bytes.len() > LONGEST {
            self.bytes = Vec::new();
        }
    }

    /// What the client has sent.
    pub(crate) fn stage(&self) -> Stage {
        self.stage
    }

    /// Whether what the server sends will be compressed: whether the first method in the client's
    /// list that the server has is one of compression.
    pub(crate) fn compresses(&self) -> bool {
        self.compresses
    }

    /// Parses one line or packet if it is complete.
    fn step(&mut self) -> Option<()> {
        let length = match self.stage {
            Stage::Version => self.bytes.iter().position(|&byte| byte == b'\n')? + 1,
            Stage::Offer | Stage::Exchange => packet_length(&self.bytes)?,
            Stage::Done => return None,
        };
        let unit = self.bytes.get(..length)?;
        self.stage = match self.stage {
            Stage::Offer if unit.get(5) == Some(&KEXINIT) => {
                self.compresses = compresses(unit.get(OFFER_START..)?);
                Stage::Exchange
            }
            Stage::Version | Stage::Offer => Stage::Offer,
            Stage::Exchange | Stage::Done => Stage::Done,
        };
        self.bytes.drain(..length);
        Some(())
    }
}

fn packet_length(bytes: &[u8]) -> Option<usize> {
    let length = u32::from_be_bytes(*bytes.first_chunk()?) as usize;
    (length <= LONGEST).then_some(4 + length)
}

fn compresses(mut lists: &[u8]) -> bool {
    let mut lists = (0..=COMPRESSION).map_while(|_| String::decode(&mut lists).ok());
    let methods = lists.nth(COMPRESSION).unwrap_or_default();
    let known = methods.split(',').find(|method| ["none", "zlib@openssh.com"].contains(method));
    known == Some("zlib@openssh.com")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn packet(payload: &[u8]) -> Vec<u8> {
        let mut packet = (payload.len() as u32 + 5).to_be_bytes().to_vec();
        packet.push(4);
        packet.extend(payload);
        packet.extend([0; 4]);
        packet
    }

    /// What a client sends first.
    fn hello(compression: &str) -> Vec<u8> {
        let mut offer = vec![KEXINIT];
        offer.extend([7; 16]);
        let names = ["kex", "key", "cipher", "cipher", "mac", "mac", "zlib", compression, "", ""];
        for list in names {
            offer.extend((list.len() as u32).to_be_bytes());
            offer.extend(list.as_bytes());
        }
        offer.extend([0; 5]);
        let exchange = [30; 33];
        [b"SSH-2.0-OpenSSH_9.2p1\r\n".to_vec(), packet(&offer), packet(&exchange)].concat()
    }

    #[test]
    fn the_first_known_method_of_compression_is_chosen() {
        for (methods, compresses) in [
            ("none,zlib@openssh.com,zlib", false),
            ("zlib@openssh.com,zlib,none", true),
            ("zlib,zlib@openssh.com,none", true),
            ("zlib,none", false),
            ("", false),
        ] {
            let mut hello_of = Hello::default();
            hello_of.receive(&hello(methods));
            assert_eq!(hello_of.stage(), Stage::Done, "{methods}");
            assert_eq!(hello_of.compresses(), compresses, "{methods}");
        }
    }

    proptest! {
        #[test]
        fn pieces_make_no_difference(cuts in prop::collection::vec(1_usize..60, 1..40)) {
            let bytes = hello("zlib@openssh.com,none");
            let mut parser = Hello::default();
            let (mut rest, mut cuts) = (bytes.as_slice(), cuts.iter().cycle());
            while !rest.is_empty() {
                let (piece, after) = rest.split_at(rest.len().min(*cuts.next().unwrap()));
                parser.receive(piece);
                prop_assert_eq!(parser.stage() == Stage::Done, after.is_empty());
                rest = after;
            }
            prop_assert!(parser.compresses());
        }

        #[test]
        fn nothing_panics_and_little_is_kept(pieces in prop::collection::vec(any::<Vec<u8>>(), 0..80)) {
            let mut parser = Hello::default();
            for piece in pieces {
                parser.receive(&piece);
                prop_assert!(parser.bytes.len() <= LONGEST);
            }
        }
    }
}
