//! The PostgreSQL database of a store, which several hosts share.
//!
//! Rules:
//!
//! - **A change is on the server's disk when its method returns**, unless the server is configured not to wait for its
//!   disk (`fsync = off`).
//! - **Transactions are serializable**, unless each of their statements does everything by itself. A transaction that
//!   conflicts with another one is run again, after a random wait that doubles, up to [`MAX_CONFLICTS`] times.
//! - **Each call ends after [`TIMEOUT`]**, whatever the server or the network does. Both sides enforce the limit: a
//!   timer here, and `statement_timeout` there.
//! - **A lost connection is made again.** A call that lost it before the commit is run once more. A call that lost it
//!   during the commit fails, and its sentence says that the change may be kept or not. After a failed attempt to
//!   connect, calls fail at once for [`RETRY_INTERVAL`].
//! - **The first host creates the tables**, under a lock, and gives them a version. Tables of another version are left
//!   alone, and so is a database in which another program has tables with these names.
//! - **A password is never shown.** Sentences contain neither the address as it was given nor a part of it that may
//!   belong to a misspelt password.
//! - **No text contains the character U+0000**, which PostgreSQL cannot store in a text. Names, reasons, settings and
//!   scripts have been filtered or parsed before they get here.
//!
//! Rejected: a pool of connections, because a host has one thread for its store; and a cache of prepared statements,
//! because a host runs a few statements a second. Also rejected: the crate `postgres`.
//! Its calls wait without limit for a server that has stopped without closing its connections.

mod tls;

use std::cell::Cell;
use std::error::Error as _;
use std::future::Future;
use std::thread;
use std::time::{Duration, Instant};

use rusqlite::types::{ToSqlOutput, Value, ValueRef};
use tokio::runtime::{Builder, Runtime};
use tokio::time::timeout_at;
use tokio_postgres::config::{Host, SslMode};
use tokio_postgres::error::SqlState;
use tokio_postgres::types::private::BytesMut;
use tokio_postgres::types::{FromSql, IsNull, ToSql, Type, to_sql_checked};
use tokio_postgres::{Client, Config, Error, NoTls};

use self::tls::Tls;
use super::StoreFailure;
use super::statements::{Isolation, Row, SCHEMA, Statements, VERSION};

/// The time limit for a call.
const TIMEOUT: Duration = Duration::from_secs(5);
/// The time limit for the end of a failed transaction.
const UNDO_TIMEOUT: Duration = Duration::from_secs(1);
/// The time limit for creating the tables, including the wait for another host that creates them.
const SCHEMA_TIMEOUT: Duration = Duration::from_secs(30);
/// How long calls fail at once after a failed attempt to connect.
const RETRY_INTERVAL: Duration = Duration::from_secs(1);
/// How many times a transaction is run again after conflicts.
const MAX_CONFLICTS: u32 = 12;
/// The longest wait before a transaction is run again.
const MAX_WAIT: Duration = Duration::from_millis(128);

/// The lock under which tables are created, "Cell".
const LOCK: i64 = 0x4365_6c6c;
/// The settings of a new connection. A committed change is on the disk whatever the configuration says. A host that
/// hangs holds no lock for long.
const SETTINGS: &str = "SET idle_in_transaction_session_timeout = 10000; \
    SELECT set_config('synchronous_commit', 'on', false) \
    WHERE current_setting('synchronous_commit') = 'off'";
/// PostgreSQL's names for the types in the [tables](SCHEMA). Texts are compared by their bytes, whatever the language
/// of the database.
const TYPES: [(&str, &str); 5] = [
    ("INTEGER PRIMARY KEY AUTOINCREMENT", "BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY"),
    ("INTEGER", "BIGINT"),
    ("BLOB", "BYTEA"),
    ("TEXT", "TEXT COLLATE \"C\""),
    (" STRICT", ""),
];
/// The time of the database, at the moment of the statement and not at the start of the transaction; and the version.
const CLOCK_AND_VERSION: &str = "CREATE VIEW clock AS SELECT (extract(epoch FROM clock_timestamp()) * 1000)::bigint AS ms; \
     CREATE TABLE cellcaster (version BIGINT NOT NULL)";

/// A database on a server. It connects when a connection is needed.
pub(crate) struct PostgresDatabase {
    address: Address,
    is_to_read: bool,
    /// `None` only at the end.
    runtime: Option<Runtime>,
    session: Option<Client>,
    /// The time and the failure of the last attempt to connect, if it failed.
    refused: Option<(Instant, StoreFailure)>,
}

/// The address of a database.
struct Address {
    config: Config,
    /// `None` if connections are not encrypted.
    tls: Option<Tls>,
    /// The server and the database, as sentences name them.
    shown: String,
}

/// Runs statements over a connection, up to a deadline.
struct StatementRunner<'a> {
    runtime: &'a Runtime,
    session: &'a Client,
    deadline: tokio::time::Instant,
    shown: &'a str,
    fault: Cell<Option<StatementFault>>,
}

/// The reason why a statement failed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum StatementFault {
    /// The connection is lost, and the changes of a transaction are not kept.
    Lost,
    /// It is unknown what the server has done: the time was over, or the connection was lost during a commit.
    Unknown,
    /// Another transaction came before this one, which can be run again.
    Conflict,
    /// The disk of the server is full.
    Full,
    /// The server refuses the statement.
    Refused,
}

impl PostgresDatabase {
    /// Opens the database at an address. Creates the tables if there are none.
    pub(crate) fn open(address: &str) -> Result<Self, StoreFailure> {
        let mut server = Self::new(address, false)?;
        make_tables(&server.call(SCHEMA_TIMEOUT)?)?;
        Ok(server)
    }

    /// Opens the database at an address to read from it; `None` if it has no tables.
    pub(crate) fn open_to_read(address: &str) -> Result<Option<Self>, StoreFailure> {
        let mut server = Self::new(address, true)?;
        let has_tables = has_tables(&server.call(TIMEOUT)?)?;
        Ok(has_tables.then_some(server))
    }

    fn new(address: &str, is_to_read: bool) -> Result<Self, StoreFailure> {
        let address = Address::parse(address)?;
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| {
            StoreFailure::new(format!(
                "the connection to the host's store can't be set up: {error}"
            ))
        })?;
        Ok(Self { address, is_to_read, runtime: Some(runtime), session: None, refused: None })
    }

    /// The server and the database, without a password.
    pub(crate) fn shown(&self) -> &str {
        &self.address.shown
    }

    /// Runs statements, and runs them again after a conflict or the loss of the connection.
    pub(crate) fn run<T, E: From<StoreFailure>>(
        &mut self,
        isolation: Isolation,
        mut act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        let deadline = Instant::now() + TIMEOUT;
        let (mut conflicts, mut was_lost) = (0, false);
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let call = self.call(left)?;
            let result = match isolation {
                Isolation::None => act(&call),
                Isolation::Committed => in_transaction(&call, "READ COMMITTED", &mut act),
                Isolation::Serializable => in_transaction(&call, "SERIALIZABLE", &mut act),
            };
            let failure = match result {
                Ok(value) => return Ok(value),
                Err(failure) => failure,
            };
            match call.fault.get() {
                Some(StatementFault::Lost) if !was_lost => {
                    self.session = None;
                    was_lost = true;
                }
                Some(StatementFault::Lost | StatementFault::Unknown) => {
                    self.session = None;
                    return Err(failure);
                }
                Some(StatementFault::Conflict) if conflicts < MAX_CONFLICTS => {
                    self.undo(isolation);
                    thread::sleep(wait(conflicts));
                    conflicts += 1;
                }
                Some(StatementFault::Conflict | StatementFault::Full | StatementFault::Refused)
                | None => {
                    self.undo(isolation);
                    return Err(failure);
                }
            }
        }
    }

    /// Ends a failed transaction. If that fails, too, the connection is given up, and the transaction with it.
    fn undo(&mut self, isolation: Isolation) {
        if isolation == Isolation::None {
            return;
        }
        let is_undone = self.call(UNDO_TIMEOUT).is_ok_and(|call| call.batch("ROLLBACK").is_ok());
        if !is_undone {
            self.session = None;
        }
    }

    /// Starts a call that ends after `patience`. Connects if there is no connection.
    fn call(&mut self, patience: Duration) -> Result<StatementRunner<'_>, StoreFailure> {
        let deadline = tokio::time::Instant::now() + patience;
        if self.session.as_ref().is_none_or(Client::is_closed) {
            self.session = Some(self.connect(deadline)?);
        }
        let (Some(runtime), Some(session)) = (&self.runtime, &self.session) else {
            return Err(StoreFailure::new("the host's store is closed"));
        };
        let shown = self.address.shown.as_str();
        Ok(StatementRunner { runtime, session, deadline, shown, fault: Cell::new(None) })
    }

    fn connect(&mut self, deadline: tokio::time::Instant) -> Result<Client, StoreFailure> {
        if let Some((_, failure)) =
            self.refused.as_ref().filter(|(at, _)| at.elapsed() < RETRY_INTERVAL)
        {
            return Err(failure.clone());
        }
        let Some(runtime) = &self.runtime else {
            return Err(StoreFailure::new("the host's store is closed"));
        };
        let (config, read) = (&self.address.config, if self.is_to_read { "on" } else { "off" });
        let connect = async {
            // The next call notices the end of the connection.
            let client = if let Some(tls) = &self.address.tls {
                let (client, connection) = config.connect(tls.clone()).await?;
                tokio::spawn(connection);
                client
            } else {
                let (client, connection) = config.connect(NoTls).await?;
                tokio::spawn(connection);
                client
            };
            let patience = TIMEOUT.as_millis();
            let settings = format!(
                "{SETTINGS}; SET statement_timeout = {patience}; \
                 SET default_transaction_read_only = {read}"
            );
            client.batch_execute(&settings).await?;
            Ok::<_, Error>(client)
        };
        let connected = runtime.block_on(async { timeout_at(deadline, connect).await });
        let why = match connected {
            Ok(Ok(client)) => {
                self.refused = None;
                return Ok(client);
            }
            Ok(Err(error)) => reason(&error),
            Err(_) => "no answer in time".to_owned(),
        };
        let failure = StoreFailure::Away(format!("{} can't be used: {why}", self.address.shown));
        self.refused = Some((Instant::now(), failure.clone()));
        Err(failure)
    }
}

impl Drop for PostgresDatabase {
    fn drop(&mut self) {
        self.session = None;
        // This may run in a task of another runtime, which must not wait.
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

impl StatementRunner<'_> {
    /// Runs statements without parameters.
    fn batch(&self, sql: &str) -> Result<(), StoreFailure> {
        self.wait(self.session.batch_execute(sql))
    }

    /// Commits a transaction.
    fn commit(&self) -> Result<(), StoreFailure> {
        self.batch("COMMIT").map_err(|failure| match self.fault.get() {
            Some(StatementFault::Lost | StatementFault::Unknown) => {
                self.fault.set(Some(StatementFault::Unknown));
                StoreFailure::Away(format!(
                    "{failure}; the last change may or may not have been saved"
                ))
            }
            _ => failure,
        })
    }

    fn wait<T>(&self, answer: impl Future<Output = Result<T, Error>>) -> Result<T, StoreFailure> {
        let answered = self.runtime.block_on(async { timeout_at(self.deadline, answer).await });
        let (fault, why) = match answered {
            Ok(Ok(value)) => return Ok(value),
            Ok(Err(error)) => (fault(&error), reason(&error)),
            Err(_) => (StatementFault::Unknown, "no answer in time".to_owned()),
        };
        self.fault.set(Some(fault));
        let sentence = format!("{} failed: {why}", self.shown);
        Err(match fault {
            StatementFault::Lost | StatementFault::Unknown => StoreFailure::Away(sentence),
            StatementFault::Full => StoreFailure::Full(sentence),
            StatementFault::Conflict | StatementFault::Refused => StoreFailure::new(sentence),
        })
    }
}

impl Statements for StatementRunner<'_> {
    fn execute(&self, sql: &str, values: &[&dyn rusqlite::ToSql]) -> Result<u64, StoreFailure> {
        let values = parameters(values)?;
        self.wait(self.session.execute_raw(&numbered(sql), &values))
    }

    fn rows(&self, sql: &str, values: &[&dyn rusqlite::ToSql]) -> Result<Vec<Row>, StoreFailure> {
        let values: Vec<Parameter<'_>> = parameters(values)?;
        let values: Vec<_> = values.iter().map(|it| it as &(dyn ToSql + Sync)).collect();
        self.wait(async {
            let rows = self.session.query(&numbered(sql), &values).await?;
            rows.iter().map(row).collect()
        })
    }

    fn lock(&self, name: &str) -> Result<(), StoreFailure> {
        let sql = "SELECT pg_advisory_xact_lock(hashtextextended(?1, 0)) IS NULL";
        self.rows(sql, &[&name]).map(|_| ())
    }
}

/// A statement in PostgreSQL's form. Every question mark in a statement belongs to a parameter.
fn numbered(sql: &str) -> String {
    sql.replace('?', "$")
}

fn row(row: &tokio_postgres::Row) -> Result<Row, Error> {
    let values = (0..row.len()).map(|column| row.try_get(column).map(|Column(value)| value));
    values.collect::<Result<_, _>>().map(Row)
}

fn parameters<'a>(values: &'a [&dyn rusqlite::ToSql]) -> Result<Vec<Parameter<'a>>, StoreFailure> {
    Ok(values.iter().map(|value| value.to_sql().map(Parameter)).collect::<Result<_, _>>()?)
}

/// A parameter in rusqlite's form.
#[derive(Debug)]
struct Parameter<'a>(ToSqlOutput<'a>);

/// The value of a column.
struct Column(Value);

impl ToSql for Parameter<'_> {
    fn to_sql(
        &self,
        kind: &Type,
        out: &mut BytesMut,
    ) -> Result<IsNull, Box<dyn std::error::Error + Sync + Send>> {
        let value = match &self.0 {
            ToSqlOutput::Borrowed(value) => *value,
            ToSqlOutput::Owned(value) => ValueRef::from(value),
            _ => return Err("the parameter has no value".into()),
        };
        match value {
            ValueRef::Null => Ok(IsNull::Yes),
            ValueRef::Integer(number) if *kind == Type::INT8 => number.to_sql(kind, out),
            ValueRef::Blob(bytes) if *kind == Type::BYTEA => bytes.to_sql(kind, out),
            ValueRef::Text(text) if [Type::JSON, Type::TEXT].contains(kind) => {
                str::from_utf8(text)?.to_sql(kind, out)
            }
            _ => Err(format!("the parameter is of the type {kind}").into()),
        }
    }

    fn accepts(_: &Type) -> bool {
        true
    }

    to_sql_checked!();
}

impl<'a> FromSql<'a> for Column {
    fn from_sql(
        kind: &Type,
        raw: &'a [u8],
    ) -> Result<Self, Box<dyn std::error::Error + Sync + Send>> {
        Ok(Self(match *kind {
            Type::BOOL => bool::from_sql(kind, raw)?.into(),
            Type::INT8 => i64::from_sql(kind, raw)?.into(),
            Type::BYTEA => Vec::from_sql(kind, raw)?.into(),
            _ => String::from_sql(kind, raw)?.into(),
        }))
    }

    fn from_sql_null(_: &Type) -> Result<Self, Box<dyn std::error::Error + Sync + Send>> {
        Ok(Self(Value::Null))
    }

    fn accepts(kind: &Type) -> bool {
        [Type::BOOL, Type::INT8, Type::BYTEA, Type::TEXT].contains(kind)
    }
}

fn in_transaction<T, E: From<StoreFailure>>(
    call: &StatementRunner<'_>,
    isolation: &str,
    act: &mut impl FnMut(&dyn Statements) -> Result<T, E>,
) -> Result<T, E> {
    call.batch(&format!("BEGIN ISOLATION LEVEL {isolation}"))?;
    let value = act(call)?;
    call.commit()?;
    Ok(value)
}

/// A random wait of up to 1 ms, 2 ms, 4 ms and so on.
fn wait(conflicts: u32) -> Duration {
    let longest = (Duration::from_millis(1) * (1 << conflicts.min(10))).min(MAX_WAIT);
    // Without randomness, two transactions that met would meet again.
    let share = getrandom::u32().map_or(1.0, |number| f64::from(number) / f64::from(u32::MAX));
    longest.mul_f64(share)
}

/// Creates the tables if there are none, all at once or not at all.
fn make_tables(call: &StatementRunner<'_>) -> Result<(), StoreFailure> {
    // Not serializable, because it must see the tables that another host created while this one waited for the lock.
    let patience = SCHEMA_TIMEOUT.as_millis();
    call.batch(&format!("BEGIN; SET LOCAL statement_timeout = {patience}"))?;
    let made = call.batch(&format!("SELECT pg_advisory_xact_lock({LOCK})")).and_then(|()| {
        if has_tables(call)? {
            return Ok(());
        }
        let schema = TYPES.iter().fold(SCHEMA.to_owned(), |it, (name, own)| it.replace(name, own));
        call.batch(&schema)?;
        call.batch(CLOCK_AND_VERSION)?;
        call.batch(&format!("INSERT INTO cellcaster (version) VALUES ({VERSION})"))
    });
    call.batch(if made.is_ok() { "COMMIT" } else { "ROLLBACK" })?;
    made
}

/// Returns true if the database has the tables. These must be of this version.
fn has_tables(call: &StatementRunner<'_>) -> Result<bool, StoreFailure> {
    let sql = "SELECT current_setting('server_encoding') = 'UTF8', \
               to_regclass('cellcaster') IS NOT NULL, to_regclass('accounts') IS NOT NULL";
    let row = call.row(sql, &[])?;
    let row = row.ok_or_else(|| StoreFailure::new("the database did not list its tables"))?;
    let [is_utf8, has_version, has_accounts]: [bool; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
    if !is_utf8 {
        return Err(StoreFailure::new(
            "the database can't store text in all languages: create one with the encoding UTF8",
        ));
    }
    if !has_version && has_accounts {
        return Err(StoreFailure::new(
            "the database belongs to another program, because it already has a table \"accounts\": create a \
             database for the game",
        ));
    }
    if !has_version {
        return Ok(false);
    }
    let row = call.row("SELECT version FROM cellcaster", &[])?;
    let version: i64 = row.map(|row| row.get(0)).transpose()?.unwrap_or_default();
    if version == VERSION {
        return Ok(true);
    }
    let by = if version > VERSION {
        "a newer Cellcaster wrote: upgrade this one"
    } else {
        "this Cellcaster can't read: use a new database"
    };
    Err(StoreFailure::new(format!("the store has version {version}, which {by}")))
}

impl Address {
    fn parse(text: &str) -> Result<Self, StoreFailure> {
        let mut config: Config = text.parse().map_err(|_| no_address())?;
        let host = host(&config).ok_or_else(no_address)?;
        let database = config.get_dbname().or(config.get_user()).unwrap_or("").to_owned();
        // If a password contains an @ that is not written as %40, it is cut there, and its end is read as the host.
        if [&host, &database].iter().any(|part| part.contains(['@', ':'])) {
            return Err(no_address());
        }
        let is_local = host.starts_with('/');
        let is_encrypted = config.get_ssl_mode() == SslMode::Require && !is_local;
        let tls = is_encrypted.then(Tls::of_system).transpose()?;
        if tls.is_none() {
            config.ssl_mode(SslMode::Disable);
        }
        if config.get_application_name().is_none() {
            config.application_name("cellcaster");
        }
        config.connect_timeout(TIMEOUT).tcp_user_timeout(TIMEOUT);
        config.keepalives_idle(Duration::from_secs(30));
        let shown = format!("the database {database:?} at {host}");
        Ok(Self { config, tls, shown })
    }
}

/// The first server of an address; `None` if there is none.
fn host(config: &Config) -> Option<String> {
    let address = config.get_hostaddrs().first().map(ToString::to_string);
    address.or_else(|| match config.get_hosts().first()? {
        Host::Tcp(name) => Some(name.clone()),
        #[cfg(unix)]
        Host::Unix(path) => Some(path.display().to_string()),
    })
}

fn no_address() -> StoreFailure {
    StoreFailure::new(
        "the address of the store is invalid: write postgres://USER:PASSWORD@HOST:PORT/DATABASE, and in a \
         password %40 for @, %2F for / and %25 for %",
    )
}

fn fault(error: &Error) -> StatementFault {
    // A unique violation may be the only sign that another transaction has inserted the same row.
    const CONFLICTS: [&SqlState; 3] = [
        &SqlState::T_R_SERIALIZATION_FAILURE,
        &SqlState::T_R_DEADLOCK_DETECTED,
        &SqlState::UNIQUE_VIOLATION,
    ];
    // The connection is lost, or the server is ending, starting, or no longer accepts changes.
    const LOSSES: [&str; 3] = ["08", "57P", "25006"];
    match error.code() {
        Some(code) if CONFLICTS.contains(&code) => StatementFault::Conflict,
        Some(&SqlState::DISK_FULL) => StatementFault::Full,
        Some(code) if LOSSES.iter().any(|class| code.code().starts_with(class)) => {
            StatementFault::Lost
        }
        Some(_) => StatementFault::Refused,
        None if is_of_the_value(error) => StatementFault::Refused,
        None => StatementFault::Lost,
    }
}

/// Returns true if the cause is a parameter or a column, and not the connection.
fn is_of_the_value(error: &Error) -> bool {
    let text = error.to_string();
    text.starts_with("error serializing") || text.starts_with("error deserializing")
}

/// The reason for an error, as the server or the system states it.
fn reason(error: &Error) -> String {
    match (error.as_db_error(), error.source()) {
        (Some(error), _) => error.message().to_owned(),
        (None, Some(cause)) => cause.to_string(),
        (None, None) => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_shown_as_its_server_and_database() {
        for (text, shown) in [
            ("postgres://ada:geheim@db.example.org/games", "\"games\" at db.example.org"),
            ("postgresql://ada:geheim@192.0.2.7:5433", "\"ada\" at 192.0.2.7"),
            ("postgres://ada@%2Frun%2Fpostgresql/games?sslmode=disable", "at /run/postgresql"),
            ("postgres://ada:ge%40heim@host/games?sslmode=prefer", "\"games\" at host"),
        ] {
            let address = Address::parse(text).unwrap();
            assert!(address.shown.contains(shown), "{}", address.shown);
            assert!(!address.shown.contains("heim"), "{}", address.shown);
        }
    }

    #[test]
    fn invalid_addresses_are_refused_without_quoting_them() {
        for text in [
            "postgres://",
            "postgres:///games",
            "postgres://ada:geheim@host:port/games",
            "postgres://ada:ge@heim@host/games",
            "postgres://ada:ge@heim/heim@host/games",
            "postgres://ada:ge?heim=1@host/games?geheim=2",
            "postgres://ada:geheim@host/games?sslmode=geheim",
        ] {
            let Err(failure) = Address::parse(text) else { panic!("{text}") };
            let sentence = failure.to_string();
            assert!(!sentence.contains("heim") && sentence.lines().count() == 1, "{sentence}");
        }
    }
}
