//! What `bench` is asked for.

use lexopt::{Arg, Parser};

use super::value::Valued;
use super::{Command, Error, next, unexpected};

/// Options of `bench`.
#[derive(Debug)]
pub(in crate::cli) struct Bench {
    /// How long to measure, roughly.
    pub(in crate::cli) seconds: u8,
    pub(in crate::cli) format: BenchFormat,
}

/// How the report is written.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) enum BenchFormat {
    Table,
    Json,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut bench = Bench { seconds: 10, format: BenchFormat::Table };
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(value) => {
                let message = format!("bench takes no map, and \"{}\" is one", value.display());
                return Err(Error::mistake(message));
            }
            Arg::Long("seconds") => bench.seconds = SECONDS.value(&mut parser)?,
            Arg::Long("format") => bench.format = FORMAT.value(&mut parser)?,
            other => return Err(unexpected("bench", &OPTIONS, other)),
        }
    }
    Ok(Command::Bench(bench))
}

const OPTIONS: [&str; 2] = ["--format", "--seconds"];

const SECONDS: Valued<u8> = Valued {
    name: "--seconds",
    takes: "a whole number from 1 to 60",
    read: |text| text.parse().ok().filter(|seconds| (1..=60).contains(seconds)),
};

const FORMAT: Valued<BenchFormat> = Valued {
    name: "--format",
    takes: "table or json",
    read: |text| match text {
        "table" => Some(BenchFormat::Table),
        "json" => Some(BenchFormat::Json),
        _ => None,
    },
};
