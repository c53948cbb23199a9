//! The output of a command: standard output, and files that are either complete or unchanged.
//!
//! A file is written under another name and then renamed, as in the store. A full disk therefore
//! neither damages the old file nor leaves an incomplete new one. Pipes and devices are written
//! directly.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::Error;

/// Writes `text` to standard output.
pub fn print(text: &[u8]) -> Result<(), Error> {
    io::stdout().write_all(text).map_err(|error| Error::of_output(&error))
}

/// A file that has not replaced the old one yet, or a pipe or a device.
pub struct OutputFile {
    /// The path as the user wrote it.
    name: PathBuf,
    file: File,
    replacement: Option<Replacement>,
}

/// The temporary path of a file, and its final path.
struct Replacement {
    new: PathBuf,
    path: PathBuf,
}

impl OutputFile {
    /// Creates an empty file, which will replace the file at `path` if there is one.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let name = path.to_owned();
        let create = || {
            if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
                return Ok((File::create(path)?, None));
            }
            let replacement = Replacement::of(path);
            Ok((File::create(&replacement.new)?, Some(replacement)))
        };
        let (file, replacement) = create().map_err(|error| unwritable(path, &error))?;
        Ok(Self { name, file, replacement })
    }

    /// Writes the whole file with `write`, and renames it to its final path.
    pub fn write(
        self,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), Error> {
        let Self { name, file, replacement } = self;
        let mut output = BufWriter::new(file);
        write(&mut output)
            .and_then(|()| output.flush())
            .and_then(|()| replacement.map_or(Ok(()), |it| it.finish(output.get_ref())))
            .map_err(|error| unwritable(&name, &error))
    }
}

impl Replacement {
    /// The replacement for the file at `path`. Symbolic links are followed.
    fn of(path: &Path) -> Self {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let mut new = path.clone().into_os_string();
        new.push(".new");
        Self { new: new.into(), path }
    }

    fn finish(self, file: &File) -> io::Result<()> {
        file.sync_all()?;
        fs::rename(&self.new, &self.path)
    }
}

impl Drop for Replacement {
    /// Removes the incomplete file, if it has not been renamed.
    fn drop(&mut self) {
        _ = fs::remove_file(&self.new);
    }
}

/// The error for a file that cannot be written.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Error {
    Error::machine(format!("{} can't be written: {error}", path.display()))
}
