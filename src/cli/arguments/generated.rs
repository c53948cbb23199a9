//! Which level to dig: options of every command that shows one.

use std::ffi::OsStr;

use lexopt::Parser;

use super::Error;
use super::value::Valued;
use crate::generate::{Extent, Generator, Site};

/// A level that is dug in place of a map.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct Generated {
    pub(in crate::cli) generator: Generator,
    pub(in crate::cli) seed: u64,
    pub(in crate::cli) extent: Extent,
    /// Where to start; in the level's first corner where there is none.
    pub(in crate::cli) start: Option<Site>,
}

/// What was said of one, option by option.
#[derive(Debug, Default)]
pub(super) struct Options {
    generator: Option<Generator>,
    seed: Option<u64>,
    extent: Option<Extent>,
    start: Option<Site>,
}

impl Options {
    /// The names of the options.
    pub(super) const NAMES: [&str; 4] = ["--generate", "--level-size", "--seed", "--start"];

    /// Whether `name`, without its dashes, is one of them.
    pub(super) fn include(name: &str) -> bool {
        Self::NAMES.iter().any(|option| option.strip_prefix("--") == Some(name))
    }

    /// Takes the value of the option `name`, which is one of these.
    pub(super) fn take(&mut self, name: &str, parser: &mut Parser) -> Result<(), Error> {
        match name {
            "generate" => self.generator = Some(GENERATOR.value(parser)?),
            "seed" => self.seed = Some(SEED.value(parser)?),
            "level-size" => self.extent = Some(LEVEL_SIZE.value(parser)?),
            _ => self.start = Some(START.value(parser)?),
        }
        Ok(())
    }

    /// The level that all of it is about, if it is about any; and then there is no `map`.
    pub(super) fn finish(self, map: Option<&OsStr>) -> Result<Option<Generated>, Error> {
        let Self { generator, seed, extent, start } = self;
        let said =
            [extent.map(|_| "--level-size"), seed.map(|_| "--seed"), start.map(|_| "--start")];
        match (generator, said.into_iter().flatten().next(), map) {
            (Some(_), _, Some(map)) => Err(Error::mistake(format!(
                "--generate digs a level of its own, and \"{}\" is a map: leave one of them out",
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
}

const GENERATOR: Valued<Generator> =
    Valued { name: "--generate", takes: "maze, cave or office", read: Generator::named };

const SEED: Valued<u64> = Valued {
    name: "--seed",
    takes: "a whole number from 0 to 18446744073709551615",
    read: |text| text.parse().ok(),
};

const LEVEL_SIZE: Valued<Extent> = Valued {
    name: "--level-size",
    takes: "COLSxROWS from 8x8 to 1000000000x1000000000, such as 64x64",
    read: |text| {
        let (columns, rows) = text.split_once('x')?;
        Extent::new(columns.parse().ok()?, rows.parse().ok()?)
    },
};

const START: Valued<Site> = Valued {
    name: "--start",
    takes: "COLUMN,ROW, the cell to start at, such as 1000000,-1000000",
    read: |text| {
        let (column, row) = text.split_once(',')?;
        Some(Site { column: column.trim().parse().ok()?, row: row.trim().parse().ok()? })
    },
};
