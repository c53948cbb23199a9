//! What a visitor types on the pages of a session, without a terminal that shows them.
//!
//! The first two bytes choose the terminal and the size of its window, the others arrive as they are, cut at each
//! byte 0 of them: there, steps pass and a frame is drawn. The bytes that are allocated for what arrives are bounded
//! by its length, so that nobody makes a host work by typing.

use allocation_counter::measure;
use cellcaster::terminal::{Options, WindowSize};
use cellcaster_server::fuzzing::Hall;

use crate::bytes::Bytes;

/// Where a frame is drawn.
const CUT: u8 = 0;
const MOST_PARTS: usize = 16;
/// The bytes that are allocated for a byte that arrives, which may make a page anew, and for each arrival.
const BYTES_OF_A_BYTE: u64 = 32 << 10;
const BYTES_OF_A_PART: u64 = 256 << 10;

/// Lets one visitor type.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let (kind, width) = (choices.byte(), choices.byte());
    let term = ["xterm-256color", "linux", "xterm-kitty", "dumb"][usize::from(kind & 3)];
    let options = Options::from_environment(|name| (name == "TERM").then(|| term.to_owned()));
    let mut hall = Hall::small((kind >> 2).into());
    let columns = 20 + u16::from(width) % 80;
    hall.arrive("Ada", options, WindowSize::new((columns, 24), (0, 0)));
    for part in choices.take(data.len()).split(|&byte| byte == CUT).take(MOST_PARTS) {
        let used = measure(|| hall.press(0, part));
        let most = BYTES_OF_A_PART + BYTES_OF_A_BYTE * part.len() as u64;
        assert!(used.bytes_total <= most, "{} bytes for {}", used.bytes_total, part.len());
        hall.pass(3);
        _ = hall.output(0);
    }
}
