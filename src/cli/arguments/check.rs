//! What `check` is asked for.

use lexopt::{Arg, Parser};

use super::{Command, Error, next, unexpected};

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut maps = Vec::new();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) => maps.push(map),
            other => return Err(unexpected("check", &[], other)),
        }
    }
    if maps.is_empty() {
        return Err(Error::mistake(
            "check takes at least one map, as in \"cellcaster check my.toml\"",
        ));
    }
    Ok(Command::Check(maps))
}
