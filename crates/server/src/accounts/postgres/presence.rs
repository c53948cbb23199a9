//! Visits and hosts in the database, by its clock.

use std::time::Duration;

use super::PostgresStore;
use super::lease::milliseconds;
use crate::accounts::sql::{Database, Row, values};
use crate::accounts::{
    HostNotice, HostRow, Presence, StoreFailure, Visit, VisitBegin, VisitId, Visitor,
};

impl Presence for PostgresStore {
    fn begin_visit(
        &mut self,
        host: &str,
        visitor: &Visitor,
        most: u32,
        time: Duration,
    ) -> Result<VisitBegin, StoreFailure> {
        let Some(others) = most.checked_sub(1) else {
            return Ok(VisitBegin::TooMany(Duration::ZERO));
        };
        // Of those who count the same visits, each waits for the one before. A serializable transaction would
        // meet those who count others, too, where the table is short.
        let lock = "SELECT pg_advisory_xact_lock(hashtextextended('visits of ' || ?1::text, 0))";
        let in_the_way = "SELECT (extract(epoch FROM clock_timestamp() - seen_at) * 1000)::bigint \
                          FROM visits JOIN hosts ON hosts.name = visits.host WHERE visitor = ?1 \
                          AND seen_at > clock_timestamp() - ?2::bigint * interval '1 millisecond' \
                          ORDER BY seen_at DESC OFFSET ?3 LIMIT 1";
        let sql = "INSERT INTO visits (host, visitor, began_at) \
                   VALUES (?1, ?2, clock_timestamp()) RETURNING id";
        let visitor = visitor.to_string();
        let visitor = visitor.as_str();
        self.database.change_rows(|it| {
            it.execute(lock, values![visitor])?;
            let row = it.row(in_the_way, values![visitor, milliseconds(time), others])?;
            if let Some(row) = row {
                return Ok(VisitBegin::TooMany(Duration::from_millis(row.get(0)?)));
            }
            let row = it.row(sql, values![host, visitor])?;
            let row = row.ok_or_else(|| StoreFailure::new("the host's store began no visit"))?;
            Ok(VisitBegin::Begun(VisitId(row.get(0)?)))
        })
    }

    fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure> {
        let sql = "DELETE FROM visits WHERE id = ?1";
        self.database.once(|it| it.execute(sql, values![visit.0]).map(|_| ()))
    }

    fn visits(&mut self, time: Duration) -> Result<Vec<Visit>, StoreFailure> {
        let sql = "SELECT id, host, visitor, \
                   (extract(epoch FROM clock_timestamp() - began_at) * 1000)::bigint \
                   FROM visits JOIN hosts ON hosts.name = visits.host \
                   WHERE seen_at > clock_timestamp() - ?1::bigint * interval '1 millisecond' \
                   ORDER BY id";
        let values = values![milliseconds(time)];
        self.database.once(|it| it.rows(sql, values)?.iter().map(visit).collect())
    }

    fn announce(&mut self, notice: &HostNotice) -> Result<(), StoreFailure> {
        let sql = "INSERT INTO hosts (name, version, address, load, seen_at) \
                   VALUES (?1, ?2, ?3, ?4, clock_timestamp()) ON CONFLICT (name) DO UPDATE SET \
                   version = excluded.version, address = excluded.address, load = excluded.load, \
                   seen_at = clock_timestamp()";
        // What hosts have left that do not come back.
        let stale = "WITH gone AS (DELETE FROM hosts \
                     WHERE seen_at < clock_timestamp() - interval '1 day' RETURNING name) \
                     DELETE FROM visits WHERE host IN (SELECT name FROM gone)";
        let HostNotice { name, version, address, load } = notice;
        let values = values![name.as_str(), version.as_str(), address.as_str(), *load];
        self.database.once(|it| {
            it.execute(stale, &[])?;
            it.execute(sql, values).map(|_| ())
        })
    }

    fn leave(&mut self, host: &str) -> Result<(), StoreFailure> {
        let sql =
            "WITH gone AS (DELETE FROM hosts WHERE name = ?1) DELETE FROM visits WHERE host = ?1";
        self.database.once(|it| it.execute(sql, values![host]).map(|_| ()))
    }

    fn hosts(&mut self, time: Duration) -> Result<Vec<HostRow>, StoreFailure> {
        let sql = "SELECT name, version, address, load, \
                   (extract(epoch FROM clock_timestamp() - seen_at) * 1000)::bigint FROM hosts \
                   WHERE seen_at > clock_timestamp() - ?1::bigint * interval '1 millisecond' \
                   ORDER BY name";
        let values = values![milliseconds(time)];
        self.database.once(|it| it.rows(sql, values)?.iter().map(host).collect())
    }
}

fn visit(row: &Row) -> Result<Visit, StoreFailure> {
    let (id, host, visitor): (i64, String, String) = (row.get(0)?, row.get(1)?, row.get(2)?);
    let visitor = Visitor::parse(&visitor)
        .ok_or_else(|| StoreFailure::new(format!("the visit {id} is nobody's")))?;
    Ok(Visit { id: VisitId(id), host, visitor, since: Duration::from_millis(row.get(3)?) })
}

fn host(row: &Row) -> Result<HostRow, StoreFailure> {
    let (name, version, address) = (row.get(0)?, row.get(1)?, row.get(2)?);
    let notice = HostNotice { name, version, address, load: row.get(3)? };
    Ok(HostRow { notice, ago: Duration::from_millis(row.get(4)?) })
}
