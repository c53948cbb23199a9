//! The player's own maps: the map files in the current folder.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::app::{OwnLevel, OwnMap};
use crate::map;
use crate::sort;
use crate::store::map_key;

/// The map files in `folders`, sorted by name. Folders that cannot be read have none.
pub(super) fn find(folders: &[PathBuf]) -> Vec<OwnMap> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    sort::by(&mut paths, PathBuf::cmp);
    paths.into_iter().filter_map(own_map).collect()
}

/// The map in the file at `path`, if it is a TOML file with a grid or a list of bodies at its top level.
fn own_map(path: PathBuf) -> Option<OwnMap> {
    let text = text_of(&path).filter(|text| text.lines().any(begins_a_map))?;
    let name = path.file_name()?.to_string_lossy().into_owned();
    let key = key_of(&path, &text);
    let load = move || {
        let text = text_of(&path).ok_or_else(|| format!("{} can't be read", path.display()))?;
        let level = map::load_level(&path).map_err(|faults| faults.summary())?;
        Ok(OwnLevel { level, key: key_of(&path, &text) })
    };
    Some(OwnMap { name, key, load: Box::new(load) })
}

fn key_of(path: &Path, text: &str) -> String {
    map_key(&path.file_name().unwrap_or_default().to_string_lossy(), text)
}

/// The text of a TOML file that is not too large for a map.
fn text_of(path: &Path) -> Option<String> {
    const LARGEST: u64 = 1 << 20;
    let is_toml = path.extension().is_some_and(|ending| ending == OsStr::new("toml"));
    let is_small = || fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= LARGEST);
    if is_toml && is_small() { fs::read_to_string(path).ok() } else { None }
}

fn begins_a_map(line: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim() == "grid")
        || matches!(line.trim(), "[[sphere]]" | "[[plane]]" | "[[box]]")
}
