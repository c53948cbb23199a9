//! What the thread of the visits knows, and does with each call.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use super::{Call, CountedVisit, NewVisit, THERE, TooMany, Visits};
use crate::accounts::{HostNotice, HostStore, StoreFailure, VisitBegin, VisitId};
use crate::lock::locked;
use crate::ops::logging::events;

/// The visits of this host.
pub(crate) struct VisitRegistry {
    notice: HostNotice,
    /// Those that count, and that nobody has ended.
    counting: BTreeSet<VisitId>,
    ended: Arc<Mutex<Vec<VisitId>>>,
    /// Whether the database may have visits of this host that nobody here has.
    is_unsure: bool,
    /// Whether the database has not answered last.
    is_away: bool,
    has_left: bool,
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
