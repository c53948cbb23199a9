//! The hosts of a cluster, and the visitors on each of them.
//!
//! Rules:
//!
//! - **A host is present while it announces itself.** A host that ended silently counts as gone some seconds later.
//! - **A visit counts on all hosts while its host is present**, so that a limit on visits by a key or by addresses
//!   holds for all hosts together. A host that was late still has its visitors. Its visits count again then, and for a
//!   while there may be more visits than the limit.
//! - **A refusal says how fresh it is**, because the visits in the way may belong to a host that was just killed.
//! - **The clock is the store's**, as with [leases](super::Lease).
//!
//! Rejected: a counter for each visitor. The counts of a killed host would stay forever. Also rejected: a time for
//! each visit that the host renews. A host with a thousand visitors would write a thousand rows each time.

use std::time::Duration;

use rusqlite::params;

use super::lease::milliseconds;
use super::statements::Row;
use super::{HostStore, StoreFailure};

/// The number of a visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VisitId(pub(crate) i64);

/// A visit that counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Visit {
    /// Its number.
    pub id: VisitId,
    /// The host.
    pub host: String,
    /// The key or the range of addresses that it counts against.
    pub visitor: String,
}

/// A host's information about itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HostNotice {
    /// The name, which is unique in the cluster.
    pub name: String,
    /// The version of the program.
    pub version: String,
    /// The address at which players reach the host.
    pub address: String,
    /// The number of visitors.
    pub load: u32,
}

/// A host that is present.
#[derive(Clone, Debug, PartialEq)]
pub struct HostRow {
    /// Its latest notice.
    pub notice: HostNotice,
    /// The age of the notice.
    pub ago: Duration,
}

/// The visits and hosts of a cluster. In each method, a host is present if it has announced itself in the last `time`.
impl HostStore {
    /// Begins a visit if fewer than `most` visits of the visitor count. Otherwise returns a time in which the hosts of
    /// at least `most` counting visits have announced themselves.
    ///
    /// # Errors
    /// If the store can't be asked. All methods share this error. If the failure says that a change may be kept or not,
    /// the visit may count.
    pub fn begin_visit(
        &mut self,
        host: &str,
        visitor: &str,
        most: u32,
        time: Duration,
    ) -> Result<Result<VisitId, Duration>, StoreFailure> {
        let Some(others) = most.checked_sub(1) else {
            return Ok(Err(Duration::ZERO));
        };
        let in_the_way = "SELECT (SELECT ms FROM clock) - seen_at \
                          FROM visits JOIN hosts ON hosts.name = visits.host \
                          WHERE visitor = ?1 AND seen_at > (SELECT ms FROM clock) - ?2 \
                          ORDER BY seen_at DESC LIMIT 1 OFFSET ?3";
        let insert = "INSERT INTO visits (host, visitor) VALUES (?1, ?2) RETURNING id";
        self.database.change_rows(|it| {
            // Transactions that count the same visits wait for each other. While the table is short, a serializable
            // transaction would also conflict with transactions that count other visits.
            it.lock(&format!("visits of {visitor}"))?;
            let row = it.row(in_the_way, params![visitor, milliseconds(time), others])?;
            if let Some(row) = row {
                return Ok(Err(Duration::from_millis(row.count(0)?)));
            }
            let row = it.row(insert, params![host, visitor])?;
            let row =
                row.ok_or_else(|| StoreFailure::new("the host's store did not record the visit"))?;
            Ok(Ok(VisitId(row.get(0)?)))
        })
    }

    /// Ends a visit.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    pub fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure> {
        let sql = "DELETE FROM visits WHERE id = ?1";
        self.database.once(|it| it.execute(sql, params![visit.0]).map(|_| ()))
    }

    /// The visits that count, in the order in which they began.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    pub fn visits(&mut self, time: Duration) -> Result<Vec<Visit>, StoreFailure> {
        let sql = "SELECT id, host, visitor FROM visits JOIN hosts ON hosts.name = visits.host \
                   WHERE seen_at > (SELECT ms FROM clock) - ?1 ORDER BY id";
        let rows = self.database.once(|it| it.rows(sql, params![milliseconds(time)]))?;
        let visit = |row: &Row| {
            let (id, host, visitor) = (VisitId(row.get(0)?), row.get(1)?, row.get(2)?);
            Ok(Visit { id, host, visitor })
        };
        rows.iter().map(visit).collect()
    }

    /// Stores a host's notice in place of its previous one.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    pub fn announce(&mut self, notice: &HostNotice) -> Result<(), StoreFailure> {
        const DAY: Duration = Duration::from_hours(24);
        // Remove hosts that have not come back.
        let visits = "DELETE FROM visits WHERE host IN \
                      (SELECT name FROM hosts WHERE seen_at < (SELECT ms FROM clock) - ?1)";
        let hosts = "DELETE FROM hosts WHERE seen_at < (SELECT ms FROM clock) - ?1";
        let upsert = "INSERT INTO hosts (name, version, address, load, seen_at) \
                      VALUES (?1, ?2, ?3, ?4, (SELECT ms FROM clock)) \
                      ON CONFLICT (name) DO UPDATE SET version = excluded.version, \
                      address = excluded.address, load = excluded.load, seen_at = excluded.seen_at";
        let HostNotice { name, version, address, load } = notice;
        self.database.once(|it| {
            it.execute(visits, params![milliseconds(DAY)])?;
            it.execute(hosts, params![milliseconds(DAY)])?;
            it.execute(upsert, params![name, version, address, load]).map(|_| ())
        })
    }

    /// Forgets a host that ends, and all of its visits.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    pub fn leave(&mut self, host: &str) -> Result<(), StoreFailure> {
        self.database.once(|it| {
            it.execute("DELETE FROM hosts WHERE name = ?1", params![host])?;
            it.execute("DELETE FROM visits WHERE host = ?1", params![host]).map(|_| ())
        })
    }

    /// The present hosts, by name.
    ///
    /// # Errors
    /// See [`begin_visit`](Self::begin_visit).
    pub fn hosts(&mut self, time: Duration) -> Result<Vec<HostRow>, StoreFailure> {
        let sql = "SELECT name, version, address, load, (SELECT ms FROM clock) - seen_at \
                   FROM hosts WHERE seen_at > (SELECT ms FROM clock) - ?1 ORDER BY name";
        let rows = self.database.once(|it| it.rows(sql, params![milliseconds(time)]))?;
        rows.iter().map(host).collect()
    }
}

fn host(row: &Row) -> Result<HostRow, StoreFailure> {
    let (name, version, address) = (row.get(0)?, row.get(1)?, row.get(2)?);
    let notice = HostNotice { name, version, address, load: row.get(3)? };
    Ok(HostRow { notice, ago: Duration::from_millis(row.count(4)?) })
}
