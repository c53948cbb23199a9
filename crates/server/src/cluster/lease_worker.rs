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

/// A call for a host of a name.
type Act = dyn FnOnce(&mut HostStore, &str) + Send;

/// A call to the thread.
pub(crate) enum Call {
    /// To renew a lease, together with the other renewals that wait.
    Renew(Lease, oneshot::Sender<Result<bool, StoreFailure>>),
    /// To do something else, and to answer it.
    Act(Box<Act>),
}

impl LeaseWorker {
    /// A sender, and the receiver of its calls.
    pub(crate) fn new() -> (Self, mpsc::Receiver<Call>) {
        let (calls, queue) = mpsc::channel(MOST_CALLS);
        (Self { calls }, queue)
    }

    /// Starts the thread, for the host called `host`.
    pub(crate) fn start(mut store: HostStore, host: String) -> io::Result<Self> {
        let (worker, mut queue) = Self::new();
        thread::Builder::new().name("leases".to_owned()).spawn(move || {
            while let Some(calls) = gathered(&mut queue) {
                run(calls, &mut store, &host);
            }
        })?;
        Ok(worker)
    }

    /// Asks for the lease of a room, with an epoch above that of its log.
    pub(crate) fn acquire(&self, room: &str, epoch: u64) -> Reply<Option<Lease>> {
        let room = room.to_owned();
        self.act(move |store, host| store.acquire(&room, host, LEASE_TIME, epoch))
    }

    /// Renews a lease.
    pub(crate) fn renew(&self, lease: &Lease) -> Reply<bool> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Renew(lease.clone(), reply));
        answer
    }

    /// Releases a lease.
    pub(crate) fn release(&self, lease: &Lease) -> Reply<bool> {
        let lease = lease.clone();
        self.act(move |store, _| store.release(&lease))
    }

    /// Ends the lease of a room that is closed.
    pub(crate) fn forget(&self, lease: &Lease) -> Reply<bool> {
        let lease = lease.clone();
        self.act(move |store, _| store.forget(&lease))
    }

    fn act<T: Send + 'static>(
        &self,
        act: impl FnOnce(&mut HostStore, &str) -> Result<T, StoreFailure> + Send + 'static,
    ) -> Reply<T> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Act(Box::new(move |store, host| _ = reply.send(act(store, host)))));
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
pub(crate) fn run(calls: impl IntoIterator<Item = Call>, store: &mut HostStore, host: &str) {
    let (mut held, mut replies) = (Vec::new(), Vec::new());
    for call in calls {
        match call {
            Call::Act(act) => act(store, host),
            Call::Renew(lease, reply) => {
                held.push(lease);
                replies.push(reply);
            }
        }
    }
    if held.is_empty() {
        return;
    }
    let renewed = store.renew(&held);
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
        assert!(store.release(&leases[7]).unwrap());
        let rooms = leases.clone();
        let asking = thread::spawn(move || -> Vec<_> {
            rooms.iter().map(|lease| worker.renew(lease)).collect()
        });
        let mut counts = Vec::new();
        while let Some(calls) = gathered(&mut queue) {
            counts.push(calls.len());
            run(calls, &mut store, "one");
        }
        for (room, answer) in asking.join().unwrap().into_iter().enumerate() {
            assert_eq!(answer.blocking_recv().unwrap(), Ok(room != 7));
        }
        // A thread that was not scheduled for a while may have sent some of them late.
        assert!(counts.iter().sum::<usize>() == 100 && counts.len() <= 3, "{counts:?}");
    }
}
