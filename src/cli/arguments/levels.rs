//! The options of `levels`.

use super::option::{Parser, ValueOption};
use super::{Command, Subcommand};

/// Options of `levels`.
#[derive(Debug)]
pub(crate) struct Levels {
    pub(crate) format: LevelsFormat,
}

/// The format of the list.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum LevelsFormat {
    #[default]
    Table,
    Json,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "levels",
    about: "List the built-in levels with your best results",
    details: "Names each level with its title, its par time, and for each difficulty the time of your \
              fastest run and your highest rank.",
    examples: "cellcaster levels\n\
               cellcaster levels --format json",
    positionals: &[],
    options: &[&FORMAT],
    surplus: "takes no map",
    missing: "",
    read: |mut matches| {
        Ok(Command::Levels(Levels { format: FORMAT.of(&mut matches).unwrap_or_default() }))
    },
};

const FORMAT: ValueOption<LevelsFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table or json",
    help: "How the list is written",
    default: "table",
    choices: &["table", "json"],
    read: Parser::Optional(|text| match text {
        "table" => Some(LevelsFormat::Table),
        "json" => Some(LevelsFormat::Json),
        _ => None,
    }),
};
