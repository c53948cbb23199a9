//! The leases of a host's rooms.
//!
//! One call to the store renews all leases that a host holds, because each call costs a write to its disk. So a host
//! with many rooms renews all of their leases in time, however long a write takes.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use tokio::time::Instant;

use crate::accounts::worker::{CallResult, StoreWorker};
use crate::accounts::{Lease, StoreFailure};
use crate::lock::locked;
use crate::rooms::summary::RoomId;

/// How long a lease lasts without a renewal.
pub(crate) const LEASE_DURATION: Duration = Duration::from_secs(3);
/// The time between two renewals.
pub(crate) const RENEWAL_INTERVAL: Duration = Duration::from_secs(1);
/// The most calls that wait: a few for each room.
pub(crate) const MAX_CALLS: usize = 4_096;

/// The leases of one host.
pub(crate) struct Leases {
    store: StoreWorker,
    host: String,
    /// The leases that the host holds, and when each ends if it is not renewed, by this host's clock. A lease that the
    /// host has lost is removed at the next renewal.
    held: Mutex<BTreeMap<RoomId, (Lease, Instant)>>,
}

/// The answer to a call; an error if it was not accepted.
pub(crate) type LeaseAnswer<T> = CallResult<Result<T, StoreFailure>>;

impl Leases {
    pub(crate) fn new(store: StoreWorker, host: String) -> Self {
        Self { store, host, held: Mutex::default() }
    }

    /// Asks for the lease of a room, with an epoch above the epoch of its log.
    pub(crate) fn acquire(&self, room: &str, epoch: u64) -> LeaseAnswer<Option<Lease>> {
        let (room, host) = (room.to_owned(), self.host.clone());
        self.store.call(move |store| store.acquire(&room, &host, LEASE_DURATION, epoch))
    }

    /// Holds a lease that the host asked for at `asked`.
    pub(crate) fn hold(&self, room: RoomId, lease: Lease, asked: Instant) {
        locked(&self.held, |held| _ = held.insert(room, (lease, asked + LEASE_DURATION)));
    }

    /// Stops renewing the lease of a room.
    pub(crate) fn drop_hold(&self, room: RoomId) {
        locked(&self.held, |held| _ = held.remove(&room));
    }

    /// The end of a lease; `None` if the host does not hold it.
    pub(crate) fn end_of(&self, room: RoomId, lease: &Lease) -> Option<Instant> {
        let own = |held: &mut BTreeMap<_, (Lease, Instant)>| held.get(&room).cloned();
        locked(&self.held, own).filter(|(own, _)| own == lease).map(|(_, end)| end)
    }

    /// The rooms whose leases the host holds.
    pub(crate) fn rooms(&self) -> Vec<RoomId> {
        locked(&self.held, |held| held.keys().copied().collect())
    }

    /// Renews all leases that the host holds. If the store does not answer, they stay until they end.
    pub(crate) async fn renew(&self) {
        let asked = Instant::now();
        let held: Vec<(RoomId, Lease)> = locked(&self.held, |held| {
            held.iter().map(|(room, (lease, _))| (*room, lease.clone())).collect()
        });
        if held.is_empty() {
            return;
        }
        let leases: Vec<Lease> = held.iter().map(|(_, lease)| lease.clone()).collect();
        let Ok(Ok(renewed)) = self.store.call(move |store| store.renew(&leases)).await else {
            return;
        };
        for ((room, lease), is_renewed) in held.into_iter().zip(renewed) {
            if self.end_of(room, &lease).is_none() {
                continue;
            }
            if is_renewed {
                self.hold(room, lease, asked);
            } else {
                self.drop_hold(room);
            }
        }
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
