//! `--watch`: polls a map file, and reloads it after a change.
//!
//! Two versions of a file differ if their modification times or their lengths differ. The map and
//! every PNG and tileset that it names are compared, including missing ones. Rejected: a library for file
//! system notifications. It adds a thread, and dozens of crates on each platform, to save a few
//! calls per second, and it loses files that an editor replaces.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::level::load_file;
use crate::fault::Faults;
use crate::map::{Folder, Level, TextureFileError, TextureFiles};

/// A map file, and the versions of the map and its textures at the last load.
pub(crate) struct MapWatcher {
    map: PathBuf,
    watched: Vec<(PathBuf, FileVersion)>,
    /// The faults in a file that has just changed and may be incomplete.
    unconfirmed: Option<Faults>,
}

impl MapWatcher {
    /// Loads the level in the file at `map`, and starts to watch it.
    pub(crate) fn load(map: &Path) -> (Result<Level, Faults>, Self) {
        let (level, watched) = load(map);
        (level, Self { map: map.to_owned(), watched, unconfirmed: None })
    }

    /// The current level or its faults, if the file has changed since the last call. Faults are
    /// returned only if the file stays the same between two calls, because an editor may be writing
    /// or replacing it.
    pub(crate) fn change(&mut self) -> Option<Result<Level, Faults>> {
        if self.watched.iter().all(|(path, version)| version_of(path) == *version) {
            return self.unconfirmed.take().map(Err);
        }
        let (level, watched) = load(&self.map);
        self.watched = watched;
        match level {
            Ok(level) => {
                self.unconfirmed = None;
                Some(Ok(level))
            }
            Err(faults) => {
                self.unconfirmed = Some(faults);
                None
            }
        }
    }
}

fn load(map: &Path) -> (Result<Level, Faults>, Vec<(PathBuf, FileVersion)>) {
    let files = TrackedFiles {
        files: Folder::of(map),
        folder: map.parent().unwrap_or(Path::new("")),
        // The version is taken before the file is read, so a change in between causes a reload.
        watched: RefCell::new(vec![(map.to_owned(), version_of(map))]),
    };
    let level = load_file(map, &files);
    (level, files.watched.into_inner())
}

/// The files in a folder. Each read is recorded.
struct TrackedFiles<'a> {
    files: Folder,
    folder: &'a Path,
    watched: RefCell<Vec<(PathBuf, FileVersion)>>,
}

impl TextureFiles for TrackedFiles<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let path = self.folder.join(name);
        let version = version_of(&path);
        self.watched.borrow_mut().push((path, version));
        self.files.read(name)
    }
}

/// The modification time and the length, which identify a version of a file; `None` if there is no
/// file.
type FileVersion = Option<(Option<SystemTime>, u64)>;

fn version_of(path: &Path) -> FileVersion {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.modified().ok(), metadata.len()))
}

#[cfg(test)]
mod tests {
    use std::env;

    use super::*;

    const MAP: &str = "floor = \"floor.png\"\ngrid = '@'\n[things]\n\"@\" = { start = 0 }\n";
    const PNG: &[u8] = include_bytes!("../../tests/maps/rows.png");
    const ANOTHER_PNG: &[u8] = include_bytes!("../../tests/maps/letter.png");

    #[test]
    fn each_change_is_reported_once_and_faults_only_if_they_last() {
        let folder = env::temp_dir().join(format!("cellcaster-watch-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (map, texture) = (folder.join("map.toml"), folder.join("floor.png"));
        fs::write(&map, MAP).unwrap();
        fs::write(&texture, PNG).unwrap();
        let (level, mut watch) = MapWatcher::load(&map);
        let first = level.unwrap();
        assert!(watch.change().is_none());

        fs::write(&texture, ANOTHER_PNG).unwrap();
        let second = watch.change().unwrap().unwrap();
        assert!(second != first);
        assert!(watch.change().is_none());

        // The file is missing for a moment, as it is while an editor replaces it.
        fs::remove_file(&map).unwrap();
        assert!(watch.change().is_none());
        fs::write(&map, MAP).unwrap();
        assert!(watch.change().unwrap().unwrap() == second);

        fs::remove_file(&texture).unwrap();
        assert!(watch.change().is_none());
        assert!(watch.change().unwrap().is_err());
        assert!(watch.change().is_none());
        fs::write(&texture, PNG).unwrap();
        assert!(watch.change().unwrap().unwrap() == first);
        assert!(watch.change().is_none());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_map_of_tiled_is_reloaded_with_its_tileset() {
        let folder = env::temp_dir().join(format!("cellcaster-tiled-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for name in ["yard.tmx", "yard.tsx", "yard.png"] {
            fs::copy(Path::new("tests/tiled").join(name), folder.join(name)).unwrap();
        }
        let (level, mut watch) = MapWatcher::load(&folder.join("yard.tmx"));
        let first = level.unwrap();
        assert!(watch.change().is_none());

        let tileset = fs::read_to_string(folder.join("yard.tsx")).unwrap();
        let image = "<tile id=\"0\" type=\"door\"/></tileset>";
        fs::write(folder.join("yard.tsx"), tileset.replace("</tileset>", image)).unwrap();
        assert!(watch.change().is_none() && watch.change().unwrap().is_err());
        fs::write(folder.join("yard.tsx"), tileset).unwrap();
        assert!(watch.change().unwrap().unwrap() == first);
        fs::remove_dir_all(&folder).unwrap();
    }
}
