//! Leases in the database, each a row that stays as long as the room.
//!
//! What takes a lease, renews it or ends it is one statement, which the database runs on the newest version of
//! the row, so that it needs no serializable transaction and meets no other one. The time is `clock_timestamp()`, the
//! database's own at that moment; `now()` is that at which a transaction began.
//!
//! All leases of a host are renewed by one statement, and so by one write to the disk.

use std::collections::BTreeSet;
use std::time::Duration;

use serde_json::json;

use super::PostgresStore;
use super::value::escaped;
use crate::accounts::sql::{Database, Row, values};
use crate::accounts::{Lease, Leases, StoreFailure};

impl Leases for PostgresStore {
    fn acquire(
        &mut self,
        room: &str,
        host: &str,
        time: Duration,
        above: u64,
    ) -> Result<Option<Lease>, StoreFailure> {
        let sql = "INSERT INTO leases AS kept (room, host, epoch, time_ms, ends_at) VALUES \
                   (?1, ?2, ?4::bigint + 1, ?3::bigint, clock_timestamp() + ?3::bigint * interval '1 millisecond') \
                   ON CONFLICT (room) DO UPDATE SET host = excluded.host, epoch = greatest(kept.epoch, ?4::bigint) + 1, \
                   time_ms = excluded.time_ms, \
                   ends_at = clock_timestamp() + excluded.time_ms * interval '1 millisecond' \
                   WHERE kept.host IS NULL OR kept.ends_at <= clock_timestamp() \
                   RETURNING room, host, epoch, time_ms";
        let values = values![room, host, milliseconds(time), above as i64];
        self.database.change_rows(|it| it.row(sql, values)?.as_ref().map(lease).transpose())
    }

    fn renew(&mut self, leases: &[Lease]) -> Result<Vec<bool>, StoreFailure> {
        let sql = "UPDATE leases AS kept \
                   SET ends_at = clock_timestamp() + time_ms * interval '1 millisecond' \
                   FROM jsonb_to_recordset(?1::text::jsonb) \
                   AS held (room text, host text, epoch bigint) \
                   WHERE kept.room = held.room AND kept.host = held.host \
                   AND kept.epoch = held.epoch RETURNING kept.room, kept.host, kept.epoch";
        let held: Vec<_> = leases.iter().map(held).collect();
        let held = serde_json::Value::from(held).to_string();
        let renewed = self.database.once(|it| it.rows(sql, values![held.as_str()]))?;
        let renewed = renewed.iter().map(|row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)));
        let renewed: BTreeSet<(String, String, u64)> =
            renewed.collect::<Result<_, StoreFailure>>()?;
        let is_renewed =
            |it: &Lease| renewed.contains(&(it.room.clone(), it.host.clone(), it.epoch));
        Ok(leases.iter().map(is_renewed).collect())
    }

    fn release(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let sql = "UPDATE leases SET host = NULL WHERE room = ?1 AND host = ?2 AND epoch = ?3";
        let values = values![lease.room(), lease.host(), lease.epoch() as i64];
        self.database.change_rows(|it| Ok(it.execute(sql, values)? > 0))
    }

    fn forget(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let sql = "DELETE FROM leases WHERE room = ?1 AND host = ?2 AND epoch = ?3";
        let values = values![lease.room(), lease.host(), lease.epoch() as i64];
        self.database.change_rows(|it| Ok(it.execute(sql, values)? > 0))
    }

    fn holder(&mut self, room: &str) -> Result<Option<Lease>, StoreFailure> {
        let sql = "SELECT room, host, epoch, time_ms FROM leases \
                   WHERE room = ?1 AND host IS NOT NULL AND ends_at > clock_timestamp()";
        self.database.once(|it| it.row(sql, values![room])?.as_ref().map(lease).transpose())
    }
}

fn lease(row: &Row) -> Result<Lease, StoreFailure> {
    let time = Duration::from_millis(row.get(3)?);
    Ok(Lease { room: row.get(0)?, host: row.get(1)?, epoch: row.get(2)?, time })
}

/// A lease as a row of a list in JSON, with texts as the table has them.
fn held(lease: &Lease) -> serde_json::Value {
    json!({"room": escaped(&lease.room), "host": escaped(&lease.host), "epoch": lease.epoch})
}

/// A time in milliseconds, of at most a year.
pub(crate) fn milliseconds(time: Duration) -> i64 {
    const LONGEST: Duration = Duration::from_hours(365 * 24);
    time.min(LONGEST).as_millis() as i64
}
