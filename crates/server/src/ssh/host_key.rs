//! The host key, by which clients recognise the server.

use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::Path;

use russh::keys::ssh_key::LineEnding;
use russh::keys::ssh_key::private::Ed25519Keypair;
use russh::keys::{HashAlg, PrivateKey};

use cellcaster::app::store::private;
use cellcaster::fault::printable_path;

/// The server's ed25519 host key.
#[derive(Clone)]
pub struct HostKey {
    pub(crate) key: PrivateKey,
}

/// The file name in the data folder.
const NAME: &str = "host_key";
/// The largest file that is read, in bytes. A key takes about 400.
const MAX_BYTES: u64 = 16 << 10;

impl HostKey {
    /// Reads the key from the file `host_key` of `folder`. If the file does not exist, creates a new key in a
    /// file that only its owner can read.
    ///
    /// # Errors
    /// Fails if other users can read the file, if it is not an ed25519 key, or if the folder cannot be read
    /// or written.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let path = folder.join(NAME);
        match private::open(&path) {
            Ok(file) => read(file, &path),
            Err(error) if error.kind() == io::ErrorKind::NotFound => make(folder, &path),
            Err(error) => Err(unreadable(&path, &error)),
        }
    }

    /// The fingerprint that `ssh` shows on the first connection.
    pub fn fingerprint(&self) -> String {
        self.key.fingerprint(HashAlg::Sha256).to_string()
    }
}

fn read(file: File, path: &Path) -> Result<HostKey, String> {
    refuse_readable(&file, path)?;
    let mut text = String::new();
    let read = file.take(MAX_BYTES).read_to_string(&mut text);
    read.map_err(|error| unreadable(path, &error))?;
    let key = PrivateKey::from_openssh(&text).ok().filter(|key| key.key_data().is_ed25519());
    let no_key = || {
        let path = printable_path(path);
        format!(
            "{path} is not an ed25519 key in OpenSSH's format without a passphrase; move it away to get a new one"
        )
    };
    key.map(|key| HostKey { key }).ok_or_else(no_key)
}

/// Creates a key. If two servers start at the same time, both use the key whose file was created first.
fn make(folder: &Path, path: &Path) -> Result<HostKey, String> {
    let not_written =
        |cause: &dyn fmt::Display| format!("{} can't be written: {cause}", printable_path(path));
    let mut seed = [0; 32];
    getrandom::fill(&mut seed).map_err(|cause| not_written(&cause))?;
    let key = PrivateKey::from(Ed25519Keypair::from_seed(&seed));
    let text = key.to_openssh(LineEnding::LF).map_err(|cause| not_written(&cause))?;
    private::create_folder(folder).map_err(|cause| not_written(&cause))?;
    match write_new(path, text.as_bytes()) {
        Ok(()) => Ok(HostKey { key }),
        Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {
            let file = private::open(path).map_err(|cause| unreadable(path, &cause))?;
            read(file, path)
        }
        Err(cause) => Err(not_written(&cause)),
    }
}

/// Writes a file that must not exist yet. At any time the file is either complete or absent.
fn write_new(path: &Path, content: &[u8]) -> io::Result<()> {
    let mark = getrandom::u64().map_err(io::Error::other)?;
    let new = path.with_extension(format!("{mark:016x}.new"));
    let written = private_file(&new).and_then(|mut file| {
        file.write_all(content)?;
        file.sync_all()?;
        fs::hard_link(&new, path)
    });
    let removed = fs::remove_file(&new);
    written.and(removed)
}

fn private_file(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

#[cfg(unix)]
fn refuse_readable(file: &File, path: &Path) -> Result<(), String> {
    use std::os::unix::fs::PermissionsExt;
    let mode = file.metadata().map_err(|error| unreadable(path, &error))?.permissions().mode();
    let others = 0o077;
    if mode & others == 0 {
        return Ok(());
    }
    let path = printable_path(path);
    Err(format!(
        "{path} can be read or written by others, so it may not be secret; type \"chmod 600 {path}\" if nobody \
         has copied it, or move it away to get a new one"
    ))
}

#[cfg(not(unix))]
fn refuse_readable(_: &File, _: &Path) -> Result<(), String> {
    Ok(())
}

fn unreadable(path: &Path, cause: &io::Error) -> String {
    format!("{} can't be read: {cause}", printable_path(path))
}

impl fmt::Debug for HostKey {
    /// Leaves out the private key.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("HostKey").field(&self.fingerprint()).finish()
    }
}
