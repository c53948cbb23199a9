//! The options for a generated level, which several commands share.

use std::ffi::OsStr;

use clap::ArgMatches;

use super::Error;
use super::option::{Parser, ValueOption};
use crate::generate::{Extent, Generator, Site};

/// A generated level instead of a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Generated {
    pub(crate) generator: Generator,
    pub(crate) seed: u64,
    pub(crate) extent: Extent,
    /// The start; that of the level if it is `None`.
    pub(crate) start: Option<Site>,
}

/// The generated level that the options describe, if any. It excludes a `map`.
pub(crate) fn of(
    matches: &mut ArgMatches,
    map: Option<&OsStr>,
) -> Result<Option<Generated>, Error> {
    let generator = GENERATE.of(matches);
    let (seed, extent) = (SEED.of(matches), LEVEL_SIZE.of(matches));
    let start = START.of(matches);
    let said = [extent.map(|_| "--level-size"), seed.map(|_| "--seed"), start.map(|_| "--start")];
    match (generator, said.into_iter().flatten().next(), map) {
        (Some(_), _, Some(map)) => Err(Error::mistake(format!(
            "--generate makes a level of its own, and \"{}\" is a map: leave one of them out",
            map.display()
        ))),
        (None, Some(name), _) => {
            Err(Error::mistake(format!("{name} needs --generate maze, cave or office")))
        }
        (None, None, _) => Ok(None),
        (Some(generator), _, None) => Ok(Some(Generated {
            generator,
            seed: seed.unwrap_or(1),
            extent: extent.unwrap_or_default(),
            start,
        })),
    }
}

pub(crate) const GENERATE: ValueOption<Generator> = ValueOption {
    name: "generate",
    value: "KIND",
    takes: "maze, cave or office",
    help: "Generate a level in place of MAP",
    default: "",
    choices: &["maze", "cave", "office"],
    read: Parser::Optional(Generator::named),
};

pub(crate) const SEED: ValueOption<u64> = ValueOption {
    name: "seed",
    value: "N",
    takes: "a whole number from 0 to 18446744073709551615",
    help: "The seed of the generated level",
    default: "1",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok()),
};

pub(crate) const LEVEL_SIZE: ValueOption<Extent> = ValueOption {
    name: "level-size",
    value: "COLSxROWS",
    takes: "COLSxROWS from 8x8 to 1000000000x1000000000, such as 64x64",
    help: "Generate a level with walls around it, and an exit",
    default: "without an end",
    choices: &[],
    read: Parser::Optional(|text| {
        let (columns, rows) = text.split_once('x')?;
        Extent::new(columns.parse().ok()?, rows.parse().ok()?)
    }),
};

pub(crate) const START: ValueOption<Site> = ValueOption {
    name: "start",
    value: "COLUMN,ROW",
    takes: "COLUMN,ROW, the cell to start at, such as 1000000,-1000000",
    help: "The cell of the generated level to start at",
    default: "the first corner",
    choices: &[],
    read: Parser::Optional(|text| {
        let (column, row) = text.split_once(',')?;
        Some(Site { column: column.trim().parse().ok()?, row: row.trim().parse().ok()? })
    }),
};
