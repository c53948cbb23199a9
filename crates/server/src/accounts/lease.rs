//! Leases: the rights of hosts to run rooms.
//!
//! Rules:
//!
//! - **A room has at most one holder.** A lease ends when it is released, or when its time is over without a renewal.
//!   Until then no host can take it, not even its own holder: a host that was restarted waits.
//! - **A lease has an epoch**, greater than the epoch of every earlier lease of the room. No epoch is repeated while
//!   the room exists. So the actions of a host with an expired lease can be distinguished from the actions of its
//!   successor.
//! - **An expired lease that no host has taken can be renewed**, with its epoch.
//! - **The clock is the store's.** A host with a wrong clock keeps no lease too long and loses none.
//! - **One statement takes, renews or ends leases**, on the newest version of their rows. So it needs no serializable
//!   transaction. One statement, and so one write to the disk, renews all leases of a host.
//!
//! Rejected: locks that end with their holder's connection. A connection outlives a host that hangs,
//! and a host outlives a connection that was cut.

use std::collections::BTreeSet;
use std::time::Duration;

use rusqlite::params;
use serde_json::{Map, json};

use super::{HostStore, StoreFailure};

/// The right to run a room, for a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lease {
    /// The name of the room, without control characters.
    pub room: String,
    /// The host that holds the lease.
    pub host: String,
    /// Its number among the leases of the room.
    pub epoch: u64,
    /// How long it lasts without a renewal.
    pub time: Duration,
}

/// Leases.
impl HostStore {
    /// Takes the lease of a room for `time`; `None` if the room has a holder. The epoch is greater than `above` and
    /// all earlier epochs. The caller passes `above` because a store that was restored from a backup may know fewer
    /// epochs than the caller.
    ///
    /// # Errors
    /// If the store can't be asked. All methods share this error. If the failure says that a change may be kept or
    /// not, the room may have a holder until `time` is over.
    pub fn acquire(
        &mut self,
        room: &str,
        host: &str,
        time: Duration,
        above: u64,
    ) -> Result<Option<Lease>, StoreFailure> {
        let sql = "INSERT INTO leases AS kept (room, host, epoch, time_ms, ends_at) \
                   VALUES (?1, ?2, ?3, ?4, (SELECT ms FROM clock) + ?4) \
                   ON CONFLICT (room) DO UPDATE SET host = excluded.host, epoch = CASE \
                   WHEN kept.epoch < excluded.epoch THEN excluded.epoch ELSE kept.epoch + 1 END, \
                   time_ms = excluded.time_ms, ends_at = excluded.ends_at \
                   WHERE kept.host IS NULL OR kept.ends_at <= (SELECT ms FROM clock) \
                   RETURNING epoch";
        let values = params![room, host, above as i64 + 1, milliseconds(time)];
        let row = self.database.change_rows(|it| it.row(sql, values))?;
        let lease = row.map(|row| {
            Ok(Lease { room: room.to_owned(), host: host.to_owned(), epoch: row.count(0)?, time })
        });
        lease.transpose()
    }

    /// Extends each lease by its time from now on. Returns true for each lease that was renewed, and false for a
    /// lease that was released or taken.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    pub fn renew(&mut self, leases: &[Lease]) -> Result<Vec<bool>, StoreFailure> {
        let sql = "UPDATE leases SET ends_at = (SELECT ms FROM clock) + time_ms \
                   FROM json_each(?1) AS held WHERE room = held.value ->> 'room' \
                   AND host = held.value ->> 'host' \
                   AND epoch = CAST(held.value ->> 'epoch' AS BIGINT) RETURNING room, host, epoch";
        let held = leases.iter().enumerate().map(|(index, lease)| {
            let Lease { room, host, epoch, .. } = lease;
            (index.to_string(), json!({ "room": room, "host": host, "epoch": epoch }))
        });
        let held = serde_json::Value::from(held.collect::<Map<_, _>>()).to_string();
        let rows = self.database.once(|it| it.rows(sql, params![held]))?;
        let renewed = rows.iter().map(|row| Ok((row.get(0)?, row.get(1)?, row.count(2)?)));
        let renewed: BTreeSet<(String, String, u64)> =
            renewed.collect::<Result<_, StoreFailure>>()?;
        let is_renewed =
            |it: &Lease| renewed.contains(&(it.room.clone(), it.host.clone(), it.epoch));
        Ok(leases.iter().map(is_renewed).collect())
    }

    /// Ends a lease. Returns true if there was one to end.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    pub fn release(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let sql = "UPDATE leases SET host = NULL WHERE room = ?1 AND host = ?2 AND epoch = ?3";
        self.change_lease(sql, lease)
    }

    /// Ends the lease of a room that is closed forever, and forgets its epochs. Returns true if there was one to
    /// end.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    pub fn forget(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let sql = "DELETE FROM leases WHERE room = ?1 AND host = ?2 AND epoch = ?3";
        self.change_lease(sql, lease)
    }

    fn change_lease(&mut self, sql: &str, lease: &Lease) -> Result<bool, StoreFailure> {
        let values = params![lease.room, lease.host, lease.epoch as i64];
        Ok(self.database.change_rows(|it| it.execute(sql, values))? > 0)
    }
}

/// A time in milliseconds, at most a year.
pub(crate) fn milliseconds(time: Duration) -> i64 {
    const MAX_DURATION: Duration = Duration::from_hours(365 * 24);
    time.min(MAX_DURATION).as_millis() as i64
}
