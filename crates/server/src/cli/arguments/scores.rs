//! The options of `scores`.

use std::path::PathBuf;

use crate::cli::arguments::database::{Database, STORE};
use cellcaster::cli::arguments::option::{FileOption, Parser, ValueOption};
use cellcaster::cli::arguments::{Command, Error, Subcommand};
use crate::accounts::Day;
use cellcaster::world::Difficulty;

/// Options of `scores`.
#[derive(Debug)]
pub(crate) struct Scores {
    /// The folder of the host's store; that of the program if `None`.
    pub(crate) data: Option<PathBuf>,
    pub(crate) store: Option<Database>,
    /// The level; all if `None`.
    pub(crate) level: Option<String>,
    /// The difficulty; all if `None`.
    pub(crate) difficulty: Option<Difficulty>,
    /// The day whose daily run is shown instead of levels.
    pub(crate) day: Option<Day>,
    pub(crate) format: ScoresFormat,
}

/// The format of the boards.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum ScoresFormat {
    #[default]
    Table,
    Json,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "scores",
    about: "List the leaderboards of a host",
    details: "For each level and difficulty it lists the fastest run of each account, with the highest \
              rank of all its runs; for a day, how far the daily runs came. It reads the store of serve, \
              also while that runs.",
    examples: "cellcaster scores\n\
               cellcaster scores --level cellar --difficulty hard\n\
               cellcaster scores --day 2026-11-22 --format json",
    positionals: &[],
    options: &[&DATA, &STORE, &LEVEL, &DIFFICULTY, &DAY, &FORMAT],
    surplus: "takes no map",
    missing: "",
    read: |mut matches| {
        let scores = Scores {
            data: DATA.of(&mut matches),
            store: STORE.of(&mut matches),
            level: LEVEL.of(&mut matches),
            difficulty: DIFFICULTY.of(&mut matches),
            day: DAY.of(&mut matches),
            format: FORMAT.of(&mut matches).unwrap_or_default(),
        };
        if scores.day.is_some() && (scores.level.is_some() || scores.difficulty.is_some()) {
            return Err(Error::mistake("--day goes without --level and --difficulty"));
        }
        Ok(Command::Scores(scores))
    },
};

const DATA: FileOption = FileOption {
    name: "data",
    help: "The folder of the store [default: the folder for data files, or CELLCASTER_DATA]",
};

const LEVEL: ValueOption<String> = ValueOption {
    name: "level",
    value: "NAME",
    takes: "the name of a built-in level, or of a map of the host without .toml",
    help: "List this level only: a built-in one, or a map of the host",
    default: "",
    choices: &[],
    read: Parser::Optional(|text| {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-_".contains(&byte);
        (!text.is_empty() && text.bytes().all(is_plain)).then(|| text.to_owned())
    }),
    repeats: false,
};

const DIFFICULTY: ValueOption<Difficulty> = ValueOption {
    name: "difficulty",
    value: "LEVEL",
    takes: "easy, normal or hard",
    help: "List this difficulty only",
    default: "",
    choices: &["easy", "normal", "hard"],
    read: Parser::Optional(Difficulty::named),
    repeats: false,
};

const DAY: ValueOption<Day> = ValueOption {
    name: "day",
    value: "DATE",
    takes: "a date such as 2026-11-22",
    help: "List the daily runs of this day",
    default: "",
    choices: &[],
    read: Parser::Optional(Day::parse),
    repeats: false,
};

const FORMAT: ValueOption<ScoresFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table or json",
    help: "How the boards are written",
    default: "table",
    choices: &["table", "json"],
    read: Parser::Optional(|text| match text {
        "table" => Some(ScoresFormat::Table),
        "json" => Some(ScoresFormat::Json),
        _ => None,
    }),
    repeats: false,
};
