//! Tiled maps: a `.tmx` or a `.tmj`. Its tilesets are the map itself, its pictures a PNG file.
//!
//! A map is read or rejected within bounded memory. If it is read, its text is a map file of the same
//! level, and the way back to Tiled changes nothing.

use allocation_counter::measure;
use cellcaster::map::tiled::{export, import};
use cellcaster::map::{self, TextureFileError, TextureFiles};

use crate::faults::check_faults;

/// The largest number of bytes that reading a map under 1 MB may need.
const MAX_BYTES: u64 = 256 << 20;

/// The text of the map under every name that is no picture's.
struct Files<'a>(&'a str);

impl TextureFiles for Files<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let picture: &[u8] = include_bytes!("maps/picture.png");
        Ok(if name.contains(".png") { picture } else { self.0.as_bytes() }.to_vec())
    }
}

/// Reads a map, and writes it again.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let files = Files(&text);
    let mut read = None;
    let used = measure(|| read = Some(import(&text, "map", &files)));
    assert!(used.bytes_max <= MAX_BYTES, "reading took {} bytes", used.bytes_max);
    let read = match read.expect("it was read") {
        Ok(read) => read,
        Err(faults) => return check_faults(&faults),
    };
    let level = map::parse_level(&read.text, "map", &files).expect("the text is a map file");
    let there = export(&read.text, "map", "tiles.png", &files).expect("it is a map with a grid");
    let back = import(&there.map, "map", &files).expect("Tiled's own file is read");
    assert!(back.level == level, "the level has changed");
}
