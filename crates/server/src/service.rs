//! The accept loop of a small service for the operator, such as the admin socket or the metrics page.

use std::future::{Future, poll_fn};
use std::io;
use std::task::{Context, Poll};
use std::time::Duration;

use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

/// The number of connections that a service answers at a time. Further ones wait in the system's queue.
const MAX_CONNECTIONS: usize = 8;
/// The pause after a failed `accept`.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(100);

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
