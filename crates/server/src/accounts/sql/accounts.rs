//! Accounts, names and settings in a database.

use std::num::NonZeroU32;

use super::{Row, Statements, bans, values};
use crate::accounts::rate::milliseconds;
use crate::accounts::{
    Account, AccountId, AccountKey, AccountSettings, Identity, NAME_HELD, Name, Origin,
    RENAME_WAIT, Refusal, StoreFailure, UnixTime, ban,
};
use cellcaster::app::parts::Choice;
use cellcaster::app::store::Preferences;
use cellcaster::world::Difficulty;

const COLUMNS: &str = "id, key, name, named_at, created_at, seen_at";

pub(crate) fn of_key(
    database: &dyn Statements,
    key: &AccountKey,
) -> Result<Option<Account>, StoreFailure> {
    let sql = format!("SELECT {COLUMNS} FROM accounts WHERE key = ?1");
    database.row(&sql, values![&key.bytes()[..]])?.as_ref().map(account).transpose()
}

pub(crate) fn named(
    database: &dyn Statements,
    name: &Name,
) -> Result<Option<Account>, StoreFailure> {
    let sql = format!(
        "SELECT {COLUMNS} FROM accounts WHERE id IN \
         (SELECT account FROM names WHERE key IN (?1, ?2) AND held_until IS NULL) \
         ORDER BY name <> ?3, id LIMIT 1"
    );
    let keys = name.keys();
    let [first, last] = [keys.first(), keys.last()].map(Option::<&String>::cloned);
    database.row(&sql, values![first, last, name.as_str()])?.as_ref().map(account).transpose()
}

pub(crate) fn create(
    database: &dyn Statements,
    origin: Option<&Origin>,
    key: &AccountKey,
    name: &Name,
    now: UnixTime,
) -> Result<Account, Refusal> {
    if of_key(database, key)?.is_some() {
        return Err(Refusal::KeyKnown);
    }
    check_name(database, None, name, now)?;
    if let Some(origin) = origin {
        count_origin(database, origin, now)?;
    }
    let sql = "INSERT INTO accounts (key, name, named_at, created_at, seen_at) \
               VALUES (?1, ?2, ?3, ?3, ?3) RETURNING id";
    let row = database.row(sql, values![&key.bytes()[..], name.as_str(), now])?;
    let row = row.ok_or_else(|| StoreFailure::new("the host's store made no account"))?;
    let id: AccountId = row.get(0)?;
    take_name(database, id, name)?;
    let (key, name) = (*key, name.clone());
    Ok(Account { id, key, name, named_at: now, created_at: now, seen_at: now })
}

pub(crate) fn rename(
    database: &dyn Statements,
    id: AccountId,
    name: &Name,
    now: UnixTime,
) -> Result<Account, Refusal> {
    let sql = format!("SELECT {COLUMNS} FROM accounts WHERE id = ?1");
    let known = database.row(&sql, values![id])?.as_ref().map(account).transpose()?;
    let known = known.ok_or(Refusal::NoAccount)?;
    let next = known.named_at.after(RENAME_WAIT);
    if now < next {
        return Err(Refusal::TooEarly { next });
    }
    check_name(database, Some(id), name, now)?;
    let sql = "UPDATE names SET held_until = ?2 WHERE account = ?1 AND held_until IS NULL";
    database.execute(sql, values![id, now.after(NAME_HELD)])?;
    take_name(database, id, name)?;
    let sql = "UPDATE accounts SET name = ?2, named_at = ?3 WHERE id = ?1";
    database.execute(sql, values![id, name.as_str(), now])?;
    Ok(Account { name: name.clone(), named_at: now, ..known })
}

pub(crate) fn note_visit(
    database: &dyn Statements,
    id: AccountId,
    now: UnixTime,
) -> Result<(), StoreFailure> {
    let sql = "UPDATE accounts SET seen_at = ?2 WHERE id = ?1";
    database.execute(sql, values![id, now]).map(|_| ())
}

pub(crate) fn settings(
    database: &dyn Statements,
    id: AccountId,
) -> Result<AccountSettings, StoreFailure> {
    let sql = "SELECT crosshair, compass, bell, ghost, difficulty, glyphs, colors, \
               frames_per_second, configuration, correction FROM settings WHERE account = ?1";
    let Some(row) = database.row(sql, values![id])? else {
        return Ok(AccountSettings::default());
    };
    let difficulty: String = row.get(4)?;
    let [glyphs, colors]: [Option<String>; 2] = [row.get(5)?, row.get(6)?];
    let frames: Option<u32> = row.get(7)?;
    let correction: Option<String> = row.get(9)?;
    let preferences = Preferences {
        crosshair: row.get(0)?,
        compass: row.get(1)?,
        bell: row.get(2)?,
        ghost: row.get(3)?,
        difficulty: Difficulty::named(&difficulty).unwrap_or_default(),
        glyphs: glyphs.and_then(|name| Choice::named(&name)),
        colors: colors.and_then(|name| Choice::named(&name)),
        correction: correction.and_then(|name| Choice::named(&name)).unwrap_or_default(),
        frames_per_second: frames.and_then(NonZeroU32::new),
    };
    Ok(AccountSettings { preferences, configuration: row.get(8)? })
}

pub(crate) fn set_settings(
    database: &dyn Statements,
    id: AccountId,
    settings: &AccountSettings,
) -> Result<(), StoreFailure> {
    let AccountSettings { preferences, configuration } = settings;
    let Preferences { crosshair, compass, bell, ghost, difficulty, .. } = *preferences;
    let [glyphs, colors] =
        [preferences.glyphs.map(Choice::name), preferences.colors.map(Choice::name)];
    let frames = preferences.frames_per_second.map(NonZeroU32::get);
    let sql = "INSERT INTO settings (account, crosshair, compass, bell, ghost, difficulty, glyphs, \
               colors, frames_per_second, configuration, correction) \
               VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11) \
               ON CONFLICT (account) DO UPDATE SET crosshair = excluded.crosshair, \
               compass = excluded.compass, bell = excluded.bell, ghost = excluded.ghost, \
               difficulty = excluded.difficulty, glyphs = excluded.glyphs, \
               colors = excluded.colors, frames_per_second = excluded.frames_per_second, \
               configuration = excluded.configuration, correction = excluded.correction";
    let values = values![
        id,
        crosshair,
        compass,
        bell,
        ghost,
        difficulty.name(),
        glyphs,
        colors,
        frames,
        configuration.as_str(),
        preferences.correction.name()
    ];
    database.execute(sql, values).map(|_| ())
}

fn account(row: &Row) -> Result<Account, StoreFailure> {
    Ok(Account {
        id: row.get(0)?,
        key: AccountKey::new(row.get(1)?),
        name: row.get(2)?,
        named_at: row.get(3)?,
        created_at: row.get(4)?,
        seen_at: row.get(5)?,
    })
}

/// Counts a new account of a network, and forgets the networks that have their whole allowance.
fn count_origin(database: &dyn Statements, origin: &Origin, now: UnixTime) -> Result<(), Refusal> {
    let network = origin.network.to_string();
    let network = network.as_str();
    let sql = "SELECT whole_at_ms FROM account_rates WHERE network = ?1";
    let row = database.row(sql, values![network])?;
    let known = row.map(|row| row.get(0)).transpose()?;
    let whole_at = origin.count(known, now)?;
    let sql = "DELETE FROM account_rates WHERE whole_at_ms <= ?1";
    database.execute(sql, values![milliseconds(now)])?;
    let sql = "INSERT INTO account_rates (network, whole_at_ms) VALUES (?1, ?2) \
               ON CONFLICT (network) DO UPDATE SET whole_at_ms = excluded.whole_at_ms";
    database.execute(sql, values![network, whole_at])?;
    Ok(())
}

/// Refuses a name that is banned, or belongs to another account than `own`.
fn check_name(
    database: &dyn Statements,
    own: Option<AccountId>,
    name: &Name,
    now: UnixTime,
) -> Result<(), Refusal> {
    let identity = Identity { name: Some(name), ..Identity::default() };
    if ban::applying(bans::in_force(database, now)?, &identity).is_some() {
        return Err(Refusal::NameBanned);
    }
    let sql = "SELECT account FROM names WHERE key = ?1 AND account IS DISTINCT FROM ?2 \
               AND (held_until IS NULL OR held_until > ?3)";
    for key in name.keys() {
        if database.row(sql, values![key, own, now])?.is_some() {
            return Err(Refusal::NameTaken);
        }
    }
    Ok(())
}

fn take_name(database: &dyn Statements, id: AccountId, name: &Name) -> Result<(), StoreFailure> {
    let sql = "INSERT INTO names (key, account, held_until) VALUES (?1, ?2, NULL) \
               ON CONFLICT (key) DO UPDATE SET account = excluded.account, held_until = NULL";
    for key in name.keys() {
        database.execute(sql, values![key, id])?;
    }
    Ok(())
}
