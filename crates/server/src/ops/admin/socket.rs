//! The server's end of the socket.

use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use std::{fs, os};

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};
use tokio::sync::Semaphore;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

use super::{AdminReply, MOST_REQUEST, Operator, socket_of};

/// A socket at which an operator can ask. It is removed when this is dropped.
#[derive(Debug)]
pub struct AdminSocket {
    listener: UnixListener,
    path: PathBuf,
}

const MOST_CONNECTIONS: usize = 8;
const PATIENCE: Duration = Duration::from_secs(5);
/// The pause after a failed `accept`.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

impl AdminSocket {
    /// Listens in a data folder. A socket that a killed server has left there is replaced.
    ///
    /// # Errors
    /// [`ErrorKind::AddrInUse`] if a server listens there; otherwise that of the system.
    pub fn bind(folder: &Path) -> io::Result<Self> {
        let path = socket_of(folder);
        if os::unix::net::UnixStream::connect(&path).is_ok() {
            return Err(io::Error::new(ErrorKind::AddrInUse, "another server uses this folder"));
        }
        if fs::symlink_metadata(&path).is_ok_and(|found| found.file_type().is_socket()) {
            fs::remove_file(&path)?;
        }
        let listener = UnixListener::bind(&path)?;
        let socket = Self { listener, path };
        fs::set_permissions(&socket.path, fs::Permissions::from_mode(0o600))?;
        Ok(socket)
    }

    /// Answers requests until the future is dropped.
    pub async fn serve(self, operator: Operator) {
        let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        // Its tasks end with it.
        let mut tasks = JoinSet::new();
        loop {
            while tasks.try_join_next().is_some() {}
            let Ok(place) = places.clone().acquire_owned().await else { return };
            let Ok((stream, _)) = self.listener.accept().await else {
                sleep(ACCEPT_PAUSE).await;
                continue;
            };
            let operator = operator.clone();
            tasks.spawn(async move {
                _ = timeout(PATIENCE, converse(stream, &operator)).await;
                drop(place);
            });
        }
    }
}

impl Drop for AdminSocket {
    fn drop(&mut self) {
        _ = fs::remove_file(&self.path);
    }
}

async fn converse(mut stream: UnixStream, operator: &Operator) -> io::Result<()> {
    let user = stream.peer_cred()?.uid();
    // Between its creation and the change of its mode, others may have connected.
    if user != 0 && user != rustix::process::geteuid().as_raw() {
        return Ok(());
    }
    answer(&mut stream, operator).await
}

/// Answers the one request of a connection.
pub(crate) async fn answer<S>(stream: &mut S, operator: &Operator) -> io::Result<()>
where
    S: AsyncRead + AsyncWrite + Unpin,
{
    let reply = match request(stream).await?.as_deref().map(serde_json::from_slice) {
        Some(Ok(request)) => operator.answer(&request).await,
        Some(Err(error)) => AdminReply::Fault(format!("this is no request: {error}")),
        None => AdminReply::Fault(format!("a request is a line of at most {MOST_REQUEST} bytes")),
    };
    let mut line = serde_json::to_vec(&reply)?;
    line.push(b'\n');
    stream.write_all(&line).await
}

/// The first line; `None` if it is too long or has no end.
async fn request(stream: &mut (impl AsyncRead + Unpin)) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    let mut buffer = [0; 1024];
    while bytes.len() < MOST_REQUEST {
        let length = stream.read(&mut buffer).await?;
        if length == 0 {
            break;
        }
        bytes.extend(&buffer[..length]);
        if let Some(end) = bytes.iter().position(|&byte| byte == b'\n') {
            bytes.truncate(end);
            return Ok(Some(bytes).filter(|line| line.len() < MOST_REQUEST));
        }
    }
    Ok(None)
}
