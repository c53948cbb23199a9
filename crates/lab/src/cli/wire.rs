//! `cellcaster-lab wire`: error over bytes.

use std::ffi::{OsStr, OsString};
use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args, ValueHint};
use ratatui::layout::Size;

use crate::report::{Format, Report, Table};
use crate::wire::{WirePlan, report, report_glyphs, report_palettes};
use cellcaster::app::parts::Choice;
use cellcaster::app::{Replay, Settings};
use cellcaster::cli::options::{choice, fidelity, frames, window};
use cellcaster::cli::parse::ValidValues;
use cellcaster::cli::replay::{SHOWCASE, load};
use cellcaster::cli::{Error, level};
use cellcaster::color::palette::ColorDepth;
use cellcaster::map::builtin;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;

/// Measure the bytes of frames and the errors that a viewer sees
///
/// Plays a script off screen, and measures the bytes that its frames send to a terminal.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-lab wire\n  cellcaster-lab wire --script walk.script cellar\n  cellcaster-lab wire --palette 256 --size 80x24\n  cellcaster-lab wire --glyphs all --format svg > glyphs.svg"
)]
pub(crate) struct Wire {
    /// A map file, "-" for standard input, or a built-in level
    map: Option<OsString>,
    /// The script to play [default: a walk in citadel]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    script: Option<PathBuf>,
    /// The size of the window in cells, with sides up to 1000 and up to 200000 cells
    #[arg(long, value_name = "COLSxROWS", default_value = "120x40", value_parser = window)]
    size: Size,
    /// The frames per second, from 1 to 240
    #[arg(long = "fps", value_name = "N", default_value = "30", value_parser = frames)]
    frames_per_second: NonZeroU32,
    /// The colour depth
    #[arg(long = "colors", value_name = "DEPTH", default_value = "true", value_parser = choice::<ColorDepth>())]
    depth: ColorDepth,
    /// The glyph set: half, quadrant, sextant, octant, ascii or ramp; all compares half, quadrant, sextant and octant
    /// in all levels
    #[arg(long, value_name = "SET", default_value = "half", value_parser = glyphs)]
    glyphs: Glyphs,
    /// The largest colour error: exact, high, low, or a number from 0 to 255; may be repeated [default: exact, high and
    /// low]
    #[arg(long = "fidelity", value_name = "LEVEL", value_parser = fidelity)]
    fidelities: Vec<Fidelity>,
    /// Compare ways to choose among 256 or 16 colours in all levels, instead of encoders
    #[arg(long, value_name = "DEPTH", value_parser = palette)]
    palette: Option<ColorDepth>,
    /// The format of the report
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The glyph sets of a report about bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Glyphs {
    One(GlyphSet),
    All,
}

fn palette(text: &str) -> Result<ColorDepth, ValidValues> {
    let depth = ColorDepth::named(text);
    let indexed = [ColorDepth::Indexed256, ColorDepth::Indexed16];
    depth.filter(|depth| indexed.contains(depth)).ok_or(ValidValues("256 or 16"))
}

fn glyphs(text: &str) -> Result<Glyphs, ValidValues> {
    match text {
        "all" => Ok(Glyphs::All),
        _ => GlyphSet::named(text)
            .map(Glyphs::One)
            .ok_or(ValidValues("half, quadrant, sextant, octant, ascii, ramp or all")),
    }
}

/// Writes the report that `options` request.
pub(crate) fn run(options: &Wire) -> Result<(), Error> {
    let &Wire { size, frames_per_second, .. } = options;
    let levels =
        || builtin::LEVELS.iter().filter_map(|level| Some((level.name, level.world().ok()?)));
    let is_played =
        options.map.is_some() || options.script.is_some() || !options.fidelities.is_empty();
    let table = match (options.palette, options.glyphs) {
        (Some(_), _) if is_played => {
            return Err(Error::mistake(
                "--palette compares in all levels: leave out the map, --script and --fidelity",
            ));
        }
        (palette, Glyphs::All) if is_played || palette.is_some() => {
            return Err(Error::mistake(
                "--glyphs all compares in all levels: leave out the map, --script, --fidelity and --palette",
            ));
        }
        (Some(depth), _) => report_palettes(depth, size, frames_per_second, levels()),
        (None, Glyphs::All) => {
            report_glyphs(size, frames_per_second, levels().map(|(_, world)| world))
        }
        (None, Glyphs::One(glyphs)) => encoders(options, glyphs)?,
    };
    Report::print(&[table], options.format)
}

fn encoders(options: &Wire, glyphs: GlyphSet) -> Result<Table, Error> {
    let (script, map) = match &options.script {
        Some(path) => (load(path)?, options.map.as_deref()),
        None => (SHOWCASE.script()?, options.map.as_deref().or(Some(OsStr::new(SHOWCASE.level)))),
    };
    let plan = WirePlan {
        script: &script,
        size: options.size,
        depth: options.depth,
        frames_per_second: options.frames_per_second,
        fidelities: match options.fidelities.as_slice() {
            [] => &[Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW],
            named => named,
        },
    };
    let settings = Settings { depth: Some(options.depth), glyphs, ..Settings::default() };
    Ok(report(&plan, &mut Replay::new(level::load_series(map)?, settings, plan.size)))
}
