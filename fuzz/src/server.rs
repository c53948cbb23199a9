//! The server without connections: the first byte says which part of it.
//!
//! - Sessions of a room: their clients' terminals send anything, and the log of the round gives the room,
//!   bit for bit. A session ends only after it has given its terminal back.
//! - A recorded room: it is played again or refused, twice the same.
//! - The two stores of a host: both answer alike, whatever is asked of them.
//! - What operators and visitors write: a configuration, a request, a name, a range of addresses.

mod hall;
mod store;
mod words;

use crate::bytes::Bytes;

/// Gives the other bytes to the part that the first one says.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    match choices.below(4) {
        0 => hall::run(&mut choices),
        1 => hall::replay(&String::from_utf8_lossy(choices.take(data.len()))),
        2 => store::run(&mut choices),
        _ => words::run(choices.byte(), choices.take(data.len())),
    }
}
