//! `cellcaster levels`: lists the built-in levels and the player's best results.

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::Error;
use super::machine::open_store;
use super::output_file::print;
use crate::app::status::{of_steps, tenths};
use crate::app::store::Best;
use crate::game::STEPS_PER_SECOND;
use crate::map::builtin;
use crate::sort;
use crate::world::{Difficulty, World};

/// List the built-in levels with your best results
///
/// Names each level with its title, its par time, and for each difficulty the time of your fastest run and your highest
/// rank.
#[derive(Args, Debug)]
#[command(after_long_help = "Examples:\n  cellcaster levels\n  cellcaster levels --format json")]
pub(crate) struct LevelsCommand {
    /// The format of the list
    #[arg(long, value_enum, default_value_t)]
    format: ListFormat,
}

/// The format of the list.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum ListFormat {
    #[default]
    Table,
    Json,
}

/// A built-in level with its best results.
struct LevelEntry {
    /// The position in the playing order, counted from 1.
    order: usize,
    name: &'static str,
    world: World,
    /// The best results, by difficulty.
    bests: [Option<Best>; 3],
}

/// Writes the list in the format that `options` select.
pub(crate) fn run(options: &LevelsCommand) -> Result<(), Error> {
    let (store, damage) = open_store();
    if let Some(sentence) = damage {
        Error::machine(sentence).warn();
    }
    let levels = (1..).zip(builtin::LEVELS).map(|(order, level)| {
        let bests = Difficulty::ALL.map(|difficulty| store.best(level.name, difficulty).copied());
        Ok(LevelEntry { order, name: level.name, world: level.world()?, bests })
    });
    let entries = levels.collect::<Result<Vec<LevelEntry>, Error>>()?;
    let text = match options.format {
        ListFormat::Table => table(&entries),
        ListFormat::Json => {
            format!("{}\n", json!(entries.iter().map(object).collect::<Vec<_>>()))
        }
    };
    print(text.as_bytes())
}

fn table(entries: &[LevelEntry]) -> String {
    let mut rows = vec![["", "name", "title", "par", "easy", "normal", "hard"].map(str::to_owned)];
    rows.extend(entries.iter().map(|entry| {
        let par = entry.world.par().map_or("-".to_owned(), |seconds| tenths(seconds.into()));
        let [easy, normal, hard] = entry.bests.map(|best| {
            best.map_or("-".to_owned(), |best| {
                let taken_back = match best.tally.taken_back {
                    0 => String::new(),
                    count => format!(" ({count} taken back)"),
                };
                format!("{} {}{taken_back}", of_steps(best.tally.steps), best.rank)
            })
        });
        let title = entry.world.title().to_owned();
        [entry.order.to_string(), entry.name.to_owned(), title, par, easy, normal, hard]
    }));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [usize; 7] = std::array::from_fn(|column| width(column).unwrap_or_default());
    let line = |row: &[String; 7]| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn object(entry: &LevelEntry) -> Value {
    let best = |best: Best| {
        let tally = best.tally;
        json!({
            "steps": tally.steps,
            "seconds": tally.steps as f64 / f64::from(STEPS_PER_SECOND),
            "treasure": { "found": tally.treasure.found, "total": tally.treasure.total },
            "secrets": { "found": tally.secrets.found, "total": tally.secrets.total },
            "alarms": tally.alarms,
            "deaths": tally.deaths,
            "stunned": tally.stunned,
            "taken_back": tally.taken_back,
            "rank": best.rank.name(),
        })
    };
    let bests = Difficulty::ALL.into_iter().zip(entry.bests);
    let bests = bests.map(|(difficulty, it)| (difficulty.name().to_owned(), json!(it.map(best))));
    json!({
        "order": entry.order,
        "name": entry.name,
        "title": entry.world.title(),
        "par": entry.world.par(),
        "best": Value::Object(sort::gathered(bests)),
    })
}
