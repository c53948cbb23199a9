//! What `cast` is asked for.

use std::ffi::OsString;

use lexopt::{Arg, Parser};

use super::{Command, Error, next, unexpected, value};
use crate::cast::Method;

/// Options of `cast`.
#[derive(Debug, Default)]
pub(in crate::cli) struct Cast {
    pub(in crate::cli) map: Option<OsString>,
    pub(in crate::cli) method: Method,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut cast = Cast::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if cast.map.is_none() => cast.map = Some(map),
            Arg::Long("caster") => cast.method = value::method(&mut parser)?,
            other => return Err(unexpected("cast", &["--caster"], other)),
        }
    }
    Ok(Command::Cast(cast))
}
