//! The player's own maps: the map files in the current folder.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::app::OwnMap;
use crate::map;

/// The map files in `folders`, sorted by name. Folders that cannot be read have none.
pub(super) fn find(folders: &[PathBuf]) -> Vec<OwnMap> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| is_map(path)).collect();
    paths.sort();
    paths.into_iter().map(own_map).collect()
}

fn own_map(path: PathBuf) -> OwnMap {
    let name = path.strip_prefix(".").unwrap_or(&path).display().to_string();
    let load = move || map::load_level(&path).map_err(|faults| faults.summary());
    OwnMap { name, load: Box::new(load) }
}

/// Whether a TOML file is a map: it has a grid or a list of bodies at its top level.
fn is_map(path: &Path) -> bool {
    const LARGEST: u64 = 1 << 20;
    let is_toml = path.extension().is_some_and(|ending| ending == OsStr::new("toml"));
    let is_small = || fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= LARGEST);
    let text = if is_toml && is_small() { fs::read_to_string(path).ok() } else { None };
    text.is_some_and(|text| text.lines().any(begins_a_map))
}

fn begins_a_map(line: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim() == "grid")
        || matches!(line.trim(), "[[sphere]]" | "[[plane]]" | "[[box]]")
}
