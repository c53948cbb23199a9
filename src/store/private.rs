//! Files that nobody else on the machine reads.

use std::fs::{self, DirBuilder, OpenOptions};
use std::io;
use std::path::Path;

/// Creates a folder, and those that it is in, unless it exists. Only its owner can look into it.
pub(crate) fn create_folder(folder: &Path) -> io::Result<()> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    restrict_folder(&mut builder);
    builder.create(folder)
}

/// Creates an empty file unless it exists. Only its owner can read it, then and from now on.
pub(crate) fn create_file(file: &Path) -> io::Result<()> {
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).write(true);
    restrict_file(&mut options);
    let file = options.open(file)?;
    restrict_existing(&file)
}

#[cfg(unix)]
fn restrict_folder(builder: &mut DirBuilder) {
    use std::os::unix::fs::DirBuilderExt;
    builder.mode(0o700);
}

#[cfg(unix)]
fn restrict_file(options: &mut OpenOptions) {
    use std::os::unix::fs::OpenOptionsExt;
    options.mode(0o600);
}

#[cfg(unix)]
fn restrict_existing(file: &fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o600))
}

#[cfg(not(unix))]
fn restrict_folder(_: &mut DirBuilder) {}

#[cfg(not(unix))]
fn restrict_file(_: &mut OpenOptions) {}

#[cfg(not(unix))]
fn restrict_existing(_: &fs::File) -> io::Result<()> {
    Ok(())
}
