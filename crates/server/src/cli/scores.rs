//! `cellcaster-server scores`: the leaderboards of a host.

use std::fmt::Write as _;
use std::io::{self, Write};

use cellcaster::app::parts::of_steps;
use cellcaster::cli::Error;
use cellcaster::cli::machine::data_folder;
use cellcaster::game::STEPS_PER_SECOND;
use serde_json::{Value, json};
use unicode_width::UnicodeWidthStr;

use super::arguments::{ListFormat, Scores};
use super::host_store::{StoreLocation, failed};
use crate::accounts::{HostStore, LevelBoard, LevelScore, Name, StoreFailure};

/// The most entries that are listed for a board.
const MAX: usize = 100;

/// Boards, each with its entries.
type Boards = Vec<(LevelBoard, Vec<LevelScore>)>;

/// Prints the boards that `options` request.
pub(crate) fn run(options: &Scores) -> Result<(), Error> {
    let folder = || options.data.clone().or_else(data_folder).map(StoreLocation::Folder);
    let database =
        StoreLocation::named(options.store.store.clone()).or_else(folder).ok_or_else(|| {
            Error::mistake("this system has no default data folder: name the host's with --data")
        })?;
    let boards = boards(&mut database.open_to_read()?, options).map_err(failed)?;
    let text = match options.format {
        ListFormat::Table if boards.is_empty() => "no results\n".to_owned(),
        ListFormat::Table => boards.iter().map(table).collect::<Vec<_>>().join("\n"),
        ListFormat::Json => format!("{}\n", boards.iter().map(object).collect::<Value>()),
    };
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

fn boards(store: &mut HostStore, options: &Scores) -> Result<Boards, StoreFailure> {
    let is_of =
        |level: &String, board: &LevelBoard| [board.level(), board.name()].contains(&&**level);
    let boards = store.level_boards()?.into_iter().filter(|board| {
        options.level.as_ref().is_none_or(|level| is_of(level, board))
            && options.difficulty.is_none_or(|difficulty| difficulty == board.difficulty())
    });
    let scored = |board: LevelBoard| {
        let scores = store.level_scores(&board, MAX)?;
        Ok((board, scores))
    };
    boards.map(scored).collect()
}

/// A board: its title, a line of headings, and a line for each entry.
fn table((board, scores): &(LevelBoard, Vec<LevelScore>)) -> String {
    let mut text = format!("{}, {}\n", board.level(), board.difficulty().name());
    let mut push = |place: &str, name: &str, time: &str, rank: &str| {
        // A name can take more columns than it has characters.
        let blanks = " ".repeat(Name::MAX_COLUMNS.saturating_sub(name.width()));
        writeln!(text, "{place:>4}  {name}{blanks}  {time:<8}  {rank}")
            .expect("a string takes any text");
    };
    push("", "name", "time", "rank");
    for (place, score) in (1..).zip(scores) {
        let time = of_steps(score.tally.steps);
        push(&i32::to_string(&place), score.name.as_str(), &time, score.rank.name());
    }
    text
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
