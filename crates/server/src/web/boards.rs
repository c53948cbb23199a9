//! The leaderboards for browsers, as JSON and as text.
//!
//! All browsers share the boards of the last [`INTERVAL`], so that they do not keep the store busy.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tokio::sync::Mutex;

use crate::accounts::worker::CallResult;
use crate::accounts::{HostStore, LevelBoard, LevelScore, ScoredBoards};
use crate::logging;
use crate::rooms::room::Catalog;
use cellcaster::app::parts::of_steps;

/// The time for which boards are kept.
const INTERVAL: Duration = Duration::from_secs(30);
/// The most entries of a board.
const MAX: usize = 10;

/// Asks the store for boards; `None` if the host ends.
pub(crate) type AskBoards = Box<dyn Fn() -> Option<CallResult<Option<ScoredBoards>>> + Send + Sync>;

/// The boards of a host.
pub(crate) struct Boards {
    ask: AskBoards,
    latest: Mutex<Option<(Instant, ScoredBoards)>>,
}

/// The boards in a store; `None` after a failure.
pub(crate) fn read(store: &mut HostStore) -> Option<ScoredBoards> {
    store.scored_boards(MAX).map_err(logging::store_failed).ok()
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
        let board = |(board, scores): &(LevelBoard, Vec<LevelScore>)| {
            let (title, difficulty) = (catalog.title(board.level()), board.difficulty().name());
            let lines: String = (1..).zip(scores).map(|(place, score)| score.line(place)).collect();
            format!("{title}, {difficulty}\n{lines}\n")
        };
        let text = |boards: &ScoredBoards| match &boards[..] {
            [] => "no results\n".to_owned(),
            boards => boards.iter().map(board).collect(),
        };
        self.with(catalog, text).await
    }

    async fn with<T>(&self, catalog: &Catalog, act: impl FnOnce(&ScoredBoards) -> T) -> T {
        let mut latest = self.latest.lock().await;
        let is_new = latest.as_ref().is_some_and(|(at, _)| at.elapsed() < INTERVAL);
        if !is_new
            && let Some(answer) = (self.ask)()
            && let Ok(Some(mut boards)) = answer.await
        {
            boards.retain(|(board, _)| catalog.has(board.level()));
            *latest = Some((Instant::now(), boards));
        }
        act(latest.as_ref().map_or(&Vec::new(), |(_, boards)| boards))
    }
}
