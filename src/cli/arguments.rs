//! The arguments: words to typed options, each mistake one sentence.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use glam::DVec2;
use lexopt::{Arg, Parser};

use super::Error;
use crate::cast::{Method, NotAMethod};
use crate::fault;
use crate::palette::ColorDepth;
use crate::render::Filter;
use crate::tui::{CellAspect, GlyphMode};
use crate::world::{FieldOfView, Heading, Pitch};

/// What is asked for.
#[derive(Debug)]
pub(super) enum Command {
    Help,
    Version,
    Play(Play),
    Snapshot(Snapshot),
    Cast(Cast),
    Check(Vec<OsString>),
    Accuracy(Accuracy),
}

/// Options of `play`; `None` where the terminal or the configuration decides.
#[derive(Debug, Default)]
pub(super) struct Play {
    pub(super) map: Option<OsString>,
    pub(super) config: Option<PathBuf>,
    pub(super) frames_per_second: FramesPerSecond,
    pub(super) field_of_view: FieldOfView,
    pub(super) cell_aspect: Option<CellAspect>,
    pub(super) glyphs: GlyphMode,
    pub(super) depth: Option<ColorDepth>,
    pub(super) method: Method,
    pub(super) filter: Filter,
}

/// Options of `snapshot`.
#[derive(Debug, Default)]
pub(super) struct Snapshot {
    pub(super) map: Option<OsString>,
    pub(super) size: SnapshotSize,
    /// Where to look from; the map's start where there is none.
    pub(super) camera: Option<(DVec2, Heading)>,
    /// How high the eye is; where somebody's is who stands there if there is none.
    pub(super) eye: Option<f64>,
    pub(super) pitch: Pitch,
    pub(super) field_of_view: FieldOfView,
    pub(super) cell_aspect: CellAspect,
    pub(super) glyphs: GlyphMode,
    pub(super) depth: ColorDepth,
    pub(super) format: Format,
    pub(super) method: Method,
    pub(super) filter: Filter,
    /// Whether to tell how the frame is drawn instead of writing it.
    pub(super) explain: bool,
}

/// Options of `cast`.
#[derive(Debug, Default)]
pub(super) struct Cast {
    pub(super) map: Option<OsString>,
    pub(super) method: Method,
}

/// Options of `accuracy`.
#[derive(Debug)]
pub(super) struct Accuracy {
    pub(super) map: Option<OsString>,
    pub(super) set: Option<String>,
    /// None for all.
    pub(super) methods: Vec<Method>,
    /// Rays in each scene.
    pub(super) rays: usize,
    pub(super) seed: u64,
    pub(super) format: ReportFormat,
}

/// How a report is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum ReportFormat {
    Table,
    Json,
    Csv,
    Svg,
    Png,
}

/// The most frames a second, from 1 to 240.
#[derive(Clone, Copy, Debug)]
pub(super) struct FramesPerSecond(pub(super) u32);

impl Default for FramesPerSecond {
    fn default() -> Self {
        Self(30)
    }
}

/// Columns and rows of a snapshot, each from 1 to 4096.
#[derive(Clone, Copy, Debug)]
pub(super) struct SnapshotSize {
    pub(super) columns: u16,
    pub(super) rows: u16,
}

impl Default for SnapshotSize {
    fn default() -> Self {
        Self { columns: 80, rows: 24 }
    }
}

/// How a snapshot is written.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Format {
    #[default]
    Text,
    Ansi,
    Json,
    Png,
}

impl Command {
    /// What `arguments` ask for, the program's own name first.
    pub(super) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, Error> {
        let arguments: Vec<OsString> = arguments.into_iter().skip(1).collect();
        let (name, rest) = match arguments.split_first() {
            Some((first, rest)) if is_command(first) => (first.to_str().unwrap_or_default(), rest),
            _ => ("play", arguments.as_slice()),
        };
        let parser = Parser::from_args(rest);
        match name {
            "snapshot" => parse_snapshot(parser),
            "cast" => parse_cast(parser),
            "check" => parse_check(parser),
            "accuracy" => parse_accuracy(parser),
            "help" => Ok(Self::Help),
            _ => parse_play(parser),
        }
    }
}

pub(super) const COMMANDS: [&str; 6] = ["play", "snapshot", "cast", "check", "accuracy", "help"];

fn is_command(argument: &OsStr) -> bool {
    COMMANDS.iter().any(|&command| argument == command)
}

fn parse_play(mut parser: Parser) -> Result<Command, Error> {
    let mut play = Play::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Short('V') | Arg::Long("version") => return Ok(Command::Version),
            Arg::Value(map) if play.map.is_none() => play.map = Some(map),
            Arg::Long("config") => {
                play.config = Some(word(&mut parser, "--config", "a file")?.into());
            }
            Arg::Long("fps") => play.frames_per_second = FRAMES_PER_SECOND.value(&mut parser)?,
            Arg::Long("fov") => play.field_of_view = FIELD_OF_VIEW.value(&mut parser)?,
            Arg::Long("cell-aspect") => play.cell_aspect = Some(CELL_ASPECT.value(&mut parser)?),
            Arg::Long("glyphs") => play.glyphs = GLYPHS.value(&mut parser)?,
            Arg::Long("colors") => play.depth = Some(COLORS.value(&mut parser)?),
            Arg::Long("caster") => play.method = method(&mut parser)?,
            Arg::Long("filter") => play.filter = FILTER.value(&mut parser)?,
            other => return Err(unexpected("play", &PLAY_OPTIONS, other)),
        }
    }
    Ok(Command::Play(play))
}

fn parse_snapshot(mut parser: Parser) -> Result<Command, Error> {
    let mut snapshot = Snapshot::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if snapshot.map.is_none() => snapshot.map = Some(map),
            Arg::Long("size") => snapshot.size = SIZE.value(&mut parser)?,
            Arg::Long("camera") => snapshot.camera = Some(CAMERA.value(&mut parser)?),
            Arg::Long("eye") => snapshot.eye = Some(EYE.value(&mut parser)?),
            Arg::Long("pitch") => snapshot.pitch = PITCH.value(&mut parser)?,
            Arg::Long("fov") => snapshot.field_of_view = FIELD_OF_VIEW.value(&mut parser)?,
            Arg::Long("cell-aspect") => snapshot.cell_aspect = CELL_ASPECT.value(&mut parser)?,
            Arg::Long("glyphs") => snapshot.glyphs = GLYPHS.value(&mut parser)?,
            Arg::Long("colors") => snapshot.depth = COLORS.value(&mut parser)?,
            Arg::Long("format") => snapshot.format = FORMAT.value(&mut parser)?,
            Arg::Long("caster") => snapshot.method = method(&mut parser)?,
            Arg::Long("filter") => snapshot.filter = FILTER.value(&mut parser)?,
            Arg::Long("explain") => snapshot.explain = true,
            other => return Err(unexpected("snapshot", &SNAPSHOT_OPTIONS, other)),
        }
    }
    Ok(Command::Snapshot(snapshot))
}

fn parse_cast(mut parser: Parser) -> Result<Command, Error> {
    let mut cast = Cast::default();
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if cast.map.is_none() => cast.map = Some(map),
            Arg::Long("caster") => cast.method = method(&mut parser)?,
            other => return Err(unexpected("cast", &["--caster"], other)),
        }
    }
    Ok(Command::Cast(cast))
}

fn parse_accuracy(mut parser: Parser) -> Result<Command, Error> {
    let mut accuracy = Accuracy {
        map: None,
        set: None,
        methods: Vec::new(),
        rays: 2000,
        seed: 1,
        format: ReportFormat::Table,
    };
    while let Some(argument) = next(&mut parser)? {
        match argument {
            Arg::Short('h') | Arg::Long("help") => return Ok(Command::Help),
            Arg::Value(map) if accuracy.map.is_none() => accuracy.map = Some(map),
            Arg::Long("set") => accuracy.set = Some(SET.value(&mut parser)?),
            Arg::Long("caster") => accuracy.methods.push(method(&mut parser)?),
            Arg::Long("rays") => accuracy.rays = RAYS.value(&mut parser)?,
            Arg::Long("seed") => accuracy.seed = SEED.value(&mut parser)?,
            Arg::Long("format") => accuracy.format = REPORT_FORMAT.value(&mut parser)?,
            other => return Err(unexpected("accuracy", &ACCURACY_OPTIONS, other)),
        }
    }
    Ok(Command::Accuracy(accuracy))
}

fn parse_check(mut parser: Parser) -> Result<Command, Error> {
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

const PLAY_OPTIONS: [&str; 9] = [
    "--caster",
    "--cell-aspect",
    "--colors",
    "--config",
    "--filter",
    "--fov",
    "--fps",
    "--glyphs",
    "--version",
];
const SNAPSHOT_OPTIONS: [&str; 12] = [
    "--camera",
    "--caster",
    "--cell-aspect",
    "--colors",
    "--explain",
    "--eye",
    "--filter",
    "--format",
    "--fov",
    "--glyphs",
    "--pitch",
    "--size",
];

const ACCURACY_OPTIONS: [&str; 5] = ["--caster", "--format", "--rays", "--seed", "--set"];

/// An option that takes a value.
struct Valued<T> {
    name: &'static str,
    /// What it takes, to say so where it gets something else.
    takes: &'static str,
    read: fn(&str) -> Option<T>,
}

impl<T> Valued<T> {
    fn value(&self, parser: &mut Parser) -> Result<T, Error> {
        let text = word(parser, self.name, self.takes)?;
        let text = text.to_string_lossy();
        (self.read)(&text).ok_or_else(|| {
            Error::mistake(format!("{} takes {}, not \"{text}\"", self.name, self.takes))
        })
    }
}

const FRAMES_PER_SECOND: Valued<FramesPerSecond> = Valued {
    name: "--fps",
    takes: "a whole number from 1 to 240",
    read: |text| {
        let frames = text.parse().ok().filter(|frames| (1..=240).contains(frames));
        frames.map(FramesPerSecond)
    },
};

const FIELD_OF_VIEW: Valued<FieldOfView> = Valued {
    name: "--fov",
    takes: "degrees above 0 and below 180",
    read: |text| FieldOfView::from_degrees(text.parse().ok()?),
};

const CELL_ASPECT: Valued<CellAspect> = Valued {
    name: "--cell-aspect",
    takes: "the height of a cell over its width, from 0.1 to 10",
    read: |text| CellAspect::new(text.parse().ok()?),
};

const GLYPHS: Valued<GlyphMode> = Valued {
    name: "--glyphs",
    takes: "half or ascii",
    read: |text| match text {
        "half" => Some(GlyphMode::Half),
        "ascii" => Some(GlyphMode::Ascii),
        _ => None,
    },
};

const FILTER: Valued<Filter> = Valued {
    name: "--filter",
    takes: "mip or nearest",
    read: |text| match text {
        "mip" => Some(Filter::Mip),
        "nearest" => Some(Filter::Nearest),
        _ => None,
    },
};

const COLORS: Valued<ColorDepth> = Valued {
    name: "--colors",
    takes: "true, 256, 16 or mono",
    read: |text| match text {
        "true" => Some(ColorDepth::True),
        "256" => Some(ColorDepth::Indexed256),
        "16" => Some(ColorDepth::Indexed16),
        "mono" => Some(ColorDepth::Mono),
        _ => None,
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

const SIZE: Valued<SnapshotSize> = Valued {
    name: "--size",
    takes: "COLSxROWS from 1x1 to 4096x4096, such as 80x24",
    read: |text| {
        let (columns, rows) = text.split_once('x')?;
        let side = |text: &str| text.parse().ok().filter(|side| (1..=4096).contains(side));
        Some(SnapshotSize { columns: side(columns)?, rows: side(rows)? })
    },
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

const SET: Valued<String> =
    Valued { name: "--set", takes: "the name of a set", read: |text| Some(text.to_owned()) };

const RAYS: Valued<usize> = Valued {
    name: "--rays",
    takes: "a whole number from 1 to 10000000",
    read: |text| text.parse().ok().filter(|rays| (1..=10_000_000).contains(rays)),
};

const SEED: Valued<u64> =
    Valued { name: "--seed", takes: "a whole number", read: |text| text.parse().ok() };

const REPORT_FORMAT: Valued<ReportFormat> = Valued {
    name: "--format",
    takes: "table, json, csv, svg or png",
    read: |text| match text {
        "table" => Some(ReportFormat::Table),
        "json" => Some(ReportFormat::Json),
        "csv" => Some(ReportFormat::Csv),
        "svg" => Some(ReportFormat::Svg),
        "png" => Some(ReportFormat::Png),
        _ => None,
    },
};

/// The value of `--caster`, which knows best what is wrong with it.
fn method(parser: &mut Parser) -> Result<Method, Error> {
    let text = word(parser, "--caster", "the name of a method")?;
    let text = text.to_string_lossy();
    text.parse().map_err(|error: NotAMethod| Error::mistake(format!("--caster {text}: {error}")))
}

/// The next argument.
fn next(parser: &mut Parser) -> Result<Option<Arg<'_>>, Error> {
    // What can go wrong here is a value for an option that takes none, such as `--help=yes`.
    parser.next().map_err(|error| Error::mistake(error.to_string()))
}

/// The word after an option.
fn word(parser: &mut Parser, name: &str, takes: &str) -> Result<OsString, Error> {
    parser
        .value()
        .map_err(|_| Error::mistake(format!("{name} takes {takes}, and nothing follows it")))
}

fn unexpected(command: &str, options: &[&str], argument: Arg<'_>) -> Error {
    let help = "\"cellcaster --help\" lists what there is";
    match argument {
        Arg::Value(value) => Error::mistake(format!(
            "{command} takes one map, and \"{}\" is one too many; {help}",
            value.display()
        )),
        Arg::Short(letter) => Error::mistake(format!("{command} has no option -{letter}; {help}")),
        Arg::Long(name) => {
            let name = format!("--{name}");
            let meant = fault::nearest(&name, options);
            let hint = meant.map_or(help.to_owned(), |meant| format!("did you mean {meant}?"));
            Error::mistake(format!("{command} has no option {name}; {hint}"))
        }
    }
}
