//! Maps: the text of a map file and, behind the first byte 0, choices: rules, intents and cameras.
//!
//! A map is read or refused within the memory that the tests of hostile maps allow. For one that is
//! read:
//!
//! - the player is never inside anything, whatever they want;
//! - no step of the game takes more work than a millisecond allows;
//! - steps of a game at rest equal one wait;
//! - a renderer that drew another picture draws the same one as a new renderer, one thread the same one
//!   as several, and `explain` the same one as `render`.

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
const MOST_BYTES: u64 = 256 << 20;

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
    assert!(used.bytes_max <= MOST_BYTES, "reading took {} bytes", used.bytes_max);
    level?.map_err(|faults| check_faults(&faults)).ok()
}
