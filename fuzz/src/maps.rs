//! Maps: the text of a map file and, behind the first byte 0, choices: rules, intents and cameras.
//!
//! A map is read or rejected within the memory that the tests of hostile maps allow. If a map is
//! read:
//!
//! - the player is never inside anything, whatever their intents;
//! - no step of the game takes more work than fits in a millisecond;
//! - steps of a game at rest equal one wait;
//! - a renderer that has drawn another picture draws the same picture as a new renderer, one thread
//!   draws the same as several, and `explain` draws the same as `render`.

mod bodies;
mod grid;
mod intents;
mod mutator;
mod views;
mod vocabulary;

use allocation_counter::measure;
use cellcaster::map::{self, Level};

use crate::bytes::Bytes;
use crate::faults::check_faults;
use crate::files::OneFile;
pub use mutator::mutate;

/// Ends the text of a map.
const END: u8 = 0;

/// A sheet with holes: 16×8 texels, of 16-bit RGBA.
const PICTURE: &[u8] = include_bytes!("maps/picture.png");

/// The largest number of bytes that reading a map under 1 MB may need.
const MAX_BYTES: u64 = 256 << 20;

/// Reads a map, plays in it and draws it.
pub fn run(data: &[u8]) {
    let end = data.iter().position(|&byte| byte == END).unwrap_or(data.len());
    let (text, rest) = data.split_at(end);
    let mut choices = Bytes::new(rest.get(1..).unwrap_or_default());
    match read(text) {
        Some(Level::Grid(world)) => grid::check(*world, &mut choices),
        Some(Level::Space(scene)) => bodies::check(scene, &mut choices),
        None => {}
    }
}

/// Reads a map within bounded memory; `None` if it has faults.
fn read(text: &[u8]) -> Option<Level> {
    let mut level = None;
    let used = measure(|| level = Some(map::read_level(text, "map", &OneFile(PICTURE))));
    assert!(used.bytes_max <= MAX_BYTES, "reading took {} bytes", used.bytes_max);
    level?.map_err(|faults| check_faults(&faults)).ok()
}
