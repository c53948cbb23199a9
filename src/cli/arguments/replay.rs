//! What `replay` is asked for.

use std::ffi::OsString;
use std::path::PathBuf;

use lexopt::{Arg, Parser};

use super::generated::{Generated, Options};
use super::value::{self, FramesPerSecond, Size};
use super::{Command, Error, next, unexpected, word};
use crate::palette::ColorDepth;
use crate::terminal::Fidelity;
use crate::world::FieldOfView;

/// Options of `replay`.
#[derive(Debug)]
pub(in crate::cli) struct Replay {
    pub(in crate::cli) script: PathBuf,
    pub(in crate::cli) map: Option<OsString>,
    /// What to dig in place of a map.
    pub(in crate::cli) generated: Option<Generated>,
    /// Where to write; standard output where there is none.
    pub(in crate::cli) cast: Option<PathBuf>,
    pub(in crate::cli) size: Size,
    pub(in crate::cli) frames_per_second: FramesPerSecond,
    pub(in crate::cli) field_of_view: FieldOfView,
    pub(in crate::cli) depth: ColorDepth,
    pub(in crate::cli) fidelity: Fidelity,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut replay = Replay {
        script: PathBuf::new(),
        map: None,
        generated: None,
        cast: None,
        size: Size::default(),
        frames_per_second: FramesPerSecond::default(),
        field_of_view: FieldOfView::default(),
        depth: ColorDepth::default(),
        fidelity: Fidelity::default(),
    };
    let mut script = None;
    let mut generated = Options::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(path) if script.is_none() => script = Some(path),
            Arg::Value(map) if replay.map.is_none() => replay.map = Some(map),
            Arg::Long("cast") => replay.cast = Some(word(&mut parser, "--cast", "a file")?.into()),
            Arg::Long("size") => replay.size = value::WINDOW_SIZE.value(&mut parser)?,
            Arg::Long("fps") => {
                replay.frames_per_second = value::FRAMES_PER_SECOND.value(&mut parser)?;
            }
            Arg::Long("fov") => replay.field_of_view = value::FIELD_OF_VIEW.value(&mut parser)?,
            Arg::Long("colors") => replay.depth = value::COLORS.value(&mut parser)?,
            Arg::Long("fidelity") => replay.fidelity = value::fidelity(&mut parser)?,
            Arg::Long(name) if Options::include(name) => {
                let name = name.to_owned();
                generated.take(&name, &mut parser)?;
            }
            other => return Err(unexpected("replay", &OPTIONS, other)),
        }
    }
    let script = script.ok_or_else(|| {
        Error::mistake("replay takes a script, as in \"cellcaster replay walk.script\"")
    })?;
    replay.generated = generated.finish(replay.map.as_deref())?;
    Ok(Command::Replay(Replay { script: script.into(), ..replay }))
}

const OPTIONS: [&str; 10] = [
    "--cast",
    "--colors",
    "--fidelity",
    "--fov",
    "--fps",
    "--generate",
    "--level-size",
    "--seed",
    "--size",
    "--start",
];
