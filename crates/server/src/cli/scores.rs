//! `cellcaster-server scores`: the leaderboards of a host.

use std::io::{self, Write};

use cellcaster::cli::Error;
use cellcaster::game::STEPS_PER_SECOND;
use serde_json::{Value, json};

use super::arguments::{ListFormat, Scores};
use super::host_store::{StoreLocation, failed};
use crate::accounts::{LevelBoard, LevelScore};

/// The most entries that are listed for a board.
const MAX: usize = 100;

/// Prints the boards that `options` request.
pub(crate) fn run(options: &Scores) -> Result<(), Error> {
    let database = StoreLocation::named(options.store.store.clone(), options.data.clone())?;
    let is_of =
        |level: &String, board: &LevelBoard| [board.level(), board.name()].contains(&&**level);
    let mut boards = database.open_to_read()?.scored_boards(MAX).map_err(failed)?;
    boards.retain(|(board, _)| {
        options.level.as_ref().is_none_or(|level| is_of(level, board))
            && options.difficulty.is_none_or(|difficulty| difficulty == board.difficulty())
    });
    let text = match options.format {
        ListFormat::Table if boards.is_empty() => "no results\n".to_owned(),
        ListFormat::Table => boards.iter().map(table).collect::<Vec<_>>().join("\n"),
        ListFormat::Json => format!("{}\n", boards.iter().map(object).collect::<Value>()),
    };
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

/// A board: its title, a line of headings, and a line for each entry.
fn table((board, scores): &(LevelBoard, Vec<LevelScore>)) -> String {
    let (level, difficulty) = (board.level(), board.difficulty().name());
    let lines: String = (1..).zip(scores).map(|(place, score)| score.line(place)).collect();
    format!("{level}, {difficulty}\n      name              time      rank\n{lines}")
}

fn object((board, scores): &(LevelBoard, Vec<LevelScore>)) -> Value {
    let entry = |(place, score): (usize, &LevelScore)| {
        let tally = score.tally;
        json!({
            "place": place,
            "name": score.name.as_str(),
            "steps": tally.steps,
            "seconds": tally.steps as f64 / f64::from(STEPS_PER_SECOND),
            "treasure": { "found": tally.treasure.found, "total": tally.treasure.total },
            "secrets": { "found": tally.secrets.found, "total": tally.secrets.total },
            "alarms": tally.alarms,
            "deaths": tally.deaths,
            "stunned": tally.stunned,
            "rank": score.rank.name(),
            "verified": score.verified_at.seconds(),
        })
    };
    json!({
        "level": board.level(),
        "difficulty": board.difficulty().name(),
        "entries": (1..).zip(scores).map(entry).collect::<Vec<_>>(),
    })
}
