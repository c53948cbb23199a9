//! `--watch`: a map file that is looked at again and again, and loaded anew when it changes.
//!
//! What is compared is the time of the last change and the length, of the map and of every PNG that it
//! asks for, whether or not there is one. A library that is told of changes by the system was refused:
//! it brings a thread and some dozens of crates on each platform, for a few calls a second, and loses
//! files that an editor replaces.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::fault::Faults;
use crate::map::{self, Folder, Level, TextureFileError, TextureFiles};

/// A map file, and what it and its textures were like when it was loaded last.
pub(super) struct Watch {
    map: PathBuf,
    seen: Vec<Seen>,
    /// What is wrong with a file that has just changed: it may not have been written to its end.
    unconfirmed: Option<Faults>,
}

impl Watch {
    /// Loads the level that the file at `map` describes, and keeps an eye on it.
    pub(super) fn load(map: &Path) -> (Result<Level, Faults>, Self) {
        let (level, seen) = load(map);
        (level, Self { map: map.to_owned(), seen, unconfirmed: None })
    }

    /// The level as it is now, or what is wrong with it, if it has changed since the last call. Of a
    /// level with faults this tells only when it has stayed the same from one call to the next: an
    /// editor may be writing the file, or replacing it.
    pub(super) fn change(&mut self) -> Option<Result<Level, Faults>> {
        if self.seen.iter().all(Seen::is_up_to_date) {
            return self.unconfirmed.take().map(Err);
        }
        let (level, seen) = load(&self.map);
        self.seen = seen;
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

fn load(map: &Path) -> (Result<Level, Faults>, Vec<Seen>) {
    let files = NotedFiles {
        files: Folder::of(map),
        folder: map.parent().unwrap_or(Path::new("")),
        // Before it is read: what changes meanwhile is loaded again.
        seen: RefCell::new(vec![Seen::now(map.to_owned())]),
    };
    let level = map::load_level_with(map, &files);
    (level, files.seen.into_inner())
}

/// The files of a folder, with a note of each that is read.
struct NotedFiles<'a> {
    files: Folder,
    folder: &'a Path,
    seen: RefCell<Vec<Seen>>,
}

impl TextureFiles for NotedFiles<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        self.seen.borrow_mut().push(Seen::now(self.folder.join(name)));
        self.files.read(name)
    }
}

/// What a file was like at some time.
struct Seen {
    path: PathBuf,
    stamp: Option<Stamp>,
}

impl Seen {
    fn now(path: PathBuf) -> Self {
        Self { stamp: Stamp::of(&path), path }
    }

    fn is_up_to_date(&self) -> bool {
        Stamp::of(&self.path) == self.stamp
    }
}

/// What tells one version of a file from another.
#[derive(PartialEq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
}

impl Stamp {
    /// `None` for a file that is not there.
    fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Some(Self { modified: metadata.modified().ok(), length: metadata.len() })
    }
}

#[cfg(test)]
mod tests {
    use std::env;

    use super::*;

    const MAP: &str = "floor = \"floor.png\"\ngrid = '@'\n[things]\n\"@\" = { start = 0 }\n";
    const PNG: &[u8] = include_bytes!("../../tests/maps/rows.png");
    const ANOTHER_PNG: &[u8] = include_bytes!("../../tests/maps/letter.png");

    #[test]
    fn every_change_is_told_of_once_and_a_fault_when_it_lasts() {
        let folder = env::temp_dir().join(format!("cellcaster-watch-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (map, texture) = (folder.join("map.toml"), folder.join("floor.png"));
        fs::write(&map, MAP).unwrap();
        fs::write(&texture, PNG).unwrap();
        let (level, mut watch) = Watch::load(&map);
        let first = level.unwrap();
        assert!(watch.change().is_none());

        fs::write(&texture, ANOTHER_PNG).unwrap();
        let second = watch.change().unwrap().unwrap();
        assert!(second != first);
        assert!(watch.change().is_none());

        // Gone for a moment only, as where an editor replaces it.
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
}
