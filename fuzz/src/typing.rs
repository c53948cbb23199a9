//! The keys that a visitor types on the pages of a session, without a terminal that shows the
//! pages.
//!
//! The first two bytes choose the terminal and the size of its window. The others arrive unchanged,
//! cut at each byte 0, where steps pass and a frame is drawn. The number of bytes allocated for
//! them is bounded by their length, so nobody can make a host work by typing.

use allocation_counter::measure;
use cellcaster::terminal::{SessionOptions, WindowSize};
use cellcaster_server::fuzzing::FuzzedRoom;

use crate::bytes::Bytes;

/// The byte at which a frame is drawn.
const CUT: u8 = 0;
const MAX_PARTS: usize = 16;
/// The number of bytes allocated for a byte that arrives, which may rebuild a page of 39 kB, and for each
/// arrival.
const BYTES_OF_A_BYTE: u64 = 48 << 10;
const BYTES_OF_A_PART: u64 = 256 << 10;

/// Lets one visitor type.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let (kind, width) = (choices.byte(), choices.byte());
    let term = ["xterm-256color", "linux", "xterm-kitty", "dumb"][usize::from(kind & 3)];
    let options =
        SessionOptions::from_environment(|name| (name == "TERM").then(|| term.to_owned()));
    let mut room = FuzzedRoom::small((kind >> 2).into());
    let columns = 20 + u16::from(width) % 80;
    room.arrive("Ada", options, WindowSize::new((columns, 24), (0, 0)));
    for part in choices.take(data.len()).split(|&byte| byte == CUT).take(MAX_PARTS) {
        let used = measure(|| room.press(0, part));
        let most = BYTES_OF_A_PART + BYTES_OF_A_BYTE * part.len() as u64;
        assert!(used.bytes_total <= most, "{} bytes for {}", used.bytes_total, part.len());
        room.pass(3);
        _ = room.output(0);
    }
}
