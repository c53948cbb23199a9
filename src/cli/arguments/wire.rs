//! What `wire` is asked for.

use std::ffi::OsString;
use std::path::PathBuf;

use lexopt::{Arg, Parser};

use super::value::{self, FramesPerSecond, Size, Valued};
use super::{Command, Error, next, unexpected, word};
use crate::terminal::Fidelity;

/// Options of `wire`.
#[derive(Debug)]
pub(in crate::cli) struct Wire {
    pub(in crate::cli) map: Option<OsString>,
    /// What is played; the built-in walk where there is none.
    pub(in crate::cli) script: Option<PathBuf>,
    pub(in crate::cli) size: Size,
    pub(in crate::cli) frames_per_second: FramesPerSecond,
    /// None for those that have a name.
    pub(in crate::cli) fidelities: Vec<Fidelity>,
    pub(in crate::cli) format: WireFormat,
}

/// How the report is written.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) enum WireFormat {
    Table,
    Json,
    Csv,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut wire = Wire {
        map: None,
        script: None,
        size: Size { columns: 120, rows: 40 },
        frames_per_second: FramesPerSecond::default(),
        fidelities: Vec::new(),
        format: WireFormat::Table,
    };
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if wire.map.is_none() => wire.map = Some(map),
            Arg::Long("script") => {
                wire.script = Some(word(&mut parser, "--script", "a file")?.into());
            }
            Arg::Long("size") => wire.size = value::WINDOW_SIZE.value(&mut parser)?,
            Arg::Long("fps") => {
                wire.frames_per_second = value::FRAMES_PER_SECOND.value(&mut parser)?;
            }
            Arg::Long("fidelity") => wire.fidelities.push(value::fidelity(&mut parser)?),
            Arg::Long("format") => wire.format = FORMAT.value(&mut parser)?,
            other => return Err(unexpected("wire", &OPTIONS, other)),
        }
    }
    Ok(Command::Wire(wire))
}

const OPTIONS: [&str; 5] = ["--fidelity", "--format", "--fps", "--script", "--size"];

const FORMAT: Valued<WireFormat> = Valued {
    name: "--format",
    takes: "table, json or csv",
    read: |text| match text {
        "table" => Some(WireFormat::Table),
        "json" => Some(WireFormat::Json),
        "csv" => Some(WireFormat::Csv),
        _ => None,
    },
};
