//! Results that have waited for the store: recorded as soon as it answers.
//!
//! Each is a call of its own, so that those of players come in between. While the store refuses results although
//! it answers, they are tried again less often. Results that a full disk keeps in memory are written as soon as
//! there is room.

use std::sync::Weak;
use std::time::Duration;

use cellcaster::app::parts::of_steps;
use tokio::time::sleep;

use super::results::Recorder;
use super::{Shared, unix_time};
use crate::accounts::{HostStore, Late, WaitingResults};
use crate::lock::locked;
use crate::logging;

/// The time from one round to the next.
const PERIOD: Duration = Duration::from_secs(2);
/// The same after a round in which the store has refused results.
const REFUSED_PERIOD: Duration = Duration::from_mins(1);

/// Records what waits, again and again, as long as the host exists.
pub(crate) async fn record_all(shared: Weak<Shared>) {
    loop {
        let mut refused = 0;
        loop {
            // The host is not held while the store is waited for: its last owner ends the thread of the store.
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
        sleep(if refused > 0 { REFUSED_PERIOD } else { PERIOD }).await;
    }
}

/// What comes after a result.
enum Next {
    /// The result waits no more.
    Recorded,
    /// It waits on, and the next one may be tried.
    Refused,
    /// None: the store is away or full, or no more results wait.
    None,
}

impl Recorder {
    /// Records the result that waits after `skipped` others.
    fn record_late(&self, store: &mut HostStore, skipped: usize) -> Next {
        let Some(waiting) = &self.waiting else { return Next::None };
        let (late, count) = locked(waiting, |waiting| {
            let late = waiting.record(skipped, store, |name| self.world(name), unix_time());
            if matches!(late, None | Some(Late::NotNow)) {
                // The failure was logged when the first of them began to wait. It is tried again.
                _ = waiting.save();
            }
            (late, waiting.len())
        });
        self.metrics.results_waiting.set(count as i64);
        match late {
            None | Some(Late::NotNow) => return Next::None,
            Some(Late::Refused(failure)) => {
                self.failed(&failure);
                return Next::Refused;
            }
            Some(Late::Recorded(account, run)) => {
                let (level, steps) = (run.board().level(), run.tally().steps);
                logging::result_verified(account.name.as_str(), level, steps, run.rank().name());
                let level = self.catalog.title(level);
                let line = format!("your result in {level}, {}, is recorded now.", of_steps(steps));
                self.visitors.say_to(&account.key, &line);
            }
            Some(Late::Refuted(result, reason)) => {
                self.metrics.results(false).inc();
                logging::result_lost(&result.key, reason);
            }
            Some(Late::GivenUp(result, failure)) => logging::result_lost(&result.key, failure),
        }
        Next::Recorded
    }

    /// Leaves everything on the disk when the host ends: results that wait in memory, and the log of the store.
    pub(crate) fn end(&self, store: &mut HostStore) {
        if let Some(waiting) = &self.waiting
            && locked(waiting, WaitingResults::save).is_err()
        {
            // The store may lie on another disk.
            while matches!(self.record_late(store, 0), Next::Recorded) {}
            if let Err(failure) = locked(waiting, WaitingResults::save) {
                logging::store_failed(format!("results that wait are lost: {failure}"));
            }
        }
        if let Err(failure) = store.checkpoint() {
            logging::store_failed(failure);
        }
    }
}
