//! What a client sends before it has logged in: a version and packets, of which the input names the kinds and fields.
//!
//! The connection ends, and work, memory and answers are bounded by what arrives.

use crate::bytes::Bytes;
use crate::ssh::Stream;

/// Sends the packets.
pub fn run(data: &[u8]) {
    Stream::new().choose(&mut Bytes::new(data)).send();
}
