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

use std::collections::BTreeSet;
use std::time::Duration;

use rusqlite::params;
use serde_json::{Map, Value};

use super::lease::milliseconds;
use super::statements::Row;
use super::{HostStore, StoreFailure};

/// The number of a visit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VisitId(pub(crate) i64);

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
    /// Begins a visit by each of `limits`: a visitor, and the most visits of theirs that may count. If a limit is
    /// reached, begins none. Then returns the index of that limit, and a time in which the hosts of at least as many
    /// counting visits have announced themselves.
    ///
    /// # Errors
    /// If the store can't be asked. All methods share this error. If the failure says that a change may be kept or not,
    /// the visits may count.
    pub fn begin_visits(
        &mut self,
        host: &str,
        limits: &[(String, u32)],
        time: Duration,
    ) -> Result<Result<Vec<VisitId>, (usize, Duration)>, StoreFailure> {
        let in_the_way = "SELECT (SELECT ms FROM clock) - seen_at \
                          FROM visits JOIN hosts ON hosts.name = visits.host \
                          WHERE visitor = ?1 AND seen_at > (SELECT ms FROM clock) - ?2 \
                          ORDER BY seen_at DESC LIMIT 1 OFFSET ?3";
        let insert = "INSERT INTO visits (host, visitor) VALUES (?1, ?2) RETURNING id";
        self.database.change_rows(|it| {
            for (index, (visitor, most)) in limits.iter().enumerate() {
                let Some(others) = most.checked_sub(1) else {
                    return Ok(Err((index, Duration::ZERO)));
                };
                // Transactions that count the same visits wait for each other. While the table is short, a
                // serializable transaction would also conflict with transactions that count other visits.
                it.lock(&format!("visits of {visitor}"))?;
                let row = it.row(in_the_way, params![visitor, milliseconds(time), others])?;
                if let Some(row) = row {
                    return Ok(Err((index, Duration::from_millis(row.count(0)?))));
                }
            }
            let begun = limits.iter().map(|(visitor, _)| {
                let row = it.row(insert, params![host, visitor])?;
                let row = row.ok_or_else(|| {
                    StoreFailure::new("the host's store did not record the visit")
                })?;
                Ok(VisitId(row.get(0)?))
            });
            begun.collect::<Result<_, _>>().map(Ok)
        })
    }

    /// Ends the visits of a host, except for those in `kept`.
    ///
    /// # Errors
    /// See [`begin_visits`](Self::begin_visits).
    pub fn end_other_visits(
        &mut self,
        host: &str,
        kept: &BTreeSet<VisitId>,
    ) -> Result<(), StoreFailure> {
        let sql = "DELETE FROM visits WHERE host = ?1 AND id NOT IN \
                   (SELECT CAST(kept.key AS BIGINT) FROM json_each(?2) AS kept)";
        let kept: Map<_, _> = kept.iter().map(|id| (id.0.to_string(), Value::Null)).collect();
        let kept = Value::from(kept).to_string();
        self.database.once(|it| it.execute(sql, params![host, kept]).map(|_| ()))
    }

    /// Stores a host's notice in place of its previous one.
    ///
    /// # Errors
    /// See [`begin_visits`](Self::begin_visits).
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
    /// See [`begin_visits`](Self::begin_visits).
    pub fn leave(&mut self, host: &str) -> Result<(), StoreFailure> {
        self.database.once(|it| {
            it.execute("DELETE FROM hosts WHERE name = ?1", params![host])?;
            it.execute("DELETE FROM visits WHERE host = ?1", params![host]).map(|_| ())
        })
    }

    /// The present hosts, by name.
    ///
    /// # Errors
    /// See [`begin_visits`](Self::begin_visits).
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
