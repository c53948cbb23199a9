//! What a command writes: standard output, and a file that is complete, or as it was before.
//!
//! A file is written under another name and renamed, as in the store, so that a full disk costs neither
//! the file before nor leaves a part of the new one. Pipes and devices are written directly.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::Error;

/// Writes `text` to standard output.
pub fn print(text: &[u8]) -> Result<(), Error> {
    io::stdout().write_all(text).map_err(|error| Error::of_output(&error))
}

/// A file that is not in its place yet, or a pipe or a device.
pub struct OutputFile {
    /// The file as the user called it.
    name: PathBuf,
    file: File,
    replacement: Option<Replacement>,
}

/// The path under which a file is written, and the one that it gets at the end.
struct Replacement {
    new: PathBuf,
    path: PathBuf,
}

impl OutputFile {
    /// An empty file that will replace the one at `path`, if there is one.
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

    /// Writes the whole file by `write`, and puts it in its place.
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
    /// The replacement of the file at `path`, or of the one that a link there leads to.
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
    /// Removes the part that was written, if it has not been renamed.
    fn drop(&mut self) {
        _ = fs::remove_file(&self.new);
    }
}

/// The error for a file that cannot be written.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Error {
    Error::machine(format!("{} can't be written: {error}", path.display()))
}
