//! Results: a run counts after its script was replayed.

use super::unix_time;
use crate::game::STEPS_PER_SECOND;
use crate::server::Metrics;
use crate::server::line::Line;
use crate::server::logging::events;
use crate::server::room::{Catalog, NAME_COLUMNS};
use crate::server::sequencer::FinishedRun;
use crate::server::session::BoardRow;
use crate::store::host::{
    Account, AccountId, HostStore, LevelBoard, StoreFailure, VerifiedLevel, VerifiedRun,
    verify_with,
};
use crate::world::{Difficulty, World};

/// The most entries of a board that are shown, and the places that are told.
const MOST_ROWS: usize = 100;

/// Replays a run of an account and records it; a sentence about it for the player.
pub(super) fn record(
    store: &mut dyn HostStore,
    account: &Account,
    run: &FinishedRun,
    catalog: &Catalog,
    metrics: &Metrics,
) -> String {
    let world = |name: &str| catalog.world(name).map(|world| World::clone(world));
    let run = match verify_with(&run.script, world) {
        Ok(VerifiedRun::Level(run)) => run,
        Ok(VerifiedRun::Descent(_)) => return "The level has no board.".to_owned(),
        Err(reason) => {
            metrics.results_refused.count();
            events::result_refused(account.name.as_str(), &run.level, &reason);
            return format!("The result does not count. {reason}");
        }
    };
    metrics.results_verified.count();
    match placed(store, account.id, &run) {
        Ok(sentence) => sentence,
        Err(failure) => {
            metrics.store_errors.count();
            events::store_failed(failure);
            "The host can't keep your result now.".to_owned()
        }
    }
}

fn placed(
    store: &mut dyn HostStore,
    account: AccountId,
    run: &VerifiedLevel,
) -> Result<String, StoreFailure> {
    let improved = store.record(account, run, unix_time())?;
    let scores = store.level_scores(run.board(), MOST_ROWS)?;
    let place = scores.iter().position(|score| score.account == account);
    let (time, rank) = (clock(run.tally().steps), run.rank());
    if let Some(score) = place.map(|place| &scores[place]) {
        let (name, level) = (score.name.as_str(), run.board().level());
        events::result_verified(name, level, run.tally().steps, rank.name());
    }
    let what = if improved.time { "your best" } else { "not your best" };
    Ok(match place {
        Some(place) => format!("{time}, rank {rank}: {what}. You are number {}.", place + 1),
        None => format!("{time}, rank {rank}: {what}."),
    })
}

/// The entries of a board.
pub(super) fn board(
    store: &mut dyn HostStore,
    level: &str,
    difficulty: Difficulty,
    own: Option<AccountId>,
) -> Vec<BoardRow> {
    let Some(board) = LevelBoard::new(level, difficulty) else { return Vec::new() };
    let scores = store.level_scores(&board, MOST_ROWS).unwrap_or_else(|failure| {
        events::store_failed(failure);
        Vec::new()
    });
    let row = |score: crate::store::host::LevelScore| {
        Some(BoardRow {
            name: Line::of(score.name.as_str(), NAME_COLUMNS)?,
            steps: score.tally.steps,
            rank: score.rank,
            is_own: own == Some(score.account),
        })
    };
    scores.into_iter().filter_map(row).collect()
}

/// Steps as minutes and seconds.
fn clock(steps: u64) -> String {
    let tenths = steps * 10 / u64::from(STEPS_PER_SECOND);
    format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}
