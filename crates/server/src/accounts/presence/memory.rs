//! Visits and hosts in memory, with a clock that is set.

use std::collections::BTreeMap;
use std::time::Duration;

use super::{HostNotice, HostRow, Presence, Visit, VisitBegin, VisitId, Visitor};
use crate::accounts::StoreFailure;

/// Visits and hosts of one program, whose time [passes](Self::pass) when it is told to.
///
/// ```
/// use std::time::Duration;
///
/// use cellcaster_server::accounts::{
///     AccountKey, HostNotice, MemoryPresence, Presence, VisitBegin, Visitor,
/// };
///
/// let (mut presence, time) = (MemoryPresence::default(), Duration::from_secs(10));
/// presence.announce(&HostNotice { name: "one".to_owned(), ..HostNotice::default() })?;
/// let ada = Visitor::Key(AccountKey::new([1; 32]));
/// let VisitBegin::Begun(visit) = presence.begin_visit("one", &ada, 1, time)? else { panic!() };
/// assert!(matches!(presence.begin_visit("other", &ada, 1, time)?, VisitBegin::TooMany(_)));
/// presence.end_visit(visit)?;
/// assert!(matches!(presence.begin_visit("other", &ada, 1, time)?, VisitBegin::Begun(_)));
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
}

impl MemoryPresence {
    /// Lets time pass.
    pub fn pass(&mut self, time: Duration) {
        self.now += time;
    }

    /// The time since a host has announced itself, if that is less than `time`.
    fn ago(&self, host: &str, time: Duration) -> Option<Duration> {
        let (_, at) = self.hosts.get(host)?;
        Some(self.now.saturating_sub(*at)).filter(|ago| *ago < time)
    }
}

impl Presence for MemoryPresence {
    fn begin_visit(
        &mut self,
        host: &str,
        visitor: &Visitor,
        most: u32,
        time: Duration,
    ) -> Result<VisitBegin, StoreFailure> {
        let of_visitor = self.visits.values().filter(|kept| kept.visitor == *visitor);
        let mut agos: Vec<Duration> =
            of_visitor.filter_map(|kept| self.ago(&kept.host, time)).collect();
        agos.sort();
        if agos.len() >= most as usize {
            let ago = (most as usize).checked_sub(1).map(|index| agos[index]);
            return Ok(VisitBegin::TooMany(ago.unwrap_or_default()));
        }
        self.last += 1;
        let kept = Kept { host: host.to_owned(), visitor: *visitor, began: self.now };
        self.visits.insert(VisitId(self.last), kept);
        Ok(VisitBegin::Begun(VisitId(self.last)))
    }

    fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure> {
        self.visits.remove(&visit);
        Ok(())
    }

    fn visits(&mut self, time: Duration) -> Result<Vec<Visit>, StoreFailure> {
        let counting = self.visits.iter().filter(|(_, kept)| self.ago(&kept.host, time).is_some());
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

    fn leave(&mut self, host: &str) -> Result<(), StoreFailure> {
        self.hosts.remove(host);
        self.visits.retain(|_, kept| kept.host != host);
        Ok(())
    }

    fn hosts(&mut self, time: Duration) -> Result<Vec<HostRow>, StoreFailure> {
        let rows = self.hosts.values().filter_map(|(notice, _)| {
            let ago = self.ago(&notice.name, time)?;
            Some(HostRow { notice: notice.clone(), ago })
        });
        Ok(rows.collect())
    }
}
