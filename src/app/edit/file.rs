//! The file of the map that is being edited, and its journal.
//!
//! - The journal lies beside the map and has its name with `.journal` after it. It is the whole text of the map, so it is
//!   as bounded as a map, and a map itself. It exists only while the text differs from the file.
//! - Both files are replaced atomically, with the permissions of the map. The map is also synchronised; the journal
//!   outlives the program, but perhaps not a power cut.
//! - A file that another program has changed since is not overwritten without a question.
//!
//! Rejected: a journal of operations. It would be shorter, but need a format, a version and bounds of its own.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::app::store::private;
use crate::fault::{Faults, printable_path};
use crate::map::{self, MAX_BYTES};

/// A map file with its journal.
#[derive(Debug)]
pub struct MapFile {
    path: PathBuf,
    journal: PathBuf,
    /// The text in the file, as far as the editor knows; `None` if there is no file.
    saved: Option<String>,
    /// The text in the journal, if the editor has written it.
    kept: Option<String>,
}

/// The reason why a map was not saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// Another program has changed the file.
    Changed,
    /// A sentence about a failure.
    Failed(String),
}

impl MapFile {
    /// The map file at `path`, which need not exist.
    ///
    /// # Errors
    /// The reason why the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, Faults> {
        let mut journal = path.as_os_str().to_owned();
        journal.push(".journal");
        let saved =
            if fs::exists(path).unwrap_or(true) { Some(map::text_of_file(path)?) } else { None };
        Ok(Self { path: path.to_owned(), journal: journal.into(), saved, kept: None })
    }

    /// The path of the map.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of the journal, for sentences.
    pub fn journal_name(&self) -> String {
        printable_path(&self.journal)
    }

    /// The text in the file; `None` if there is no file.
    pub fn saved(&self) -> Option<&str> {
        self.saved.as_deref()
    }

    /// The text in the journal of an editor that ended without saving, or that is still open.
    ///
    /// # Errors
    /// A sentence about a journal that cannot be read.
    pub fn unsaved(&self) -> Result<Option<String>, String> {
        match private::read_text(&self.journal, MAX_BYTES as u64) {
            Ok(text) => Ok(Some(text).filter(|text| Some(text) != self.saved.as_ref())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{} can't be read: {error}", self.journal_name())),
        }
    }

    /// Returns true if the map was written after the journal.
    pub fn is_newer_than_journal(&self) -> bool {
        let written = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
        written(&self.path) > written(&self.journal)
    }

    /// Keeps `text` in the journal, or removes the journal if the file has this text.
    ///
    /// # Errors
    /// A sentence about a journal that cannot be written.
    pub fn keep(&mut self, text: &str) -> Result<(), String> {
        if Some(text) == self.saved.as_deref() {
            self.discard();
            return Ok(());
        }
        if Some(text) == self.kept.as_deref() {
            return Ok(());
        }
        // Tried once for each text.
        self.kept = Some(text.to_owned());
        self.replace(&self.journal, text, false)
            .map_err(|error| format!("{} can't be written: {error}", self.journal_name()))
    }

    /// Removes the journal.
    pub fn discard(&mut self) {
        self.kept = None;
        // It need not exist.
        _ = fs::remove_file(&self.journal);
    }

    /// Writes `text` to the file, and removes the journal. With `overwrites`, changes by other programs are lost.
    ///
    /// # Errors
    /// The reason why the file still has its old text.
    pub fn save(&mut self, text: &str, overwrites: bool) -> Result<(), NotSaved> {
        let path = fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone());
        let there = match private::read(&path, MAX_BYTES as u64) {
            Ok(there) => Some(there),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(self.unwritable(&error)),
        };
        let is_known = there.as_deref() == self.saved.as_deref().map(str::as_bytes);
        if !is_known && !overwrites {
            return Err(NotSaved::Changed);
        }
        self.replace(&path, text, true).map_err(|error| self.unwritable(&error))?;
        self.saved = Some(text.to_owned());
        self.discard();
        Ok(())
    }

    fn unwritable(&self, error: &io::Error) -> NotSaved {
        NotSaved::Failed(format!("{} can't be written: {error}", printable_path(&self.path)))
    }

    /// Replaces the file at `path`, with the permissions of the map.
    fn replace(&self, path: &Path, text: &str, synchronises: bool) -> io::Result<()> {
        let mut new = path.as_os_str().to_owned();
        new.push(".new");
        let new = Path::new(&new);
        // It is left from an editor that was killed, or was put there as a trap.
        _ = fs::remove_file(new);
        let written = File::create_new(new).and_then(|mut file| {
            if let Ok(metadata) = fs::metadata(&self.path) {
                file.set_permissions(metadata.permissions())?;
            }
            file.write_all(text.as_bytes())?;
            if synchronises { file.sync_all() } else { Ok(()) }
        });
        written.and_then(|()| fs::rename(new, path)).inspect_err(|_| {
            // On a full disk, the incomplete file would take up the last space.
            _ = fs::remove_file(new);
        })
    }
}

#[cfg(test)]
mod tests {
    use std::env;
    use std::time::{Duration, SystemTime};

    use super::*;

    const MAP: &str = "grid = '@'\n";

    /// The path of a map in a new folder.
    fn path(name: &str) -> PathBuf {
        let folder = env::temp_dir().join(format!("cellcaster-edit-{name}-{}", std::process::id()));
        _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder.join("map.toml")
    }

    fn names(path: &Path) -> Vec<String> {
        let names = fs::read_dir(path.parent().unwrap()).unwrap();
        let mut names: Vec<_> =
            names.map(|it| it.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_journal_lasts_until_the_map_is_saved() {
        let path = path("journal");
        fs::write(&path, MAP).unwrap();
        let mut file = MapFile::open(&path).unwrap();
        assert_eq!((file.saved(), file.unsaved()), (Some(MAP), Ok(None)));
        file.keep("grid = '#'\n").unwrap();
        file.keep("grid = '##'\n").unwrap();
        assert_eq!(names(&path), ["map.toml", "map.toml.journal"]);

        // The program is killed here, and starts again.
        let mut file = MapFile::open(&path).unwrap();
        assert_eq!(file.unsaved(), Ok(Some("grid = '##'\n".to_owned())));
        assert!(!file.is_newer_than_journal());
        let later = SystemTime::now() + Duration::from_mins(1);
        File::options().append(true).open(&path).unwrap().set_modified(later).unwrap();
        assert!(file.is_newer_than_journal());
        assert_eq!(fs::read_to_string(&path).unwrap(), MAP);
        file.save("grid = '##'\n", false).unwrap();
        assert_eq!(names(&path), ["map.toml"]);
        assert_eq!(file.unsaved(), Ok(None));

        // Back to what the file has, by undoing: nothing is left to restore.
        file.keep("grid = '#'\n").unwrap();
        file.keep("grid = '##'\n").unwrap();
        assert_eq!(names(&path), ["map.toml"]);
        fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }

    #[test]
    fn a_file_that_another_program_has_changed_is_not_overwritten_unasked() {
        let path = path("changed");
        let mut new = MapFile::open(&path).unwrap();
        assert_eq!(new.saved(), None);
        fs::write(&path, "grid = '.'\n").unwrap();
        assert_eq!(new.save(MAP, false), Err(NotSaved::Changed));
        assert_eq!(fs::read_to_string(&path).unwrap(), "grid = '.'\n");
        new.save(MAP, true).unwrap();
        new.save("grid = '#'\n", false).unwrap();
        fs::remove_file(&path).unwrap();
        assert_eq!(new.save(MAP, false), Err(NotSaved::Changed));
        fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let path = path("links");
        let link = path.with_file_name("link.toml");
        fs::write(&path, MAP).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        symlink(&path, &link).unwrap();
        let mut file = MapFile::open(&link).unwrap();
        file.keep("grid = '#'\n").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&link.with_file_name("link.toml.journal")), 0o600);
        file.save("grid = '#'\n", false).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(
            (mode(&path), fs::read_to_string(&path).unwrap()),
            (0o600, "grid = '#'\n".to_owned())
        );
        fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }
}
