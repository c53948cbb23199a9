//! Results: a run counts once its script has been replayed.
//!
//! Results that wait for the store are recorded as soon as it is available.
//!
//! Each waiting result is a separate call to the store, so that calls for players run in between. If the
//! store is available but refuses results, they are retried less often. Results that a full disk keeps in
//! memory are written as soon as there is space.

use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;

use tokio::time::sleep;

use super::{Clock, Shared};
use crate::accounts::{
    Account, AccountId, HostStore, LateOutcome, LevelBoard, LevelScore, StoreFailure, UnixTime,
    VerifiedRun, WaitingResult, WaitingResults, verify_at,
};
use crate::line::Line;
use crate::lock::locked;
use crate::logging;
use crate::metrics::Metrics;
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{Catalog, NAME_COLUMNS};
use crate::rooms::sequencer::FinishedRun;
use crate::sessions::session::BoardRow;
use crate::visitors::Visitors;
use cellcaster::app::parts::of_steps;
use cellcaster::app::store::Improved;
use cellcaster::game::Script;
use cellcaster::world::{Difficulty, World};

/// The maximum number of board entries shown, and the lowest place that a player is told.
const MAX_ROWS: usize = 100;

/// Replays runs and records them, on the store's thread.
#[derive(Clone, Debug)]
pub(crate) struct ResultRecorder {
    pub(crate) catalog: Arc<Catalog>,
    pub(crate) clock: Clock,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) visitors: Visitors,
    /// The results that wait while the store is unreachable or full; `None` if results do not wait on this host.
    pub(crate) waiting: Option<Arc<Mutex<WaitingResults>>>,
}

impl ResultRecorder {
    /// Replays a run and records it for the account; returns a sentence for the player.
    pub(crate) fn record(
        &self,
        store: &mut HostStore,
        account: &Account,
        run: &FinishedRun,
    ) -> String {
        let now = self.clock.now();
        let run = match verify_at(&run.script, now, |name| self.world(name)) {
            Ok(run) => run,
            Err(reason) => {
                self.metrics.results(false).inc();
                logging::result_refused(account.name.as_str(), &run.level, &reason);
                return format!("The result does not count. {reason}");
            }
        };
        self.metrics.results(true).inc();
        match store.of_key(&account.key).and_then(|id| store.record(id, &run, now)) {
            Ok(improved) => self.placed(store, account, &run, improved),
            Err(failure) => {
                self.failed(&failure);
                let is_kept = self.keep(account, &run, now);
                if is_kept { kept(&failure) } else { "The host can't save your result now." }
                    .to_owned()
            }
        }
    }

    /// The world of a level.
    pub(crate) fn world(&self, name: &str) -> Option<World> {
        self.catalog.world(name).map(Arc::unwrap_or_clone)
    }

    pub(crate) fn failed(&self, failure: &StoreFailure) {
        self.metrics.store_errors.inc();
        logging::store_failed(failure);
    }

    /// The sentence for a recorded run: its time, its rank and its place on the board.
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
        let scores = store.level_scores(run.board(), MAX_ROWS).unwrap_or_else(|failure| {
            self.failed(&failure);
            Vec::new()
        });
        match scores.iter().position(|score| score.account == account.id) {
            Some(place) => format!("{what} You are number {}.", place + 1),
            None => what,
        }
    }

    /// Keeps a run until the store accepts it, on disk or else in memory. Returns whether it was kept.
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

/// The sentence for a player whose result waits because of `failure`.
fn kept(failure: &StoreFailure) -> &'static str {
    match failure {
        StoreFailure::Away(_) => {
            "The host can't reach its database; your result is kept and will be recorded."
        }
        StoreFailure::Full(_) => "The host's disk is full; your result waits until there is space.",
        StoreFailure::Refused(_) => {
            "The host can't record your result now; it is kept and will be recorded."
        }
    }
}

/// The entries of a board for display.
pub(crate) fn board(
    store: &mut HostStore,
    level: &str,
    difficulty: Difficulty,
    own: Option<AccountId>,
) -> Vec<BoardRow> {
    let Some(board) = LevelBoard::new(level, difficulty) else { return Vec::new() };
    let scores = store.level_scores(&board, MAX_ROWS).unwrap_or_else(|failure| {
        logging::store_failed(failure);
        Vec::new()
    });
    let row = |score: LevelScore| {
        Some(BoardRow {
            name: Line::of(score.name.as_str(), NAME_COLUMNS)?,
            steps: score.tally.steps,
            rank: score.rank,
            is_own: own == Some(score.account),
        })
    };
    scores.into_iter().filter_map(row).collect()
}

/// The run of a player on the board of a level.
///
/// # Errors
/// A sentence, if the board has no such run.
pub(crate) fn run(
    store: &mut HostStore,
    catalog: &Arc<Catalog>,
    (level, difficulty): (&str, Difficulty),
    name: Line,
) -> Result<RoomRecord, String> {
    let found = LevelBoard::new(level, difficulty).and_then(|board| {
        let scores = store.level_scores(&board, MAX_ROWS).ok()?;
        let score = scores.into_iter().find(|score| score.name.as_str() == name.as_str())?;
        let text = store.script(score.account, &board).ok()??;
        RoomRecord::of_script(&Script::parse(&text, "the script").ok()?, name, catalog)
    });
    found.ok_or_else(|| "The run cannot be shown: it is no longer on the board.".to_owned())
}

/// The pause between two passes over the waiting results.
const INTERVAL: Duration = Duration::from_secs(2);
/// The pause after a pass in which the store has refused results.
const REFUSED_INTERVAL: Duration = Duration::from_mins(1);

/// Records the waiting results in repeated passes, for as long as the host exists.
pub(crate) async fn record_all(shared: Weak<Shared>) {
    loop {
        let mut refused = 0;
        loop {
            // The host is not held while waiting: its last owner shuts down the store's thread.
            let Some(answer) = shared.upgrade().map(|shared| {
                let recorder = shared.recorder.clone();
                shared.store.call(move |store| recorder.record_late(store, refused))
            }) else {
                return;
            };
            match answer.await {
                Ok(Next::Recorded) => {}
                Ok(Next::Refused) => refused += 1,
                Ok(Next::None) | Err(_) => break,
            }
        }
        sleep(if refused > 0 { REFUSED_INTERVAL } else { INTERVAL }).await;
    }
}

/// The step that follows an attempt to record a result.
enum Next {
    /// The result is settled: go on.
    Recorded,
    /// The result stays; try the one after it.
    Refused,
    /// Stop: the store is unreachable or full, or no more results wait.
    None,
}

impl ResultRecorder {
    /// Tries to record the result after the first `skipped` ones.
    fn record_late(&self, store: &mut HostStore, skipped: usize) -> Next {
        let Some(waiting) = &self.waiting else { return Next::None };
        let (late, count) = locked(waiting, |waiting| {
            let late = waiting.record(skipped, store, |name| self.world(name), self.clock.now());
            if matches!(late, None | Some(LateOutcome::NotNow)) {
                // The error was logged when the first of these results began to wait. Saving is tried again later.
                _ = waiting.save();
            }
            (late, waiting.len())
        });
        self.metrics.results_waiting.set(count as i64);
        match late {
            None | Some(LateOutcome::NotNow) => return Next::None,
            Some(LateOutcome::Refused(failure)) => {
                self.failed(&failure);
                return Next::Refused;
            }
            Some(LateOutcome::Recorded(account, run)) => {
                let (level, steps) = (run.board().level(), run.tally().steps);
                logging::result_verified(account.name.as_str(), level, steps, run.rank().name());
                let level = self.catalog.title(level);
                let line =
                    format!("your result in {level}, {}, has been recorded.", of_steps(steps));
                self.visitors.say_to(&account.key, &line);
            }
            Some(LateOutcome::Refuted(result, reason)) => {
                self.metrics.results(false).inc();
                logging::result_lost(&result.key, reason);
            }
            Some(LateOutcome::GivenUp(result, failure)) => {
                logging::result_lost(&result.key, failure);
            }
        }
        Next::Recorded
    }

    /// Writes everything to disk when the host shuts down: the results in memory, and the store's log.
    pub(crate) fn end(&self, store: &mut HostStore) {
        if let Some(waiting) = &self.waiting
            && locked(waiting, WaitingResults::save).is_err()
        {
            // The store may be on another disk, which still has space.
            while matches!(self.record_late(store, 0), Next::Recorded) {}
            if let Err(failure) = locked(waiting, WaitingResults::save) {
                logging::store_failed(format!("waiting results are lost: {failure}"));
            }
        }
        if let Err(failure) = store.checkpoint() {
            logging::store_failed(failure);
        }
    }
}
