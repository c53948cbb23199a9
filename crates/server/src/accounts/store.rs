//! Accounts, their settings, bans and results: the statements, which are the same for both databases.

use std::fmt;
use std::path::Path;

use cellcaster::app::store::{Best, Improved};
use cellcaster::game::Rank;
use cellcaster::world::Difficulty;
use rusqlite::{Connection, params};
use serde::Serialize;

use super::applying;

use super::postgres::PostgresDatabase;
use super::rate::milliseconds;
use super::results::{ScoredBoards, with_run};
use super::statements::{Isolation, Row, Statements};
use super::{
    Account, AccountId, AccountKey, AccountRefusal, AccountSettings, AddressPrefix, Ban, BanScope,
    BanTarget, Day, Identity, KEPT_DAYS, LevelBoard, LevelScore, NAME_HELD, Name, Origin,
    RENAME_INTERVAL, StoreFailure, UnixTime, VerifiedRun, sqlite,
};

/// The store of a host.
pub struct HostStore {
    pub(crate) database: Database,
}

/// A SQLite file, or a PostgreSQL server that several hosts share.
pub(crate) enum Database {
    File(Connection),
    Server(Box<PostgresDatabase>),
    /// Fails every call with this failure.
    #[cfg(test)]
    Failing(StoreFailure),
}

impl Database {
    /// Runs statements that may run twice, because they only read, or set the same values again.
    ///
    /// # Errors
    /// The errors of `act`.
    pub(crate) fn once<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        self.run(Isolation::None, act)
    }

    /// Runs a transaction, which is undone if `act` fails. Transactions take effect one after the other.
    ///
    /// # Errors
    /// The errors of `act`, and a failure to commit.
    pub(crate) fn change<T, E: From<StoreFailure>>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        self.run(Isolation::Serializable, act)
    }

    /// Runs a transaction in which each statement sees the changes that others have committed by then. It waits for
    /// transactions that change the same row.
    ///
    /// # Errors
    /// The errors of `act`, and a failure to commit.
    pub(crate) fn change_rows<T>(
        &mut self,
        act: impl FnMut(&dyn Statements) -> Result<T, StoreFailure>,
    ) -> Result<T, StoreFailure> {
        self.run(Isolation::Committed, act)
    }

    fn run<T, E: From<StoreFailure>>(
        &mut self,
        isolation: Isolation,
        act: impl FnMut(&dyn Statements) -> Result<T, E>,
    ) -> Result<T, E> {
        match self {
            Self::File(connection) => sqlite::run(connection, isolation, act),
            Self::Server(server) => server.run(isolation, act),
            #[cfg(test)]
            Self::Failing(failure) => Err(failure.clone().into()),
        }
    }
}

/// Opening a store.
impl HostStore {
    /// Opens the store in the file `host.db` of `folder`. Creates both if they do not exist.
    ///
    /// # Errors
    /// If the folder can't be used, or the file is damaged, of another version or of another program.
    pub fn open(folder: &Path) -> Result<Self, StoreFailure> {
        Ok(Self { database: Database::File(sqlite::open(folder)?) })
    }

    /// Opens the store in `folder` to read from it while a host uses it. `None` if there is none. All methods that
    /// change something fail.
    ///
    /// # Errors
    /// If it can't be read, or is of another version.
    pub fn open_to_read(folder: &Path) -> Result<Option<Self>, StoreFailure> {
        let connection = sqlite::open_to_read(folder)?;
        Ok(connection.map(|connection| Self { database: Database::File(connection) }))
    }

    /// Connects to the store at an address such as `postgres://user@host/database`. Creates the tables if there are
    /// none.
    ///
    /// # Errors
    /// If the server can't be reached, or the database is of another version or of another program.
    pub fn connect(address: &str) -> Result<Self, StoreFailure> {
        Ok(Self { database: Database::Server(Box::new(PostgresDatabase::open(address)?)) })
    }

    /// Connects to the store at an address to read from it. `None` if there is none. All methods that change something
    /// fail.
    ///
    /// # Errors
    /// If the server can't be reached, or the database is of another version.
    pub fn connect_to_read(address: &str) -> Result<Option<Self>, StoreFailure> {
        let server = PostgresDatabase::open_to_read(address)?;
        Ok(server.map(|server| Self { database: Database::Server(Box::new(server)) }))
    }

    /// The name of the server and the database, without a password; `None` for a file.
    pub(crate) fn database(&self) -> Option<&str> {
        match &self.database {
            Database::Server(server) => Some(server.shown()),
            Database::File(_) => None,
            #[cfg(test)]
            Database::Failing(_) => None,
        }
    }

    /// Copies the write-ahead log of a file into the file, for the time while no host runs.
    ///
    /// # Errors
    /// If it can't be written. Nothing is lost in that case.
    pub fn checkpoint(&mut self) -> Result<(), StoreFailure> {
        if let Database::File(connection) = &self.database {
            sqlite::checkpoint(connection)?;
        }
        Ok(())
    }
}

const ACCOUNT: &str = "id, key, name, named_at, created_at, seen_at";

/// Accounts, names and settings.
impl HostStore {
    /// The account of a key.
    ///
    /// # Errors
    /// If the store can't be read. All methods share this error.
    pub fn account(&mut self, key: &AccountKey) -> Result<Option<Account>, StoreFailure> {
        self.database.once(|it| account_of_key(it, key))
    }

    /// The number of a key's account. A number from another time may be another account's, because the database may have
    /// been replaced since.
    ///
    /// # Errors
    /// If there is no such account; also see [`account`](Self::account).
    pub(crate) fn of_key(&mut self, key: &AccountKey) -> Result<AccountId, StoreFailure> {
        let account = self.account(key)?;
        account
            .map(|account| account.id)
            .ok_or_else(|| StoreFailure::new("the account does not exist"))
    }

    /// The account with `name`, or with a name that looks like it.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn account_named(&mut self, name: &Name) -> Result<Option<Account>, StoreFailure> {
        let sql = format!(
            "SELECT {ACCOUNT} FROM accounts WHERE id IN \
             (SELECT account FROM names WHERE key IN (?1, ?2) AND held_until IS NULL) \
             ORDER BY name <> ?3, id LIMIT 1"
        );
        let keys = name.keys();
        let values = params![keys.first(), keys.last(), name];
        self.database.once(|it| it.row(&sql, values)?.as_ref().map(account).transpose())
    }

    /// Creates the account of a key, with a name. A created account counts against the rate of its `origin`, if there
    /// is one.
    ///
    /// # Errors
    /// A [`AccountRefusal`]: for example, the name is taken or banned, or the network creates too many accounts.
    pub fn create_account(
        &mut self,
        origin: Option<&Origin>,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, AccountRefusal> {
        let sql = "INSERT INTO accounts (key, name, named_at, created_at, seen_at) \
                   VALUES (?1, ?2, ?3, ?3, ?3) RETURNING id";
        self.database.change(|it| {
            if account_of_key(it, key)?.is_some() {
                return Err(AccountRefusal::KeyKnown);
            }
            check_name(it, None, name, now)?;
            if let Some(origin) = origin {
                count_origin(it, origin, now)?;
            }
            let row = it.row(sql, params![key.bytes(), name, now])?;
            let row = row
                .ok_or_else(|| StoreFailure::new("the host's store did not create the account"))?;
            let id = row.get(0)?;
            take_name(it, id, name)?;
            let (key, name) = (*key, name.clone());
            Ok(Account { id, key, name, named_at: now, created_at: now, seen_at: now })
        })
    }

    /// Changes the name of an account.
    ///
    /// # Errors
    /// [`AccountRefusal`].
    pub fn rename(
        &mut self,
        id: AccountId,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, AccountRefusal> {
        let select = format!("SELECT {ACCOUNT} FROM accounts WHERE id = ?1");
        let hold = "UPDATE names SET held_until = ?2 WHERE account = ?1 AND held_until IS NULL";
        let update = "UPDATE accounts SET name = ?2, named_at = ?3 WHERE id = ?1";
        self.database.change(|it| {
            let known = it.row(&select, params![id])?.as_ref().map(account).transpose()?;
            let known = known.ok_or(AccountRefusal::NoAccount)?;
            let next = known.named_at.after(RENAME_INTERVAL);
            if now < next {
                return Err(AccountRefusal::TooEarly { next });
            }
            check_name(it, Some(id), name, now)?;
            it.execute(hold, params![id, now.after(NAME_HELD)])?;
            take_name(it, id, name)?;
            it.execute(update, params![id, name, now])?;
            Ok(Account { name: name.clone(), named_at: now, ..known })
        })
    }

    /// Records the time of a player's visit.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn note_visit(&mut self, id: AccountId, now: UnixTime) -> Result<(), StoreFailure> {
        let sql = "UPDATE accounts SET seen_at = ?2 WHERE id = ?1";
        self.database.once(|it| it.execute(sql, params![id, now]).map(|_| ()))
    }

    /// The settings of an account; the defaults if it has none.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn settings(&mut self, id: AccountId) -> Result<AccountSettings, StoreFailure> {
        let sql = "SELECT preferences, configuration, ignored FROM settings WHERE account = ?1";
        let row = self.database.once(|it| it.row(sql, params![id]))?;
        let settings = row.map(|row| {
            // Preferences of another version become the defaults.
            let preferences = serde_json::from_str(&row.get::<String>(0)?).unwrap_or_default();
            let mut ignored: Vec<Name> =
                serde_json::from_str(&row.get::<String>(2)?).unwrap_or_default();
            ignored.truncate(AccountSettings::MAX_IGNORED);
            Ok(AccountSettings { preferences, configuration: row.get(1)?, ignored })
        });
        settings.unwrap_or_else(|| Ok(AccountSettings::default()))
    }

    /// Replaces the settings of an account.
    ///
    /// # Errors
    /// If the configuration is too long; also see [`account`](Self::account).
    pub fn set_settings(
        &mut self,
        id: AccountId,
        settings: &AccountSettings,
    ) -> Result<(), StoreFailure> {
        let AccountSettings { preferences, configuration, ignored } = settings.checked()?;
        let sql = "INSERT INTO settings (account, preferences, configuration, ignored) \
                   VALUES (?1, ?2, ?3, ?4) \
                   ON CONFLICT (account) DO UPDATE SET preferences = excluded.preferences, \
                   configuration = excluded.configuration, ignored = excluded.ignored";
        let values = params![id, json(preferences), configuration, json(ignored)];
        self.database.once(|it| it.execute(sql, values).map(|_| ()))
    }
}

/// Bans.
impl HostStore {
    /// Bans a target. The ban replaces an earlier one of the same scope and target.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn ban(&mut self, ban: &Ban) -> Result<(), StoreFailure> {
        let Ban { scope, target, until, reason, by, made_at } = ban;
        let (kind, text) = target.parts();
        let sql = "INSERT INTO bans (scope, kind, target, until, reason, made_by, made_at) \
                   VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)";
        self.database.change(|it| {
            remove_ban(it, *scope, target)?;
            let values = params![scope.name(), kind, text, until, reason, by, made_at];
            it.execute(sql, values).map(|_| ())
        })
    }

    /// Ends the ban of a target. Returns true if there was one.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn unban(&mut self, scope: BanScope, target: &BanTarget) -> Result<bool, StoreFailure> {
        self.database.change(|it| remove_ban(it, scope, target))
    }

    /// The bans of a scope in force, in the order in which they were made.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn bans(&mut self, scope: BanScope, now: UnixTime) -> Result<Vec<Ban>, StoreFailure> {
        self.database.once(|it| bans_in_force(it, scope, now))
    }

    /// The ban in force that keeps a visitor from the host. If several apply, returns the last to end.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn ban_of(
        &mut self,
        identity: &Identity<'_>,
        now: UnixTime,
    ) -> Result<Option<Ban>, StoreFailure> {
        Ok(applying(&self.bans(BanScope::Visit, now)?, identity).cloned())
    }
}

/// Results and boards.
impl HostStore {
    /// Records a run, and returns its improvements.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn record(
        &mut self,
        account: AccountId,
        run: &VerifiedRun,
        now: UnixTime,
    ) -> Result<Improved, StoreFailure> {
        let (level, difficulty) = (run.board().level(), run.board().difficulty().name());
        let select = "SELECT tally, rank FROM results \
                      WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
        let insert = "INSERT INTO results \
                      (account, level, difficulty, steps, tally, rank, verified_at, script) \
                      VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) \
                      ON CONFLICT (account, level, difficulty) DO UPDATE SET \
                      steps = excluded.steps, tally = excluded.tally, rank = excluded.rank, \
                      verified_at = excluded.verified_at, script = excluded.script";
        let set_rank =
            "UPDATE results SET rank = ?4 WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
        self.database.change(|it| {
            let known = it.row(select, params![account, level, difficulty])?;
            let (best, improved) = with_run(known.map(|row| best(&row, 0)).transpose()?, run);
            let Best { tally, rank } = best;
            if improved.time {
                let (steps, tally, script) = (tally.steps as i64, json(&tally), run.script());
                let values =
                    params![account, level, difficulty, steps, tally, rank.name(), now, script];
                it.execute(insert, values)?;
            } else if improved.rank {
                it.execute(set_rank, params![account, level, difficulty, rank.name()])?;
            }
            Ok(improved)
        })
    }

    /// The best results of an account, in the order of levels and difficulties.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn bests(&mut self, account: AccountId) -> Result<Vec<(LevelBoard, Best)>, StoreFailure> {
        let sql = "SELECT level, difficulty, tally, rank FROM results WHERE account = ?1";
        let rows = self.database.once(|it| it.rows(sql, params![account]))?;
        let bests = rows.iter().map(|row| Ok((board(row)?, best(row, 2)?)));
        let bests = bests.collect::<Result<Vec<_>, StoreFailure>>()?.into_iter();
        let mut bests: Vec<_> = bests.filter_map(|(board, best)| Some((board?, best))).collect();
        bests.sort_by_key(|(board, _)| board.order());
        Ok(bests)
    }

    /// The boards with results, in the order of levels and difficulties.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn level_boards(&mut self) -> Result<Vec<LevelBoard>, StoreFailure> {
        let sql = "SELECT DISTINCT level, difficulty FROM results";
        let rows = self.database.once(|it| it.rows(sql, &[]))?;
        let known = rows.iter().map(board).collect::<Result<Vec<_>, _>>()?;
        let mut boards: Vec<LevelBoard> = known.into_iter().flatten().collect();
        boards.sort_by_key(LevelBoard::order);
        Ok(boards)
    }

    /// All boards, each with its first `most` entries.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub(crate) fn scored_boards(&mut self, most: usize) -> Result<ScoredBoards, StoreFailure> {
        let boards = self.level_boards()?.into_iter();
        boards.map(|board| Ok((board.clone(), self.level_scores(&board, most)?))).collect()
    }

    /// The first `most` entries of a board: the fastest run of each account. Of equally fast runs, the earlier one
    /// comes first.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn level_scores(
        &mut self,
        board: &LevelBoard,
        most: usize,
    ) -> Result<Vec<LevelScore>, StoreFailure> {
        let sql = "SELECT account, name, verified_at, tally, rank \
                   FROM results JOIN accounts ON id = account \
                   WHERE level = ?1 AND difficulty = ?2 \
                   ORDER BY steps, verified_at, account LIMIT ?3";
        let most = i64::try_from(most).unwrap_or(i64::MAX);
        let values = params![board.level(), board.difficulty().name(), most];
        self.database.once(|it| it.rows(sql, values)?.iter().map(score).collect())
    }

    /// Removes the results of daily levels that are older than the kept days, by the database's clock. A host with a
    /// wrong clock therefore removes nothing. Returns the number of results.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub(crate) fn forget_dailies(&mut self) -> Result<u64, StoreFailure> {
        // The names of all daily levels have the same length, so they are in the order of the days.
        let delete = "DELETE FROM results WHERE level > 'daily-' AND level < ?1 \
                      AND level LIKE 'daily-____-__-__'";
        self.database.once(|it| {
            let now = it.row("SELECT ms / 1000 FROM clock", &[])?;
            let now = now.map_or(Ok(0), |row| row.count(0))?;
            let first = Day::of(UnixTime::new(now)).before(KEPT_DAYS - 1);
            it.execute(delete, params![first.level()])
        })
    }

    /// The script of an account's fastest run.
    ///
    /// # Errors
    /// See [`account`](Self::account).
    pub fn script(
        &mut self,
        account: AccountId,
        board: &LevelBoard,
    ) -> Result<Option<String>, StoreFailure> {
        let sql =
            "SELECT script FROM results WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
        let values = params![account, board.level(), board.difficulty().name()];
        self.database.once(|it| it.row(sql, values)?.map(|row| row.get(0)).transpose())
    }
}

impl fmt::Debug for HostStore {
    /// Leaves out the address, because it may contain a password.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HostStore").finish_non_exhaustive()
    }
}

fn account_of_key(it: &dyn Statements, key: &AccountKey) -> Result<Option<Account>, StoreFailure> {
    let sql = format!("SELECT {ACCOUNT} FROM accounts WHERE key = ?1");
    it.row(&sql, params![key.bytes()])?.as_ref().map(account).transpose()
}

/// Counts a new account for its network, and forgets the networks that have their whole allowance.
fn count_origin(it: &dyn Statements, origin: &Origin, now: UnixTime) -> Result<(), AccountRefusal> {
    let network = origin.network.to_string();
    let sql = "SELECT whole_at_ms FROM account_rates WHERE network = ?1";
    let known = it.row(sql, params![network])?.map(|row| row.get(0)).transpose()?;
    let whole_at = origin.count(known, now)?;
    let sql = "DELETE FROM account_rates WHERE whole_at_ms <= ?1";
    it.execute(sql, params![milliseconds(now)])?;
    let sql = "INSERT INTO account_rates (network, whole_at_ms) VALUES (?1, ?2) \
               ON CONFLICT (network) DO UPDATE SET whole_at_ms = excluded.whole_at_ms";
    it.execute(sql, params![network, whole_at])?;
    Ok(())
}

/// Refuses a name that is banned, or that belongs to an account other than `own`.
fn check_name(
    it: &dyn Statements,
    own: Option<AccountId>,
    name: &Name,
    now: UnixTime,
) -> Result<(), AccountRefusal> {
    let identity = Identity { name: Some(name), ..Identity::default() };
    if applying(&bans_in_force(it, BanScope::Visit, now)?, &identity).is_some() {
        return Err(AccountRefusal::NameBanned);
    }
    let sql = "SELECT account FROM names WHERE key = ?1 AND account IS DISTINCT FROM ?2 \
               AND (held_until IS NULL OR held_until > ?3)";
    for key in name.keys() {
        if it.row(sql, params![key, own, now])?.is_some() {
            return Err(AccountRefusal::NameTaken);
        }
    }
    Ok(())
}

fn take_name(it: &dyn Statements, id: AccountId, name: &Name) -> Result<(), StoreFailure> {
    let sql = "INSERT INTO names (key, account, held_until) VALUES (?1, ?2, NULL) \
               ON CONFLICT (key) DO UPDATE SET account = excluded.account, held_until = NULL";
    for key in name.keys() {
        it.execute(sql, params![key, id])?;
    }
    Ok(())
}

fn remove_ban(
    it: &dyn Statements,
    scope: BanScope,
    target: &BanTarget,
) -> Result<bool, StoreFailure> {
    let mut removed = false;
    for (id, ban) in bans(it, scope)? {
        if ban.target.is_same(target) {
            it.execute("DELETE FROM bans WHERE id = ?1", params![id])?;
            removed = true;
        }
    }
    Ok(removed)
}

fn bans_in_force(
    it: &dyn Statements,
    scope: BanScope,
    now: UnixTime,
) -> Result<Vec<Ban>, StoreFailure> {
    let bans = bans(it, scope)?.into_iter().map(|(_, ban)| ban);
    Ok(bans.filter(|ban| ban.is_in_force(now)).collect())
}

/// All bans of a scope with their numbers, in the order in which they were made. Bans with an unknown target are left out.
fn bans(it: &dyn Statements, scope: BanScope) -> Result<Vec<(i64, Ban)>, StoreFailure> {
    let sql = "SELECT id, kind, target, until, reason, made_by, made_at FROM bans \
               WHERE scope = ?1 ORDER BY id";
    let mut bans = Vec::new();
    for row in it.rows(sql, params![scope.name()])? {
        if let Some(target) = BanTarget::of_parts(&row.get::<String>(1)?, &row.get::<String>(2)?) {
            let (until, reason, by, made_at) = (row.get(3)?, row.get(4)?, row.get(5)?, row.get(6)?);
            bans.push((row.get(0)?, Ban { scope, target, until, reason, by, made_at }));
        }
    }
    Ok(bans)
}

impl BanScope {
    /// The name of a scope, as the store keeps it.
    fn name(self) -> &'static str {
        match self {
            Self::Visit => "visit",
            Self::Talk => "talk",
        }
    }
}

impl BanTarget {
    /// The kind and the text of a target, as the store keeps them.
    fn parts(&self) -> (&'static str, String) {
        match self {
            Self::Key(key) => ("key", key.to_string()),
            Self::Name(name) => ("name", name.to_string()),
            Self::Addresses(prefix) => ("addresses", prefix.to_string()),
        }
    }

    fn of_parts(kind: &str, text: &str) -> Option<Self> {
        match kind {
            "key" => AccountKey::parse(text).map(Self::Key),
            "name" => Some(Self::Name(Name::kept(text))),
            _ => AddressPrefix::parse(text).map(Self::Addresses),
        }
    }
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

/// The board in the first two columns; `None` if that level no longer exists.
fn board(row: &Row) -> Result<Option<LevelBoard>, StoreFailure> {
    let (level, difficulty): (String, String) = (row.get(0)?, row.get(1)?);
    Ok(Difficulty::named(&difficulty).and_then(|difficulty| LevelBoard::new(&level, difficulty)))
}

fn score(row: &Row) -> Result<LevelScore, StoreFailure> {
    let Best { tally, rank } = best(row, 3)?;
    let (account, name, verified_at) = (row.get(0)?, row.get(1)?, row.get(2)?);
    Ok(LevelScore { account, name, tally, rank, verified_at })
}

/// The result whose tally is in column `first` and whose rank is in the next column.
fn best(row: &Row, first: usize) -> Result<Best, StoreFailure> {
    let tally = serde_json::from_str(&row.get::<String>(first)?).map_err(|error| {
        StoreFailure::new(format!("a result in the host's store can't be read: {error}"))
    })?;
    let rank: String = row.get(first + 1)?;
    Ok(Best { tally, rank: Rank::named(&rank).unwrap_or(Rank::Burglar) })
}

fn json(value: &impl Serialize) -> String {
    // Numbers and names always have a form in JSON.
    serde_json::to_string(value).unwrap_or_default()
}
