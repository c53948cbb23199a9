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

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::accounts::Day;
use cellcaster::app::store::map_key;
use cellcaster::fault::{Faults, printable_path};
use cellcaster::map::{self, Folder, builtin};
use cellcaster::world::World;
use thiserror::Error;

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

/// An error while reading maps.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum MapsError {
    /// A sentence.
    #[error("{0}")]
    Sentence(String),
    /// Several sentences, or reports in the format of `cellcaster check`, one per line.
    #[error("{0}")]
    Report(String),
}

impl HostMaps {
    /// Reads the maps of a folder, or a single map file.
    ///
    /// # Errors
    /// All faults of all maps, or the reason why the folder cannot be read.
    pub fn read(path: &Path) -> Result<Self, MapsError> {
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
                return Err(MapsError::Sentence(format!(
                    "the maps in {} are larger than {most} MiB together: remove some",
                    printable_path(path)
                )));
            }
        }
        match MapsError::of_all(errors) {
            None => Ok(Self(maps)),
            Some(error) => Err(error),
        }
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

impl MapsError {
    /// Joins all errors into one; `None` if there are none.
    fn of_all(mut errors: Vec<Self>) -> Option<Self> {
        if errors.len() <= 1 {
            return errors.pop();
        }
        let texts: Vec<String> = errors.iter().map(Self::to_string).collect();
        Some(Self::Report(texts.join("\n")))
    }
}

impl From<Faults> for MapsError {
    fn from(faults: Faults) -> Self {
        Self::Report(faults.to_string().trim_end().to_owned())
    }
}

/// The map files in a folder, sorted by name; or `path` itself if it is not a folder.
fn map_files(path: &Path) -> Result<Vec<PathBuf>, MapsError> {
    let unreadable = |error| {
        MapsError::Sentence(format!("the maps in {} can't be read: {error}", printable_path(path)))
    };
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
            return Err(MapsError::Sentence(format!(
                "there are more than {MAX_MAPS} maps in {}: remove some",
                printable_path(path)
            )));
        }
    }
    files.sort();
    Ok(files)
}

/// Reads a map; returns it with its length in bytes.
fn read_map(path: &Path) -> Result<(HostMap, u64), MapsError> {
    let name = map_name(path)?;
    let shown = printable_path(path);
    let unreadable = |error| MapsError::Sentence(format!("{shown} can't be read: {error}"));
    // Opening a pipe would block until its other end is opened.
    if !fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(MapsError::Sentence(format!("{shown} is not a file")));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(MAX_MAP_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    let length = bytes.len() as u64;
    if length > MAX_MAP_BYTES {
        let most = MAX_MAP_BYTES >> 10;
        return Err(MapsError::Sentence(format!(
            "{shown} is larger than {most} KiB, the limit for a host's map"
        )));
    }
    let text = Faults::text_of(bytes, &shown, "map")?;
    let world = Arc::new(map::parse(&text, &shown, &Folder::of(path))?);
    let key = map_key(&name, &text);
    Ok((HostMap { name, key, world }, length))
}

/// The name of the map in a file, or an error if the name is not allowed.
fn map_name(path: &Path) -> Result<String, MapsError> {
    const MAX_LENGTH: usize = 32;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let is_plain = |byte: u8| matches!(byte, b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_');
    if !(1..=MAX_LENGTH).contains(&name.len()) || !name.bytes().all(is_plain) {
        return Err(MapsError::Sentence(format!(
            "{} needs another name: 1 to {MAX_LENGTH} of the characters a to z, 0 to 9, - and _, then .toml",
            printable_path(path)
        )));
    }
    if builtin::LEVELS.iter().any(|level| level.name == name) {
        return Err(MapsError::Sentence(format!(
            "{} needs another name: {name} is a built-in level",
            printable_path(path)
        )));
    }
    if Day::of_level(&name).is_some() {
        return Err(MapsError::Sentence(format!(
            "{} needs another name: {name} is the daily level of a day",
            printable_path(path)
        )));
    }
    Ok(name.into_owned())
}

#[cfg(test)]
mod tests;
