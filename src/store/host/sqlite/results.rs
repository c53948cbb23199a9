//! Results in the file.

use rusqlite::{Connection, OptionalExtension, Result, Row, params};

use super::accounts::{name, seconds, time};
use crate::game::{Rank, Share, Tally};
use crate::store::host::score::with_run;
use crate::store::host::{
    AccountId, DailyScore, DailyTry, Day, LevelBoard, LevelScore, UnixTime, VerifiedDescent,
    VerifiedLevel,
};
use crate::store::{Best, Improved, Reached};
use crate::world::Difficulty;

/// The columns of a [`Best`].
const BEST: &str = "steps, treasure, treasure_total, secrets, secrets_total, alarms, deaths, \
                    stunned, rank";

pub(super) fn record(
    connection: &Connection,
    account: AccountId,
    run: &VerifiedLevel,
    now: UnixTime,
) -> Result<Improved> {
    let board = run.board();
    let (level, difficulty) = (board.level(), board.difficulty().name());
    let sql =
        format!("SELECT {BEST} FROM results WHERE account = ?1 AND level = ?2 AND difficulty = ?3");
    let of_board = (account.0, level, difficulty);
    let known = connection.query_row(&sql, of_board, |row| best(row, 0)).optional()?;
    let (best, improved) = with_run(known, run);
    if improved.time {
        write(connection, account, run, best, now)?;
    } else if improved.rank {
        let sql =
            "UPDATE results SET rank = ?4 WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
        connection.execute(sql, (account.0, level, difficulty, best.rank.name()))?;
    }
    Ok(improved)
}

fn write(
    connection: &Connection,
    account: AccountId,
    run: &VerifiedLevel,
    best: Best,
    now: UnixTime,
) -> Result<()> {
    let Best { tally: Tally { steps, treasure, secrets, alarms, deaths, stunned }, rank } = best;
    let sql = format!(
        "INSERT OR REPLACE INTO results \
         (account, level, difficulty, {BEST}, verified_at, script) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14)"
    );
    let values = params![
        account.0,
        run.board().level(),
        run.board().difficulty().name(),
        steps as i64,
        treasure.found,
        treasure.total,
        secrets.found,
        secrets.total,
        alarms,
        deaths,
        stunned,
        rank.name(),
        seconds(now),
        run.script(),
    ];
    connection.execute(&sql, values).map(|_| ())
}

pub(super) fn begin_daily(
    connection: &Connection,
    account: AccountId,
    day: Day,
    now: UnixTime,
) -> Result<Option<DailyTry>> {
    let sql = "INSERT INTO dailies \
               (account, day, floors, treasure, steps, begun_at, verified_at, script) \
               VALUES (?1, ?2, 0, 0, 0, ?3, ?3, '') ON CONFLICT DO NOTHING";
    let count = connection.execute(sql, (account.0, day.number(), seconds(now)))?;
    Ok((count > 0).then_some(DailyTry { account, day }))
}

pub(super) fn record_daily(
    connection: &Connection,
    daily: &DailyTry,
    run: &VerifiedDescent,
    now: UnixTime,
) -> Result<bool> {
    let (account, day) = (daily.account.0, daily.day.number());
    let sql = "SELECT floors, treasure, steps FROM dailies WHERE account = ?1 AND day = ?2";
    let known = connection.query_row(sql, (account, day), |row| reached(row, 0)).optional()?;
    let of_day = run.day() == Some(daily.day);
    if !known.is_some_and(|known| of_day && known < run.reached()) {
        return Ok(false);
    }
    let Reached { floors, treasure, steps } = run.reached();
    let sql = "UPDATE dailies SET floors = ?3, treasure = ?4, steps = ?5, verified_at = ?6, \
               script = ?7 WHERE account = ?1 AND day = ?2";
    let values = (account, day, floors, treasure, steps as i64, seconds(now), run.script());
    connection.execute(sql, values)?;
    Ok(true)
}

pub(super) fn bests(
    connection: &Connection,
    account: AccountId,
) -> Result<Vec<(LevelBoard, Best)>> {
    let sql = format!("SELECT level, difficulty, {BEST} FROM results WHERE account = ?1");
    let mut statement = connection.prepare(&sql)?;
    let rows = statement.query_map([account.0], |row| Ok((board(row)?, best(row, 2)?)))?;
    let rows = rows.collect::<Result<Vec<_>>>()?.into_iter();
    let mut bests: Vec<_> = rows.filter_map(|(board, best)| Some((board?, best))).collect();
    bests.sort_by(|(one, _), (other, _)| one.cmp(other));
    Ok(bests)
}

pub(super) fn level_boards(connection: &Connection) -> Result<Vec<LevelBoard>> {
    let mut statement = connection.prepare("SELECT DISTINCT level, difficulty FROM results")?;
    let known = statement.query_map([], board)?.collect::<Result<Vec<_>>>()?;
    let mut boards: Vec<LevelBoard> = known.into_iter().flatten().collect();
    boards.sort();
    Ok(boards)
}

pub(super) fn level_scores(
    connection: &Connection,
    board: &LevelBoard,
    most: usize,
) -> Result<Vec<LevelScore>> {
    let sql = format!(
        "SELECT account, name, verified_at, {BEST} FROM results JOIN accounts ON id = account \
         WHERE level = ?1 AND difficulty = ?2 ORDER BY steps, verified_at, account LIMIT ?3"
    );
    let mut statement = connection.prepare(&sql)?;
    let values = (board.level(), board.difficulty().name(), limit(most));
    let scores = statement.query_map(values, |row| {
        let Best { tally, rank } = best(row, 3)?;
        let (account, name) = (AccountId(row.get(0)?), name(row, 1)?);
        Ok(LevelScore { account, name, tally, rank, verified_at: time(row, 2)? })
    })?;
    scores.collect()
}

pub(super) fn daily_scores(
    connection: &Connection,
    day: Day,
    most: usize,
) -> Result<Vec<DailyScore>> {
    let sql = "SELECT account, name, verified_at, floors, treasure, steps \
               FROM dailies JOIN accounts ON id = account WHERE day = ?1 AND floors > 0 \
               ORDER BY floors DESC, treasure DESC, steps, verified_at, account LIMIT ?2";
    let mut statement = connection.prepare(sql)?;
    let scores = statement.query_map((day.number(), limit(most)), |row| {
        let (account, name) = (AccountId(row.get(0)?), name(row, 1)?);
        Ok(DailyScore { account, name, reached: reached(row, 3)?, verified_at: time(row, 2)? })
    })?;
    scores.collect()
}

pub(super) fn script(
    connection: &Connection,
    account: AccountId,
    board: &LevelBoard,
) -> Result<Option<String>> {
    let sql = "SELECT script FROM results WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
    let values = (account.0, board.level(), board.difficulty().name());
    connection.query_row(sql, values, |row| row.get(0)).optional()
}

fn limit(most: usize) -> i64 {
    i64::try_from(most).unwrap_or(i64::MAX)
}

/// The board in the first two columns; `None` if there is none of that name any more.
fn board(row: &Row<'_>) -> Result<Option<LevelBoard>> {
    let (level, difficulty): (String, String) = (row.get(0)?, row.get(1)?);
    Ok(Difficulty::named(&difficulty).and_then(|difficulty| LevelBoard::new(&level, difficulty)))
}

/// The result in the columns [`BEST`] from `first` on.
fn best(row: &Row<'_>, first: usize) -> Result<Best> {
    let share = |column: usize| -> Result<Share> {
        Ok(Share { found: row.get(column)?, total: row.get(column + 1)? })
    };
    let tally = Tally {
        steps: steps(row, first)?,
        treasure: share(first + 1)?,
        secrets: share(first + 3)?,
        alarms: row.get(first + 5)?,
        deaths: row.get(first + 6)?,
        stunned: row.get(first + 7)?,
    };
    let rank: String = row.get(first + 8)?;
    Ok(Best { tally, rank: Rank::named(&rank).unwrap_or(Rank::Burglar) })
}

fn reached(row: &Row<'_>, first: usize) -> Result<Reached> {
    let (floors, treasure) = (row.get(first)?, row.get(first + 1)?);
    Ok(Reached { floors, treasure, steps: steps(row, first + 2)? })
}

fn steps(row: &Row<'_>, column: usize) -> Result<u64> {
    Ok(row.get::<_, i64>(column)?.max(0) as u64)
}
