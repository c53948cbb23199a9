//! What `bench` is asked for.

use std::path::PathBuf;

use lexopt::{Arg, Parser};

use super::value::Valued;
use super::{Command, Error, next, unexpected, word};

/// Options of `bench`.
#[derive(Debug)]
pub(in crate::cli) struct Bench {
    /// How long to measure, roughly.
    pub(in crate::cli) seconds: u8,
    pub(in crate::cli) format: BenchFormat,
    /// Where plots are drawn, besides.
    pub(in crate::cli) plot: Option<PathBuf>,
}

/// How the report is written.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) enum BenchFormat {
    Table,
    Markdown,
    Json,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut bench = Bench { seconds: 10, format: BenchFormat::Table, plot: None };
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(value) => {
                let message = format!("bench takes no map, and \"{}\" is one", value.display());
                return Err(Error::mistake(message));
            }
            Arg::Long("seconds") => bench.seconds = SECONDS.value(&mut parser)?,
            Arg::Long("format") => bench.format = FORMAT.value(&mut parser)?,
            Arg::Long("plot") => bench.plot = Some(word(&mut parser, "--plot", "a file")?.into()),
            other => return Err(unexpected("bench", &OPTIONS, other)),
        }
    }
    Ok(Command::Bench(bench))
}

const OPTIONS: [&str; 3] = ["--format", "--plot", "--seconds"];

const SECONDS: Valued<u8> = Valued {
    name: "--seconds",
    takes: "a whole number from 1 to 60",
    read: |text| text.parse().ok().filter(|seconds| (1..=60).contains(seconds)),
};

const FORMAT: Valued<BenchFormat> = Valued {
    name: "--format",
    takes: "table, markdown or json",
    read: |text| match text {
        "table" => Some(BenchFormat::Table),
        "markdown" => Some(BenchFormat::Markdown),
        "json" => Some(BenchFormat::Json),
        _ => None,
    },
};
