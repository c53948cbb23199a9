//! The program's private files. Only their owner can read them, and the program opens only regular
//! files.

use std::fs::{self, DirBuilder, File, Metadata, OpenOptions};
use std::io::{self, Read};
#[cfg(unix)]
use std::os::unix::fs::{DirBuilderExt, FileTypeExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;

/// An error for a path that is not a regular file.
#[derive(Debug, thiserror::Error)]
#[error("it is {0}, not a file: move it away")]
struct NoFile(&'static str);

/// Opens a file to read it, without ever waiting. Anything but a regular file is an error. In
/// particular, a named pipe is an error, because its reader would wait for a writer.
pub fn open(file: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    options.custom_flags(DO_NOT_WAIT);
    let opened = options.open(file)?;
    refuse_others(&opened.metadata()?)?;
    Ok(opened)
}

/// The content of a regular file.
///
/// # Errors
/// [`io::ErrorKind::FileTooLarge`] if it has more than `most` bytes.
pub fn read(file: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut content = Vec::new();
    open(file)?.take(most.saturating_add(1)).read_to_end(&mut content)?;
    if content.len() as u64 > most {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(content)
}

/// The text in a regular file.
///
/// # Errors
/// As for [`read`]; also [`io::ErrorKind::InvalidData`] if the file is not UTF-8.
#[cfg(feature = "cli")]
pub fn read_text(file: &Path, most: u64) -> io::Result<String> {
    let content = read(file, most)?;
    String::from_utf8(content)
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// Creates a folder and its parents, unless the folder exists. Only the owner can look into it.
pub fn create_folder(folder: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    builder.mode(0o700);
    builder.create(folder)
}

/// Opens a file to write to it, and creates it if it does not exist. Sets its permissions so that
/// only the owner can read it.
pub(crate) fn open_to_write(file: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).write(true);
    restrict_file(&mut options);
    #[cfg(unix)]
    options.custom_flags(DO_NOT_WAIT);
    let opened = options.open(file).or_else(|error| {
        // A named pipe without a reader cannot be opened.
        fs::metadata(file).map_or(Ok(()), |metadata| refuse_others(&metadata)).and(Err(error))
    })?;
    refuse_others(&opened.metadata()?)?;
    #[cfg(unix)]
    opened.set_permissions(fs::Permissions::from_mode(0o600))?;
    Ok(opened)
}

/// Creates an empty file, unless the file exists. Sets its permissions so that only the owner can
/// read it.
pub fn create_file(file: &Path) -> io::Result<()> {
    open_to_write(file).map(drop)
}

/// Returns an error unless `file` is a regular file.
pub fn check_is_file(file: &Path) -> io::Result<()> {
    refuse_others(&fs::metadata(file)?)
}

/// Makes a file that is created with `options` readable by its owner only.
#[cfg_attr(not(unix), expect(unused_variables, reason = "only Unix files have modes"))]
pub fn restrict_file(options: &mut OpenOptions) {
    #[cfg(unix)]
    options.mode(0o600);
}

fn refuse_others(metadata: &Metadata) -> io::Result<()> {
    let kind = metadata.file_type();
    let name = match () {
        () if kind.is_file() => return Ok(()),
        () if kind.is_dir() => "a folder",
        #[cfg(unix)]
        () if kind.is_fifo() => "a named pipe",
        #[cfg(unix)]
        () if kind.is_socket() => "a socket",
        () => "a device",
    };
    Err(io::Error::new(io::ErrorKind::InvalidInput, NoFile(name)))
}

/// The flag that makes opening a file never wait.
#[cfg(unix)]
const DO_NOT_WAIT: i32 = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();
