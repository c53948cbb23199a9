//! Visits and hosts in memory, with a clock that is set.

use std::collections::BTreeMap;
use std::time::Duration;

use super::{HostNotice, HostRow, Presence, Visit, VisitId, Visitor};
use crate::store::host::StoreFailure;

/// Visits and hosts of one program, whose time [passes](Self::pass) when it is told to.
///
/// ```
/// use std::time::Duration;
///
/// use cellcaster::store::host::{AccountKey, MemoryPresence, Presence, Visitor};
///
/// let (mut presence, time) = (MemoryPresence::default(), Duration::from_secs(10));
/// let ada = Visitor::Key(AccountKey::new([1; 32]));
/// let visit = presence.begin_visit("one", &ada, 1, time)?.unwrap();
/// assert_eq!(presence.begin_visit("other", &ada, 1, time)?, None);
/// presence.end_visit(visit)?;
/// assert!(presence.begin_visit("other", &ada, 1, time)?.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryPresence {
    now: Duration,
    last: i64,
    visits: BTreeMap<VisitId, Kept>,
    /// By name, with the time of the notice.
    hosts: BTreeMap<String, (HostNotice, Duration)>,
}

#[derive(Clone, Debug)]
struct Kept {
    host: String,
    visitor: Visitor,
    began: Duration,
    ends: Duration,
}

impl MemoryPresence {
    /// Lets time pass.
    pub fn pass(&mut self, time: Duration) {
        self.now += time;
    }
}

impl Presence for MemoryPresence {
    fn begin_visit(
        &mut self,
        host: &str,
        visitor: &Visitor,
        most: u32,
        time: Duration,
    ) -> Result<Option<VisitId>, StoreFailure> {
        let now = self.now;
        let counting = self.visits.values().filter(|kept| now < kept.ends);
        if counting.filter(|kept| kept.visitor == *visitor).count() >= most as usize {
            return Ok(None);
        }
        self.last += 1;
        let (host, visitor) = (host.to_owned(), *visitor);
        let kept = Kept { host, visitor, began: now, ends: now + time };
        self.visits.insert(VisitId(self.last), kept);
        Ok(Some(VisitId(self.last)))
    }

    fn renew_visits(&mut self, host: &str, time: Duration) -> Result<u64, StoreFailure> {
        let ends = self.now + time;
        let own = self.visits.values_mut().filter(|kept| kept.host == host);
        Ok(own.map(|kept| kept.ends = ends).count() as u64)
    }

    fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure> {
        self.visits.remove(&visit);
        Ok(())
    }

    fn end_visits(&mut self, host: &str) -> Result<u64, StoreFailure> {
        let before = self.visits.len();
        self.visits.retain(|_, kept| kept.host != host);
        Ok((before - self.visits.len()) as u64)
    }

    fn visits(&mut self) -> Result<Vec<Visit>, StoreFailure> {
        let counting = self.visits.iter().filter(|(_, kept)| self.now < kept.ends);
        let visit = |(id, kept): (&VisitId, &Kept)| Visit {
            id: *id,
            host: kept.host.clone(),
            visitor: kept.visitor,
            since: self.now.saturating_sub(kept.began),
        };
        Ok(counting.map(visit).collect())
    }

    fn announce(&mut self, notice: &HostNotice) -> Result<(), StoreFailure> {
        self.hosts.insert(notice.name.clone(), (notice.clone(), self.now));
        Ok(())
    }

    fn hosts(&mut self, time: Duration) -> Result<Vec<HostRow>, StoreFailure> {
        let rows = self.hosts.values().map(|(notice, at)| HostRow {
            notice: notice.clone(),
            ago: self.now.saturating_sub(*at),
        });
        Ok(rows.filter(|row| row.ago < time).collect())
    }
}
