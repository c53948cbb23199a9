//! Results in a database.

use super::{Row, Statements, values};
use crate::accounts::score::with_run;
use crate::accounts::{
    AccountId, DailyScore, DailyTry, Day, LevelBoard, LevelScore, StoreFailure, UnixTime,
    VerifiedDescent, VerifiedLevel,
};
use cellcaster::app::store::{Best, Improved, Reached};
use cellcaster::game::{Rank, Share, Tally};
use cellcaster::world::Difficulty;

/// The columns of a [`Best`].
const BEST: &str = "steps, treasure, treasure_total, secrets, secrets_total, alarms, deaths, \
                    stunned, rank";

pub(crate) fn record(
    database: &dyn Statements,
    account: AccountId,
    run: &VerifiedLevel,
    now: UnixTime,
) -> Result<Improved, StoreFailure> {
    let board = run.board();
    let (level, difficulty) = (board.level(), board.difficulty().name());
    let sql =
        format!("SELECT {BEST} FROM results WHERE account = ?1 AND level = ?2 AND difficulty = ?3");
    let known = database.row(&sql, values![account, level, difficulty])?;
    let (best, improved) = with_run(known.map(|row| best(&row, 0)).transpose()?, run);
    if improved.time {
        write(database, account, run, best, now)?;
    } else if improved.rank {
        let sql =
            "UPDATE results SET rank = ?4 WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
        database.execute(sql, values![account, level, difficulty, best.rank.name()])?;
    }
    Ok(improved)
}

fn write(
    database: &dyn Statements,
    account: AccountId,
    run: &VerifiedLevel,
    best: Best,
    now: UnixTime,
) -> Result<(), StoreFailure> {
    let Best { tally: Tally { steps, treasure, secrets, alarms, deaths, stunned }, rank } = best;
    let sql = format!(
        "INSERT INTO results (account, level, difficulty, {BEST}, verified_at, script) \
         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14) \
         ON CONFLICT (account, level, difficulty) DO UPDATE SET steps = excluded.steps, \
         treasure = excluded.treasure, treasure_total = excluded.treasure_total, \
         secrets = excluded.secrets, secrets_total = excluded.secrets_total, \
         alarms = excluded.alarms, deaths = excluded.deaths, stunned = excluded.stunned, \
         rank = excluded.rank, verified_at = excluded.verified_at, script = excluded.script"
    );
    let values = values![
        account,
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
        now,
        run.script(),
    ];
    database.execute(&sql, values).map(|_| ())
}

pub(crate) fn begin_daily(
    database: &dyn Statements,
    account: AccountId,
    day: Day,
    now: UnixTime,
) -> Result<Option<DailyTry>, StoreFailure> {
    let sql = "INSERT INTO dailies \
               (account, day, floors, treasure, steps, begun_at, verified_at, script) \
               VALUES (?1, ?2, 0, 0, 0, ?3, ?3, '') ON CONFLICT (account, day) DO NOTHING";
    let count = database.execute(sql, values![account, day.number(), now])?;
    Ok((count > 0).then_some(DailyTry { account, day }))
}

pub(crate) fn record_daily(
    database: &dyn Statements,
    daily: &DailyTry,
    run: &VerifiedDescent,
    now: UnixTime,
) -> Result<bool, StoreFailure> {
    let (account, day) = (daily.account, daily.day.number());
    let sql = "SELECT floors, treasure, steps FROM dailies WHERE account = ?1 AND day = ?2";
    let known = database.row(sql, values![account, day])?;
    let known = known.map(|row| reached(&row, 0)).transpose()?;
    let of_day = run.day() == Some(daily.day);
    if !known.is_some_and(|known| of_day && known < run.reached()) {
        return Ok(false);
    }
    let Reached { floors, treasure, steps } = run.reached();
    let sql = "UPDATE dailies SET floors = ?3, treasure = ?4, steps = ?5, verified_at = ?6, \
               script = ?7 WHERE account = ?1 AND day = ?2";
    let values = values![account, day, floors, treasure, steps as i64, now, run.script()];
    database.execute(sql, values)?;
    Ok(true)
}

pub(crate) fn bests(
    database: &dyn Statements,
    account: AccountId,
) -> Result<Vec<(LevelBoard, Best)>, StoreFailure> {
    let sql = format!("SELECT level, difficulty, {BEST} FROM results WHERE account = ?1");
    let rows = database.rows(&sql, values![account])?;
    let bests = rows.iter().map(|row| Ok((board(row)?, best(row, 2)?)));
    let bests = bests.collect::<Result<Vec<_>, StoreFailure>>()?.into_iter();
    let mut bests: Vec<_> = bests.filter_map(|(board, best)| Some((board?, best))).collect();
    bests.sort_by(|(one, _), (other, _)| one.cmp(other));
    Ok(bests)
}

pub(crate) fn level_boards(database: &dyn Statements) -> Result<Vec<LevelBoard>, StoreFailure> {
    let rows = database.rows("SELECT DISTINCT level, difficulty FROM results", &[])?;
    let known = rows.iter().map(board).collect::<Result<Vec<_>, _>>()?;
    let mut boards: Vec<LevelBoard> = known.into_iter().flatten().collect();
    boards.sort();
    Ok(boards)
}

pub(crate) fn level_scores(
    database: &dyn Statements,
    board: &LevelBoard,
    most: usize,
) -> Result<Vec<LevelScore>, StoreFailure> {
    let sql = format!(
        "SELECT account, name, verified_at, {BEST} FROM results JOIN accounts ON id = account \
         WHERE level = ?1 AND difficulty = ?2 ORDER BY steps, verified_at, account LIMIT ?3"
    );
    let values = values![board.level(), board.difficulty().name(), limit(most)];
    let score = |row: &Row| {
        let Best { tally, rank } = best(row, 3)?;
        let (account, name, verified_at) = (row.get(0)?, row.get(1)?, row.get(2)?);
        Ok(LevelScore { account, name, tally, rank, verified_at })
    };
    database.rows(&sql, values)?.iter().map(score).collect()
}

pub(crate) fn daily_scores(
    database: &dyn Statements,
    day: Day,
    most: usize,
) -> Result<Vec<DailyScore>, StoreFailure> {
    let sql = "SELECT account, name, verified_at, floors, treasure, steps \
               FROM dailies JOIN accounts ON id = account WHERE day = ?1 AND floors > 0 \
               ORDER BY floors DESC, treasure DESC, steps, verified_at, account LIMIT ?2";
    let score = |row: &Row| {
        let (account, name, verified_at) = (row.get(0)?, row.get(1)?, row.get(2)?);
        Ok(DailyScore { account, name, reached: reached(row, 3)?, verified_at })
    };
    database.rows(sql, values![day.number(), limit(most)])?.iter().map(score).collect()
}

pub(crate) fn script(
    database: &dyn Statements,
    account: AccountId,
    board: &LevelBoard,
) -> Result<Option<String>, StoreFailure> {
    let sql = "SELECT script FROM results WHERE account = ?1 AND level = ?2 AND difficulty = ?3";
    let values = values![account, board.level(), board.difficulty().name()];
    database.row(sql, values)?.map(|row| row.get(0)).transpose()
}

fn limit(most: usize) -> i64 {
    i64::try_from(most).unwrap_or(i64::MAX)
}

/// The board in the first two columns; `None` if there is none of that name any more.
fn board(row: &Row) -> Result<Option<LevelBoard>, StoreFailure> {
    let (level, difficulty): (String, String) = (row.get(0)?, row.get(1)?);
    Ok(Difficulty::named(&difficulty).and_then(|difficulty| LevelBoard::new(&level, difficulty)))
}

/// The result in the columns [`BEST`] from `first` on.
fn best(row: &Row, first: usize) -> Result<Best, StoreFailure> {
    let share = |column: usize| -> Result<Share, StoreFailure> {
        Ok(Share { found: row.get(column)?, total: row.get(column + 1)? })
    };
    let tally = Tally {
        steps: row.get(first)?,
        treasure: share(first + 1)?,
        secrets: share(first + 3)?,
        alarms: row.get(first + 5)?,
        deaths: row.get(first + 6)?,
        stunned: row.get(first + 7)?,
    };
    let rank: String = row.get(first + 8)?;
    Ok(Best { tally, rank: Rank::named(&rank).unwrap_or(Rank::Burglar) })
}

fn reached(row: &Row, first: usize) -> Result<Reached, StoreFailure> {
    let (floors, treasure) = (row.get(first)?, row.get(first + 1)?);
    Ok(Reached { floors, treasure, steps: row.get(first + 2)? })
}
