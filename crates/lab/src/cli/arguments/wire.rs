//! The options of `wire`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::ArgMatches;

use cellcaster::cli::arguments::option::{FileOption, Parser, ValueOption};
use cellcaster::cli::arguments::value::{self, FramesPerSecond, Size};
use cellcaster::cli::arguments::{Command, Error, Subcommand, map};
use cellcaster::color::palette::ColorDepth;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;

/// Options of `wire`.
#[derive(Debug)]
pub(crate) struct Wire {
    pub(crate) map: Option<OsString>,
    /// The script; the built-in walk if `None`.
    pub(crate) script: Option<PathBuf>,
    pub(crate) size: Size,
    pub(crate) frames_per_second: FramesPerSecond,
    pub(crate) depth: ColorDepth,
    /// The glyphs; `None` compares those of pixels, instead of encoders.
    pub(crate) glyphs: Option<GlyphSet>,
    /// The named fidelities if empty.
    pub(crate) fidelities: Vec<Fidelity>,
    /// The palette whose methods are compared, instead of encoders.
    pub(crate) palette: Option<ColorDepth>,
    pub(crate) format: WireFormat,
}

/// The format of the report.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum WireFormat {
    #[default]
    Table,
    Json,
    Csv,
    /// A plot; of glyph sets only.
    Svg,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "wire",
    about: "Bytes a frame against what the viewer sees",
    details: "Plays a script off screen, and measures what its frames take on their way to a terminal.",
    examples: "cellcaster wire\n\
               cellcaster wire my.toml --script walk.script --fidelity high --fidelity 12",
    positionals: &[map::OPTIONAL],
    options: &[
        &SCRIPT,
        &SIZE,
        &value::FRAMES_PER_SECOND,
        &GLYPHS,
        &value::COLORS,
        &FIDELITY,
        &PALETTE,
        &FORMAT,
    ],
    surplus: "takes one map",
    missing: "",
    read,
};

fn read(mut matches: ArgMatches) -> Result<Command, Error> {
    let wire = Wire {
        map: map::of(&mut matches),
        script: SCRIPT.of(&mut matches),
        size: SIZE.of(&mut matches).unwrap_or(Size { columns: 120, rows: 40 }),
        frames_per_second: value::FRAMES_PER_SECOND.of(&mut matches).unwrap_or_default(),
        depth: value::COLORS.of(&mut matches).unwrap_or_default(),
        glyphs: GLYPHS.of(&mut matches).unwrap_or(Some(GlyphSet::Half)),
        fidelities: FIDELITY.all_of(&mut matches),
        palette: PALETTE.of(&mut matches),
        format: FORMAT.of(&mut matches).unwrap_or_default(),
    };
    let is_played = wire.map.is_some() || wire.script.is_some() || !wire.fidelities.is_empty();
    if wire.palette.is_some() && is_played {
        return Err(Error::mistake(
            "--palette compares in all levels: leave out the map, --script and --fidelity",
        ));
    }
    if wire.glyphs.is_none() && (is_played || wire.palette.is_some()) {
        return Err(Error::mistake(
            "--glyphs all compares in all levels: leave out the map, --script, --fidelity and --palette",
        ));
    }
    if wire.glyphs.is_some() && matches!(wire.format, WireFormat::Svg) {
        return Err(Error::mistake("--format svg needs --glyphs all"));
    }
    Ok(Command::Wire(wire))
}

const SCRIPT: FileOption =
    FileOption { name: "script", help: "What is played [default: a walk in citadel]" };

const SIZE: ValueOption<Size> = ValueOption { default: "120x40", ..value::WINDOW_SIZE };

const FIDELITY: ValueOption<Fidelity> = ValueOption {
    help: "How far colours may be off: exact, high, low, or from 0 to 255; may be repeated",
    default: "those that have a name",
    repeats: true,
    ..value::FIDELITY
};

const GLYPHS: ValueOption<Option<GlyphSet>> = ValueOption {
    name: "glyphs",
    value: "SET",
    takes: "half, quadrant, sextant, octant, ascii, ramp or all",
    help: "What a cell shows, as in play; `all` compares half, quadrant, sextant and octant in all levels",
    default: "half",
    choices: &["half", "quadrant", "sextant", "octant", "ascii", "ramp", "all"],
    read: Parser::Optional(|text| match text {
        "half" => Some(Some(GlyphSet::Half)),
        "quadrant" => Some(Some(GlyphSet::Quadrant)),
        "sextant" => Some(Some(GlyphSet::Sextant)),
        "octant" => Some(Some(GlyphSet::Octant)),
        "ascii" => Some(Some(GlyphSet::Ascii)),
        "ramp" => Some(Some(GlyphSet::Ramp)),
        "all" => Some(None),
        _ => None,
    }),
    repeats: false,
};

const PALETTE: ValueOption<ColorDepth> = ValueOption {
    name: "palette",
    value: "DEPTH",
    takes: "256 or 16",
    help: "Compare ways to choose among so few colours, in all levels, in place of encoders",
    default: "",
    choices: &["256", "16"],
    read: Parser::Optional(|text| match text {
        "256" => Some(ColorDepth::Indexed256),
        "16" => Some(ColorDepth::Indexed16),
        _ => None,
    }),
    repeats: false,
};

const FORMAT: ValueOption<WireFormat> = ValueOption {
    name: "format",
    value: "FORMAT",
    takes: "table, json, csv or svg",
    help: "How the report is written",
    default: "table",
    choices: &["table", "json", "csv", "svg"],
    read: Parser::Optional(|text| match text {
        "table" => Some(WireFormat::Table),
        "json" => Some(WireFormat::Json),
        "csv" => Some(WireFormat::Csv),
        "svg" => Some(WireFormat::Svg),
        _ => None,
    }),
    repeats: false,
};
