//! Bans in a database.

use super::{Row, Statements, values};
use crate::accounts::{AccountKey, AddressPrefix, Ban, BanTarget, Name, StoreFailure, UnixTime};

const KEY: &str = "key";
const NAME: &str = "name";
const ADDRESSES: &str = "addresses";

pub(crate) fn add(database: &dyn Statements, ban: &Ban) -> Result<(), StoreFailure> {
    remove(database, &ban.target)?;
    let (kind, target) = match &ban.target {
        BanTarget::Key(key) => (KEY, key.to_string()),
        BanTarget::Name(name) => (NAME, name.to_string()),
        BanTarget::Addresses(prefix) => (ADDRESSES, prefix.to_string()),
    };
    let sql = "INSERT INTO bans (kind, target, until, reason, made_by, made_at) \
               VALUES (?1, ?2, ?3, ?4, ?5, ?6)";
    let Ban { until, reason, by, made_at, .. } = ban;
    let values = values![kind, target, *until, reason.as_str(), by.as_str(), *made_at];
    database.execute(sql, values).map(|_| ())
}

pub(crate) fn remove(database: &dyn Statements, target: &BanTarget) -> Result<bool, StoreFailure> {
    let mut removed = false;
    for (id, ban) in all(database)? {
        if ban.target.is_same(target) {
            database.execute("DELETE FROM bans WHERE id = ?1", values![id])?;
            removed = true;
        }
    }
    Ok(removed)
}

pub(crate) fn in_force(database: &dyn Statements, now: UnixTime) -> Result<Vec<Ban>, StoreFailure> {
    let bans = all(database)?.into_iter().map(|(_, ban)| ban);
    Ok(bans.filter(|ban| ban.is_in_force(now)).collect())
}

/// All bans with their numbers, in the order in which they were made.
fn all(database: &dyn Statements) -> Result<Vec<(i64, Ban)>, StoreFailure> {
    let sql = "SELECT id, kind, target, until, reason, made_by, made_at FROM bans ORDER BY id";
    let bans = database.rows(sql, &[])?.iter().map(ban).collect::<Result<Vec<_>, _>>()?;
    Ok(bans.into_iter().flatten().collect())
}

/// The ban of a row; `None` if its target is none.
fn ban(row: &Row) -> Result<Option<(i64, Ban)>, StoreFailure> {
    let (kind, text): (String, String) = (row.get(1)?, row.get(2)?);
    let target = match kind.as_str() {
        KEY => AccountKey::parse(&text).map(BanTarget::Key),
        NAME => Some(BanTarget::Name(Name::kept(&text))),
        _ => AddressPrefix::parse(&text).map(BanTarget::Addresses),
    };
    let Some(target) = target else { return Ok(None) };
    let (until, reason, by, made_at) = (row.get(3)?, row.get(4)?, row.get(5)?, row.get(6)?);
    Ok(Some((row.get(0)?, Ban { target, until, reason, by, made_at })))
}
