//! Results: a run counts after its script was replayed.

use std::sync::{Arc, Mutex};

use super::unix_time;
use crate::accounts::{
    Account, AccountId, HostStore, LevelBoard, StoreFailure, UnixTime, VerifiedRun, WaitingResult,
    WaitingResults, verify_with,
};
use crate::line::Line;
use crate::lock::locked;
use crate::logging;
use crate::metrics::Metrics;
use crate::rooms::room::{Catalog, NAME_COLUMNS};
use crate::rooms::sequencer::FinishedRun;
use crate::sessions::session::BoardRow;
use crate::visitors::Visitors;
use cellcaster::app::parts::of_steps;
use cellcaster::app::store::Improved;
use cellcaster::world::{Difficulty, World};

/// The most entries of a board that are shown, and the places that are told.
const MOST_ROWS: usize = 100;

/// What replays runs and records them, on the thread of the store.
#[derive(Clone, Debug)]
pub(crate) struct Recorder {
    pub(crate) catalog: Arc<Catalog>,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) visitors: Visitors,
    /// The results that wait for a store that is away or full; `None` where none do.
    pub(crate) waiting: Option<Arc<Mutex<WaitingResults>>>,
}

impl Recorder {
    /// Replays a run of an account and records it; a sentence about it for the player.
    pub(crate) fn record(
        &self,
        store: &mut HostStore,
        account: &Account,
        run: &FinishedRun,
    ) -> String {
        let run = match verify_with(&run.script, |name| self.world(name)) {
            Ok(run) => run,
            Err(reason) => {
                self.metrics.results(false).inc();
                logging::result_refused(account.name.as_str(), &run.level, &reason);
                return format!("The result does not count. {reason}");
            }
        };
        self.metrics.results(true).inc();
        let now = unix_time();
        match store.record(account.id, &run, now) {
            Ok(improved) => self.placed(store, account, &run, improved),
            Err(failure) => {
                self.failed(&failure);
                let is_kept = self.keep(account, &run, now);
                if is_kept { kept(&failure) } else { "The host can't keep your result now." }
                    .to_owned()
            }
        }
    }

    /// The world of a level.
    pub(crate) fn world(&self, name: &str) -> Option<World> {
        self.catalog.world(name).map(|world| World::clone(world))
    }

    pub(crate) fn failed(&self, failure: &StoreFailure) {
        self.metrics.store_errors.inc();
        logging::store_failed(failure);
    }

    /// What a run that was recorded has improved.
    fn placed(
        &self,
        store: &mut HostStore,
        account: &Account,
        run: &VerifiedRun,
        improved: Improved,
    ) -> String {
        let (steps, rank) = (run.tally().steps, run.rank());
        logging::result_verified(account.name.as_str(), run.board().level(), steps, rank.name());
        let what = if improved.time { "your best" } else { "not your best" };
        let what = format!("{}, rank {rank}: {what}.", of_steps(steps));
        let scores = store.level_scores(run.board(), MOST_ROWS).unwrap_or_else(|failure| {
            self.failed(&failure);
            Vec::new()
        });
        match scores.iter().position(|score| score.account == account.id) {
            Some(place) => format!("{what} You are number {}.", place + 1),
            None => what,
        }
    }

    /// Keeps a run until the store takes it, on the disk or else in memory. Returns whether it is kept.
    fn keep(&self, account: &Account, run: &VerifiedRun, at: UnixTime) -> bool {
        let Some(waiting) = &self.waiting else { return false };
        let result = WaitingResult { key: account.key, at, script: run.script().to_owned() };
        let (added, saved, count) = locked(waiting, |waiting| {
            let added = waiting.add(result);
            (added, waiting.save(), waiting.len())
        });
        self.metrics.results_waiting.set(count as i64);
        for failure in [&added, &saved].into_iter().filter_map(|it| it.as_ref().err()) {
            logging::store_failed(failure);
        }
        if added.is_ok() {
            logging::result_waits(account.name.as_str(), run.board().level());
        }
        added.is_ok()
    }
}

/// What a player is told whose result waits because of `failure`.
fn kept(failure: &StoreFailure) -> &'static str {
    if failure.is_away() {
        "The host can't reach its database; your result is kept and will be recorded."
    } else if failure.is_full() {
        "The host's disk is full; your result waits until there is room."
    } else {
        "The host can't record your result now; it is kept and will be recorded."
    }
}

/// The entries of a board.
pub(crate) fn board(
    store: &mut HostStore,
    level: &str,
    difficulty: Difficulty,
    own: Option<AccountId>,
) -> Vec<BoardRow> {
    let Some(board) = LevelBoard::new(level, difficulty) else { return Vec::new() };
    let scores = store.level_scores(&board, MOST_ROWS).unwrap_or_else(|failure| {
        logging::store_failed(failure);
        Vec::new()
    });
    let row = |score: crate::accounts::LevelScore| {
        Some(BoardRow {
            name: Line::of(score.name.as_str(), NAME_COLUMNS)?,
            steps: score.tally.steps,
            rank: score.rank,
            is_own: own == Some(score.account),
        })
    };
    scores.into_iter().filter_map(row).collect()
}
