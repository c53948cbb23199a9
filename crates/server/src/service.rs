//! Listening for clients, and the accept loop of a small service for the operator, such as the admin socket or the
//! metrics page.

pub(crate) mod http;

use std::future::{Future, poll_fn};
use std::io;
use std::net::SocketAddr;
use std::task::{Context, Poll};
use std::time::Duration;

use tokio::net::{TcpListener, TcpSocket};
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

/// The number of connections that a service answers at a time. Further ones wait in the system's queue.
const MAX_CONNECTIONS: usize = 8;
/// The pause after a failed `accept`.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(100);

/// Listens at `address`. Connections get send buffers of `send_buffer` bytes, because by default the system would buffer
/// megabytes for a client that does not read. At most `backlog` connections wait to be accepted.
///
/// # Errors
/// Fails if the address cannot be bound.
pub(crate) fn listen(
    address: SocketAddr,
    send_buffer: u32,
    backlog: u32,
) -> io::Result<TcpListener> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4()? } else { TcpSocket::new_v6()? };
    // Same as `TcpListener::bind`: another server may just have released the address.
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(send_buffer)?;
    socket.bind(address)?;
    socket.listen(backlog)
}

/// Answers each connection that `accept` returns. Each answer may take at most `time`. Runs until the future
/// is dropped.
pub(crate) async fn serve_each<S, P, A>(
    mut accept: impl FnMut(&mut Context<'_>) -> Poll<io::Result<(S, P)>>,
    time: Duration,
    answer: impl Fn(S) -> A,
) where
    A: Future<Output = io::Result<()>> + Send + 'static,
{
    // Dropping the set aborts its tasks.
    let mut tasks = JoinSet::new();
    loop {
        while tasks.len() >= MAX_CONNECTIONS {
            tasks.join_next().await;
        }
        while tasks.try_join_next().is_some() {}
        match poll_fn(&mut accept).await {
            Ok((connection, _)) => _ = tasks.spawn(timeout(time, answer(connection))),
            Err(_) => sleep(ACCEPT_RETRY_INTERVAL).await,
        }
    }
}
