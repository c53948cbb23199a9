//! The messages of a cluster's hosts about a room: messages of its log, broadcasts, records, and
//! the head of a checkpoint.
//!
//! The first byte chooses the origin of the room: a mode, a record, or a checkpoint. The record or
//! the head follows, and then parts, each with a byte for its kind and a byte for a number. All of
//! them begin with a length byte, and have no versions. Bytes that parse as a message are written
//! as bytes that parse as the same message, and no message ends a host.

use allocation_counter::measure;
use cellcaster_server::fuzzing::SharedRoom;

const MAX_PARTS: usize = 32;
/// The largest number of steps in a message, and in all messages.
const MAX_STEPS: u64 = 60;
/// The largest number of bytes allocated for a step, as long as nobody draws.
const BYTES_OF_A_STEP: u64 = 64 << 10;
/// The largest number of bytes allocated for a byte of a message.
const BYTES_OF_A_BYTE: u64 = 256;

/// Delivers all parts to a host.
pub fn run(data: &[u8]) {
    let Some((&from, rest)) = data.split_first() else { return };
    let mut parts = Parts(rest);
    let first = || parts.next().unwrap_or_default();
    let Some(mut room) = begun(from, first) else { return };
    let mut steps = 0;
    for part in parts.take(MAX_PARTS) {
        let Some(([kind, number], text)) = part.split_first_chunk() else { continue };
        let count = u64::from(*number).min(MAX_STEPS);
        steps += count;
        if steps > MAX_STEPS {
            break;
        }
        let used = measure(|| match kind % 4 {
            0 => room.follow(count, &String::from_utf8_lossy(text)),
            1 => room.hear(text),
            2 => room.lead(count),
            _ => room.read(text),
        });
        let most = 64 * 1024 + BYTES_OF_A_STEP * count + BYTES_OF_A_BYTE * text.len() as u64;
        assert!(used.bytes_total <= most || kind % 4 == 3, "{} bytes", used.bytes_total);
        room = room.put();
    }
}

/// Parts of the input, each preceded by its length. The last part may be shorter.
struct Parts<'a>(&'a [u8]);

impl<'a> Iterator for Parts<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let (&length, rest) = self.0.split_first()?;
        let (part, rest) = rest.split_at(usize::from(length).min(rest.len()));
        self.0 = rest;
        Some(part)
    }
}

fn begun<'a>(from: u8, mut part: impl FnMut() -> &'a [u8]) -> Option<SharedRoom> {
    match from % 8 {
        6 => SharedRoom::of_record(part()),
        7 => SharedRoom::new((from / 8).into()).restored(part()).ok(),
        mode => Some(SharedRoom::new(mode.into())),
    }
}
