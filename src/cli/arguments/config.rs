//! What `config` is asked for.

use std::path::PathBuf;

use lexopt::{Arg, Parser};

use super::{Command, Error, next, unexpected, word};

/// Options of `config`.
#[derive(Debug, Default)]
pub(in crate::cli) struct Config {
    pub(in crate::cli) config: Option<PathBuf>,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut config = Config::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Long("config") => {
                config.config = Some(word(&mut parser, "--config", "a file")?.into());
            }
            Arg::Value(value) => {
                return Err(Error::mistake(format!(
                    "config takes no map, and \"{}\" is one; name a file with --config",
                    value.display()
                )));
            }
            other => return Err(unexpected("config", &["--config"], other)),
        }
    }
    Ok(Command::Config(config))
}
