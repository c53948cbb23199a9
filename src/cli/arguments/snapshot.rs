//! The options of `snapshot`.

use std::ffi::OsString;

use clap::ArgMatches;
use glam::DVec2;

use super::generated::{self, Generated};
use super::option::{Flag, Parser, ValueOption};
use super::value::{self, Size};
use super::{Command, Error, Subcommand, map};
use crate::color::palette::ColorDepth;
use crate::render::Filter;
use crate::tui::{CellAspect, GlyphSet};
use crate::world::{FieldOfView, Heading, Pitch};

/// Options of `snapshot`.
#[derive(Debug)]
pub(crate) struct Snapshot {
    pub(crate) map: Option<OsString>,
    /// The generated level instead of a map.
    pub(crate) generated: Option<Generated>,
    /// The size of the picture. If `None`, 80x24; with `--watch`, the size of the window.
    pub(crate) size: Option<Size>,
    /// The position and heading; the map's start if `None`.
    pub(crate) camera: Option<(DVec2, Heading)>,
    /// The height of the eye; that of a player who stands there if `None`.
    pub(crate) eye: Option<f64>,
    /// The pitch. If `None`, level, or in a map of bodies that of the start.
    pub(crate) pitch: Option<Pitch>,
    pub(crate) field_of_view: FieldOfView,
    pub(crate) cell_aspect: CellAspect,
    pub(crate) glyphs: GlyphSet,
    pub(crate) depth: ColorDepth,
    pub(crate) format: Format,
    pub(crate) filter: Filter,
    /// Whether to write the frame's counts instead of the frame.
    pub(crate) explain: bool,
    /// Whether to draw again when the map changes.
    pub(crate) watches: bool,
}

/// The format of a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Format {
    #[default]
    Text,
    Ansi,
    Json,
    Png,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "snapshot",
    about: "One frame to standard output",
    details: "Draws what the game would show, without a terminal, the same bytes on every machine. Of a \
              map of bodies, --eye and --pitch are as at its start where they are not given.",
    examples: "cellcaster snapshot museum --format ansi\n\
               cellcaster snapshot my.toml --size 120x40 --format png > my.png\n\
               cellcaster snapshot my.toml --camera 2.5,3.5,90 --format json\n\
               cellcaster snapshot my.toml --format ansi --watch",
    positionals: &[map::OPTIONAL],
    options: &[
        &value::SIZE,
        &CAMERA,
        &EYE,
        &PITCH,
        &value::FIELD_OF_VIEW,
        &value::CELL_ASPECT,
        &value::GLYPHS,
        &value::COLORS,
        &value::FILTER,
        &value::CASTER,
        &FORMAT,
        &EXPLAIN,
        &value::WATCH,
        &generated::GENERATE,
        &generated::SEED,
        &generated::LEVEL_SIZE,
        &generated::START,
    ],
    surplus: "takes one map",
    missing: "",
    read,
};

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let map = map::of(&mut matches);
    let generated = generated::of(&mut matches, map.as_deref())?;
    Ok(Command::Snapshot(Snapshot {
        map,
        generated,
        size: value::SIZE.of(&mut matches),
        camera: CAMERA.of(&mut matches),
        eye: EYE.of(&mut matches),
        pitch: PITCH.of(&mut matches),
        field_of_view: value::FIELD_OF_VIEW.of(&mut matches).unwrap_or_default(),
        cell_aspect: value::CELL_ASPECT.of(&mut matches).unwrap_or_default(),
        glyphs: value::GLYPHS.of(&mut matches).unwrap_or_default(),
        depth: value::COLORS.of(&mut matches).unwrap_or_default(),
        format: FORMAT.of(&mut matches).unwrap_or_default(),
        filter: value::FILTER.of(&mut matches).unwrap_or_default(),
        explain: EXPLAIN.of(&matches),
        watches: value::WATCH.of(&matches),
    }))
}

const CAMERA: ValueOption<(DVec2, Heading)> = ValueOption {
    name: "camera",
    value: "X,Y,HEADING",
    takes: "X,Y,HEADING, three finite numbers such as 2.5,3.5,90",
    help: "Where to look from, in cells, and which way, in degrees: 0 is east, 90 south",
    default: "the map's start",
    choices: &[],
    read: Parser::Optional(|text| {
        let mut numbers = text.split(',').map(|number| number.trim().parse::<f64>().ok());
        let position = DVec2::new(numbers.next()??, numbers.next()??);
        let heading = Heading::from_degrees(numbers.next()??)?;
        (position.is_finite() && numbers.next().is_none()).then_some((position, heading))
    }),
};

const EYE: ValueOption<f64> = ValueOption {
    name: "eye",
    value: "HEIGHT",
    takes: "a finite height in cells, such as 0.5",
    help: "How high the eye is above floor level, in cells",
    default: "0.5",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok().filter(|eye: &f64| eye.is_finite())),
};

const PITCH: ValueOption<Pitch> = ValueOption {
    name: "pitch",
    value: "DEG",
    takes: "degrees from -30, down, to 30, up",
    help: "Look down, from -30 degrees, or up, to 30",
    default: "0",
    choices: &[],
    read: Parser::Optional(|text| Pitch::from_degrees(text.parse().ok()?)),
};

const FORMAT: ValueOption<Format> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "text, ansi, json or png",
    help: "How it is written: characters (text), with colours (ansi), a list of cells (json) or a \
           picture of them (png)",
    default: "text",
    choices: &["text", "ansi", "json", "png"],
    read: Parser::Optional(|text| match text {
        "text" => Some(Format::Text),
        "ansi" => Some(Format::Ansi),
        "json" => Some(Format::Json),
        "png" => Some(Format::Png),
        _ => None,
    }),
};

const EXPLAIN: Flag =
    Flag { name: "explain", help: "Say how the frame is drawn and what it costs, in its place" };
