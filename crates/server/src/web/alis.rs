//! Messages of `ALiS`, version 1: the protocol by which asciinema's player shows a live stream over a WebSocket.
//!
//! The first message is [`MAGIC`], the second one [`start`]. Each message has one event. Numbers are LEB128. An event has
//! a number, and its time in microseconds since the event before. `start` contains the whole screen, so a player that has
//! missed events goes on with another `start`.

use bytes::Bytes;
use ratatui::layout::Size;

/// The name of the protocol in the opening handshake.
pub(crate) const PROTOCOL: &str = "v1.alis";
/// The first message.
pub(crate) const MAGIC: &[u8] = b"ALiS\x01";
/// The message at the end of the stream.
pub(crate) const END: &[u8] = b"\x04";

/// The screen after event `number`, at `time`.
pub(crate) fn start(number: u64, time: u64, size: Size, screen: &str) -> Bytes {
    let mut bytes = vec![1];
    for number in [number, time, size.width.into(), size.height.into()] {
        push_number(&mut bytes, number);
    }
    // The player chooses the colours of text without a colour.
    bytes.push(0);
    push_text(&mut bytes, screen);
    bytes.into()
}

/// The output of event `number`, `since` the event before.
pub(crate) fn output(number: u64, since: u64, text: &str) -> Bytes {
    let mut bytes = vec![b'o'];
    push_number(&mut bytes, number);
    push_number(&mut bytes, since);
    push_text(&mut bytes, text);
    bytes.into()
}

fn push_text(bytes: &mut Vec<u8>, text: &str) {
    push_number(bytes, text.len() as u64);
    bytes.extend(text.as_bytes());
}

fn push_number(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 127 {
        bytes.push(number as u8 | 128);
        number >>= 7;
    }
    bytes.push(number as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes that the protocol's own implementation writes.
    #[test]
    fn events_have_their_numbers_in_leb128() {
        let size = Size::new(80, 24);
        assert_eq!(*start(2, 300, size, "hi"), *b"\x01\x02\xac\x02\x50\x18\0\x02hi");
        let text = "x".repeat(128);
        let event = output(127, 128, &text);
        assert_eq!(event[..6], *b"o\x7f\x80\x01\x80\x01");
        assert_eq!(event[6..], *text.as_bytes());
    }
}
