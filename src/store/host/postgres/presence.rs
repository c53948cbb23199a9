//! Visits and hosts in the database, by its clock.

use std::time::Duration;

use super::PostgresStore;
use super::lease::milliseconds;
use crate::store::host::sql::{Database, Row, values};
use crate::store::host::{HostNotice, HostRow, Presence, StoreFailure, Visit, VisitId, Visitor};

impl Presence for PostgresStore {
    fn begin_visit(
        &mut self,
        host: &str,
        visitor: &Visitor,
        most: u32,
        time: Duration,
    ) -> Result<Option<VisitId>, StoreFailure> {
        // Of those who count the same visits, each waits for the one before. A serializable transaction would
        // meet those who count others, too, where the table is short.
        let lock = "SELECT pg_advisory_xact_lock(hashtextextended('visits of ' || ?1::text, 0))";
        let sql = "INSERT INTO visits (host, visitor, began_at, ends_at) SELECT ?1::text, ?2::text, \
                   clock_timestamp(), clock_timestamp() + ?4::bigint * interval '1 millisecond' \
                   WHERE (SELECT count(*) FROM visits \
                   WHERE visitor = ?2::text AND ends_at > clock_timestamp()) < ?3::bigint RETURNING id";
        let visitor = visitor.to_string();
        self.database.change_rows(|it| {
            it.execute(lock, values![visitor.as_str()])?;
            let row = it.row(sql, values![host, visitor.as_str(), most, milliseconds(time)])?;
            row.map(|row| row.get(0).map(VisitId)).transpose()
        })
    }

    fn renew_visits(&mut self, host: &str, time: Duration) -> Result<u64, StoreFailure> {
        let sql = "UPDATE visits SET \
                   ends_at = clock_timestamp() + ?2::bigint * interval '1 millisecond' WHERE host = ?1";
        // Those of hosts that do not come back.
        let stale = "DELETE FROM visits WHERE ends_at < clock_timestamp() - interval '1 day'";
        self.database.once(|it| {
            it.execute(stale, &[])?;
            it.execute(sql, values![host, milliseconds(time)])
        })
    }

    fn end_visit(&mut self, visit: VisitId) -> Result<(), StoreFailure> {
        let sql = "DELETE FROM visits WHERE id = ?1";
        self.database.once(|it| it.execute(sql, values![visit.0]).map(|_| ()))
    }

    fn end_visits(&mut self, host: &str) -> Result<u64, StoreFailure> {
        let sql = "DELETE FROM visits WHERE host = ?1";
        self.database.change_rows(|it| it.execute(sql, values![host]))
    }

    fn visits(&mut self) -> Result<Vec<Visit>, StoreFailure> {
        let sql = "SELECT id, host, visitor, \
                   (extract(epoch FROM clock_timestamp() - began_at) * 1000)::bigint \
                   FROM visits WHERE ends_at > clock_timestamp() ORDER BY id";
        self.database.once(|it| it.rows(sql, &[])?.iter().map(visit).collect())
    }

    fn announce(&mut self, notice: &HostNotice) -> Result<(), StoreFailure> {
        let sql = "INSERT INTO hosts (name, version, address, load, seen_at) \
                   VALUES (?1, ?2, ?3, ?4, clock_timestamp()) ON CONFLICT (name) DO UPDATE SET \
                   version = excluded.version, address = excluded.address, load = excluded.load, \
                   seen_at = clock_timestamp()";
        let HostNotice { name, version, address, load } = notice;
        let values = values![name.as_str(), version.as_str(), address.as_str(), *load];
        self.database.once(|it| it.execute(sql, values).map(|_| ()))
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
