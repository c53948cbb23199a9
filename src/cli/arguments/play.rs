//! The options of `play`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::ArgMatches;

use super::generated::{self, Generated};
use super::option::{FileOption, Flag, Parser, ValueOption};
use super::value::{self, FramesPerSecond};
use super::{Command, Error, Subcommand, map};
use crate::color::palette::ColorDepth;
use crate::render::Filter;
use crate::terminal::{Fidelity, UnknownFidelity};
use crate::tui::{CellAspect, GlyphSet};
use crate::world::{Difficulty, FieldOfView};

/// Options of `play`; `None` where the configuration or the terminal decides.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(crate) struct Play {
    pub(crate) map: Option<OsString>,
    /// The generated level instead of a map.
    pub(crate) generated: Option<Generated>,
    pub(crate) config: Option<PathBuf>,
    pub(crate) frames_per_second: Option<FramesPerSecond>,
    pub(crate) field_of_view: Option<FieldOfView>,
    pub(crate) cell_aspect: Option<CellAspect>,
    pub(crate) glyphs: Option<GlyphSet>,
    pub(crate) depth: Option<ColorDepth>,
    pub(crate) filter: Option<Filter>,
    pub(crate) fidelity: Option<FidelityChoice>,
    /// The difficulty; the one chosen before if `None`.
    pub(crate) difficulty: Option<Difficulty>,
    /// Whether to play the daily run, or an endless game.
    pub(crate) is_daily: bool,
    pub(crate) is_endless: bool,
    pub(crate) shows_stats: bool,
    /// The file of the recording.
    pub(crate) record: Option<PathBuf>,
    /// Whether the recording may replace a file.
    pub(crate) overwrites: bool,
    /// Whether to reload the map when it changes.
    pub(crate) watches: bool,
}

/// The choice of fidelity.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FidelityChoice {
    /// As the link allows.
    Auto,
    Fixed(Fidelity),
}

impl FidelityChoice {
    /// The fixed fidelity; `None` if the link decides.
    pub(crate) fn fixed(self) -> Option<Fidelity> {
        match self {
            Self::Auto => None,
            Self::Fixed(fidelity) => Some(fidelity),
        }
    }
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "play",
    about: "Play; without MAP, from the title screen",
    details: "Plays in the terminal. \"?\" shows the keys, and Ctrl-C leaves. What you have reached is kept \
              in the folder for data files, or in the one that CELLCASTER_DATA names. Over SSH it takes \
              \"ssh -t HOST cellcaster\".",
    examples: "cellcaster\n\
               cellcaster play --generate maze --seed 7\n\
               cellcaster play --daily\n\
               cellcaster my.toml --colors 256\n\
               cellcaster play my.toml --watch\n\
               ssh -t host cellcaster\n\
               cellcaster --record walk.script && cellcaster replay walk.script > walk.cast",
    positionals: &[map::OPTIONAL],
    options: &[
        &DIFFICULTY,
        &DAILY,
        &ENDLESS,
        &CONFIG,
        &value::FRAMES_PER_SECOND,
        &value::FIELD_OF_VIEW,
        &CELL_ASPECT,
        &value::GLYPHS,
        &COLORS,
        &value::FILTER,
        &value::CASTER,
        &FIDELITY,
        &STATS,
        &value::WATCH,
        &RECORD,
        &FORCE,
        &generated::GENERATE,
        &generated::SEED,
        &generated::LEVEL_SIZE,
        &generated::START,
    ],
    surplus: "takes one map",
    missing: "",
    read: |matches| Ok(Command::Play(read(matches)?)),
};

fn read(mut matches: ArgMatches) -> Result<Play, Error> {
    let map = map::of(&mut matches);
    let generated = generated::of(&mut matches, map.as_deref())?;
    Ok(Play {
        map,
        generated,
        config: CONFIG.of(&mut matches),
        frames_per_second: value::FRAMES_PER_SECOND.of(&mut matches),
        field_of_view: value::FIELD_OF_VIEW.of(&mut matches),
        cell_aspect: CELL_ASPECT.of(&mut matches),
        glyphs: value::GLYPHS.of(&mut matches),
        depth: COLORS.of(&mut matches),
        filter: value::FILTER.of(&mut matches),
        fidelity: FIDELITY.of(&mut matches),
        difficulty: DIFFICULTY.of(&mut matches),
        is_daily: DAILY.of(&matches),
        is_endless: ENDLESS.of(&matches),
        shows_stats: STATS.of(&matches),
        record: RECORD.of(&mut matches),
        overwrites: FORCE.of(&matches),
        watches: value::WATCH.of(&matches),
    })
}

pub(crate) const CONFIG: FileOption = FileOption {
    name: "config",
    help: "The settings [default: cellcaster/config.toml in the folder for configuration files]",
};

const CELL_ASPECT: ValueOption<CellAspect> =
    ValueOption { default: "what the terminal says, or 2", ..value::CELL_ASPECT };

const COLORS: ValueOption<ColorDepth> =
    ValueOption { default: "what the terminal has", ..value::COLORS };

const FIDELITY: ValueOption<FidelityChoice> = ValueOption {
    name: "fidelity",
    value: "LEVEL",
    takes: "auto, exact, high, low or a number up to 255",
    help: "How exact colours are while something moves: as the link allows (auto), exact, high, low, \
           or how far they may be off, from 0 to 255",
    default: "auto",
    choices: &[],
    read: Parser::Fallible(|text| match text {
        "auto" => Ok(FidelityChoice::Auto),
        _ => text
            .parse()
            .map(FidelityChoice::Fixed)
            .map_err(|error: UnknownFidelity| format!("--fidelity: {error}, or auto")),
    }),
};

const DIFFICULTY: ValueOption<Difficulty> = ValueOption {
    name: "difficulty",
    value: "LEVEL",
    takes: "easy, normal or hard",
    help: "How hard MAP or the endless game is: easy, normal or hard",
    default: "as chosen in the game, or normal",
    choices: &["easy", "normal", "hard"],
    read: Parser::Optional(Difficulty::named),
};

const DAILY: Flag = Flag {
    name: "daily",
    help: "Play the floors of the day, which are the same for all, at normal difficulty; the first \
           try counts",
};

const ENDLESS: Flag =
    Flag { name: "endless", help: "Play floor after floor, each harder than the one before" };

const STATS: Flag =
    Flag { name: "stats", help: "Show frames and bytes a second, round trip and fidelity" };

const RECORD: FileOption = FileOption {
    name: "record",
    help: "Write FILE.cast, which is what the terminal is sent, as asciicast v3; or FILE.script, which \
           is what you do, for replay and wire",
};

const FORCE: Flag = Flag { name: "force", help: "Let --record replace a file" };
