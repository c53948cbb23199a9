//! The visits of all hosts, so that limits of connections hold for all of them together.
//!
//! # Rules
//!
//! - A visit begins in the database when it is known who the visitor is, and ends with their session.
//! - A host announces itself each second. The visits of a host that was silent for [`THERE`] do not count.
//! - A visitor may be over a limit because of their own visit on a host that was just killed. So a visitor over a
//!   limit waits until each host of the earlier visits has announced itself again, or its visits no longer count.
//! - While the database is away nobody begins a visit, and running visits go on. Visits that end meanwhile are ended in
//!   the database later.
//!
//! Rejected: a new visit in place of an earlier one. Two clients that connect again by themselves would end each other's
//! visits for ever.

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::io;
use std::net::IpAddr;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, sleep};

use crate::accounts::{
    AccountKey, HostNotice, HostRow, HostStore, StoreFailure, VisitBegin, VisitId, Visitor,
};
use crate::lock::locked;
use crate::ops::logging::events;
use crate::ssh::admission::Refusal;
use crate::ssh::admission::counted_address;

/// The time from one announcement of a host to the next.
pub(crate) const ANNOUNCED: Duration = Duration::from_secs(1);
/// The time in which a host that has announced itself is there.
pub(crate) const THERE: Duration = Duration::from_secs(5);
/// The time after which a visitor over a limit is counted again.
const AGAIN: Duration = Duration::from_millis(250);
/// The most calls that wait.
const MOST_CALLS: usize = 256;

/// The sender of calls to a thread, since the methods of [`HostStore`] block. Clones send to the same thread.
#[derive(Clone, Debug)]
pub(crate) struct Visits {
    calls: mpsc::Sender<Call>,
    /// The visits that are still to be ended in the database.
    ended: Arc<Mutex<Vec<VisitId>>>,
}

/// A visit that counts on all hosts until it is dropped.
#[derive(Debug)]
pub(crate) struct CountedVisit {
    ids: Vec<VisitId>,
    visits: Visits,
}

/// A visit that is to begin, and the most there may be.
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

/// Why a visit does not begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum VisitRefusal {
    /// There are too many, on all hosts together.
    TooMany(Refusal),
    /// The database was not asked, or has not answered.
    NotNow(String),
}

/// What is asked of the thread.
#[derive(Debug)]
pub(crate) enum Call {
    /// To begin a visit; its guard has the sender.
    Begin(NewVisit, Visits, oneshot::Sender<Begun>),
    /// To end what has ended.
    End,
    /// To announce the host with so many visitors.
    Announce(u32),
    /// The hosts that are there.
    Hosts(oneshot::Sender<Result<Vec<HostRow>, StoreFailure>>),
    /// To forget the host, which ends.
    Leave(oneshot::Sender<()>),
}

type Begun = Result<Result<CountedVisit, TooMany>, StoreFailure>;

/// A limit that is reached, counting only hosts that have announced themselves in the time `ago`.
#[derive(Debug)]
pub(crate) struct TooMany {
    reason: Refusal,
    ago: Duration,
}

/// The visits of this host, as its thread knows them.
pub(crate) struct VisitRegistry {
    notice: HostNotice,
    /// The visits that count and have not ended.
    counting: BTreeSet<VisitId>,
    ended: Arc<Mutex<Vec<VisitId>>>,
    /// Whether the database may have visits of this host that nobody here has.
    is_unsure: bool,
    /// Whether the last call to the database failed.
    is_away: bool,
    has_left: bool,
}

impl Visits {
    /// A sender, and the receiver of its calls.
    pub(crate) fn new() -> (Self, mpsc::Receiver<Call>) {
        let (calls, queue) = mpsc::channel(MOST_CALLS);
        (Self { calls, ended: Arc::default() }, queue)
    }

    /// Starts the thread, for the host of `notice`.
    pub(crate) fn start(mut presence: HostStore, notice: HostNotice) -> io::Result<Self> {
        let (visits, mut queue) = Self::new();
        let mut registry = VisitRegistry::new(notice, &visits);
        thread::Builder::new().name("visits".to_owned()).spawn(move || {
            while let Some(call) = queue.blocking_recv() {
                registry.run(&mut presence, call);
            }
        })?;
        Ok(visits)
    }

    /// Begins a visit.
    pub(crate) async fn begin(&self, new_visit: NewVisit) -> Result<CountedVisit, VisitRefusal> {
        let came = Instant::now();
        loop {
            let waited = came.elapsed();
            let (reply, answer) = oneshot::channel();
            self.call(Call::Begin(new_visit, self.clone(), reply));
            let begun = answer.await.map_err(|_| "too many calls wait".to_owned());
            let begun = begun.and_then(|begun| begun.map_err(|failure| failure.to_string()));
            match begun.map_err(VisitRefusal::NotNow)? {
                Ok(visit) => return Ok(visit),
                Err(TooMany { reason, ago }) if ago < waited => {
                    return Err(VisitRefusal::TooMany(reason));
                }
                Err(_) => sleep(AGAIN).await,
            }
        }
    }

    /// Announces the host with so many visitors.
    pub(crate) fn announce(&self, load: usize) {
        self.call(Call::Announce(u32::try_from(load).unwrap_or(u32::MAX)));
    }

    /// The hosts that are there; `None` if the database does not say.
    pub(crate) async fn hosts(&self) -> Option<Vec<HostRow>> {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Hosts(reply));
        answer.await.ok()?.ok()
    }

    /// Forgets this host.
    pub(crate) async fn leave(&self) {
        let (reply, answer) = oneshot::channel();
        self.call(Call::Leave(reply));
        _ = answer.await;
    }

    fn call(&self, call: Call) {
        // The answer to a call that is not accepted is an error, since its sender is dropped.
        _ = self.calls.try_send(call);
    }
}

impl NewVisit {
    /// The key and the address that the visit counts against, each with its limit and the reason of a refusal.
    fn limits(&self) -> impl Iterator<Item = (Visitor, u32, Refusal)> {
        let by_key = self.key.map(|key| (Visitor::Key(key), self.per_key, Refusal::Key));
        let address = Visitor::Addresses(counted_address(self.address));
        by_key.into_iter().chain([(address, self.per_address, Refusal::Address)])
    }
}

impl Drop for CountedVisit {
    fn drop(&mut self) {
        locked(&self.visits.ended, |ended| ended.append(&mut self.ids));
        self.visits.call(Call::End);
    }
}

impl VisitRegistry {
    pub(crate) fn new(notice: HostNotice, visits: &Visits) -> Self {
        let (counting, ended) = (BTreeSet::new(), Arc::clone(&visits.ended));
        Self { notice, counting, ended, is_unsure: false, is_away: false, has_left: false }
    }

    /// Does what a call asks for, and answers.
    pub(crate) fn run(&mut self, presence: &mut HostStore, call: Call) {
        self.end(presence);
        match call {
            Call::Begin(new_visit, visits, reply) => {
                let begun = self.begin(presence, &new_visit);
                let begun = begun.map(|begun| begun.map(|ids| CountedVisit { ids, visits }));
                // A visit that nobody waits for any more ends when it is dropped.
                _ = reply.send(begun);
            }
            Call::Announce(load) if !self.has_left => self.announce(presence, load),
            Call::Announce(_) | Call::End => {}
            Call::Hosts(reply) => _ = reply.send(presence.hosts(THERE)),
            Call::Leave(reply) => {
                self.has_left = true;
                self.counting.clear();
                self.note(presence.leave(&self.notice.name));
                _ = reply.send(());
            }
        }
    }

    /// Begins a visit by the key and by the address, or neither.
    fn begin(
        &mut self,
        presence: &mut HostStore,
        new_visit: &NewVisit,
    ) -> Result<Result<Vec<VisitId>, TooMany>, StoreFailure> {
        let mut ids = Vec::new();
        for (visitor, most, reason) in new_visit.limits() {
            match presence.begin_visit(&self.notice.name, &visitor, most, THERE) {
                Ok(VisitBegin::Begun(id)) => {
                    self.counting.insert(id);
                    ids.push(id);
                }
                Ok(VisitBegin::TooMany(ago)) => {
                    self.end_all(presence, ids);
                    return Ok(Err(TooMany { reason, ago }));
                }
                Err(failure) => {
                    self.is_unsure = true;
                    self.end_all(presence, ids);
                    return Err(failure);
                }
            }
        }
        Ok(Ok(ids))
    }

    /// Ends the visits whose sessions have ended.
    fn end(&mut self, presence: &mut HostStore) {
        let ended = locked(&self.ended, std::mem::take);
        self.end_all(presence, ended);
    }

    fn end_all(&mut self, presence: &mut HostStore, ids: Vec<VisitId>) {
        for id in ids {
            // One that this host has left has ended with all others.
            if self.counting.remove(&id) && (self.is_away || presence.end_visit(id).is_err()) {
                self.is_unsure = true;
            }
        }
    }

    fn announce(&mut self, presence: &mut HostStore, load: u32) {
        self.notice.load = load;
        let announced = presence.announce(&self.notice);
        self.note(announced);
        if self.is_unsure && !self.is_away {
            self.is_unsure = self.end_unknown(presence).is_err();
        }
    }

    /// Ends the visits of this host that nobody has, since a call has failed.
    fn end_unknown(&mut self, presence: &mut HostStore) -> Result<(), StoreFailure> {
        for visit in presence.visits(THERE)? {
            if visit.host == self.notice.name && !self.counting.contains(&visit.id) {
                presence.end_visit(visit.id)?;
            }
        }
        Ok(())
    }

    /// Notes whether the database answers, and logs that it does not any more.
    fn note(&mut self, answer: Result<(), StoreFailure>) {
        let was_away = std::mem::replace(&mut self.is_away, answer.is_err());
        if let Err(failure) = answer
            && !was_away
        {
            events::store_failed(failure);
        }
    }
}
