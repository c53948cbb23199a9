//! Maps that were written to take long or to need much memory: the bytes that reading them takes.
//!
//! Bytes are asserted and seconds are not, since every step of the work that a limit bounds also
//! allocates, or is counted against the limit itself.

use allocation_counter::measure;
use cellcaster::fault::Faults;
use cellcaster::map::{self, Level, NoFiles};

/// The largest number of bytes that a map under 1 MB may need.
const SMALL_MAP: u64 = 256 << 20;
/// The largest number of bytes that any map may need.
const LARGE_MAP: u64 = 1 << 30;

/// Reads a map, and asserts that this needs at most `most` bytes at once.
fn read(text: &str, most: u64) -> Result<Level, Faults> {
    let mut level = None;
    let needed = measure(|| level = Some(map::parse_level(text, "map", &NoFiles)));
    let start: String = text.chars().take(20).collect();
    assert!(needed.bytes_max <= most, "{} bytes for {start:?}…", needed.bytes_max);
    level.unwrap()
}

/// `part` repeated up to `length` bytes.
fn repeated(part: &str, length: usize) -> String {
    part.repeat(length / part.len())
}

#[test]
fn text_of_many_tokens_is_refused_before_it_is_parsed() {
    let parts = ["=\n", "[", "a.", "a=1\n", "[[a]]\n", "sphere=[{},{},{}]\n", "'\n", "#\n", "\n"];
    for part in parts {
        assert!(read(&repeated(part, map::MAX_BYTES), LARGE_MAP).is_err(), "{part:?}");
        assert!(read(&repeated(part, 1_000_000), SMALL_MAP).is_err(), "{part:?}");
    }
    for (start, item, end) in [("a=[", "1,", "]"), ("sphere=[", "{},", "]"), ("a='", "#", "'")] {
        for (length, most) in [(map::MAX_BYTES - 10, LARGE_MAP), (1_000_000, SMALL_MAP)] {
            let text = [start, &repeated(item, length), end].concat();
            assert!(read(&text, most).is_err(), "{start:?}");
        }
    }
}

#[test]
fn the_fault_of_too_many_tokens_has_a_place() {
    let text = format!("title = 'Hall'\n{}", "k = 1\n".repeat(100_000));
    insta::assert_snapshot!(read(&text, SMALL_MAP).unwrap_err(), @r"
    error: a file has 262144 TOML tokens at most
         --> map:43691:5
          |
    43691 | k = 1
          |     ^ this is one too many
          |
          = help: leave some definitions out; a string is one token, however long
    ");
}
