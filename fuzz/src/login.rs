//! The data that a client sends before it has logged in: a version and packets. The input chooses
//! the kinds and fields of the packets.
//!
//! The connection ends. Work, memory and answers are bounded by the number of bytes that arrive.

use crate::bytes::Bytes;
use crate::ssh::Stream;

/// Sends the packets.
pub fn run(data: &[u8]) {
    Stream::new().choose(&mut Bytes::new(data)).send();
}
