//! The player's own maps: the map files in the current folder, and those that are named by a path.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::app::store::map_key;
use crate::app::{OwnLevel, OwnMap};
use crate::map::{self, Level};
use crate::sort;

/// The map files in `folders`, sorted by name. Folders that cannot be read have none.
pub(crate) fn find(folders: &[PathBuf]) -> Vec<OwnMap> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    sort::by(&mut paths, PathBuf::cmp);
    paths.into_iter().filter_map(own_map).collect()
}

/// The map in the file at `path`, if it is a TOML file with a grid or a list of bodies at its top level.
fn own_map(path: PathBuf) -> Option<OwnMap> {
    let is_toml = path.extension().is_some_and(|ending| ending == OsStr::new("toml"));
    let text = text_of(&path).filter(|text| is_toml && text.lines().any(begins_a_map))?;
    let name = path.file_name()?.to_string_lossy().into_owned();
    let key = key_of(&path, &text);
    let load = move || load(&path);
    Some(OwnMap { name, key, load: Box::new(load) })
}

/// Loads the map in the file at `path`.
///
/// # Errors
/// A sentence for the player.
pub(crate) fn load(path: &Path) -> Result<OwnLevel, String> {
    if !path.is_file() {
        return Err(format!("{} is no file now", path.display()));
    }
    let level = map::load_level(path).map_err(|faults| faults.summary())?;
    own_level(path, level).ok_or_else(|| format!("{} can't be read", path.display()))
}

/// `level` with what it is kept by, which was loaded from `path`; `None` if that is no file that can be read
/// again.
pub(crate) fn own_level(path: &Path, level: Level) -> Option<OwnLevel> {
    let text = text_of(path)?;
    let file = fs::canonicalize(path).ok()?.into_os_string().into_string().ok();
    Some(OwnLevel { level, key: key_of(path, &text), file })
}

fn key_of(path: &Path, text: &str) -> String {
    map_key(&path.file_name().unwrap_or_default().to_string_lossy(), text)
}

/// The text of a file that is not too large for a map.
fn text_of(path: &Path) -> Option<String> {
    const LARGEST: u64 = 1 << 20;
    let is_small = fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= LARGEST);
    if is_small { fs::read_to_string(path).ok() } else { None }
}

fn begins_a_map(line: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim() == "grid")
        || matches!(line.trim(), "[[sphere]]" | "[[plane]]" | "[[box]]")
}
