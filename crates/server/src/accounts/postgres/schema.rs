//! The tables, and how a database of an older version gets them.

use super::SCHEMA_PATIENCE;
use super::session::Call;
use crate::accounts::StoreFailure;
use crate::accounts::sql::{Statements, values};

/// The lock under which tables are made, "Cell".
const LOCK: i64 = 0x4365_6c6c;
/// The statements that lead from each version to the next one. They are only ever added to.
pub(crate) const MIGRATIONS: &[&str] = &[FIRST, SECOND, THIRD, FOURTH];

/// As those of SQLite. A text is compared by its bytes, whatever the language of the database.
const FIRST: &str = r#"
CREATE TABLE accounts (
    id BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    key BYTEA NOT NULL UNIQUE CHECK (length(key) = 32),
    name TEXT NOT NULL,
    named_at BIGINT NOT NULL,
    created_at BIGINT NOT NULL,
    seen_at BIGINT NOT NULL
);

CREATE TABLE names (
    key TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    account BIGINT NOT NULL REFERENCES accounts,
    held_until BIGINT
);
CREATE INDEX names_of_account ON names (account);

CREATE TABLE settings (
    account BIGINT NOT NULL PRIMARY KEY REFERENCES accounts,
    crosshair BIGINT NOT NULL,
    compass BIGINT NOT NULL,
    bell BIGINT NOT NULL,
    ghost BIGINT NOT NULL,
    difficulty TEXT NOT NULL,
    glyphs TEXT,
    colors TEXT,
    frames_per_second BIGINT,
    configuration TEXT NOT NULL
);

CREATE TABLE bans (
    id BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    kind TEXT NOT NULL CHECK (kind IN ('key', 'name', 'addresses')),
    target TEXT NOT NULL,
    until BIGINT,
    reason TEXT NOT NULL,
    made_by TEXT NOT NULL,
    made_at BIGINT NOT NULL
);

CREATE TABLE results (
    account BIGINT NOT NULL REFERENCES accounts,
    level TEXT COLLATE "C" NOT NULL,
    difficulty TEXT COLLATE "C" NOT NULL,
    steps BIGINT NOT NULL CHECK (steps >= 0),
    treasure BIGINT NOT NULL,
    treasure_total BIGINT NOT NULL,
    secrets BIGINT NOT NULL,
    secrets_total BIGINT NOT NULL,
    alarms BIGINT NOT NULL,
    deaths BIGINT NOT NULL,
    stunned BIGINT NOT NULL,
    rank TEXT NOT NULL,
    verified_at BIGINT NOT NULL,
    script TEXT NOT NULL,
    PRIMARY KEY (account, level, difficulty)
);
CREATE INDEX results_of_board ON results (level, difficulty, steps, verified_at, account);

CREATE TABLE dailies (
    account BIGINT NOT NULL REFERENCES accounts,
    day BIGINT NOT NULL,
    floors BIGINT NOT NULL,
    treasure BIGINT NOT NULL,
    steps BIGINT NOT NULL CHECK (steps >= 0),
    begun_at BIGINT NOT NULL,
    verified_at BIGINT NOT NULL,
    script TEXT NOT NULL,
    PRIMARY KEY (account, day)
);
CREATE INDEX dailies_of_day ON dailies (day);
"#;

/// What hosts tell each other.
const SECOND: &str = r#"
CREATE TABLE leases (
    room TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    host TEXT,
    epoch BIGINT NOT NULL,
    time_ms BIGINT NOT NULL,
    ends_at TIMESTAMPTZ NOT NULL
);

CREATE TABLE visits (
    id BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    host TEXT COLLATE "C" NOT NULL,
    visitor TEXT COLLATE "C" NOT NULL,
    began_at TIMESTAMPTZ NOT NULL,
    ends_at TIMESTAMPTZ NOT NULL
);
CREATE INDEX visits_of_visitor ON visits (visitor);
CREATE INDEX visits_of_host ON visits (host);

CREATE TABLE hosts (
    name TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    version TEXT NOT NULL,
    address TEXT NOT NULL,
    load BIGINT NOT NULL,
    seen_at TIMESTAMPTZ NOT NULL
);
"#;

/// A visit counts while its host is there, whose row says so. Hosts count the accounts of networks together.
const THIRD: &str = r#"
ALTER TABLE visits DROP COLUMN ends_at;

CREATE TABLE account_rates (
    network TEXT COLLATE "C" NOT NULL PRIMARY KEY,
    whole_at_ms BIGINT NOT NULL
);
"#;

const FOURTH: &str = "ALTER TABLE settings ADD COLUMN correction TEXT";

/// What a database has.
enum Found {
    /// None of the tables.
    Nothing,
    /// The number of migrations.
    Version(usize),
}

/// Brings a database to the newest version, all at once or not at all.
pub(crate) fn migrate(call: &Call<'_>, migrations: &[&str]) -> Result<(), StoreFailure> {
    // Not serializable: what another host has made while this one waited for the lock is to be seen.
    let patience = SCHEMA_PATIENCE.as_millis();
    call.batch(&format!("BEGIN; SET LOCAL statement_timeout = {patience}"))?;
    let migrated = apply(call, migrations);
    call.batch(if migrated.is_ok() { "COMMIT" } else { "ROLLBACK" })?;
    migrated
}

fn apply(call: &Call<'_>, migrations: &[&str]) -> Result<(), StoreFailure> {
    call.batch(&format!("SELECT pg_advisory_xact_lock({LOCK})"))?;
    let known = match found(call, migrations.len())? {
        Found::Version(version) => version,
        Found::Nothing => {
            call.batch(
                "CREATE TABLE cellcaster (version BIGINT NOT NULL); \
                 INSERT INTO cellcaster (version) VALUES (0)",
            )?;
            0
        }
    };
    for (version, migration) in (1_i64..).zip(migrations).skip(known) {
        call.batch(migration)?;
        call.execute("UPDATE cellcaster SET version = ?1", values![version])?;
    }
    Ok(())
}

/// Whether a database has the tables, which must be of the newest version.
pub(crate) fn check_to_read(call: &Call<'_>) -> Result<bool, StoreFailure> {
    match found(call, MIGRATIONS.len())? {
        Found::Nothing => Ok(false),
        Found::Version(version) if version < MIGRATIONS.len() => Err(StoreFailure::new(format!(
            "the store has the older version {version}: start a host once, which renews it"
        ))),
        Found::Version(_) => Ok(true),
    }
}

/// What a database has, which may be `newest` and no newer.
fn found(call: &Call<'_>, newest: usize) -> Result<Found, StoreFailure> {
    let sql = "SELECT current_setting('server_encoding') = 'UTF8', \
               to_regclass('cellcaster') IS NOT NULL, to_regclass('accounts') IS NOT NULL";
    let row = call.row(sql, &[])?;
    let row = row.ok_or_else(|| StoreFailure::new("the database says nothing of its tables"))?;
    let [is_utf8, has_version, has_accounts]: [bool; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
    if !is_utf8 {
        return Err(StoreFailure::new(
            "the database does not hold texts of all languages: make one with the encoding UTF8",
        ));
    }
    if !has_version && has_accounts {
        return Err(StoreFailure::new(
            "the database belongs to another program: it has a table accounts, and is left as it is",
        ));
    }
    if !has_version {
        return Ok(Found::Nothing);
    }
    let row = call.row("SELECT version FROM cellcaster", &[])?;
    let version: u64 = row.map(|row| row.get(0)).transpose()?.unwrap_or_default();
    if version > newest as u64 {
        return Err(StoreFailure::new(format!(
            "the store has version {version}, which a newer Cellcaster wrote: it is left as it is"
        )));
    }
    Ok(Found::Version(version as usize))
}
