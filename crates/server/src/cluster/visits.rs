//! The visits of all hosts, so that limits of connections hold for all of them together.
//!
//! # Rules
//!
//! - A visit begins in the database when it is known who the visitor is, and ends with their session.
//! - A host announces itself each second. The visits of one that has not done so for [`THERE`] do not count.
//! - A visitor may be over a limit because of their own visit on a host that was just killed. So a visitor over a
//!   limit waits until each host of the earlier visits has announced itself again, or its visits no longer count.
//! - While the database is away nobody begins a visit, and those that run go on. What has ended meanwhile is
//!   ended in the database later.
//!
//! A new visit in place of an earlier one was refused: two clients that connect again by themselves would end
//! each other's visits for ever.

mod registry;
#[cfg(test)]
mod tests;

use std::io;
use std::net::IpAddr;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, sleep};

pub(crate) use self::registry::VisitRegistry;
use crate::accounts::{AccountKey, HostNotice, HostRow, HostStore, StoreFailure, VisitId, Visitor};
use crate::lock::locked;
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
    /// As whom they count, with the most visits and the reason of a refusal.
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
