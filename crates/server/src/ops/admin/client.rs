//! The operator's end of the socket.

use std::fmt;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::{AdminReply, AdminRequest, MOST_REPLY, socket_of};
use cellcaster::fault::printable_path;

/// Why a server has not answered.
#[derive(Debug)]
pub enum AdminFailure {
    /// No server runs with this data folder.
    NoServer(PathBuf),
    /// The socket belongs to another user.
    NotAllowed(PathBuf),
    /// The connection failed.
    Failed(PathBuf, io::Error),
}

/// Longer than the server takes for a request.
const PATIENCE: Duration = Duration::from_secs(10);

/// Asks the server of a data folder.
///
/// # Errors
/// [`AdminFailure`], which is one sentence.
pub fn ask(folder: &Path, request: &AdminRequest) -> Result<AdminReply, AdminFailure> {
    let socket = socket_of(folder);
    converse(&socket, request).map_err(|error| match error.kind() {
        ErrorKind::NotFound | ErrorKind::ConnectionRefused => {
            AdminFailure::NoServer(folder.to_owned())
        }
        ErrorKind::PermissionDenied => AdminFailure::NotAllowed(socket),
        _ => AdminFailure::Failed(socket, error),
    })
}

fn converse(socket: &Path, request: &AdminRequest) -> io::Result<AdminReply> {
    let mut stream = UnixStream::connect(socket)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut line = serde_json::to_vec(request)?;
    line.push(b'\n');
    stream.write_all(&line)?;
    let mut reply = Vec::new();
    BufReader::new(stream.take(MOST_REPLY)).read_until(b'\n', &mut reply)?;
    Ok(serde_json::from_slice(&reply)?)
}

impl fmt::Display for AdminFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoServer(folder) => {
                write!(f, "no server runs with the data in {}", printable_path(folder))
            }
            Self::NotAllowed(socket) => {
                write!(
                    f,
                    "{} belongs to another user: ask as that user, or as root",
                    printable_path(socket)
                )
            }
            Self::Failed(socket, error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
            {
                let seconds = PATIENCE.as_secs();
                write!(
                    f,
                    "the server at {} has not answered for {seconds} s",
                    printable_path(socket)
                )
            }
            Self::Failed(socket, error) => {
                write!(f, "the server at {} does not answer: {error}", printable_path(socket))
            }
        }
    }
}

impl std::error::Error for AdminFailure {}
