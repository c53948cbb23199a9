//! A thread for calls to the leases, whose methods block.
//!
//! Renewals that wait for the thread are one call of the store: each costs a write to its disk. So a host with
//! many rooms renews all of their leases in time, however long a write takes.

use std::{io, iter, thread};

use tokio::sync::{mpsc, oneshot};

use crate::store::host::{Lease, Leases, StoreFailure};

/// The time that a lease lasts without being renewed.
pub(super) const LEASE_TIME: std::time::Duration = std::time::Duration::from_secs(3);
/// The most calls that wait: one a second for each room.
const MOST_CALLS: usize = 4_096;

/// The sender of calls to the thread. Clones send to the same thread.
#[derive(Clone)]
pub(super) struct LeaseWorker {
    calls: mpsc::Sender<Call>,
}

/// The answer to a call; an error if it was not accepted.
pub(super) type Reply<T> = oneshot::Receiver<Result<T, StoreFailure>>;

/// What is asked of the leases.
pub(super) enum Call {
    Acquire(String, u64, oneshot::Sender<Result<Option<Lease>, StoreFailure>>),
    Renew(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
    Release(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
    Forget(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
}

impl LeaseWorker {
    /// A sender, and the receiver of its calls.
    pub(super) fn new() -> (Self, mpsc::Receiver<Call>) {
        let (calls, queue) = mpsc::channel(MOST_CALLS);
        (Self { calls }, queue)
    }

    /// Starts the thread, for the host called `host`.
    pub(super) fn start(mut leases: Box<dyn Leases>, host: String) -> io::Result<Self> {
        let (worker, mut queue) = Self::new();
        thread::Builder::new().name("leases".to_owned()).spawn(move || {
            while let Some(first) = queue.blocking_recv() {
                let rest = iter::from_fn(|| queue.try_recv().ok()).take(MOST_CALLS);
                run(iter::once(first).chain(rest), &mut *leases, &host);
            }
        })?;
        Ok(worker)
    }

    /// Asks for the lease of a room, with an epoch above that of its log.
    pub(super) fn acquire(&self, room: &str, epoch: u64) -> Reply<Option<Lease>> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Acquire(room.to_owned(), epoch, reply));
        answer
    }

    /// Renews a lease.
    pub(super) fn renew(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Renew(lease.clone(), reply));
        answer
    }

    /// Releases a lease.
    pub(super) fn release(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Release(lease.clone(), reply));
        answer
    }

    /// Ends the lease of a room that is closed.
    pub(super) fn forget(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Forget(lease.clone(), reply));
        answer
    }

    fn call(&self, call: Call) {
        // The answer to a call that is not accepted is an error, since its sender is dropped.
        _ = self.calls.try_send(call);
    }
}

/// Does what was asked, and answers: all renewals at once, after the rest.
pub(super) fn run(calls: impl Iterator<Item = Call>, leases: &mut dyn Leases, host: &str) {
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
