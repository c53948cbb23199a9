//! The files from which a map's text and pictures come.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use crate::fault::Faults;

/// The largest map file, in bytes: room for the largest grid in characters of three bytes.
pub const MAX_BYTES: usize = 64 << 20;
/// The largest PNG file, in bytes.
const MAX_FILE_BYTES: usize = 16 << 20;

/// The source of a map's own textures.
///
/// [`Folder`] reads from the folder of the map. A program can also look up pictures that are
/// compiled in or in an archive:
///
/// ```
/// use cellcaster::map::{TextureFileError, TextureFiles};
///
/// struct CompiledIn(&'static [(&'static str, &'static [u8])]);
///
/// impl TextureFiles for CompiledIn {
///     fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
///         let (_, bytes) =
///             self.0.iter().find(|(known, _)| *known == name).ok_or(TextureFileError::Missing)?;
///         Ok(bytes.to_vec())
///     }
/// }
/// ```
pub trait TextureFiles {
    /// Reads the PNG file `name`. The name ends in `.png`, may contain folders (`a/b.png`), and
    /// never leads out of the map's folder.
    ///
    /// # Errors
    /// The reason why the file cannot be read.
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError>;
}

/// The reason why a texture file cannot be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum TextureFileError {
    /// The file does not exist.
    Missing,
    /// The file links to a file outside the map's folder.
    Outside,
    /// The name belongs to a folder or a device.
    NotAFile,
    /// It is larger than any PNG of an allowed size.
    TooLarge,
    /// It cannot be read.
    Unreadable(io::Error),
}

impl fmt::Display for TextureFileError {
    /// Writes the reason, to follow the name of the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("does not exist"),
            Self::Outside => f.write_str("links to a file outside the map's folder"),
            Self::NotAFile => f.write_str("is not a file"),
            Self::TooLarge => write!(f, "is larger than {} MiB", MAX_FILE_BYTES >> 20),
            Self::Unreadable(error) => write!(f, "cannot be read: {}", error.kind()),
        }
    }
}

impl std::error::Error for TextureFileError {}

/// A source without files, for maps that use built-in textures only.
#[derive(Clone, Copy, Debug)]
pub struct NoFiles;

impl TextureFiles for NoFiles {
    fn read(&self, _: &str) -> Result<Vec<u8>, TextureFileError> {
        Err(TextureFileError::Missing)
    }
}

/// The files in one folder and its subfolders. Links that lead out of the folder are not followed.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// The folder of the map file at `map`.
    pub fn of(map: &Path) -> Self {
        match map.parent() {
            Some(parent) if parent != Path::new("") => Self { path: parent.to_owned() },
            _ => Self { path: PathBuf::from(".") },
        }
    }

    fn real_path(&self, name: &str) -> Result<PathBuf, TextureFileError> {
        let folder = self.path.canonicalize()?;
        let file = folder.join(name).canonicalize()?;
        if !file.starts_with(&folder) {
            return Err(TextureFileError::Outside);
        }
        if !fs::metadata(&file)?.is_file() {
            return Err(TextureFileError::NotAFile);
        }
        Ok(file)
    }
}

impl TextureFiles for Folder {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let mut bytes = Vec::new();
        let file = File::open(self.real_path(name)?)?;
        file.take(MAX_FILE_BYTES as u64 + 1).read_to_end(&mut bytes)?;
        if bytes.len() > MAX_FILE_BYTES {
            return Err(TextureFileError::TooLarge);
        }
        Ok(bytes)
    }
}

impl From<io::Error> for TextureFileError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            _ => Self::Unreadable(error),
        }
    }
}

/// Returns whether `name` has the extension of a PNG file.
pub(crate) fn is_png(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

/// Returns whether `name` stays below its folder, and names the same file on every system.
pub(crate) fn stays_inside(name: &str) -> bool {
    !name.contains(['\\', ':']) && name.split('/').all(|part| !matches!(part, "" | "." | ".."))
}

/// Reads the text of a map, which may have up to [`MAX_BYTES`].
pub(crate) fn read_text(input: impl Read, name: &str) -> Result<String, Faults> {
    let mut bytes = Vec::new();
    let read = input.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| unreadable(name, &error))?;
    if bytes.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    Faults::text_of(bytes, name, "map")
}

/// Opens the map file at `path`, which faults call `name`.
///
/// Only a regular file is opened: opening a pipe would wait for its other end, and a device may
/// have no end.
pub(crate) fn open(path: &Path, name: &str) -> Result<File, Faults> {
    let metadata = fs::metadata(path).map_err(|error| unreadable(name, &error))?;
    if metadata.is_dir() {
        let message = format!("{name} is a folder, not a map");
        return Err(Faults::of_whole_file(name, &message, "name a map file in it"));
    }
    if !metadata.is_file() {
        let message = format!("{name} is a pipe or a device, not a map");
        return Err(Faults::of_whole_file(name, &message, "a map on standard input is called -"));
    }
    File::open(path).map_err(|error| unreadable(name, &error))
}

pub(crate) fn too_large(name: &str) -> Faults {
    let limit = MAX_BYTES >> 20;
    let message = format!("{name} is larger than {limit} MiB, the maximum for a map");
    Faults::of_whole_file(name, &message, "")
}

fn unreadable(name: &str, error: &io::Error) -> Faults {
    let message = match error.kind() {
        io::ErrorKind::NotFound => format!("there is no file {name}"),
        kind => format!("{name} cannot be read: {kind}"),
    };
    Faults::of_whole_file(name, &message, "")
}
