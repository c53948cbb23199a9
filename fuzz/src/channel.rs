//! What a client sends in a session, without encryption: packets, of which the input names the kinds and fields.
//!
//! The connection ends, and work, memory and answers are bounded by what arrives. The session sends back what it gets.

use crate::bytes::Bytes;
use crate::ssh::Stream;

/// The message by which a server accepts a terminal or a shell.
const CHANNEL_SUCCESS: u8 = 99;

/// Sends the packets, in a session.
pub fn run(data: &[u8]) {
    let answer = Stream::in_session().choose(&mut Bytes::new(data)).send();
    // Length, padding, type and the number of the channel.
    let accepts = |packet: &[u8]| packet == [CHANNEL_SUCCESS, 0, 0, 0, 0];
    let count = answer.windows(5).filter(|packet| accepts(packet)).count();
    assert!(count >= 2, "no session has begun: {:?}", String::from_utf8_lossy(&answer));
}
