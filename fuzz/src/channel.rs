//! The packets that a client sends in a session, without encryption. The input chooses their kinds
//! and fields.
//!
//! The connection ends. Work, memory and answers are bounded by the number of bytes that arrive.
//! The session echoes its input.

use crate::bytes::Bytes;
use crate::ssh::Stream;

/// The message with which a server accepts a terminal or a shell.
const CHANNEL_SUCCESS: u8 = 99;

/// Sends the packets in a session.
pub fn run(data: &[u8]) {
    let answer = Stream::in_session().choose(&mut Bytes::new(data)).send();
    // Type and number of the channel, after length and padding.
    let accepts = |packet: &[u8]| packet == [CHANNEL_SUCCESS, 0, 0, 0, 0];
    let count = answer.windows(5).filter(|packet| accepts(packet)).count();
    assert!(count >= 2, "no session has begun: {:?}", String::from_utf8_lossy(&answer));
}
