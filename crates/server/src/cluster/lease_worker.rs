//! A thread for calls to the leases, whose methods block.
//!
//! All rooms of a host ask for a renewal at the same time, and those that ask within [`GATHERED`] are one call of the
//! store: each call costs a write to its disk. So a host with many rooms renews all of their leases in time, however
//! long a write takes.

use std::time::Duration;
use std::{io, iter, thread};

use tokio::sync::{mpsc, oneshot};

use crate::accounts::{HostStore, Lease, StoreFailure};

/// The time that a lease lasts without being renewed.
pub(crate) const LEASE_TIME: Duration = Duration::from_secs(3);
/// How long the thread waits for further renewals after the first one.
const GATHERED: Duration = Duration::from_millis(50);
/// The most calls that wait: one a second for each room.
const MOST_CALLS: usize = 4_096;

/// The sender of calls to the thread. Clones send to the same thread.
#[derive(Clone)]
pub(crate) struct LeaseWorker {
    calls: mpsc::Sender<Call>,
}

/// The answer to a call; an error if it was not accepted.
pub(crate) type Reply<T> = oneshot::Receiver<Result<T, StoreFailure>>;

/// What is asked of the leases.
pub(crate) enum Call {
    Acquire(String, u64, oneshot::Sender<Result<Option<Lease>, StoreFailure>>),
    Renew(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
    Release(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
    Forget(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
}

impl LeaseWorker {
    /// A sender, and the receiver of its calls.
    pub(crate) fn new() -> (Self, mpsc::Receiver<Call>) {
        let (calls, queue) = mpsc::channel(MOST_CALLS);
        (Self { calls }, queue)
    }

    /// Starts the thread, for the host called `host`.
    pub(crate) fn start(mut leases: HostStore, host: String) -> io::Result<Self> {
        let (worker, mut queue) = Self::new();
        thread::Builder::new().name("leases".to_owned()).spawn(move || {
            while let Some(calls) = gathered(&mut queue) {
                run(calls, &mut leases, &host);
            }
        })?;
        Ok(worker)
    }

    /// Asks for the lease of a room, with an epoch above that of its log.
    pub(crate) fn acquire(&self, room: &str, epoch: u64) -> Reply<Option<Lease>> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Acquire(room.to_owned(), epoch, reply));
        answer
    }

    /// Renews a lease.
    pub(crate) fn renew(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Renew(lease.clone(), reply));
        answer
    }

    /// Releases a lease.
    pub(crate) fn release(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Release(lease.clone(), reply));
        answer
    }

    /// Ends the lease of a room that is closed.
    pub(crate) fn forget(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Forget(lease.clone(), reply));
        answer
    }

    fn call(&self, call: Call) {
        // The answer to a call that is not accepted is an error, since its sender is dropped.
        _ = self.calls.try_send(call);
    }
}

/// Waits for a call, and returns it with those that wait behind it; `None` after the last call.
fn gathered(queue: &mut mpsc::Receiver<Call>) -> Option<Vec<Call>> {
    let first = queue.blocking_recv()?;
    if matches!(first, Call::Renew(..)) {
        thread::sleep(GATHERED);
    }
    let rest = iter::from_fn(|| queue.try_recv().ok()).take(MOST_CALLS);
    Some(iter::once(first).chain(rest).collect())
}

/// Does what was asked, and answers: all renewals at once, after the rest.
pub(crate) fn run(calls: impl IntoIterator<Item = Call>, leases: &mut HostStore, host: &str) {
    let (mut held, mut replies) = (Vec::new(), Vec::new());
    for call in calls {
        match call {
            Call::Acquire(room, epoch, reply) => {
                _ = reply.send(leases.acquire(&room, host, LEASE_TIME, epoch));
            }
            Call::Release(lease, reply) => _ = reply.send(leases.release(&lease)),
            Call::Forget(lease, reply) => _ = reply.send(leases.forget(&lease)),
            Call::Renew(lease, reply) => {
                held.push(lease);
                replies.push(reply);
            }
        }
    }
    if held.is_empty() {
        return;
    }
    let renewed = leases.renew(&held);
    for (index, reply) in replies.into_iter().enumerate() {
        _ = reply.send(renewed.as_ref().map(|it| it[index]).map_err(Clone::clone));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leases_that_are_renewed_at_the_same_time_are_one_call() {
        let (worker, mut queue) = LeaseWorker::new();
        let mut store = HostStore::in_memory();
        let mut take =
            |room: usize| store.acquire(&room.to_string(), "one", LEASE_TIME, 0).unwrap().unwrap();
        let leases: Vec<Lease> = (0..100).map(&mut take).collect();
        let (first, rest) = leases.split_at(1);
        let first = worker.renew(&first[0]);
        let later = worker.clone();
        let rest = rest.to_vec();
        // They come while the first one waits for others.
        let renewing =
            thread::spawn(move || rest.iter().map(|lease| later.renew(lease)).collect::<Vec<_>>());
        let calls = gathered(&mut queue).unwrap();
        assert_eq!(calls.len(), 100);
        assert!(store.release(&leases[7]).unwrap());
        run(calls, &mut store, "one");
        let answers = iter::once(first).chain(renewing.join().unwrap());
        for (room, answer) in answers.enumerate() {
            assert_eq!(answer.blocking_recv().unwrap(), Ok(room != 7));
        }
        drop(worker);
        assert!(gathered(&mut queue).is_none());
    }
}
