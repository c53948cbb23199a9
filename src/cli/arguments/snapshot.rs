//! What `snapshot` is asked for.

use std::ffi::OsString;

use glam::DVec2;
use lexopt::{Arg, Parser};

use super::generated::{Generated, Options};
use super::value::{self, Size, Valued};
use super::{Command, Error, next, unexpected};
use crate::cast::Method;
use crate::palette::ColorDepth;
use crate::render::Filter;
use crate::tui::{CellAspect, GlyphMode};
use crate::world::{FieldOfView, Heading, Pitch};

/// Options of `snapshot`.
#[derive(Debug, Default)]
pub(in crate::cli) struct Snapshot {
    pub(in crate::cli) map: Option<OsString>,
    /// What to dig in place of a map.
    pub(in crate::cli) generated: Option<Generated>,
    pub(in crate::cli) size: Size,
    /// Where to look from; the map's start where there is none.
    pub(in crate::cli) camera: Option<(DVec2, Heading)>,
    /// How high the eye is; where somebody's is who stands there if there is none.
    pub(in crate::cli) eye: Option<f64>,
    /// How far up or down to look; straight ahead, or as at the start of a map of bodies, if there is
    /// none.
    pub(in crate::cli) pitch: Option<Pitch>,
    pub(in crate::cli) field_of_view: FieldOfView,
    pub(in crate::cli) cell_aspect: CellAspect,
    pub(in crate::cli) glyphs: GlyphMode,
    pub(in crate::cli) depth: ColorDepth,
    pub(in crate::cli) format: Format,
    pub(in crate::cli) method: Method,
    pub(in crate::cli) filter: Filter,
    /// Whether to tell how the frame is drawn instead of writing it.
    pub(in crate::cli) explain: bool,
}

/// How a snapshot is written.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::cli) enum Format {
    #[default]
    Text,
    Ansi,
    Json,
    Png,
}

pub(super) fn parse(mut parser: Parser) -> Result<Command, Error> {
    let mut snapshot = Snapshot::default();
    let mut generated = Options::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if snapshot.map.is_none() => snapshot.map = Some(map),
            Arg::Long("size") => snapshot.size = value::SIZE.value(&mut parser)?,
            Arg::Long("camera") => snapshot.camera = Some(CAMERA.value(&mut parser)?),
            Arg::Long("eye") => snapshot.eye = Some(EYE.value(&mut parser)?),
            Arg::Long("pitch") => snapshot.pitch = Some(PITCH.value(&mut parser)?),
            Arg::Long("fov") => snapshot.field_of_view = value::FIELD_OF_VIEW.value(&mut parser)?,
            Arg::Long("cell-aspect") => {
                snapshot.cell_aspect = value::CELL_ASPECT.value(&mut parser)?;
            }
            Arg::Long("glyphs") => snapshot.glyphs = value::GLYPHS.value(&mut parser)?,
            Arg::Long("colors") => snapshot.depth = value::COLORS.value(&mut parser)?,
            Arg::Long("format") => snapshot.format = FORMAT.value(&mut parser)?,
            Arg::Long("caster") => snapshot.method = value::method(&mut parser)?,
            Arg::Long("filter") => snapshot.filter = value::FILTER.value(&mut parser)?,
            Arg::Long("explain") => snapshot.explain = true,
            Arg::Long(name) if Options::include(name) => {
                let name = name.to_owned();
                generated.take(&name, &mut parser)?;
            }
            other => return Err(unexpected("snapshot", &OPTIONS, other)),
        }
    }
    snapshot.generated = generated.finish(snapshot.map.as_deref())?;
    Ok(Command::Snapshot(snapshot))
}

const OPTIONS: [&str; 16] = [
    "--camera",
    "--caster",
    "--cell-aspect",
    "--colors",
    "--explain",
    "--eye",
    "--filter",
    "--format",
    "--fov",
    "--generate",
    "--glyphs",
    "--level-size",
    "--pitch",
    "--seed",
    "--size",
    "--start",
];

const EYE: Valued<f64> = Valued {
    name: "--eye",
    takes: "a finite height in cells, such as 0.5",
    read: |text| text.parse().ok().filter(|eye: &f64| eye.is_finite()),
};

const PITCH: Valued<Pitch> = Valued {
    name: "--pitch",
    takes: "degrees from -30, down, to 30, up",
    read: |text| Pitch::from_degrees(text.parse().ok()?),
};

const CAMERA: Valued<(DVec2, Heading)> = Valued {
    name: "--camera",
    takes: "X,Y,HEADING, three finite numbers such as 2.5,3.5,90",
    read: |text| {
        let mut numbers = text.split(',').map(|number| number.trim().parse::<f64>().ok());
        let position = DVec2::new(numbers.next()??, numbers.next()??);
        let heading = Heading::from_degrees(numbers.next()??)?;
        (position.is_finite() && numbers.next().is_none()).then_some((position, heading))
    },
};

const FORMAT: Valued<Format> = Valued {
    name: "--format",
    takes: "text, ansi, json or png",
    read: |text| match text {
        "text" => Some(Format::Text),
        "ansi" => Some(Format::Ansi),
        "json" => Some(Format::Json),
        "png" => Some(Format::Png),
        _ => None,
    },
};
