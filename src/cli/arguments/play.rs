//! What `play` is asked for.

use std::ffi::OsString;
use std::path::PathBuf;

use lexopt::{Arg, Parser};

use super::generated::{Generated, Options};
use super::value::{self, FramesPerSecond};
use super::{Command, Error, next, unexpected, word};
use crate::cast::Method;
use crate::palette::ColorDepth;
use crate::render::Filter;
use crate::terminal::Fidelity;
use crate::tui::{CellAspect, GlyphMode};
use crate::world::FieldOfView;

/// Options of `play`; `None` where the terminal or the configuration decides.
#[derive(Debug, Default)]
pub(in crate::cli) struct Play {
    pub(in crate::cli) map: Option<OsString>,
    /// What to dig in place of a map.
    pub(in crate::cli) generated: Option<Generated>,
    pub(in crate::cli) config: Option<PathBuf>,
    pub(in crate::cli) frames_per_second: FramesPerSecond,
    pub(in crate::cli) field_of_view: FieldOfView,
    pub(in crate::cli) cell_aspect: Option<CellAspect>,
    pub(in crate::cli) glyphs: Option<GlyphMode>,
    pub(in crate::cli) depth: Option<ColorDepth>,
    pub(in crate::cli) method: Method,
    pub(in crate::cli) filter: Filter,
    pub(in crate::cli) fidelity: Option<Fidelity>,
    pub(in crate::cli) shows_stats: bool,
    /// Where to write what happens.
    pub(in crate::cli) record: Option<PathBuf>,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut play = Play::default();
    let mut generated = Options::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Short('V') | Arg::Long("version") => return Ok(Command::Version),
            Arg::Value(map) if play.map.is_none() => play.map = Some(map),
            Arg::Long("config") => {
                play.config = Some(word(&mut parser, "--config", "a file")?.into());
            }
            Arg::Long("fps") => {
                play.frames_per_second = value::FRAMES_PER_SECOND.value(&mut parser)?;
            }
            Arg::Long("fov") => play.field_of_view = value::FIELD_OF_VIEW.value(&mut parser)?,
            Arg::Long("cell-aspect") => {
                play.cell_aspect = Some(value::CELL_ASPECT.value(&mut parser)?);
            }
            Arg::Long("glyphs") => play.glyphs = Some(value::GLYPHS.value(&mut parser)?),
            Arg::Long("colors") => play.depth = Some(value::COLORS.value(&mut parser)?),
            Arg::Long("caster") => play.method = value::method(&mut parser)?,
            Arg::Long("filter") => play.filter = value::FILTER.value(&mut parser)?,
            Arg::Long("fidelity") => play.fidelity = value::fidelity_or_auto(&mut parser)?,
            Arg::Long("stats") => play.shows_stats = true,
            Arg::Long("record") => {
                play.record = Some(word(&mut parser, "--record", "a file")?.into());
            }
            Arg::Long(name) if Options::include(name) => {
                let name = name.to_owned();
                generated.take(&name, &mut parser)?;
            }
            other => return Err(unexpected("play", &OPTIONS, other)),
        }
    }
    play.generated = generated.finish(play.map.as_deref())?;
    Ok(Command::Play(play))
}

const OPTIONS: [&str; 16] = [
    "--caster",
    "--cell-aspect",
    "--colors",
    "--config",
    "--fidelity",
    "--filter",
    "--fov",
    "--fps",
    "--generate",
    "--glyphs",
    "--level-size",
    "--record",
    "--seed",
    "--start",
    "--stats",
    "--version",
];
