//! Accounts, names and settings in the file.

use std::num::NonZeroU32;

use rusqlite::{Connection, OptionalExtension, Result, Row, params};

use super::bans;
use crate::store::Preferences;
use crate::store::host::{
    Account, AccountId, AccountKey, AccountSettings, Identity, NAME_HELD, Name, RENAME_WAIT,
    Refusal, UnixTime, ban,
};
use crate::store::values::{self, COLORS, GLYPHS, name_of};
use crate::world::Difficulty;

const COLUMNS: &str = "id, key, name, named_at, created_at, seen_at";

pub(super) fn of_key(connection: &Connection, key: &AccountKey) -> Result<Option<Account>> {
    let sql = format!("SELECT {COLUMNS} FROM accounts WHERE key = ?1");
    connection.query_row(&sql, [key.bytes()], account).optional()
}

pub(super) fn named(connection: &Connection, name: &Name) -> Result<Option<Account>> {
    let sql = format!(
        "SELECT {COLUMNS} FROM accounts WHERE id IN \
         (SELECT account FROM names WHERE key IN (?1, ?2) AND held_until IS NULL) \
         ORDER BY name <> ?3, id LIMIT 1"
    );
    let keys = name.keys();
    let values = (keys.first(), keys.last(), name.as_str());
    connection.query_row(&sql, values, account).optional()
}

pub(super) fn create(
    connection: &Connection,
    key: &AccountKey,
    name: &Name,
    now: UnixTime,
) -> Result<Account, Refusal> {
    if of_key(connection, key)?.is_some() {
        return Err(Refusal::KeyKnown);
    }
    check_name(connection, None, name, now)?;
    let sql = "INSERT INTO accounts (key, name, named_at, created_at, seen_at) \
               VALUES (?1, ?2, ?3, ?3, ?3)";
    connection.execute(sql, params![key.bytes(), name.as_str(), seconds(now)])?;
    let id = AccountId(connection.last_insert_rowid());
    take_name(connection, id, name)?;
    let (key, name) = (*key, name.clone());
    Ok(Account { id, key, name, named_at: now, created_at: now, seen_at: now })
}

pub(super) fn rename(
    connection: &Connection,
    id: AccountId,
    name: &Name,
    now: UnixTime,
) -> Result<Account, Refusal> {
    let sql = format!("SELECT {COLUMNS} FROM accounts WHERE id = ?1");
    let known = connection.query_row(&sql, [id.0], account).optional()?;
    let known = known.ok_or(Refusal::NoAccount)?;
    let next = known.named_at.after(RENAME_WAIT);
    if now < next {
        return Err(Refusal::TooEarly { next });
    }
    check_name(connection, Some(id), name, now)?;
    let sql = "UPDATE names SET held_until = ?2 WHERE account = ?1 AND held_until IS NULL";
    connection.execute(sql, (id.0, seconds(now.after(NAME_HELD))))?;
    take_name(connection, id, name)?;
    let sql = "UPDATE accounts SET name = ?2, named_at = ?3 WHERE id = ?1";
    connection.execute(sql, (id.0, name.as_str(), seconds(now)))?;
    Ok(Account { name: name.clone(), named_at: now, ..known })
}

pub(super) fn note_visit(connection: &Connection, id: AccountId, now: UnixTime) -> Result<()> {
    let sql = "UPDATE accounts SET seen_at = ?2 WHERE id = ?1";
    connection.execute(sql, (id.0, seconds(now))).map(|_| ())
}

pub(super) fn settings(connection: &Connection, id: AccountId) -> Result<AccountSettings> {
    let sql = "SELECT crosshair, compass, bell, ghost, difficulty, glyphs, colors, \
               frames_per_second, configuration FROM settings WHERE account = ?1";
    let settings = connection.query_row(sql, [id.0], |row| {
        let difficulty: String = row.get(4)?;
        let [glyphs, colors]: [Option<String>; 2] = [row.get(5)?, row.get(6)?];
        let frames: Option<u32> = row.get(7)?;
        let preferences = Preferences {
            crosshair: row.get(0)?,
            compass: row.get(1)?,
            bell: row.get(2)?,
            ghost: row.get(3)?,
            difficulty: Difficulty::named(&difficulty).unwrap_or_default(),
            glyphs: glyphs.and_then(|name| values::named(&GLYPHS, &name)),
            colors: colors.and_then(|name| values::named(&COLORS, &name)),
            frames_per_second: frames.and_then(NonZeroU32::new),
        };
        Ok(AccountSettings { preferences, configuration: row.get(8)? })
    });
    Ok(settings.optional()?.unwrap_or_default())
}

pub(super) fn set_settings(
    connection: &Connection,
    id: AccountId,
    settings: &AccountSettings,
) -> Result<()> {
    let AccountSettings { preferences, configuration } = settings;
    let Preferences { crosshair, compass, bell, ghost, difficulty, .. } = *preferences;
    let [glyphs, colors] = [
        preferences.glyphs.map(|mode| name_of(&GLYPHS, mode)),
        preferences.colors.map(|depth| name_of(&COLORS, depth)),
    ];
    let frames = preferences.frames_per_second.map(NonZeroU32::get);
    let sql = "INSERT OR REPLACE INTO settings (account, crosshair, compass, bell, ghost, \
               difficulty, glyphs, colors, frames_per_second, configuration) \
               VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)";
    let values = params![
        id.0,
        crosshair,
        compass,
        bell,
        ghost,
        difficulty.name(),
        glyphs,
        colors,
        frames,
        configuration
    ];
    connection.execute(sql, values).map(|_| ())
}

/// A time as the file has it.
pub(super) fn seconds(time: UnixTime) -> i64 {
    time.seconds() as i64
}

/// The time in a column.
pub(super) fn time(row: &Row<'_>, column: usize) -> Result<UnixTime> {
    Ok(UnixTime::new(row.get::<_, i64>(column)?.max(0) as u64))
}

/// The name in a column.
pub(super) fn name(row: &Row<'_>, column: usize) -> Result<Name> {
    Ok(Name::kept(&row.get::<_, String>(column)?))
}

fn account(row: &Row<'_>) -> Result<Account> {
    Ok(Account {
        id: AccountId(row.get(0)?),
        key: AccountKey::new(row.get(1)?),
        name: name(row, 2)?,
        named_at: time(row, 3)?,
        created_at: time(row, 4)?,
        seen_at: time(row, 5)?,
    })
}

/// Refuses a name that is banned, or belongs to another account than `own`.
fn check_name(
    connection: &Connection,
    own: Option<AccountId>,
    name: &Name,
    now: UnixTime,
) -> Result<(), Refusal> {
    let identity = Identity { name: Some(name), ..Identity::default() };
    if ban::applying(bans::in_force(connection, now)?, &identity).is_some() {
        return Err(Refusal::NameBanned);
    }
    let sql = "SELECT EXISTS (SELECT 1 FROM names WHERE key = ?1 AND account IS NOT ?2 \
               AND (held_until IS NULL OR held_until > ?3))";
    for key in name.keys() {
        let values = (key, own.map(|id| id.0), seconds(now));
        if connection.query_row(sql, values, |row| row.get(0))? {
            return Err(Refusal::NameTaken);
        }
    }
    Ok(())
}

fn take_name(connection: &Connection, id: AccountId, name: &Name) -> Result<()> {
    let sql = "INSERT OR REPLACE INTO names (key, account, held_until) VALUES (?1, ?2, NULL)";
    for key in name.keys() {
        connection.execute(sql, (key, id.0))?;
    }
    Ok(())
}
