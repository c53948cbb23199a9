//! Bans in the file.

use rusqlite::{Connection, Result, Row};

use super::accounts::{seconds, time};
use crate::store::host::{AccountKey, AddressPrefix, Ban, BanTarget, Name, UnixTime};

const KEY: &str = "key";
const NAME: &str = "name";
const ADDRESSES: &str = "addresses";

pub(super) fn add(connection: &Connection, ban: &Ban) -> Result<()> {
    remove(connection, &ban.target)?;
    let (kind, target) = match &ban.target {
        BanTarget::Key(key) => (KEY, key.to_string()),
        BanTarget::Name(name) => (NAME, name.to_string()),
        BanTarget::Addresses(prefix) => (ADDRESSES, prefix.to_string()),
    };
    let sql = "INSERT INTO bans (kind, target, until, reason, made_by, made_at) \
               VALUES (?1, ?2, ?3, ?4, ?5, ?6)";
    let until = ban.until.map(seconds);
    let values = (kind, target, until, &ban.reason, &ban.by, seconds(ban.made_at));
    connection.execute(sql, values).map(|_| ())
}

pub(super) fn remove(connection: &Connection, target: &BanTarget) -> Result<bool> {
    let mut removed = false;
    for (id, ban) in all(connection)? {
        if ban.target.is_same(target) {
            connection.execute("DELETE FROM bans WHERE id = ?1", [id])?;
            removed = true;
        }
    }
    Ok(removed)
}

pub(super) fn in_force(connection: &Connection, now: UnixTime) -> Result<Vec<Ban>> {
    let bans = all(connection)?.into_iter().map(|(_, ban)| ban);
    Ok(bans.filter(|ban| ban.is_in_force(now)).collect())
}

/// All bans with their numbers, in the order in which they were made.
fn all(connection: &Connection) -> Result<Vec<(i64, Ban)>> {
    let sql = "SELECT id, kind, target, until, reason, made_by, made_at FROM bans ORDER BY id";
    let mut statement = connection.prepare(sql)?;
    let bans = statement.query_map([], ban)?.collect::<Result<Vec<_>>>()?;
    Ok(bans.into_iter().flatten().collect())
}

/// The ban of a row; `None` if its target is none.
fn ban(row: &Row<'_>) -> Result<Option<(i64, Ban)>> {
    let (kind, text): (String, String) = (row.get(1)?, row.get(2)?);
    let target = match kind.as_str() {
        KEY => AccountKey::parse(&text).map(BanTarget::Key),
        NAME => Some(BanTarget::Name(Name::kept(&text))),
        _ => AddressPrefix::parse(&text).map(BanTarget::Addresses),
    };
    let Some(target) = target else { return Ok(None) };
    let has_end = row.get::<_, Option<i64>>(3)?.is_some();
    let until = if has_end { Some(time(row, 3)?) } else { None };
    let (reason, by) = (row.get(4)?, row.get(5)?);
    Ok(Some((row.get(0)?, Ban { target, until, reason, by, made_at: time(row, 6)? })))
}
