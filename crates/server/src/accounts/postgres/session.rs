//! The connection to a server, and calls over it, each with a deadline.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::future::Future;
use std::time::{Duration, Instant};

use tokio::runtime::{Builder, Runtime};
use tokio::time::timeout_at;
use tokio_postgres::error::SqlState;
use tokio_postgres::types::ToSql;
use tokio_postgres::{Client, Error, NoTls, Statement};

use super::address::Address;
use super::{PATIENCE, PAUSE};
use crate::accounts::StoreFailure;
use crate::accounts::sql::{Row, Statements, Value};

/// What a server is told about a new connection. A change is on the disk when it is kept, whatever the
/// configuration says; a host that hangs holds no lock for long.
const SETTINGS: &str = "SET idle_in_transaction_session_timeout = 10000; \
    SELECT set_config('synchronous_commit', 'on', false) \
    WHERE current_setting('synchronous_commit') = 'off'";

/// A connection that is made when it is needed.
pub(crate) struct Link {
    address: Address,
    is_to_read: bool,
    /// `None` at the end alone.
    runtime: Option<Runtime>,
    session: Option<Session>,
    /// When a connection could not be made, and why.
    refused: Option<(Instant, StoreFailure)>,
}

/// A connection.
struct Session {
    client: Client,
    /// The statements that the server knows. A store has some thirty.
    prepared: RefCell<HashMap<String, Statement>>,
}

/// Statements over a connection, up to a deadline.
pub(crate) struct Call<'a> {
    runtime: &'a Runtime,
    session: &'a Session,
    deadline: tokio::time::Instant,
    shown: &'a str,
    fault: Cell<Option<Fault>>,
}

/// Why a statement failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    /// The connection is lost, and what a transaction has changed is not kept.
    Lost,
    /// Nobody knows what the server has done: the time was over, or the connection was lost while a change was
    /// kept.
    Unknown,
    /// Another transaction came before this one, which can be run again.
    Conflict,
    /// The disk of the server is full.
    Full,
    /// The server does not do it.
    Refused,
}

impl Link {
    pub(crate) fn new(address: Address, is_to_read: bool) -> Result<Self, StoreFailure> {
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| {
            StoreFailure::new(format!("the host's store can't have a connection: {error}"))
        })?;
        Ok(Self { address, is_to_read, runtime: Some(runtime), session: None, refused: None })
    }

    /// A call that ends after `patience`. A connection is made if there is none.
    pub(crate) fn call(&mut self, patience: Duration) -> Result<Call<'_>, StoreFailure> {
        let deadline = tokio::time::Instant::now() + patience;
        self.look_at_the_connection();
        if self.session.as_ref().is_none_or(|session| session.client.is_closed()) {
            self.session = Some(self.connect(deadline)?);
        }
        let (Some(runtime), Some(session)) = (&self.runtime, &self.session) else {
            return Err(StoreFailure::new("the host's store is closed"));
        };
        let shown = self.address.shown.as_str();
        Ok(Call { runtime, session, deadline, shown, fault: Cell::new(None) })
    }

    /// Gives a connection up, and all that is under way over it.
    pub(crate) fn close(&mut self) {
        self.session = None;
    }

    /// Notices that the server has ended the connection meanwhile, before anything is lost with it.
    fn look_at_the_connection(&self) {
        const TURNS: u32 = 3;
        if let Some(runtime) = self.runtime.as_ref().filter(|_| self.session.is_some()) {
            // A turn each for the end to be heard, for the task of the connection, and for its own end.
            runtime.block_on(async {
                for _ in 0..TURNS {
                    tokio::task::yield_now().await;
                }
            });
        }
    }

    fn connect(&mut self, deadline: tokio::time::Instant) -> Result<Session, StoreFailure> {
        if let Some((_, failure)) = self.refused.as_ref().filter(|(at, _)| at.elapsed() < PAUSE) {
            return Err(failure.clone());
        }
        let Some(runtime) = &self.runtime else {
            return Err(StoreFailure::new("the host's store is closed"));
        };
        let (config, read) = (&self.address.config, if self.is_to_read { "on" } else { "off" });
        let connect = async {
            // The end of the connection is noticed by the next call.
            let client = if let Some(tls) = &self.address.tls {
                let (client, connection) = config.connect(tls.clone()).await?;
                tokio::spawn(connection);
                client
            } else {
                let (client, connection) = config.connect(NoTls).await?;
                tokio::spawn(connection);
                client
            };
            let patience = PATIENCE.as_millis();
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
                return Ok(Session { client, prepared: RefCell::default() });
            }
            Ok(Err(error)) => reason(&error),
            Err(_) => "no answer in time".to_owned(),
        };
        let failure = StoreFailure::away(format!("{} can't be used: {why}", self.address.shown));
        self.refused = Some((Instant::now(), failure.clone()));
        Err(failure)
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.session = None;
        // It may be in a task of another runtime, which must not wait.
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

impl Call<'_> {
    /// Why the last statement failed.
    pub(crate) fn fault(&self) -> Option<Fault> {
        self.fault.get()
    }

    /// Runs statements without parameters.
    pub(crate) fn batch(&self, sql: &str) -> Result<(), StoreFailure> {
        self.wait(self.session.client.batch_execute(sql))
    }

    /// Keeps what a transaction has changed.
    pub(crate) fn commit(&self) -> Result<(), StoreFailure> {
        self.batch("COMMIT").map_err(|failure| match self.fault.get() {
            Some(Fault::Lost | Fault::Unknown) => {
                self.fault.set(Some(Fault::Unknown));
                StoreFailure::away(format!("{failure}; the last change may be kept or not"))
            }
            _ => failure,
        })
    }

    async fn prepare(&self, sql: &str) -> Result<Statement, Error> {
        let known = self.session.prepared.borrow().get(sql).cloned();
        if let Some(known) = known {
            return Ok(known);
        }
        // No statement has a question mark that is not a parameter's.
        let statement = self.session.client.prepare(&sql.replace('?', "$")).await?;
        self.session.prepared.borrow_mut().insert(sql.to_owned(), statement.clone());
        Ok(statement)
    }

    fn wait<T>(&self, answer: impl Future<Output = Result<T, Error>>) -> Result<T, StoreFailure> {
        let answered = self.runtime.block_on(async { timeout_at(self.deadline, answer).await });
        let (fault, why) = match answered {
            Ok(Ok(value)) => return Ok(value),
            Ok(Err(error)) => (fault(&error), reason(&error)),
            Err(_) => (Fault::Unknown, "no answer in time".to_owned()),
        };
        self.fault.set(Some(fault));
        let sentence = format!("{} failed: {why}", self.shown);
        Err(match fault {
            Fault::Lost | Fault::Unknown => StoreFailure::away(sentence),
            Fault::Full => StoreFailure::full(sentence),
            Fault::Conflict | Fault::Refused => StoreFailure::new(sentence),
        })
    }
}

impl Statements for Call<'_> {
    fn execute(&self, sql: &str, values: &[Value]) -> Result<u64, StoreFailure> {
        self.wait(async {
            let statement = self.prepare(sql).await?;
            self.session.client.execute(&statement, &parameters(values)).await
        })
    }

    fn rows(&self, sql: &str, values: &[Value]) -> Result<Vec<Row>, StoreFailure> {
        self.wait(async {
            let statement = self.prepare(sql).await?;
            let rows = self.session.client.query(&statement, &parameters(values)).await?;
            rows.iter().map(row).collect()
        })
    }
}

fn parameters(values: &[Value]) -> Vec<&(dyn ToSql + Sync)> {
    values.iter().map(|value| value as &(dyn ToSql + Sync)).collect()
}

fn row(row: &tokio_postgres::Row) -> Result<Row, Error> {
    (0..row.len()).map(|column| row.try_get(column)).collect::<Result<_, _>>().map(Row)
}

fn fault(error: &Error) -> Fault {
    // A transaction may learn that another one has inserted the same row from that row alone.
    const CONFLICTS: [&SqlState; 3] = [
        &SqlState::T_R_SERIALIZATION_FAILURE,
        &SqlState::T_R_DEADLOCK_DETECTED,
        &SqlState::UNIQUE_VIOLATION,
    ];
    // The connection is lost, or the server ends, begins, or is not one that takes changes any more.
    const LOSSES: [&str; 3] = ["08", "57P", "25006"];
    match error.code() {
        Some(code) if CONFLICTS.contains(&code) => Fault::Conflict,
        Some(&SqlState::DISK_FULL) => Fault::Full,
        Some(code) if LOSSES.iter().any(|class| code.code().starts_with(class)) => Fault::Lost,
        Some(_) => Fault::Refused,
        None if is_of_the_value(error) => Fault::Refused,
        None => Fault::Lost,
    }
}

/// Whether the cause is a parameter or a column, and not the connection.
fn is_of_the_value(error: &Error) -> bool {
    let text = error.to_string();
    text.starts_with("error serializing") || text.starts_with("error deserializing")
}

/// What the server or the system says.
fn reason(error: &Error) -> String {
    match (error.as_db_error(), std::error::Error::source(error)) {
        (Some(error), _) => error.message().to_owned(),
        (None, Some(cause)) => cause.to_string(),
        (None, None) => error.to_string(),
    }
}
