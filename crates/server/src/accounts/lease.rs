//! Leases: which host has a room.
//!
//! Rules:
//!
//! - **A room has at most one holder.** A lease ends when it is released, or when its time is over without a
//!   renewal. No host takes it before that, not even its own holder: a host that was started again waits.
//! - **A lease has an epoch**, greater than that of every earlier lease of the room. No epoch is repeated while the
//!   room exists, so that what a host does under an expired lease can be told from what its successor does.
//! - **An expired lease that no host has taken can be renewed**, with its epoch.
//! - **Time is that of the store.** A host whose clock is wrong keeps no lease too long and loses none.
//! - **One statement takes, renews or ends leases**, on the newest version of their rows. So it needs no serializable
//!   transaction. All leases of a host are renewed by one statement, and so by one write to the disk.
//!
//! Rejected: locks that end with their holder's connection. A connection outlives a host that hangs,
//! and a host outlives a connection that was cut.

use std::collections::BTreeSet;
use std::time::Duration;

use rusqlite::params;
use serde_json::{Map, json};

use super::{HostStore, StoreFailure};

/// The right to have a room, for a while.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lease {
    /// The room, whose name has no control characters.
    pub room: String,
    /// The host that has it.
    pub host: String,
    /// Its number among the leases of the room.
    pub epoch: u64,
    /// How long it lasts without a renewal.
    pub time: Duration,
}

/// Leases.
impl HostStore {
    /// Takes the lease of a room for `time`, with an epoch above `above` and all earlier ones; `None` if the
    /// room has a holder. A store that was restored from a backup may know fewer epochs than its callers do.
    ///
    /// # Errors
    /// If the store can't be asked; so for each method. If the failure says that a change may be kept or not, the
    /// room may have a holder until `time` is over.
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

    /// Makes leases last for their times from now on, and returns for each whether it does. A lease that was
    /// released or taken does not.
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

    /// Ends a lease, and returns whether there was one to end.
    ///
    /// # Errors
    /// See [`acquire`](Self::acquire).
    pub fn release(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let sql = "UPDATE leases SET host = NULL WHERE room = ?1 AND host = ?2 AND epoch = ?3";
        self.change_lease(sql, lease)
    }

    /// Ends the lease of a room that is closed for ever, and forgets its epochs. Returns whether there was one to
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

/// A time in milliseconds, of at most a year.
pub(crate) fn milliseconds(time: Duration) -> i64 {
    const LONGEST: Duration = Duration::from_hours(365 * 24);
    time.min(LONGEST).as_millis() as i64
}
