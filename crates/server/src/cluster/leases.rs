//! The leases of a host's rooms.
//!
//! All rooms of a host ask for a renewal at the same time. The requests within [`BATCH_DELAY`] become one call to the
//! store, because each call costs a write to its disk. So a host with many rooms renews all of their leases in time,
//! however long a write takes.

use std::sync::{Arc, Mutex};
use std::time::Duration;
use std::{mem, thread};

use tokio::sync::oneshot;

use crate::accounts::worker::{CallResult, StoreWorker};
use crate::accounts::{Lease, StoreFailure};
use crate::lock::locked;

/// How long a lease lasts without a renewal.
pub(crate) const LEASE_DURATION: Duration = Duration::from_secs(3);
/// How long the first renewal waits for others.
pub(crate) const BATCH_DELAY: Duration = Duration::from_millis(50);
/// The most calls that wait: one a second for each room.
pub(crate) const MAX_CALLS: usize = 4_096;

/// The leases of one host.
pub(crate) struct Leases {
    pub(crate) store: StoreWorker,
    pub(crate) host: String,
    pub(crate) batch_delay: Duration,
    pub(crate) renewals: Arc<Mutex<Vec<Renewal>>>,
}

/// The answer to a call; an error if it was not accepted.
pub(crate) type LeaseAnswer<T> = CallResult<Result<T, StoreFailure>>;

/// A lease to renew, and the sender of the answer.
pub(crate) type Renewal = (Lease, oneshot::Sender<Result<bool, StoreFailure>>);

impl Leases {
    /// Asks for the lease of a room, with an epoch above the epoch of its log.
    pub(crate) fn acquire(&self, room: &str, epoch: u64) -> LeaseAnswer<Option<Lease>> {
        let (room, host) = (room.to_owned(), self.host.clone());
        self.store.call(move |store| store.acquire(&room, &host, LEASE_DURATION, epoch))
    }

    /// Renews a lease, together with the other waiting renewals.
    pub(crate) fn renew(&self, lease: &Lease) -> LeaseAnswer<bool> {
        let (reply, answer) = oneshot::channel();
        locked(&self.renewals, |renewals| renewals.push((lease.clone(), reply)));
        let (renewals, batch_delay) = (Arc::clone(&self.renewals), self.batch_delay);
        let is_accepted = self.store.run(move |store| {
            // An earlier call may have renewed all of them.
            if locked(&renewals, |renewals| renewals.is_empty()) {
                return;
            }
            thread::sleep(batch_delay);
            let (leases, replies): (Vec<_>, Vec<_>) =
                locked(&renewals, mem::take).into_iter().unzip();
            let renewed = store.renew(&leases);
            for (index, reply) in replies.into_iter().enumerate() {
                _ = reply.send(renewed.as_ref().map(|it| it[index]).map_err(Clone::clone));
            }
        });
        if !is_accepted {
            // Drop the senders, so that nobody waits for an answer that does not come.
            locked(&self.renewals, Vec::clear);
        }
        answer
    }

    /// Releases a lease.
    pub(crate) fn release(&self, lease: &Lease) -> LeaseAnswer<bool> {
        let lease = lease.clone();
        self.store.call(move |store| store.release(&lease))
    }

    /// Ends the lease of a room that is closed.
    pub(crate) fn forget(&self, lease: &Lease) -> LeaseAnswer<bool> {
        let lease = lease.clone();
        self.store.call(move |store| store.forget(&lease))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accounts::HostStore;

    #[test]
    fn simultaneous_renewals_are_one_call() {
        let (worker, mut queue) = StoreWorker::new(MAX_CALLS);
        let renewals = Arc::<Mutex<Vec<Renewal>>>::default();
        let host = "one".to_owned();
        let own = Leases {
            store: worker,
            host,
            batch_delay: BATCH_DELAY,
            renewals: Arc::clone(&renewals),
        };
        let mut store = HostStore::in_memory();
        let mut take = |room: usize| {
            store.acquire(&room.to_string(), "one", LEASE_DURATION, 0).unwrap().unwrap()
        };
        let leases: Vec<Lease> = (0..100).map(&mut take).collect();
        assert!(store.release(&leases[7]).unwrap());
        let asking =
            thread::spawn(move || -> Vec<_> { leases.iter().map(|it| own.renew(it)).collect() });
        let mut calls = 0;
        while let Some(call) = queue.blocking_recv() {
            calls += usize::from(!locked(&renewals, |it| it.is_empty()));
            call(&mut store);
        }
        for (room, answer) in asking.join().unwrap().into_iter().enumerate() {
            assert_eq!(answer.blocking_recv().unwrap(), Ok(room != 7));
        }
        // A thread that was not scheduled for a while may have sent some renewals late.
        assert!(calls <= 3, "{calls}");
    }
}
