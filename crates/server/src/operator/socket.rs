//! The socket `admin.sock` in a data folder: the server's end and the operator's end.

use std::fs::{self, Permissions};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::os::unix::net::UnixStream as BlockingStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tokio::io::{AsyncBufReadExt, AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};

use super::Operator;
use crate::admin::{AdminReply, AdminRequest};
use crate::service::serve_each;
use cellcaster::cli::Error;
use cellcaster::fault::printable_path;

/// A socket for an operator's requests. It is removed when this value is dropped.
#[derive(Debug)]
pub struct AdminSocket {
    listener: UnixListener,
    path: PathBuf,
}

/// The longest line of a request, in bytes.
const MAX_REQUEST_BYTES: u64 = 4096;
/// The longest line of a reply, in bytes. A hundred thousand visitors take less.
const MAX_REPLY_BYTES: u64 = 32 << 20;
/// The time limit for a request, on the server.
const SERVER_TIMEOUT: Duration = Duration::from_secs(5);
const CLIENT_TIMEOUT: Duration = Duration::from_secs(10);

impl AdminSocket {
    /// Listens in a data folder. Replaces a socket that a killed server left there.
    ///
    /// # Errors
    /// [`ErrorKind::AddrInUse`] if a server listens there; otherwise the system's error.
    pub fn bind(folder: &Path) -> io::Result<Self> {
        let path = socket_of(folder);
        if BlockingStream::connect(&path).is_ok() {
            return Err(io::Error::new(ErrorKind::AddrInUse, "another server uses this folder"));
        }
        if fs::symlink_metadata(&path).is_ok_and(|found| found.file_type().is_socket()) {
            fs::remove_file(&path)?;
        }
        let listener = UnixListener::bind(&path)?;
        let socket = Self { listener, path };
        fs::set_permissions(&socket.path, Permissions::from_mode(0o600))?;
        Ok(socket)
    }

    /// Answers requests until the future is dropped.
    pub async fn serve(self, operator: Operator) {
        let answer = |stream| {
            let operator = operator.clone();
            async move { converse(stream, &operator).await }
        };
        serve_each(|context| self.listener.poll_accept(context), SERVER_TIMEOUT, answer).await;
    }
}

impl Drop for AdminSocket {
    fn drop(&mut self) {
        _ = fs::remove_file(&self.path);
    }
}

async fn converse(mut stream: UnixStream, operator: &Operator) -> io::Result<()> {
    let user = stream.peer_cred()?.uid();
    // Others may have connected between the creation of the socket and the change of its mode.
    if user != 0 && user != rustix::process::geteuid().as_raw() {
        return Ok(());
    }
    answer(&mut stream, operator).await
}

/// Answers the only request of a connection.
pub(crate) async fn answer<S>(stream: &mut S, operator: &Operator) -> io::Result<()>
where
    S: AsyncRead + AsyncWrite + Unpin,
{
    let reply = match request(stream).await?.map(|line| serde_json::from_slice(&line)) {
        Some(Ok(request)) => operator.answer(&request).await,
        Some(Err(error)) => AdminReply::of_fault(format!("the request can't be parsed: {error}")),
        None => AdminReply::of_fault(format!(
            "a request must be one line of at most {MAX_REQUEST_BYTES} bytes"
        )),
    };
    let mut line = serde_json::to_vec(&reply)?;
    line.push(b'\n');
    stream.write_all(&line).await
}

/// The first line without its end; `None` if it is too long or has no end.
async fn request(stream: &mut (impl AsyncRead + Unpin)) -> io::Result<Option<Vec<u8>>> {
    let mut line = Vec::new();
    let mut stream = tokio::io::BufReader::new(stream.take(MAX_REQUEST_BYTES));
    stream.read_until(b'\n', &mut line).await?;
    Ok((line.pop() == Some(b'\n')).then_some(line))
}

/// Sends a request to the server of a data folder. `None` if no server runs there.
///
/// # Errors
/// A sentence, if the server refuses the request or does not answer.
pub fn ask(folder: &Path, request: &AdminRequest) -> Result<Option<AdminReply>, Error> {
    let socket = socket_of(folder);
    let error = match exchange(&socket, request) {
        Ok(AdminReply { fault: Some(sentence), .. }) => return Err(Error::mistake(sentence)),
        Ok(reply) => return Ok(Some(reply)),
        Err(error) => error,
    };
    let shown = printable_path(&socket);
    Err(match error.kind() {
        ErrorKind::NotFound | ErrorKind::ConnectionRefused => return Ok(None),
        ErrorKind::PermissionDenied => Error::mistake(format!(
            "{shown} belongs to another user: run this command as that user or as root"
        )),
        ErrorKind::WouldBlock | ErrorKind::TimedOut => {
            let seconds = CLIENT_TIMEOUT.as_secs();
            Error::machine(format!("the server at {shown} did not answer within {seconds} s"))
        }
        _ => Error::machine(format!("the server at {shown} does not answer: {error}")),
    })
}

fn exchange(socket: &Path, request: &AdminRequest) -> io::Result<AdminReply> {
    let mut stream = BlockingStream::connect(socket)?;
    stream.set_read_timeout(Some(CLIENT_TIMEOUT))?;
    stream.set_write_timeout(Some(CLIENT_TIMEOUT))?;
    let mut line = serde_json::to_vec(request)?;
    line.push(b'\n');
    stream.write_all(&line)?;
    let mut reply = Vec::new();
    BufReader::new(stream.take(MAX_REPLY_BYTES)).read_until(b'\n', &mut reply)?;
    Ok(serde_json::from_slice(&reply)?)
}

fn socket_of(folder: &Path) -> PathBuf {
    folder.join("admin.sock")
}
