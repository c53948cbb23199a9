//! The bytes of a map: from a file or a stream, up to a limit.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use super::MAX_BYTES;
use crate::fault::Faults;

pub(crate) fn read_text(input: impl Read, name: &str) -> Result<String, Faults> {
    let mut bytes = Vec::new();
    let read = input.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| unreadable(name, &error))?;
    if bytes.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    Faults::text_of(bytes, name, "map")
}

/// Opens the map file at `path`, which faults call `name`.
///
/// Only a regular file is opened: opening a pipe would wait for its other end, and a device may
/// have no end.
pub(crate) fn open(path: &Path, name: &str) -> Result<File, Faults> {
    let metadata = fs::metadata(path).map_err(|error| unreadable(name, &error))?;
    if metadata.is_dir() {
        let message = format!("{name} is a folder, not a map");
        return Err(Faults::of_whole_file(name, &message, "name a map file in it"));
    }
    if !metadata.is_file() {
        let message = format!("{name} is a pipe or a device, not a map");
        return Err(Faults::of_whole_file(name, &message, "a map on standard input is called -"));
    }
    File::open(path).map_err(|error| unreadable(name, &error))
}

/// Reads at most `limit` bytes of a file.
pub(crate) fn read_up_to(path: &Path, limit: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limit as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

pub(crate) fn too_large(name: &str) -> Faults {
    let limit = MAX_BYTES >> 20;
    let message = format!("{name} is larger than {limit} MiB, the most that a map may have");
    Faults::of_whole_file(name, &message, "")
}

fn unreadable(name: &str, error: &io::Error) -> Faults {
    let message = match error.kind() {
        io::ErrorKind::NotFound => format!("there is no file {name}"),
        kind => format!("{name} cannot be read: {kind}"),
    };
    Faults::of_whole_file(name, &message, "")
}
