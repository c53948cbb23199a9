//! The leaderboards for browsers, as JSON and as text.
//!
//! All browsers share the boards of the last [`INTERVAL`], so that they do not keep the store busy.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tokio::sync::Mutex;
use unicode_width::UnicodeWidthStr;

use crate::accounts::worker::CallResult;
use crate::accounts::{HostStore, LevelBoard, LevelScore, Name, StoreFailure};
use crate::logging;
use crate::rooms::room::Catalog;
use cellcaster::app::parts::of_steps;

/// The time for which boards are kept.
const INTERVAL: Duration = Duration::from_secs(30);
/// The most entries of a board.
const MAX: usize = 10;

/// Boards, each with its entries.
pub(crate) type ScoredBoards = Vec<(LevelBoard, Vec<LevelScore>)>;

/// Asks the store for boards; `None` if the host ends.
pub(crate) type AskBoards = Box<dyn Fn() -> Option<CallResult<ScoredBoards>> + Send + Sync>;

/// The boards of a host.
pub(crate) struct Boards {
    ask: AskBoards,
    latest: Mutex<Option<(Instant, ScoredBoards)>>,
}

/// The boards in a store. After a failure, those that could be read.
pub(crate) fn read(store: &mut HostStore) -> ScoredBoards {
    let mut boards = Vec::new();
    let mut read = || -> Result<(), StoreFailure> {
        for board in store.level_boards()? {
            let scores = store.level_scores(&board, MAX)?;
            boards.push((board, scores));
        }
        Ok(())
    };
    read().unwrap_or_else(logging::store_failed);
    boards
}

impl Boards {
    pub(crate) fn new(ask: AskBoards) -> Self {
        Self { ask, latest: Mutex::default() }
    }

    /// The boards of the levels that the host has, as JSON.
    pub(crate) async fn json(&self, catalog: &Catalog) -> Value {
        let entry = |(place, score): (u32, &LevelScore)| {
            json!({
                "place": place,
                "name": score.name.as_str(),
                "time": of_steps(score.tally.steps),
                "rank": score.rank.name(),
            })
        };
        let board = |(board, scores): &(LevelBoard, Vec<LevelScore>)| {
            json!({
                "level": catalog.title(board.level()),
                "difficulty": board.difficulty().name(),
                "entries": (1..).zip(scores).map(entry).collect::<Value>(),
            })
        };
        self.with(catalog, |boards| boards.iter().map(board).collect()).await
    }

    /// The same boards as text.
    pub(crate) async fn text(&self, catalog: &Catalog) -> String {
        let text = |boards: &ScoredBoards| {
            let mut text = String::new();
            for (board, scores) in boards {
                // Writing to a string cannot fail.
                let title = catalog.title(board.level());
                _ = writeln!(text, "{title}, {}", board.difficulty().name());
                for (place, LevelScore { name, tally, rank, .. }) in (1..).zip(scores) {
                    let blanks = Name::MAX_COLUMNS.saturating_sub(name.as_str().width());
                    let (name, time) = (name.as_str(), of_steps(tally.steps));
                    _ = writeln!(
                        text,
                        "{place:>4}  {name}{:blanks$}  {time:<8}  {}",
                        "",
                        rank.name()
                    );
                }
                text.push('\n');
            }
            if boards.is_empty() { "no results\n".to_owned() } else { text }
        };
        self.with(catalog, text).await
    }

    async fn with<T>(&self, catalog: &Catalog, act: impl FnOnce(&ScoredBoards) -> T) -> T {
        let mut latest = self.latest.lock().await;
        let is_new = latest.as_ref().is_some_and(|(at, _)| at.elapsed() < INTERVAL);
        if !is_new
            && let Some(answer) = (self.ask)()
            && let Ok(mut boards) = answer.await
        {
            boards.retain(|(board, _)| catalog.has(board.level()));
            *latest = Some((Instant::now(), boards));
        }
        act(latest.as_ref().map_or(&Vec::new(), |(_, boards)| boards))
    }
}
