//! A recorded room. It is replayed or rejected, with the same result twice. The number of bytes
//! allocated for it is bounded: a round has its own game and at most 1,200 steps, and a header
//! takes a hundred bytes.

use allocation_counter::measure;
use cellcaster_server::fuzzing::FuzzedRoom;

/// The number of bytes allocated for the first round, and for each byte of the recording.
const BYTES_OF_A_ROUND: u64 = 16 << 20;
const BYTES_OF_A_BYTE: u64 = 160 << 10;

/// Plays a recording twice.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let mut played = None;
    let used = measure(|| played = Some(FuzzedRoom::replayed(&text)));
    let most = BYTES_OF_A_ROUND + BYTES_OF_A_BYTE * data.len() as u64;
    assert!(used.bytes_total <= most, "{} bytes for {}", used.bytes_total, data.len());
    assert_eq!(Some(FuzzedRoom::replayed(&text)), played);
}
