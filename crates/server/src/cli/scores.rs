//! `cellcaster-server scores`: the leaderboards of a host.

use std::io::{self, Write};

use serde_json::{Value, json};
use unicode_width::UnicodeWidthStr;

use super::arguments::{Scores, ScoresFormat};
use super::database::Database;
use crate::accounts::{DailyScore, Day, HostStore, LevelBoard, LevelScore, StoreFailure};
use crate::cli::host_store::{self, failed};
use cellcaster::app::parts::of_steps;
use cellcaster::cli::Error;
use cellcaster::cli::machine::data_folder;
use cellcaster::game::STEPS_PER_SECOND;

/// The entries of a board that are listed.
const MOST: usize = 100;

/// Boards with their entries.
enum Boards {
    Levels(Vec<(LevelBoard, Vec<LevelScore>)>),
    Day(Day, Vec<DailyScore>),
}

/// Writes the boards that `options` request.
pub(crate) fn run(options: &Scores) -> Result<(), Error> {
    let folder = || options.data.clone().or_else(data_folder).map(Database::Folder);
    let database =
        host_store::named(options.store.store.clone()).or_else(folder).ok_or_else(|| {
            Error::mistake("there is no folder for data files: name the one of the host by --data")
        })?;
    let boards = find(&database, options)?;
    let text = match options.format {
        ScoresFormat::Table => table(&boards),
        ScoresFormat::Json => format!("{}\n", object(&boards)),
    };
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

fn find(database: &Database, options: &Scores) -> Result<Boards, Error> {
    let mut store = host_store::open_to_read(database)?;
    match options.day {
        Some(day) => Ok(Boards::Day(day, store.daily_scores(day, MOST).map_err(failed)?)),
        None => levels(&mut *store, options).map(Boards::Levels).map_err(failed),
    }
}

fn levels(
    store: &mut dyn HostStore,
    options: &Scores,
) -> Result<Vec<(LevelBoard, Vec<LevelScore>)>, StoreFailure> {
    let is_of =
        |level: &String, board: &LevelBoard| [board.level(), board.name()].contains(&&**level);
    let boards = store.level_boards()?.into_iter().filter(|board| {
        options.level.as_ref().is_none_or(|level| is_of(level, board))
            && options.difficulty.is_none_or(|difficulty| difficulty == board.difficulty())
    });
    let scored = |board: LevelBoard| {
        let scores = store.level_scores(&board, MOST)?;
        Ok((board, scores))
    };
    boards.map(scored).collect()
}

fn table(boards: &Boards) -> String {
    match boards {
        Boards::Levels(boards) if boards.is_empty() => "no results\n".to_owned(),
        Boards::Day(day, scores) if scores.is_empty() => format!("{day}: no results\n"),
        Boards::Levels(boards) => {
            let boards = boards.iter().map(|(board, scores)| {
                let title = format!("{}, {}", board.level(), board.difficulty().name());
                section(
                    &title,
                    ["time", "rank"],
                    scores.iter().map(|score| {
                        let rank = score.rank.name().to_owned();
                        (score.name.as_str(), [of_steps(score.tally.steps), rank])
                    }),
                )
            });
            boards.collect::<Vec<_>>().join("\n")
        }
        Boards::Day(day, scores) => section(
            &day.to_string(),
            ["floors", "treasure", "time"],
            scores.iter().map(|score| {
                let reached = score.reached;
                let time = of_steps(reached.steps);
                let values = [reached.floors.to_string(), reached.treasure.to_string(), time];
                (score.name.as_str(), values)
            }),
        ),
    }
}

/// A board: its title, a line of headings, and a line for each entry.
fn section<'a, const N: usize>(
    title: &str,
    headings: [&str; N],
    entries: impl Iterator<Item = (&'a str, [String; N])>,
) -> String {
    let mut text = format!("{title}\n");
    let mut push = |place: &str, name: &str, values: &[String]| {
        // A name may be wider than it has characters.
        let blanks = " ".repeat(NAME_COLUMNS.saturating_sub(name.width()));
        let values: Vec<String> = values.iter().map(|value| format!("{value:<8}")).collect();
        let line = format!("{place:>4}  {name}{blanks}  {}", values.join("  "));
        text.push_str(line.trim_end());
        text.push('\n');
    };
    push("", "name", &headings.map(str::to_owned));
    for (place, (name, values)) in (1..).zip(entries) {
        push(&i32::to_string(&place), name, &values);
    }
    text
}

const NAME_COLUMNS: usize = crate::accounts::Name::MOST_COLUMNS;

fn object(boards: &Boards) -> Value {
    let seconds = |steps: u64| steps as f64 / f64::from(STEPS_PER_SECOND);
    let of_level = |(place, score): (usize, &LevelScore)| {
        let tally = score.tally;
        json!({
            "place": place,
            "name": score.name.as_str(),
            "steps": tally.steps,
            "seconds": seconds(tally.steps),
            "treasure": { "found": tally.treasure.found, "total": tally.treasure.total },
            "secrets": { "found": tally.secrets.found, "total": tally.secrets.total },
            "alarms": tally.alarms,
            "deaths": tally.deaths,
            "stunned": tally.stunned,
            "rank": score.rank.name(),
            "verified": score.verified_at.seconds(),
        })
    };
    let of_day = |(place, score): (usize, &DailyScore)| {
        json!({
            "place": place,
            "name": score.name.as_str(),
            "floors": score.reached.floors,
            "treasure": score.reached.treasure,
            "steps": score.reached.steps,
            "seconds": seconds(score.reached.steps),
            "verified": score.verified_at.seconds(),
        })
    };
    match boards {
        Boards::Levels(boards) => boards
            .iter()
            .map(|(board, scores)| {
                json!({
                    "level": board.level(),
                    "difficulty": board.difficulty().name(),
                    "entries": (1..).zip(scores).map(of_level).collect::<Vec<_>>(),
                })
            })
            .collect(),
        Boards::Day(day, scores) => json!({
            "day": day.to_string(),
            "entries": (1..).zip(scores).map(of_day).collect::<Vec<_>>(),
        }),
    }
}
