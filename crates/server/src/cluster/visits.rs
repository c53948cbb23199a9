//! The visits of all hosts, counted together for the limits on connections.
//!
//! # Rules
//!
//! - A visit begins in the database once the visitor is known, and ends with their session.
//! - A host announces itself each second. The visits of a host that has been silent for [`HOST_TIMEOUT`] do not count.
//! - A visitor may be over a limit because of their own visit on a host that was just killed. So a visitor over a limit
//!   waits until each host of the earlier visits has announced itself again, or until its visits no longer count.
//! - While the database is unavailable, no visit begins, and running visits go on. Visits that end meanwhile are ended
//!   in the database later.
//!
//! Rejected: a new visit in place of an earlier one. Two clients that reconnect automatically would end each other's
//! visits forever.

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::net::IpAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::time::{Instant, sleep};

use crate::accounts::worker::{CallResult, StoreWorker};
use crate::accounts::{AccountKey, HostNotice, HostRow, HostStore, StoreFailure, VisitId};
use crate::admission::{Refusal, counted_address};
use crate::lock::locked;
use crate::logging;

/// The time between two announcements of a host.
pub(crate) const ANNOUNCEMENT_INTERVAL: Duration = Duration::from_secs(1);
/// How long a host counts as present after an announcement.
pub(crate) const HOST_TIMEOUT: Duration = Duration::from_secs(5);
/// The time after which a visitor over a limit is counted again.
const RECOUNT_INTERVAL: Duration = Duration::from_millis(250);
/// The visits of this host. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct Visits(Arc<VisitsState>);

#[derive(Debug)]
struct VisitsState {
    store: StoreWorker,
    /// Locked only by calls to the store.
    registry: Mutex<Registry>,
    counting: Mutex<Counting>,
}

/// The visits of this host that count and have not ended.
#[derive(Debug, Default)]
struct Counting {
    ids: BTreeSet<VisitId>,
    /// `true` if the database may have more visits of this host.
    is_unsure: bool,
}

/// A visit that counts on all hosts until it is dropped.
#[derive(Debug)]
pub(crate) struct CountedVisit {
    ids: Vec<VisitId>,
    visits: Visits,
}

/// A visit that is to begin, and its limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NewVisit {
    /// `None` for a guest.
    pub(crate) key: Option<AccountKey>,
    /// The most visits with the key.
    pub(crate) per_key: u32,
    pub(crate) address: IpAddr,
    /// The most visits from the address.
    pub(crate) per_address: u32,
}

/// The reason why a visit does not begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum VisitRefusal {
    /// There are too many visits, on all hosts together.
    TooMany(Refusal),
    /// The database was not asked, or has not answered.
    NotNow(String),
}

/// The announcements of this host.
#[derive(Debug)]
struct Registry {
    notice: HostNotice,
    /// `true` if the last call to the database failed.
    is_away: bool,
    has_left: bool,
}

impl Visits {
    /// Starts without visits, for the host of `notice`.
    pub(crate) fn new(store: StoreWorker, notice: HostNotice) -> Self {
        let registry = Mutex::new(Registry { notice, is_away: false, has_left: false });
        Self(Arc::new(VisitsState { store, registry, counting: Mutex::default() }))
    }

    /// Begins a visit.
    pub(crate) async fn begin(&self, new_visit: NewVisit) -> Result<CountedVisit, VisitRefusal> {
        let came = Instant::now();
        loop {
            let waited = came.elapsed();
            let visits = self.clone();
            // The call creates the guard, so that the visit of a visitor who leaves before the answer no longer counts.
            let begun = self.call(move |registry, store| {
                let begun = visits.0.begin(&registry.notice.name, store, &new_visit)?;
                Ok::<_, StoreFailure>(begun.map(|ids| CountedVisit { ids, visits }))
            });
            let begun =
                begun.await.map_err(|_| "too many calls to the store are waiting".to_owned());
            let begun = begun.and_then(|begun| begun.map_err(|failure| failure.to_string()));
            match begun.map_err(VisitRefusal::NotNow)? {
                Ok(visit) => return Ok(visit),
                // The limit is reached even if only hosts count that have announced themselves since.
                Err((reason, ago)) if ago < waited => return Err(VisitRefusal::TooMany(reason)),
                Err(_) => sleep(RECOUNT_INTERVAL).await,
            }
        }
    }

    /// Announces the host with `load` visitors.
    pub(crate) fn announce(&self, load: usize) {
        let load = u32::try_from(load).unwrap_or(u32::MAX);
        drop(self.call(move |registry, store| registry.announce(store, load)));
    }

    /// The present hosts; `None` if the database does not answer.
    pub(crate) async fn hosts(&self) -> Option<Vec<HostRow>> {
        self.call(|_, store| store.hosts(HOST_TIMEOUT)).await.ok()?.ok()
    }

    /// Forgets this host.
    pub(crate) async fn leave(&self) {
        let left = self.call(|registry, store| {
            registry.has_left = true;
            registry.note(store.leave(&registry.notice.name));
        });
        _ = left.await;
    }

    /// Ends the visits in the database that no session holds, and then runs `act`.
    fn call<T: Send + 'static>(
        &self,
        act: impl FnOnce(&mut Registry, &mut HostStore) -> T + Send + 'static,
    ) -> CallResult<T> {
        let inner = Arc::clone(&self.0);
        self.0.store.call(move |store| {
            locked(&inner.registry, |registry| {
                if !registry.is_away && !registry.has_left {
                    inner.end_others(&registry.notice.name, store);
                }
                act(registry, store)
            })
        })
    }
}

impl NewVisit {
    /// The key and the address that the visit counts against, each with its limit and the reason for a refusal.
    fn limits(&self) -> impl Iterator<Item = (String, u32, Refusal)> {
        let by_key = self.key.map(|key| (key.to_string(), self.per_key, Refusal::Key));
        let address = counted_address(self.address).to_string();
        by_key.into_iter().chain([(address, self.per_address, Refusal::Address)])
    }
}

impl Drop for CountedVisit {
    fn drop(&mut self) {
        locked(&self.visits.0.counting, |counting| {
            self.ids.iter().for_each(|id| _ = counting.ids.remove(id));
            counting.is_unsure = true;
        });
        drop(self.visits.call(|_, _| ()));
    }
}

impl VisitsState {
    /// Begins a visit by the key and by the address, or by neither. Then returns the limit that is reached, and a time in
    /// which the hosts of the visits in the way have announced themselves.
    fn begin(
        &self,
        host: &str,
        presence: &mut HostStore,
        new_visit: &NewVisit,
    ) -> Result<Result<Vec<VisitId>, (Refusal, Duration)>, StoreFailure> {
        let (limits, reasons): (Vec<_>, Vec<_>) =
            new_visit.limits().map(|(visitor, most, reason)| ((visitor, most), reason)).unzip();
        let begun = presence.begin_visits(host, &limits, HOST_TIMEOUT);
        locked(&self.counting, |counting| match &begun {
            Ok(begun) => counting.ids.extend(begun.iter().flatten()),
            Err(_) => counting.is_unsure = true,
        });
        Ok(begun?.map_err(|(index, ago)| (reasons[index], ago)))
    }

    fn end_others(&self, host: &str, presence: &mut HostStore) {
        let ids = locked(&self.counting, |counting| {
            std::mem::take(&mut counting.is_unsure).then(|| counting.ids.clone())
        });
        if ids.is_some_and(|ids| presence.end_other_visits(host, &ids).is_err()) {
            locked(&self.counting, |counting| counting.is_unsure = true);
        }
    }
}

impl Registry {
    fn announce(&mut self, presence: &mut HostStore, load: u32) {
        if self.has_left {
            return;
        }
        self.notice.load = load;
        let announced = presence.announce(&self.notice);
        self.note(announced);
    }

    /// Notes whether the database answers, and logs when it stops answering.
    fn note(&mut self, answer: Result<(), StoreFailure>) {
        let was_away = std::mem::replace(&mut self.is_away, answer.is_err());
        if let Err(failure) = answer
            && !was_away
        {
            logging::store_failed(failure);
        }
    }
}
