//! The options of `bench`.

use std::path::PathBuf;

use clap::ArgMatches;

use cellcaster::cli::arguments::option::{FileOption, Parser, ValueOption};
use cellcaster::cli::arguments::{Command, Subcommand};

/// Options of `bench`.
#[derive(Debug)]
pub(crate) struct Bench {
    /// The approximate duration of the measurement, in seconds.
    pub(crate) seconds: u8,
    pub(crate) format: BenchFormat,
    /// The file for plots.
    pub(crate) plot: Option<PathBuf>,
}

/// The format of the report.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum BenchFormat {
    #[default]
    Table,
    Markdown,
    Json,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "bench",
    about: "How fast this machine draws, and a link shows it",
    details: "",
    examples: "cellcaster bench\n\
               cellcaster bench --format json > bench.json\n\
               cellcaster bench --plot speed.svg",
    positionals: &[],
    options: &[&SECONDS, &FORMAT, &PLOT],
    surplus: "takes no map",
    missing: "",
    read: |matches| Ok(Command::Bench(read(matches))),
};

fn read(mut matches: ArgMatches) -> Bench {
    Bench {
        seconds: SECONDS.of(&mut matches).unwrap_or(10),
        format: FORMAT.of(&mut matches).unwrap_or_default(),
        plot: PLOT.of(&mut matches),
    }
}

const SECONDS: ValueOption<u8> = ValueOption {
    name: "seconds",
    value: "N",
    takes: "a whole number from 1 to 60",
    help: "How long to measure, from 1 to 60 seconds; preparing comes on top",
    default: "10",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|seconds| (1..=60).contains(seconds))),
    repeats: false,
};

const FORMAT: ValueOption<BenchFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table, markdown or json",
    help: "How the report is written",
    default: "table",
    choices: &["table", "markdown", "json"],
    read: Parser::Optional(|text| match text {
        "table" => Some(BenchFormat::Table),
        "markdown" => Some(BenchFormat::Markdown),
        "json" => Some(BenchFormat::Json),
        _ => None,
    }),
    repeats: false,
};

const PLOT: FileOption =
    FileOption { name: "plot", help: "Draw plots of it in FILE, besides, as SVG" };
