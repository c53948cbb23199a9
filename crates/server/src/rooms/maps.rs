//! The host's own maps: levels in addition to the built-in ones.
//!
//! Every `*.toml` file in a folder is a map. The maps are read once, when the server starts. All faults in
//! all maps are reported in one run, in the format of `cellcaster check`.
//!
//! # Rules
//!
//! - A map must have a grid. Players cannot meet each other in a space of bodies.
//! - A map's name is its file name without the extension: 1 to 32 characters from a to z, 0 to 9, `-` and
//!   `_`. It must not be the name of a built-in or daily level.
//! - Logs, scripts and boards refer to a map by its [key](map_key), which contains a hash of its text.
//!   Results from before a change to the map are therefore not compared with newer ones.
//! - There are at most [`MAX_MAPS`] maps, of at most [`MAX_MAP_BYTES`] each and [`MAX_BYTES`] in total.
//!
//! Rejected: reloading maps while the server runs. Open rooms and the boards would then refer to two maps
//! with the same name.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::accounts::Day;
use cellcaster::app::store::{map_key, private};
use cellcaster::fault::{Faults, printable_path};
use cellcaster::map::{self, Folder, builtin};
use cellcaster::world::World;

/// The maximum number of a host's maps.
pub const MAX_MAPS: usize = 100;
/// The maximum size of one map, in bytes.
pub const MAX_MAP_BYTES: u64 = 256 << 10;
/// The maximum total size of a host's maps, in bytes.
pub const MAX_BYTES: u64 = 4 << 20;

/// The host's own maps, ordered by name.
#[derive(Clone, Debug, Default)]
pub struct HostMaps(pub(crate) Vec<HostMap>);

#[derive(Clone, Debug)]
pub(crate) struct HostMap {
    /// The file name without its extension.
    pub(crate) name: String,
    pub(crate) key: String,
    pub(crate) world: Arc<World>,
}

impl HostMaps {
    /// Reads the maps of a folder, or a single map file.
    ///
    /// # Errors
    /// All faults of all maps, in the format of `cellcaster check`, or the reason why the folder cannot be read.
    pub fn read(path: &Path) -> Result<Self, String> {
        let files = map_files(path)?;
        let (mut maps, mut errors, mut bytes) = (Vec::new(), Vec::new(), 0);
        for file in &files {
            match read_map(file) {
                Ok((map, length)) => {
                    bytes += length;
                    maps.push(map);
                }
                Err(error) => errors.push(error),
            }
            if bytes > MAX_BYTES {
                let most = MAX_BYTES >> 20;
                return Err(format!(
                    "the maps in {} are larger than {most} MiB together: remove some",
                    printable_path(path)
                ));
            }
        }
        if errors.is_empty() { Ok(Self(maps)) } else { Err(errors.join("\n")) }
    }

    /// The names of the maps.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|map| map.name.as_str())
    }

    /// The names of all levels: the built-in ones, then the maps.
    pub fn level_names(&self) -> Vec<&str> {
        builtin::LEVELS.iter().map(|level| level.name).chain(self.names()).collect()
    }
}

/// The map files in a folder, sorted by name; or `path` itself if it is not a folder.
fn map_files(path: &Path) -> Result<Vec<PathBuf>, String> {
    let unreadable = |error| format!("the maps in {} can't be read: {error}", printable_path(path));
    if !fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        if file.extension().is_some_and(|ending| ending == "toml") {
            files.push(file);
        }
        if files.len() > MAX_MAPS {
            return Err(format!(
                "there are more than {MAX_MAPS} maps in {}: remove some",
                printable_path(path)
            ));
        }
    }
    files.sort();
    Ok(files)
}

/// Reads a map; returns it with its length in bytes.
fn read_map(path: &Path) -> Result<(HostMap, u64), String> {
    let name = map_name(path)?;
    let shown = printable_path(path);
    let bytes = private::read(path, MAX_MAP_BYTES).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            let most = MAX_MAP_BYTES >> 10;
            format!("{shown} is larger than {most} KiB, the limit for a host's map")
        }
        _ => format!("{shown} can't be read: {error}"),
    })?;
    let length = bytes.len() as u64;
    let report = |faults: Faults| faults.to_string().trim_end().to_owned();
    let text = Faults::text_of(bytes, &shown, "map").map_err(report)?;
    let world = Arc::new(map::parse(&text, &shown, &Folder::of(path)).map_err(report)?);
    let key = map_key(&name, &text);
    Ok((HostMap { name, key, world }, length))
}

/// The name of the map in a file, or an error if the name is not allowed.
fn map_name(path: &Path) -> Result<String, String> {
    const MAX_LENGTH: usize = 32;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let is_plain = |byte: u8| matches!(byte, b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_');
    let fault = if !(1..=MAX_LENGTH).contains(&name.len()) || !name.bytes().all(is_plain) {
        format!("1 to {MAX_LENGTH} of the characters a to z, 0 to 9, - and _, then .toml")
    } else if builtin::LEVELS.iter().any(|level| level.name == name) {
        format!("{name} is a built-in level")
    } else if Day::of_level(&name).is_some() {
        format!("{name} is the daily level of a day")
    } else {
        return Ok(name.into_owned());
    };
    Err(format!("{} needs another name: {fault}", printable_path(path)))
}

#[cfg(test)]
mod tests;
